//! A workbook as a file that holds several tests.

use std::{
    ops::ControlFlow,
    sync::{Mutex, PoisonError},
};

use super::{
    book::{Book, Visitor},
    gathered::Gathered,
    keyed, read,
    sample::Sample,
    stacked,
    table::{self, FoundTables, Table},
    xls::{self, Xls},
    xlsx::{self, Xlsx},
};
use crate::{
    error::FileError,
    input::Input,
    naming::{MEANS, is_listed, words},
    table::{ColumnKind, Columns, Found, Heard, KeyedTest, Part, ReadOptions, ReadPart, SkippedPart, share},
};

/// How a workbook is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Make {
    /// Office Open XML.
    Xlsx,
    /// A compound file, as of Excel 97 to 2003; perhaps an encrypted workbook of today.
    Xls,
}

/// Whether a file is a workbook, and of which make.
pub(crate) fn recognise(input: &Input) -> Option<Make> {
    let beginning = &input.beginning;
    if beginning.starts_with(xls::SIGNATURE) {
        return Some(Make::Xls);
    }
    let is_zip = beginning.starts_with(b"PK\x03\x04");
    (is_zip && xlsx::has_part(input, "[content_types].xml")).then_some(Make::Xlsx)
}

/// A table and the sheet it is in.
struct Place {
    sheet: usize,
    table: Table,
}

struct Workbook {
    input: Input,
    book: Box<dyn Book>,
    places: Vec<Place>,
    gathered: Mutex<Gathered>,
}

/// Looks for tests in every sheet of a workbook.
pub(crate) fn look_into(input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
    let input = input.unpacked()?;
    let book: Box<dyn Book> = match recognise(&input) {
        Some(Make::Xls) => Box::new(Xls::open(&input)?),
        _ => Box::new(Xlsx::open(&input)?),
    };
    let skip = u32::try_from(options.skip_lines.unwrap_or(0)).unwrap_or(u32::MAX);
    let (mut looked, mut skipped) = (Vec::new(), Vec::new());
    for (index, sheet) in book.sheets().iter().enumerate() {
        let mut pass = |reason| skipped.push((index, SkippedPart::new(&sheet.name, reason)));
        if let Some(other) = sheet.other {
            pass(other);
            continue;
        }
        let pieces = Sample::take(book.as_ref(), index, skip)?;
        if pieces.iter().all(|piece| piece.rows.is_empty()) {
            pass("empty");
            continue;
        }
        let numbers = |table: &Table| table.columns.iter().filter(|column| column.kind == ColumnKind::Number).count();
        let holds = |found: &FoundTables| found.tables.iter().any(|table| numbers(table) >= 2);
        let whole: Vec<bool> = pieces.iter().map(|piece| !piece.cut).collect();
        let stacked = stacked::find(&pieces, options);
        let mut all: Vec<(FoundTables, bool)> = stacked.into_iter().zip(whole).collect();
        all.retain(|(found, _)| holds(found));
        let is_stack = !all.is_empty();
        if !is_stack {
            let joined = Sample::joined(pieces);
            all = vec![(table::find(&joined, options), !joined.cut)];
        }
        if !all.iter().any(|(found, _)| holds(found)) {
            pass("no table of numbers");
            continue;
        }
        for ((found, whole), number) in all.into_iter().zip(1..) {
            let several = found.tables.len() > 1;
            let name = if is_stack { format!("{}, table {number}", sheet.name) } else { sheet.name.clone() };
            for table in found.tables {
                let part = part((&sheet.name, &name), &table, several, found.beside, whole);
                match keyed::cut(&input, book.as_ref(), (index, &table))? {
                    Some(keyed) => {
                        skipped.extend(keyed.skipped.map(|rows| (index, rows)));
                        let column = keyed.column;
                        let tests = keyed.tests.into_iter();
                        looked.extend(
                            tests.map(|(test, table)| (Place { sheet: index, table }, of_test(&part, &column, &test))),
                        );
                    }
                    None => looked.push((Place { sheet: index, table }, part)),
                }
            }
        }
    }
    Ok(chosen(input, book, looked, skipped))
}

/// Whether a sheet holds the mean of the tests beside it, by its name.
fn names_mean(sheet: &str) -> bool {
    words(sheet).iter().any(|word| is_listed(word, MEANS))
}

/// Why a table is no test, given that others name a time.
fn no_test(sheet: &str, table: &Table) -> Option<&'static str> {
    match table.names_time() {
        false if table.has_names() => Some("no column of time"),
        _ if names_mean(sheet) => Some("a mean of tests, by its name"),
        _ => None,
    }
}

/// Where some tables name a time, those that name their columns and no time among them are no tests, nor are means.
fn chosen(
    input: Input,
    book: Box<dyn Book>,
    looked: Vec<(Place, Part)>,
    mut skipped: Vec<(usize, SkippedPart)>,
) -> Found {
    let name = |place: &Place| book.sheets().get(place.sheet).map_or("", |sheet| sheet.name.as_str());
    let timed = looked.iter().any(|(place, _)| place.table.names_time() && !names_mean(name(place)));
    let (mut places, mut parts) = (Vec::new(), Vec::new());
    for (place, part) in looked {
        match no_test(name(&place), &place.table).filter(|_| timed) {
            Some(reason) => skipped.push((place.sheet, SkippedPart::new(part.title(), reason))),
            None => {
                places.push(place);
                parts.push(part);
            }
        }
    }
    skipped.sort_by_key(|(sheet, _)| *sheet);
    Found {
        parts,
        skipped: skipped.into_iter().map(|(_, part)| part).collect(),
        reader: Box::new(Workbook {
            input,
            book,
            places,
            gathered: Mutex::default(),
        }),
    }
}

fn part((sheet, name): (&str, &str), table: &Table, several: bool, beside: usize, whole: bool) -> Part {
    let first = u64::from(table.first_row) + 1;
    let rows = match whole {
        true => format!("rows {first} to {}", u64::from(table.last_row) + 1),
        false => format!("data from row {first}"),
    };
    let beside = match beside {
        0 => String::new(),
        1 => ", 1 cell beside the table skipped".to_owned(),
        count => format!(", {count} cells beside the table skipped"),
    };
    let unnamed = match table.left_out {
        0 => String::new(),
        count => format!(", {count} named values above it skipped"),
    };
    Part {
        name: Some(if several { format!("{name}, {}", table.range()) } else { name.to_owned() }),
        written: format!("sheet {sheet}, {}, {rows}{beside}{unnamed}", table.range()),
        columns: table.columns.clone(),
        metadata: table.metadata.clone(),
        ..Part::default()
    }
}

/// One of the tests that a column of this name tells apart in a part.
fn of_test(part: &Part, column: &str, test: &KeyedTest) -> Part {
    let title = test.title(column);
    Part {
        name: Some(format!("{}, {title}", part.title())),
        written: format!("{}, those with {column} {}", part.written, test.name.as_deref().unwrap_or_default()),
        rows: Some(test.count()),
        ..part.clone()
    }
}

impl ReadPart for Workbook {
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let Some(Place { sheet, table }) = self.places.get(part) else {
            return Ok(Columns::of(columns.len()));
        };
        let name = self.book.sheets().get(*sheet).map_or("", |sheet| sheet.name.as_str());
        // The bytes of the sheet as a share of those of the file.
        let size = self.input.size;
        let mut of_file = |done: u64, total: u64| progress(share(done, total, size), size);
        let days_to_epoch = self.book.days_to_epoch();
        let visit = |each: &mut Visitor<'_>| self.visit(part, *sheet, each);
        read::read(&self.input, (name, table, days_to_epoch), &visit, columns, &mut of_file)
    }
}

impl Workbook {
    /// Visits the cells of a table, perhaps with others around it.
    fn visit(&self, part: usize, sheet: usize, each: &mut Visitor<'_>) -> Result<(), FileError> {
        let in_sheet = |place: Option<&Place>| place.is_some_and(|place| place.sheet == sheet);
        let several = in_sheet(self.places.get(part + 1)) || part > 0 && in_sheet(self.places.get(part - 1));
        if several {
            let mut gathered = self.gathered.lock().unwrap_or_else(PoisonError::into_inner);
            let from_here = self.places.iter().enumerate().skip(part).take_while(|(_, place)| place.sheet == sheet);
            let tables = from_here.map(|(number, place)| (number, &place.table));
            if let Some(cells) = gathered.of(self.book.as_ref(), (sheet, part), tables)? {
                let total = cells.len() as u64;
                for (done, cell) in (1..).zip(cells) {
                    if each(cell.clone(), done, total)? == ControlFlow::Break(()) {
                        break;
                    }
                }
                return Ok(());
            }
        }
        self.book.visit(sheet, each)
    }
}
