//! Finding the lines with the names and the units of the columns.

use super::{block::Block, metadata::without_comment_mark};
use crate::{
    cell::{Cell, Delimiter, cells, number, unit},
    naming::names_quantity,
};

/// Names and units, one entry a column, and the indices of the lines they stand on.
#[derive(Debug, Clone, Default)]
pub(crate) struct Header {
    pub(crate) names_line: Option<usize>,
    /// A line between names and units in which some of the names go on.
    pub(crate) more_line: Option<usize>,
    pub(crate) units_line: Option<usize>,
    pub(crate) labels: Vec<(Option<String>, Option<String>)>,
}

impl Header {
    /// Whether names or units stand on the line with an index.
    pub(crate) fn holds(&self, index: usize) -> bool {
        [self.names_line, self.more_line, self.units_line].contains(&Some(index))
    }
}

/// Looks for names and units in the lines from `skip` to the first one of `block`.
///
/// `wanted` says that there are names for certain (the nearest line is taken, if need be the first one of the
/// block, which then starts one line later) or that there are none.
pub(crate) fn find(lines: &[&str], skip: usize, block: &mut Block, wanted: Option<bool>) -> Header {
    find_in_rows(&|index, block| split(lines[index], block), skip, block, wanted)
}

/// The cells of a line or row of which the index is given.
type Rows<'a> = dyn Fn(usize, &Block) -> Vec<String> + 'a;

/// As [`find`], in rows that are split already.
pub(crate) fn find_in_rows(rows: &Rows<'_>, skip: usize, block: &mut Block, wanted: Option<bool>) -> Header {
    if wanted == Some(false) {
        return label([None; 3], block, rows);
    }
    let above = candidates(rows, skip, block);
    let row = |index: usize| rows(index, block);
    let (names_line, units_line) = match above[..] {
        [near, more, far, ..] if is_units(&row(near)) && go_on(&row(more), &row(far), block) => {
            return label([Some(far), Some(more), Some(near)], block, rows);
        }
        [near, far, ..]
            if is_names(&row(far), block) && (is_units(&row(near)) || are_mostly_units(&row(near), &row(far))) =>
        {
            (Some(far), Some(near))
        }
        [near, ..] if is_bracketed_units(&row(near)) && !has_names_too(&row(near)) => (None, Some(near)),
        [near, ..] if is_names(&row(near), block) => (Some(near), None),
        [near, ..] if wanted == Some(true) => (Some(near), None),
        _ if wanted == Some(true) => (Some(take_first(block)), None),
        _ => (None, None),
    };
    label([names_line, None, units_line], block, rows)
}

/// Whether a row holds the ends of a few of the names above it.
fn go_on(more: &[String], names: &[String], block: &Block) -> bool {
    let count = |row: &[String]| filled(row).count();
    let below_names = more.iter().zip(names).all(|(more, name)| more.is_empty() || !name.is_empty());
    let words = filled(more).all(|cell| number::classify(cell.as_bytes()) == Cell::Text);
    is_names(names, block) && words && 2 * count(more) <= count(names) && below_names
}

/// Makes the first line of the block a line of names.
fn take_first(block: &mut Block) -> usize {
    let names = block.first;
    let next = block.rows().map(|(line, _)| line).nth(1);
    block.first = next.unwrap_or(names + 1);
    names
}

/// The nearest lines above the block that hold anything but the mark of the header's end or the number of a point.
fn candidates(rows: &Rows<'_>, skip: usize, block: &Block) -> Vec<usize> {
    let holds = |index: &usize| {
        let row = rows(*index, block);
        let mut cells = filled(&row);
        let is_point = match (cells.next(), cells.next()) {
            (None, _) => return false,
            // "1  (invalid)": the number of a point without a measurement.
            (Some(only), None) => only.starts_with(|letter: char| letter.is_ascii_digit()) && block.kinds.len() > 2,
            _ => false,
        };
        !is_point && !ends_header(filled(&row))
    };
    (skip..block.first).rev().filter(holds).take(3).collect()
}

/// Whether the cells of a line are a mark of the end of a header: `eoh`, `[EOH]`, `***End_of_Header***`, `END OF HEADER`.
pub(crate) fn ends_header<'c>(mut cells: impl Iterator<Item = &'c str>) -> bool {
    let Some(only) = cells.next().filter(|_| cells.next().is_none()) else {
        return false;
    };
    let letters: String = only.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    matches!(letters.as_str(), "eoh" | "endofheader" | "endheader" | "headerend")
}

/// The cells of a line of names or units.
///
/// Where blanks delimit, names may hold blanks themselves; wider gaps, tabulators or other delimiters then
/// tell them apart, if these give one name a column.
fn split(line: &str, block: &Block) -> Vec<String> {
    let line = without_comment_mark(line);
    let own: Vec<String> = owned(cells(line, block.delimiter));
    let width = block.kinds.len();
    if block.delimiter != Delimiter::Blanks || own.len() == width {
        return own;
    }
    let gaps = || {
        let parts = line.trim().split("  ").flat_map(|part| part.split('\t'));
        owned(parts.filter(|part| !part.trim().is_empty()).collect())
    };
    let mut others = std::iter::once(gaps())
        .chain([Delimiter::Comma, Delimiter::Semicolon].map(|delimiter| owned(cells(line, delimiter))));
    others.find(|row| row.len() == width).unwrap_or_else(|| joined_units(own))
}

/// Puts units in brackets back behind the names that a blank cut them off from.
fn joined_units(row: Vec<String>) -> Vec<String> {
    let mut joined: Vec<String> = Vec::new();
    for cell in row {
        match joined.last_mut() {
            Some(name) if unit::inside_brackets(&cell).is_some() && !name.ends_with([')', ']']) => {
                name.push(' ');
                name.push_str(&cell);
            }
            _ => joined.push(cell),
        }
    }
    joined
}

fn owned(row: Vec<&str>) -> Vec<String> {
    row.into_iter().map(|cell| cell.trim().to_owned()).collect()
}

fn filled(row: &[String]) -> impl Iterator<Item = &str> {
    row.iter().map(String::as_str).filter(|cell| !cell.is_empty())
}

/// Whether a row of cells holds units. A bare "F" is a force, not the farad.
fn is_units(row: &[String]) -> bool {
    filled(row).next().is_some() && filled(row).all(|cell| cell != "F" && unit::stands_alone(cell))
}

/// Whether a row below one of names holds units, some of them unheard of: half of the cells, and two at least, are units that do not
/// stand among the names, and none says what is measured.
fn are_mostly_units(row: &[String], names: &[String]) -> bool {
    let known: Vec<&str> = filled(row).filter(|cell| *cell != "F" && unit::stands_alone(cell)).collect();
    // Single letters alone may be names.
    let plain = known.iter().any(|cell| cell.chars().count() > 1);
    let among_names = filled(row).any(|cell| filled(names).any(|name| name == cell));
    let says = |cell: &str| names_quantity(cell) && !unit::stands_alone(cell);
    known.len() >= 2 && plain && 2 * known.len() >= filled(row).count() && !among_names && !filled(row).any(says)
}

/// Units that cannot be taken for names.
fn is_bracketed_units(row: &[String]) -> bool {
    is_units(row) && filled(row).any(|cell| unit::inside_brackets(cell).is_some())
}

fn has_names_too(row: &[String]) -> bool {
    filled(row).any(|cell| unit::inside_brackets(cell).is_none() && !unit::is_known(cell))
}

/// Whether a row of cells could name the columns of `block`: no numbers, and about one cell a column. More
/// cells than columns are fine (columns that no row fills), far fewer are a title.
fn is_names(row: &[String], block: &Block) -> bool {
    let width = block.kinds.len();
    let count = filled(row).count();
    let kind = |cell: &str| number::classify(cell.as_bytes());
    // Blanks leave no room for empty cells, so more of them than columns are words of a sentence.
    let surplus = row.len() > width && block.delimiter == Delimiter::Blanks;
    row.len() + 1 >= width && !surplus && count >= 2.min(width) && filled(row).all(|cell| kind(cell) == Cell::Text)
}

fn label(lines: [Option<usize>; 3], block: &Block, rows: &Rows<'_>) -> Header {
    let width = block.kinds.len();
    let row = |index: Option<usize>| index.map_or_else(Vec::new, |index| rows(index, block));
    let [names_line, more_line, units_line] = lines;
    let [mut names, more, units] = lines.map(row);
    for (name, more) in names.iter_mut().zip(more).filter(|(_, more)| !more.is_empty()) {
        *name = format!("{name} {more}");
    }
    // Tables with row labels, as R writes them, leave out the name of the labels.
    let shift = usize::from(names.len() + 1 == width && labels_rows(block, rows));
    let entry = |column: usize| {
        let name = column.checked_sub(shift).and_then(|place| names.get(place));
        let cell = name.map_or("", String::as_str);
        match units.get(column).and_then(|unit| unit::alone(unit)) {
            Some(unit) => (Some(cell.to_owned()).filter(|cell| !cell.is_empty()), Some(unit)),
            None => unit::split(cell),
        }
    };
    Header {
        names_line,
        more_line,
        units_line,
        labels: (0..width).map(entry).collect(),
    }
}

/// Whether the first column labels rows: texts, or whole numbers that count them.
fn labels_rows(block: &Block, rows: &Rows<'_>) -> bool {
    let first = |(line, _): (usize, &[Cell])| rows(line, block).into_iter().next().unwrap_or_default();
    let labels: Vec<String> = block.rows().take(3).map(first).collect();
    let counts = |pair: &[String]| match (pair[0].parse::<i64>(), pair[1].parse::<i64>()) {
        (Ok(here), Ok(next)) => next == here + 1,
        (Err(_), Err(_)) => !number::classify(pair[0].as_bytes()).is_numeric(),
        _ => false,
    };
    labels.len() > 1 && labels.windows(2).all(counts)
}
