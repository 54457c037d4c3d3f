//! Several tests in one text: tables one below the other, as rheometers export the steps of a test, or rows under the names of actions.
//!
//! | program | what separates the tests |
//! |---|---|
//! | TRIOS (TA Instruments) | a line `[step]`, the name of the step, names, units |
//! | RheoCompass (Anton Paar) | `Result: …`, `Interval and data points: 1 60`, names and units behind a label, in the language of the program |
//! | rSpace (Malvern, Netzsch) | another text in the first column, `Action Name` |
//! | any other, below one line of names | another specimen in its column, or a clock that begins again (`runs.rs`) |
//! | any other | names of columns that repeat, with a time among them; where the clock goes on it is one test (`continued.rs`) |
//!
//! Such a text is held in memory as a whole. One table of any length is not: it is streamed.

use std::{collections::HashMap, ops::Range};

use palpate::{number::counted, record::LabelledSegment};

use super::{
    columns::read_columns,
    continued, detect,
    section::{Section, Stretch},
};
use crate::{
    cell::{Cell, Delimiter, Fields, cells, number},
    error::{FileError, FileProblem},
    input::{Encoding, Input, lines},
    table::{
        Block, Columns, Found, Heard, Label, Layout, Metadata, Part, ReadOptions, ReadPart, RowKind, SkippedPart,
        Starts, names_time,
    },
};

/// Most tests of a text; of a file of more none is read.
const MOST_SECTIONS: usize = 4096;
/// Most bytes of a text of several tests (256 MiB).
const MOST_BYTES: usize = 256 << 20;
/// Most named values of all tests together.
const MOST_NAMED: usize = 1 << 16;
/// Lines that the layout of a test is found out from.
const LAYOUT_LINES: usize = 4000;
/// The first column of rSpace.
const ACTION: &str = "Action Name";

/// A text of several tests.
struct Sections {
    input: Input,
    text: String,
    sections: Vec<Section>,
}

/// The beginning of a text: its lines, the rows of numbers among them, and its encoding.
type Beginning<'b> = (&'b [&'b str], &'b Block, Encoding);

/// Looks for several tests in a text whose beginning shows that it holds some; `None` where it holds one.
pub(super) fn look_into(
    input: &Input,
    (sampled, block, encoding): Beginning<'_>,
    options: &ReadOptions,
) -> Result<Option<Found>, FileError> {
    let (skip, delimiter) = (options.skip_lines.unwrap_or(0), block.delimiter);
    let by_actions = names_actions(sampled, delimiter);
    let marked = by_actions
        || sampled.iter().any(|line| is_step(line))
        || sampled.windows(2).any(|pair| is_interval(pair, delimiter));
    if options.header.is_some() || !marked && !is_stacked(block, skip) {
        return Ok(None);
    }
    // One table alone may leave the decimal mark in doubt.
    let decimal = || Some(detect::of_rows(sampled, block.clone(), encoding, options).ok()?.decimal);
    let fixed = ReadOptions {
        delimiter: Some(delimiter),
        decimal: options.decimal.or_else(decimal),
        skip_lines: None,
        part: None,
        ..options.clone()
    };
    let timed = |sections: &[Section]| sections.iter().filter(|one| names_time(&one.layout.columns)).count();
    if !marked {
        // Numbers above the one table of a long file are no reason to hold it in memory.
        let lines: Vec<Line<'_>> = sampled.iter().map(|line| (0, *line)).collect();
        let places = stacked(&lines, skip, delimiter);
        if timed(&laid_out(&lines, places, (encoding, &fixed)).0) < 2 {
            return Ok(None);
        }
    }
    let text = whole(input, encoding)?;
    let all = numbered(&text);
    let places = if by_actions { by_action(&all, delimiter) } else { stacked(&all, skip, delimiter) };
    check_number(input, &places)?;
    let (sections, skipped) = laid_out(&all, places, (encoding, &fixed));
    let sections = continued::joined(&text, &input.name, sections);
    let is_joined = sections.iter().any(|section| section.repeated > 0);
    let titled = sections.len() > 1 && sections.iter().any(|section| section.title.is_some());
    if timed(&sections) < if titled || is_joined { 1 } else { 2 } {
        return Ok(None);
    }
    Ok(Some(of_sections(input, text, sections, skipped, encoding)))
}

pub(super) fn check_number(input: &Input, places: &[Place]) -> Result<(), FileError> {
    if places.len() > MOST_SECTIONS {
        let expected = format!("at most {MOST_SECTIONS} tests");
        let hint = "split the file, or export a part of it";
        return Err(input.wrong(FileProblem::unfit("the text", expected, format!("{}", places.len()), hint)));
    }
    Ok(())
}

pub(super) fn of_sections(
    input: &Input,
    text: String,
    sections: Vec<Section>,
    skipped: Vec<SkippedPart>,
    encoding: Encoding,
) -> Found {
    let input = input.clone();
    Found {
        parts: parts(&sections, encoding),
        skipped,
        reader: Box::new(Sections { input, text, sections }),
    }
}

/// All of a text, decoded.
pub(super) fn whole(input: &Input, encoding: Encoding) -> Result<String, FileError> {
    let bytes = input.bytes()?;
    let body = &bytes[encoding.mark_length(&bytes)..];
    if body.len() > MOST_BYTES {
        return Err(input.too_large("a text of several tests", MOST_BYTES as u64));
    }
    Ok(encoding.codec().decode_without_bom_handling(body).0.into_owned())
}

/// A line, and where its bytes begin.
pub(super) type Line<'t> = (usize, &'t str);

pub(super) fn numbered(text: &str) -> Vec<Line<'_>> {
    let begins = |line: &str| line.as_ptr() as usize - text.as_ptr() as usize;
    lines::of_text(text).into_iter().map(|line| (begins(line), line)).collect()
}

/// Whether the beginning of a text holds a second table.
fn is_stacked(block: &Block, skip: usize) -> bool {
    let mut starts = Starts::default();
    let kinds = block.cells.iter().skip(skip).map(|row| RowKind::of(row.iter().copied(), false));
    kinds.into_iter().any(|kind| starts.next(kind).is_some())
}

/// Whether two lines are the number of an interval of RheoCompass with that of its points, and names behind a label.
fn is_interval(pair: &[&str], delimiter: Delimiter) -> bool {
    let filled = |line| cells(line, delimiter).into_iter().filter(|cell| !cell.is_empty()).take(4).collect::<Vec<_>>();
    let labelled = |line: &str| first(line, delimiter).ends_with(':');
    labelled(pair[0])
        && labelled(pair[1])
        && matches!(filled(pair[0])[..], [_, number, points] if is_integer(number) && is_integer(points))
        && filled(pair[1]).len() > 2
}

/// The mark of TRIOS above every step, of which the first may be long.
fn is_step(line: &str) -> bool {
    line.trim_end_matches([',', ';', '\t', ' ']).eq_ignore_ascii_case("[step]")
}

fn kind(line: &str, delimiter: Delimiter) -> RowKind {
    let (mut labelled, mut first) = (false, true);
    let filled = Fields::of(line.as_bytes(), delimiter).filter(|cell| !cell.is_empty()).inspect(|cell| {
        labelled |= first && cell.ends_with(b":");
        first = false;
    });
    let cells: Vec<Cell> = filled.map(number::classify).collect();
    RowKind::of(cells.into_iter(), labelled)
}

/// Whether a text has the names of rSpace.
fn names_actions(sampled: &[&str], delimiter: Delimiter) -> bool {
    sampled.iter().any(|line| first(line, delimiter) == ACTION)
}

/// The first cell of a line.
fn first(line: &str, delimiter: Delimiter) -> &str {
    let cell = Fields::of(line.as_bytes(), delimiter).next().unwrap_or_default();
    // Cells are cut at ASCII bytes only, so every cell of a text is text.
    std::str::from_utf8(cell).unwrap_or_default()
}

/// A test by the indices of its lines: those of its names, where these stand elsewhere, and its own, stretch by stretch.
pub(super) struct Place {
    pub(super) title: Option<String>,
    /// Whether the title is that of these rows alone, and not of a result of several intervals.
    pub(super) is_step: bool,
    pub(super) names: Range<usize>,
    pub(super) lines: Vec<Range<usize>>,
}

/// The tables of a text that stand one below the other.
fn stacked(all: &[Line<'_>], skip: usize, delimiter: Delimiter) -> Vec<Place> {
    let mut starts = Starts::default();
    let later = all.iter().skip(skip).filter_map(|(_, line)| starts.next(kind(line, delimiter)));
    let mut bounds: Vec<usize> = [0].into_iter().chain(later).map(|start| skip + start).collect();
    bounds.push(all.len());
    let mut result = None;
    let place = |pair: &[usize]| {
        let lines = pair[0]..pair[1];
        let head = all[lines.clone()].iter().map(|(_, line)| *line);
        let head = head.take_while(|line| kind(line, delimiter) != RowKind::Data);
        let (title, is_step) = title(head, delimiter, &mut result);
        Place {
            title,
            is_step,
            names: 0..0,
            lines: vec![lines],
        }
    };
    bounds.windows(2).map(place).collect()
}

/// What the lines above a table call it, and whether that is the name of a step; else it is the number of an interval and the result that it
/// belongs to.
fn title<'t>(
    head: impl Iterator<Item = &'t str>,
    delimiter: Delimiter,
    result: &mut Option<String>,
) -> (Option<String>, bool) {
    let (mut step, mut interval, mut behind_mark) = (None, None, false);
    for line in head {
        let filled: Vec<&str> = cells(line, delimiter).into_iter().filter(|cell| !cell.is_empty()).collect();
        match filled[..] {
            [only] if behind_mark => step = Some(only.to_owned()),
            [label, value] if label.ends_with(':') => *result = Some(value.to_owned()),
            [label, number, points] if label.ends_with(':') && is_integer(number) && is_integer(points) => {
                interval = Some(number.to_owned());
            }
            _ => {}
        }
        behind_mark = is_step(line);
    }
    let is_step = step.is_some();
    let title = step.or_else(|| match (result, interval) {
        (Some(result), Some(interval)) => Some(format!("{result}, interval {interval}")),
        (None, Some(interval)) => Some(format!("interval {interval}")),
        _ => None,
    });
    (title, is_step)
}

fn is_integer(cell: &str) -> bool {
    number::classify(cell.as_bytes()) == Cell::Whole
}

/// The stretches of rows under one action each.
fn by_action(all: &[Line<'_>], delimiter: Delimiter) -> Vec<Place> {
    let Some(names) = all.iter().position(|(_, line)| first(line, delimiter) == ACTION) else {
        return Vec::new();
    };
    let mut places: Vec<Place> = Vec::new();
    for (index, (_, line)) in all.iter().enumerate().skip(names + 1).filter(|(_, (_, line))| !line.trim().is_empty()) {
        let action = first(line, delimiter);
        match places.last_mut() {
            Some(place) if action.is_empty() || place.title.as_deref() == Some(action) => {
                place.lines.iter_mut().for_each(|lines| lines.end = index + 1);
            }
            _ => places.push(Place {
                title: Some(action.to_owned()),
                is_step: true,
                names: names..names + 1,
                lines: std::iter::once(index..index + 1).collect(),
            }),
        }
    }
    places
}

/// The tests with the layout of each, and those that have none.
pub(super) fn laid_out(
    all: &[Line<'_>],
    places: Vec<Place>,
    (encoding, options): (Encoding, &ReadOptions),
) -> (Vec<Section>, Vec<SkippedPart>) {
    let (mut sections, mut skipped) = (Vec::new(), Vec::new());
    for (place, number) in places.into_iter().zip(1..) {
        let ranges = || [place.names.clone()].into_iter().chain(place.lines.iter().cloned());
        let own = || ranges().flat_map(|range| &all[range]).map(|(_, line)| *line);
        let lines: Vec<&str> = own().take(LAYOUT_LINES).collect();
        let layout = detect::rows(&lines, options);
        match layout.and_then(|block| detect::of_rows(&lines, block, encoding, options)) {
            Ok(layout) => sections.push(Section {
                held: place
                    .title
                    .as_deref()
                    .filter(|title| place.is_step && is_held(title))
                    .map(|_| own().skip(layout.first_data_line - 1).filter(|line| !line.trim().is_empty()).count()),
                title: place.title,
                stretches: ranges().filter_map(|range| stretch(all, range)).collect(),
                repeated: 0,
                layout,
            }),
            Err(_) => {
                let name = place.title.unwrap_or_else(|| format!("table {number}"));
                skipped.push(SkippedPart::new(name, "no table of numbers"));
            }
        }
    }
    (sections, skipped)
}

/// Whether a step is a hold by its name.
fn is_held(title: &str) -> bool {
    LabelledSegment::new(title, 0.0, 0.0).is_some_and(|label| label.holds)
}

/// Successive lines by their indices; `None` where there are none.
fn stretch(all: &[Line<'_>], range: Range<usize>) -> Option<Stretch> {
    let (begin, _) = all.get(range.start).filter(|_| !range.is_empty())?;
    let (last, line) = all.get(range.end - 1)?;
    Some(Stretch {
        first: range.start + 1,
        lines: range.len(),
        bytes: *begin..last + line.len(),
    })
}

/// The tests as parts of the file. What the lines above the first name, such as the geometry of a rheometer, belongs to all.
fn parts(sections: &[Section], encoding: Encoding) -> Vec<Part> {
    let common = sections.first().map_or(&[][..], |first| &first.layout.metadata);
    let mut times: HashMap<&str, usize> = HashMap::new();
    sections
        .iter()
        .filter_map(|section| section.title.as_deref())
        .for_each(|title| *times.entry(title).or_default() += 1);
    let mut room = MOST_NAMED;
    let part = |(section, number): (&Section, usize)| {
        let own = if number == 1 { &[][..] } else { &section.layout.metadata };
        let mut metadata: Vec<Metadata> = common.iter().chain(own).take(room).cloned().collect();
        room -= metadata.len();
        metadata.shrink_to_fit();
        let labels = section.title.iter().zip(section.held).map(|(title, rows)| Label {
            name: title.clone(),
            start: 0,
            end: rows,
        });
        let name = match section.title.as_deref() {
            Some(title) if times[title] == 1 => Some(title.to_owned()),
            Some(title) => Some(format!("{title}, table {number}")),
            None if sections.len() == 1 => None,
            None => Some(format!("table {number}")),
        };
        let again = match section.repeated {
            0 => String::new(),
            count => format!(", names repeated {}", counted(count, "time")),
        };
        let layout = Layout {
            encoding,
            first_data_line: section.excerpt().line(section.layout.first_data_line).0,
            ..section.layout.clone()
        };
        Part {
            name,
            written: format!("{layout}{again}"),
            columns: layout.columns,
            metadata,
            labels: labels.collect(),
            ..Part::default()
        }
    };
    sections.iter().zip(1..).map(part).collect()
}

impl ReadPart for Sections {
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let Some(section) = self.sections.get(part) else {
            return Ok(Columns::of(columns.len()));
        };
        let input = Input::from_bytes(&self.input.name, section.text(&self.text).into_bytes())?;
        let layout = Layout {
            encoding: Encoding::Utf8,
            ..section.layout.clone()
        };
        let read = read_columns(&input, &layout, columns, progress);
        let excerpt = section.excerpt();
        read.map(|read| read.of_excerpt(&excerpt))
            .map_err(|error| error.on_lines(&|line| excerpt.line(line).0))
    }
}
