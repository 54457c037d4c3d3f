//! What is gone over before `calamine` sees an archive, and that it takes at its word or passes over.
//!
//! It reserves memory by the number of shared texts that a part states, keeps styles with all they name, wraps places
//! that are too large for its numbers, takes the first shared text where a number is none, and drops what stands in a
//! value beside plain text. All of this is damage here, and reported with its place.

use std::borrow::Cow;

use quick_xml::{
    escape::resolve_xml_entity,
    events::{BytesStart, Event, attributes::Attribute},
};

use super::package::{MOST_KEPT, MOST_OF_CELL, MOST_OF_SHEET, Package, WHAT_OF_CELL};
use crate::{
    error::{FileError, FileProblem},
    faults::admits,
    formats::spreadsheet::{
        book::MOST_SHEETS,
        cell::{MOST_COLUMNS, MOST_ROWS, letters, reference},
    },
};

/// Most texts that the sheets share: each takes 24 bytes beside its letters.
const MOST_TEXTS: u64 = 2 << 20;
/// Most bytes that all styles take (128 MiB).
const MOST_OF_STYLES: u64 = 128 << 20;
/// What a style takes beside its names, rounded up.
const STYLE: u64 = 512;
/// The errors that `calamine` knows.
const FAULTS: [&str; 7] = ["#DIV/0!", "#N/A", "#NAME?", "#NULL!", "#NUM!", "#REF!", "#VALUE!"];

/// What an archive was found to hold.
#[derive(Default)]
pub(super) struct Found {
    /// The part that the archive is about.
    pub(super) document: String,
    /// Whether that part names sheets.
    pub(super) has_sheets: bool,
    texts: u64,
    /// Bytes of the parts gone over.
    unpacked: u64,
}

/// Goes over every part of XML.
pub(super) fn check(package: &Package) -> Result<Found, FileError> {
    let mut found = Found::default();
    for path in package.parts() {
        let mut part = Checked {
            package,
            path,
            found: &mut found,
            tally: Tally::default(),
            rows: None,
        };
        package.read(path, MOST_OF_SHEET, &mut |event, done| part.take(event, done))?;
    }
    Ok(found)
}

/// A part that is gone over.
struct Checked<'a> {
    package: &'a Package,
    path: &'a str,
    found: &'a mut Found,
    tally: Tally,
    /// Inside of the rows of a sheet.
    rows: Option<Rows>,
}

/// What a part has many of, and what is large in it.
#[derive(Default)]
struct Tally {
    is_sheet: bool,
    texts: u64,
    texts_stated: u64,
    styles: u64,
    sheets: usize,
    longest_name: u64,
    /// Where the cell or the shared text that is open began.
    open: Option<u64>,
}

/// Where in the rows of a sheet.
#[derive(Default)]
struct Rows {
    row: u32,
    column: u32,
    last: Option<(u32, u32)>,
    cell: Option<OpenCell>,
}

/// A cell that has begun.
#[derive(Default)]
struct OpenCell {
    kind: String,
    /// Inside of its value.
    in_value: bool,
    /// Its value has ended.
    valued: bool,
    text: String,
}

impl OpenCell {
    /// Its value may be any text, with entities.
    fn is_text(&self) -> bool {
        matches!(self.kind.as_str(), "str" | "d" | "inlineStr" | "is")
    }
}

impl Checked<'_> {
    fn take(&mut self, event: &Event<'_>, done: u64) -> Result<(), FileError> {
        if !self.tally.is_sheet {
            self.package.input.bounded(done, "a part of the workbook", MOST_KEPT)?;
        }
        // Members of an archive may be the same bytes.
        self.package.input.bounded(self.found.unpacked + done, "the workbook", u64::MAX)?;
        self.measure(event, done)?;
        match event {
            Event::Start(element) if self.rows.is_some() => self.begin_in_rows(element),
            Event::Start(element) => self.begin(element),
            Event::End(element) => self.end_in_rows(element.local_name().as_ref()),
            Event::Text(text) => {
                let cell = self.rows.as_mut().and_then(|rows| rows.cell.as_mut());
                if let Some(cell) = cell.filter(|cell| cell.in_value) {
                    cell.text.push_str(&text.xml10_content());
                }
                Ok(())
            }
            // A letter by its name or number.
            Event::GeneralRef(entity) => {
                let letter = entity.resolve_char_ref().ok().flatten();
                if letter.is_none() && resolve_xml_entity(entity.as_ref()).is_none() {
                    return Err(self.package.damaged(self.path, "XML", &format!("&{};", entity.as_ref())));
                }
                self.in_value(OpenCell::is_text, "an entity")
            }
            Event::Eof => self.finish(done),
            // A remark, an instruction, a section of raw text.
            _ => self.in_value(|cell| cell.kind == "inlineStr", "something else"),
        }
    }

    /// A cell and a shared text are held in memory with all that they are made of.
    fn measure(&mut self, event: &Event<'_>, done: u64) -> Result<(), FileError> {
        match event {
            Event::Start(element) if matches!(element.local_name().as_ref(), "c" | "si") => {
                self.tally.open = Some(done);
            }
            Event::End(element) if matches!(element.local_name().as_ref(), "c" | "si") => self.tally.open = None,
            _ => {}
        }
        match self.tally.open {
            Some(began) if !admits(done - began, MOST_OF_CELL) => {
                Err(self.package.input.too_large(WHAT_OF_CELL, MOST_OF_CELL))
            }
            _ => Ok(()),
        }
    }

    fn begin(&mut self, element: &BytesStart<'_>) -> Result<(), FileError> {
        let name = element.local_name();
        match name.as_ref() {
            "si" => self.tally.texts += 1,
            "sst" => {
                let stated = self.stated(element, "uniqueCount")?;
                let stated = stated.map_or(0, |stated| stated.trim().parse().unwrap_or(u64::MAX));
                self.tally.texts_stated = self.tally.texts_stated.max(stated);
            }
            "xf" | "font" | "fill" | "border" => self.tally.styles += 1,
            "sheetData" => {
                self.tally.is_sheet = true;
                self.rows = Some(Rows::default());
            }
            "Relationship" => self.relation(element)?,
            "sheet" => self.tally.sheets += 1,
            "numFmt" => {
                let lengths = self.attributes(element)?.into_iter().map(|attribute| attribute.value.len() as u64);
                self.tally.longest_name = lengths.fold(self.tally.longest_name, u64::max);
            }
            _ => {}
        }
        Ok(())
    }

    fn attributes<'a>(&self, element: &'a BytesStart<'_>) -> Result<Vec<Attribute<'a>>, FileError> {
        let all: Result<Vec<Attribute<'a>>, _> = element.attributes().with_checks(false).collect();
        all.map_err(|error| self.package.damaged(self.path, "attributes", &error.to_string()))
    }

    /// The value of an attribute, the first of exactly this name, as `calamine` takes it.
    fn stated<'a>(&self, element: &'a BytesStart<'_>, name: &str) -> Result<Option<Cow<'a, str>>, FileError> {
        let mut all = self.attributes(element)?.into_iter();
        Ok(all.find(|attribute| attribute.key.as_ref() == name).map(|attribute| attribute.value))
    }

    /// Parts that are read are those gone over here: other names would lead around.
    fn relation(&mut self, element: &BytesStart<'_>) -> Result<(), FileError> {
        let kind = self.stated(element, "Type")?.unwrap_or_default();
        let kind = kind.rsplit('/').next().unwrap_or_default();
        let target = self.stated(element, "Target")?.unwrap_or_default();
        let lower = target.to_ascii_lowercase();
        match kind {
            "officeDocument" if lower.ends_with(".bin") => {
                let (expected, found) = ("a workbook of XML parts (.xlsx)", "one of binary parts (.xlsb)");
                let hint = "open it in its program and save it as .xlsx";
                return Err(self.package.input.wrong(FileProblem::unfit("zip archive", expected, found, hint)));
            }
            "officeDocument" if self.path == "_rels/.rels" => target.as_ref().clone_into(&mut self.found.document),
            _ => {}
        }
        // Texts and styles are looked for under one name only, and sheets without them would show other values.
        let document = self.found.document.to_lowercase();
        let folder = document.trim_start_matches('/').rsplit_once('/').map_or("", |(folder, _)| folder);
        let only = |name: &str| lower == name || lower.trim_start_matches('/') == format!("{folder}/{name}");
        let fits = match kind {
            "officeDocument" | "worksheet" => lower.ends_with(".xml"),
            "styles" => only("styles.xml"),
            "sharedStrings" => only("sharedstrings.xml"),
            _ => true,
        };
        if !fits {
            return Err(self.package.damaged(self.path, "the usual path of a part", &target));
        }
        Ok(())
    }

    fn begin_in_rows(&mut self, element: &BytesStart<'_>) -> Result<(), FileError> {
        let name = element.local_name();
        let (place, kind) = match name.as_ref() {
            "row" | "c" => (self.stated(element, "r")?, self.stated(element, "t")?),
            _ => (None, None),
        };
        let damaged = |expected: &str, found: &str| Err(self.package.damaged(self.path, expected, found));
        let Some(rows) = &mut self.rows else { return Ok(()) };
        match (name.as_ref(), &mut rows.cell) {
            ("row", _) => {
                if let Some(text) = place {
                    match text.parse() {
                        Ok(number @ 1..=MOST_ROWS) => rows.row = number - 1,
                        _ => return damaged("the number of a row", &text),
                    }
                }
            }
            ("c", _) => {
                let place = match place {
                    None => (rows.row, rows.column),
                    Some(text) => match reference(&text) {
                        Some(place) => place,
                        None => return damaged("the position of a cell", &text),
                    },
                };
                rows.column = place.1;
                rows.cell = Some(OpenCell {
                    kind: kind.unwrap_or("n".into()).into_owned(),
                    ..OpenCell::default()
                });
                let late = rows.last.replace(place).is_some_and(|last| last >= place);
                if late || place.0 >= MOST_ROWS || place.1 >= MOST_COLUMNS {
                    return self.wrong("cells row by row inside of a sheet", "a cell out of order");
                }
            }
            ("v", Some(cell)) if !cell.valued && !cell.in_value => {
                cell.in_value = true;
                cell.text.clear();
            }
            // Text of its own, or the formula, which stand before the value.
            ("is" | "f", Some(cell)) if !cell.valued && !cell.in_value => {}
            (_, Some(cell)) if cell.in_value || cell.valued => return self.wrong("one plain value", name.as_ref()),
            _ => {}
        }
        Ok(())
    }

    fn end_in_rows(&mut self, name: &str) -> Result<(), FileError> {
        let texts = self.found.texts;
        let Some(rows) = &mut self.rows else { return Ok(()) };
        match (name, &mut rows.cell) {
            ("sheetData", _) => self.rows = None,
            ("row", _) => {
                rows.row += 1;
                rows.column = 0;
            }
            ("c", _) => {
                rows.cell = None;
                rows.column += 1;
            }
            ("v", Some(cell)) => {
                (cell.in_value, cell.valued) = (false, true);
                let text = std::mem::take(&mut cell.text);
                if let Some(expected) = expected(&cell.kind, &text, texts) {
                    return self.wrong(expected, &text);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// What stands beside plain text is damage inside of a value, unless it is `allowed` there.
    fn in_value(&mut self, allowed: impl Fn(&OpenCell) -> bool, found: &str) -> Result<(), FileError> {
        let cell = self.rows.as_ref().and_then(|rows| rows.cell.as_ref());
        match cell {
            Some(cell) if cell.in_value && !allowed(cell) => self.wrong("plain text", found),
            _ => Ok(()),
        }
    }

    /// Damage in the cell that has been come to last.
    fn wrong(&self, expected: &str, found: &str) -> Result<(), FileError> {
        let (row, column) = self.rows.as_ref().and_then(|rows| rows.last).unwrap_or_default();
        let place = format!("{}, cell {}{}", self.path, letters(column), u64::from(row) + 1);
        Err(self.package.damaged(&place, expected, found))
    }

    fn finish(&mut self, done: u64) -> Result<(), FileError> {
        let tally = &self.tally;
        let damaged = |expected: &str, found: u64| Err(self.package.damaged(self.path, expected, &found.to_string()));
        self.found.texts += tally.texts;
        self.found.unpacked += done;
        // The shortest is `<si/>`.
        if tally.texts_stated > done / 5 {
            return damaged("as many shared texts as there are bytes for", tally.texts_stated);
        }
        if self.found.texts > MOST_TEXTS {
            return damaged("at most 2097152 shared texts", self.found.texts);
        }
        if tally.styles.saturating_mul(STYLE + tally.longest_name) > MOST_OF_STYLES {
            return damaged("styles of at most 128 MiB", tally.styles);
        }
        if tally.sheets > MOST_SHEETS {
            return damaged("at most 4096 sheets", tally.sheets as u64);
        }
        let document = self.found.document.trim_start_matches('/').to_lowercase();
        self.found.has_sheets |= self.path == document && tally.sheets > 0;
        Ok(())
    }
}

/// What is expected of the value of a cell, if this is not so.
fn expected(kind: &str, text: &str, texts: u64) -> Option<&'static str> {
    let (expected, fits) = match kind {
        _ if text.is_empty() => return None,
        "n" => ("a number", text.parse().is_ok_and(f64::is_finite)),
        "s" => {
            let digits = text.len() <= 10 && text.bytes().all(|byte| byte.is_ascii_digit());
            ("the number of a shared text", digits && text.parse().is_ok_and(|number: u64| number < texts))
        }
        "e" => ("an error that Excel has", FAULTS.contains(&text)),
        _ => return None,
    };
    (!fits).then_some(expected)
}
