//! Deciding between the decimal point and the decimal comma.

use std::collections::HashSet;

use super::{block::Block, part::ColumnKind};
use crate::{
    cell::{Cell, DecimalMark, Delimiter, cells, number},
    error::DecimalDoubt,
};

/// Where the decimal mark is uncertain, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Doubt {
    /// Index of the line.
    pub(crate) line: usize,
    /// The text in doubt.
    pub(crate) found: String,
    pub(crate) doubt: DecimalDoubt,
}

impl Doubt {
    /// A doubt about a text on the line with an index.
    fn of((line, found): (usize, &str), doubt: DecimalDoubt) -> Self {
        let found = found.to_owned();
        Self { line, found, doubt }
    }
}

/// The decimal mark of the numbers in `block`. One that is `fixed` settles every doubt but this: a comma that
/// also stands between the cells cannot be a decimal mark.
pub(crate) fn decide(lines: &[&str], block: &Block, fixed: Option<DecimalMark>) -> Result<DecimalMark, Doubt> {
    if fixed != Some(DecimalMark::Point) && comma_splits_numbers(lines, block) {
        return Err(Doubt::of((block.first, lines[block.first]), DecimalDoubt::CommaSplitsNumbers));
    }
    match fixed {
        Some(mark) => Ok(mark),
        None => weigh(lines, block),
    }
}

/// Whether no number has a mark at all.
pub(crate) fn is_unseen(block: &Block) -> bool {
    places(block, Cell::Point).is_empty() && places(block, Cell::Comma).is_empty()
}

/// The first value that is a thousandth of what comes next to it, in a column that began with whole numbers: 996 and then 1.003, whose
/// point sets off thousands.
pub(crate) fn falls_to_a_thousandth(values: &[f64]) -> Option<usize> {
    let is_valid = |value: f64| value == value.trunc();
    let first = values.iter().position(|value| !is_valid(*value))?;
    let small = |value: f64| {
        let thousandths = 1e3 * value;
        (thousandths - thousandths.round()).abs() < 1e-6 * thousandths.abs().max(1.0)
    };
    let alike = |value: f64, other: f64| (0.5..2.0).contains(&(value / other));
    let jumps = |at: &usize| values[at - 1].abs() >= 100.0 && alike(1e3 * values[*at], values[at - 1]);
    // 1.000 is a whole number, too: the jump may lie before it.
    let mut near = (1..=first).rev().take_while(|at| alike(values[*at], values[first]));
    near.find(jumps).filter(|_| small(values[first]))
}

fn weigh(lines: &[&str], block: &Block) -> Result<DecimalMark, Doubt> {
    let texts = |wanted, passed: &[bool]| -> Vec<(usize, &str)> {
        let mut split = (usize::MAX, Vec::new());
        let text = |(line, column): (usize, usize)| {
            // All cells of a line come one behind the other.
            if split.0 != line {
                split = (line, cells(lines[line], block.delimiter));
            }
            (line, split.1.get(column).copied().unwrap_or_default())
        };
        places(block, wanted)
            .into_iter()
            .filter(|(_, column)| passed.get(*column) != Some(&true))
            .map(text)
            .collect()
    };
    let (points, commas) = (texts(Cell::Point, &[]), texts(Cell::Comma, &[]));
    // Where one mark sets off thousands, the other one marks decimals.
    if !points.is_empty() && !commas.is_empty() {
        let other_points = texts(Cell::Point, &thousands(lines, block, DecimalMark::Comma, false));
        let other_commas = texts(Cell::Comma, &thousands(lines, block, DecimalMark::Point, false));
        match (other_points.is_empty(), other_commas.is_empty()) {
            (true, false) => return weigh_texts(&[], &other_commas),
            (false, true) => return weigh_texts(&other_points, &[]),
            _ => {}
        }
    }
    match points.first() {
        Some(&first) if commas.is_empty() && points_set_off_thousands(block, &points) => {
            Err(Doubt::of(first, DecimalDoubt::PointThousands))
        }
        _ => weigh_texts(&points, &commas),
    }
}

/// Columns in which the other mark than that of decimals sets off thousands: beside `1.185`, which alone says nothing, stands `1.185,5` or
/// `1.234.567`; or all others are whole numbers up to 999, and another column has decimals. Where the mark `is_stated`, the other one sets off
/// thousands wherever it can.
pub(crate) fn thousands(lines: &[&str], block: &Block, mark: DecimalMark, is_stated: bool) -> Vec<bool> {
    /// What the cells of a column are.
    #[derive(Clone, Copy, Default)]
    struct Found {
        clear: bool,
        unclear: bool,
        hundreds: bool,
        other: bool,
        contrary: bool,
    }
    let decimals = if mark == DecimalMark::Comma { Cell::Comma } else { Cell::Point };
    let mut found = vec![Found::default(); block.kinds.len()];
    for (line, row) in block.rows() {
        let texts = cells(lines[line], block.delimiter);
        for ((column, text), cell) in found.iter_mut().zip(texts).zip(row).filter(|(_, cell)| cell.is_numeric()) {
            let bytes = text.as_bytes();
            let digits = bytes.iter().filter(|byte| byte.is_ascii_digit()).count();
            match *cell {
                _ if number::grouped(bytes, mark, false).is_some() => column.clear = true,
                _ if number::grouped(bytes, mark, true).is_some() => column.unclear = true,
                Cell::Whole if digits <= 3 => column.hundreds |= digits == 3,
                kind if kind == decimals || kind == Cell::NotFinite => column.other |= kind == decimals,
                _ => column.contrary = true,
            }
        }
    }
    let has_decimals = !places(block, decimals).is_empty();
    let sets_off = |found: Found| {
        let by_whole = found.unclear && (is_stated || found.hundreds && !found.other && has_decimals);
        !found.contrary && (found.clear || by_whole)
    };
    found.into_iter().map(sets_off).collect()
}

/// Whether every point of a file without decimal commas could set off thousands, and something speaks for it.
///
/// Who prints three decimals prints them in every row: whole numbers in a column with such points speak for
/// thousands. So do semicolons between the cells, which are written where the comma marks decimals.
fn points_set_off_thousands(block: &Block, points: &[(usize, &str)]) -> bool {
    if !points.iter().all(|(_, text)| looks_like_thousands(text, '.')) {
        return false;
    }
    let pointed: HashSet<usize> = places(block, Cell::Point).into_iter().map(|(_, column)| column).collect();
    let whole = places(block, Cell::Whole).into_iter().any(|(_, column)| pointed.contains(&column));
    whole || block.delimiter == Delimiter::Semicolon
}

/// The decimal mark of numbers with a point and numbers with a comma, each with the index of its line.
pub(crate) fn weigh_texts(points: &[(usize, &str)], commas: &[(usize, &str)]) -> Result<DecimalMark, Doubt> {
    // A few odd cells are for the reading of the columns to report, one by one.
    let rare = |few: &[(usize, &str)], many: &[(usize, &str)]| few.len() * 50 <= many.len();
    match (points.first(), commas.first()) {
        (_, None) => Ok(DecimalMark::Point),
        (Some(_), Some(_)) if rare(commas, points) => Ok(DecimalMark::Point),
        (Some(_), Some(_)) if rare(points, commas) => Ok(DecimalMark::Comma),
        (Some(&point), Some(&comma)) => {
            Err(Doubt::of(if comma.0 >= point.0 { comma } else { point }, DecimalDoubt::Mixed))
        }
        (None, Some(&comma)) if commas.iter().all(|(_, text)| looks_like_thousands(text, ',')) => {
            Err(Doubt::of(comma, DecimalDoubt::Thousands))
        }
        (None, Some(_)) => Ok(DecimalMark::Comma),
    }
}

/// Line and column indices of the cells of one kind in the columns of numbers.
fn places(block: &Block, wanted: Cell) -> Vec<(usize, usize)> {
    block
        .rows()
        .flat_map(|(line, row)| row.iter().enumerate().map(move |(column, cell)| (line, column, *cell)))
        .filter(|&(_, column, cell)| cell == wanted && block.kinds[column] == ColumnKind::Number)
        .map(|(line, column, _)| (line, column))
        .collect()
}

/// One mark with one to three digits before, the first no zero, and three behind it.
fn looks_like_thousands(cell: &str, mark: char) -> bool {
    let bare = cell.trim_start_matches(['+', '-']);
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    bare.split_once(mark).is_some_and(|(before, behind)| {
        (1..=3).contains(&before.len())
            && digits(before)
            && !before.starts_with('0')
            && behind.len() == 3
            && digits(behind)
    })
}

/// Whether commas between cells seem to cut numbers in two as well: "0,010,0,52" for 0.010 and 0.52.
///
/// Signs of it, given whole numbers only: half as many names as cells, cells that start with a zero like the digits
/// behind a mark, blanks behind every other comma, or rows of whole numbers that vary in length.
fn comma_splits_numbers(lines: &[&str], block: &Block) -> bool {
    let width = block.kinds.len();
    let all_whole = block.rows().all(|(_, row)| row.iter().all(|cell| !matches!(cell, Cell::Point | Cell::Comma)));
    if block.delimiter != Delimiter::Comma || !all_whole {
        return false;
    }
    let row = cells(lines[block.first], Delimiter::Comma);
    let spaced = lines[block.first].matches(", ").count();
    let spaced = width > 2 && spaced > 0 && spaced + 1 < row.len();
    half_as_many_names(lines, block) || spaced || fractions(lines, block) || varying(block)
}

/// Whether the nearest line above the data that could hold names holds half as many as there are cells.
fn half_as_many_names(lines: &[&str], block: &Block) -> bool {
    let above = lines[..block.first].iter().rev();
    let mut names = above
        .map(|line| cells(line, Delimiter::Comma))
        .filter(|row| row.iter().any(|name| !name.is_empty()))
        .skip_while(|row| row.iter().all(|name| name.starts_with(['(', '['])));
    names.next().is_some_and(|names| 2 * names.len() == block.kinds.len())
}

fn fractions(lines: &[&str], block: &Block) -> bool {
    let digits = |cell: &&str| !cell.is_empty() && cell.bytes().all(|byte| byte.is_ascii_digit());
    block.rows().any(|(line, _)| {
        let row = cells(lines[line], Delimiter::Comma);
        row.windows(2).any(|pair| {
            pair[1].len() > 1
                && pair[1].starts_with('0')
                && digits(&pair[1])
                && digits(&pair[0].trim_start_matches('-'))
        })
    })
}

fn varying(block: &Block) -> bool {
    let rows = block.cells[block.first..].iter();
    let whole = rows.filter(|row| !row.is_empty() && row.iter().all(|cell| *cell == Cell::Whole));
    let (same, other): (Vec<_>, Vec<_>) = whole.partition(|row| row.len() == block.kinds.len());
    other.len() >= 2 && other.len() * 10 > same.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decided(lines: &[&str], fixed: Option<DecimalMark>) -> Result<DecimalMark, DecimalDoubt> {
        let block = super::super::block::find(lines, 0, &Delimiter::ALL).expect("a block");
        decide(lines, &block, fixed).map_err(|doubt| doubt.doubt)
    }

    #[test]
    fn clear_cases() {
        assert_eq!(decided(&["1;2", "3;4"], None), Ok(DecimalMark::Point));
        assert_eq!(decided(&["1.5;2", "3;4"], None), Ok(DecimalMark::Point));
        assert_eq!(decided(&["1,5;2", "3;4"], None), Ok(DecimalMark::Comma));
        assert_eq!(decided(&["0,001;1,234"], None), Ok(DecimalMark::Comma));
        assert_eq!(decided(&["\"1,5\",\"2,25\""], None), Ok(DecimalMark::Comma));
        assert_eq!(decided(&["1,2", "3,4"], None), Ok(DecimalMark::Point));
    }

    /// Whole numbers of µm and mN from a German machine were read as a thousandth of what they are.
    #[test]
    fn points_between_thousands_are_no_decimals() {
        let doubt = Err(DecimalDoubt::PointThousands);
        assert_eq!(decided(&["0;0;3", "1;1.000;18.002", "2;2.000;20.110"], None), doubt);
        assert_eq!(decided(&["0\t999", "1\t1.001", "2\t1.012"], None), doubt);
        assert_eq!(decided(&["1;1.000;18.002"], None), doubt);
        assert_eq!(decided(&["0;0;3", "1;1.000;18.002"], Some(DecimalMark::Point)), Ok(DecimalMark::Point));
        // Three decimals in every row, a zero in front, or another number of decimals in some row.
        for plain in [["0\t1.000", "1\t1.001"], ["0;0.999", "1;1.001"], ["0;1", "1;1.25"], ["0.5;1", "1;1.001"]] {
            assert_eq!(decided(&plain, None), Ok(DecimalMark::Point), "{plain:?}");
        }
    }

    /// Thousands that begin after the lines a layout is found out from: 1.003 N was read for 1003 N.
    #[test]
    fn a_column_of_whole_numbers_that_falls_to_a_thousandth_has_points_between_thousands() {
        assert_eq!(falls_to_a_thousandth(&[980.0, 989.0, 996.0, 1.003, 1.01]), Some(3));
        assert_eq!(falls_to_a_thousandth(&[980.0, 989.0, 996.0, 997.5, 1000.25]), None);
        assert_eq!(falls_to_a_thousandth(&[0.0, 0.0, 1.003]), None);
        assert_eq!(falls_to_a_thousandth(&[100.0, 200.0, 300.0]), None);
        // 1.000 was the whole number 1.
        assert_eq!(falls_to_a_thousandth(&[998.0, 999.0, 1.0, 1.001]), Some(2));
        assert_eq!(falls_to_a_thousandth(&[548.0, 549.0, 1.0, 1.0, 1.002]), Some(2));
        assert_eq!(falls_to_a_thousandth(&[600.0, 1.0, 0.5]), None);
    }

    /// `1.185` beside `1.185,5`, or beside 999 in a file with decimal commas, was refused.
    #[test]
    fn a_column_shows_that_a_mark_sets_off_thousands() {
        let comma = Ok(DecimalMark::Comma);
        assert_eq!(decided(&["0,1;998,5", "0,2;1.185", "0,3;1.185,5"], None), comma);
        assert_eq!(decided(&["0,1;997", "0,2;1.001", "0,3;1.005"], None), comma);
        assert_eq!(decided(&["0.1;997", "0.2;1,001", "0.3;1,005"], None), Ok(DecimalMark::Point));
        assert_eq!(decided(&["0,1;1.001", "0,2;1.005"], None), Err(DecimalDoubt::Mixed));
        assert_eq!(decided(&["0,1;997", "0,2;1.001", "0,3;1.05"], None), Err(DecimalDoubt::Mixed));
        assert_eq!(decided(&["0,1;9970", "0,2;1.001", "0,3;1.005"], None), Err(DecimalDoubt::Mixed));
        assert_eq!(decided(&["1;997;1,001", "2;1.001;997", "3;1.005;997"], None), Err(DecimalDoubt::Mixed));
    }

    #[test]
    fn doubts() {
        let split = Err(DecimalDoubt::CommaSplitsNumbers);
        assert_eq!(decided(&["0,010,0,52", "0,020,0,53"], None), split);
        assert_eq!(decided(&["t,F", "0,1,3,52", "0,2,3,53"], None), split);
        assert_eq!(decided(&["0,1, 3,52", "0,2, 3,53"], None), split);
        assert_eq!(decided(&["0,010,0,52"], Some(DecimalMark::Comma)), split);
        assert_eq!(decided(&["0,010,0,52"], Some(DecimalMark::Point)), Ok(DecimalMark::Point));
        assert_eq!(decided(&["1,234;5,678"], None), Err(DecimalDoubt::Thousands));
        assert_eq!(decided(&["1.5;5,67"], None), Err(DecimalDoubt::Mixed));
        assert_eq!(decided(&["1.5;5,67"], Some(DecimalMark::Comma)), Ok(DecimalMark::Comma));
    }
}
