//! Tables one below the other in a sheet.

use super::{
    sample::{Row, Sample},
    table::{self, FoundTables, Table},
};
use crate::{cell::Cell, table::ReadOptions};

/// Most rows from the names of columns to the first row of numbers.
const HEADER: usize = 3;
/// Fewest rows of numbers of a table.
const FEWEST: usize = 2;

/// The tables of a sample that stand one below the other, each with what stands beside it; empty unless two of them or
/// more have names of columns with a time among them.
pub(super) fn find(sample: &Sample, options: &ReadOptions) -> Vec<FoundTables> {
    let starts = starts(&sample.rows);
    if starts.is_empty() {
        return Vec::new();
    }
    let ends = starts.iter().copied().chain([sample.rows.len()]);
    let begins = [0].into_iter().chain(starts.iter().copied());
    let mut found = Vec::new();
    for (begin, end) in begins.zip(ends) {
        let next = sample.rows.get(end).map(|row| row.number);
        let piece = Sample {
            rows: sample.rows[begin..end].to_vec(),
            whole: sample.whole || next.is_some(),
        };
        let mut tables = table::find(&piece, options);
        tables.tables.iter_mut().for_each(|table| table.end = next);
        found.push(tables);
    }
    let is_timed = |found: &&FoundTables| found.tables.iter().any(Table::names_time);
    if found.iter().filter(is_timed).count() < 2 {
        return Vec::new();
    }
    found
}

/// Where a second table begins, and any further one: behind the last row of numbers before names of columns.
fn starts(rows: &[Row]) -> Vec<usize> {
    let mut starts = Vec::new();
    // Rows of numbers since the last start, and the row behind the last of them.
    let (mut data, mut behind) = (0, 0);
    for (index, row) in rows.iter().enumerate() {
        if is_data(row) {
            data += 1;
            behind = index + 1;
        } else if data >= FEWEST && is_names(row) && is_followed(&rows[index + 1..]) {
            starts.push(behind);
            data = 0;
        }
    }
    starts
}

fn count(row: &Row, which: impl Fn(Cell) -> bool) -> usize {
    row.cells.iter().filter(|(_, value)| which(value.class())).count()
}

fn is_data(row: &Row) -> bool {
    count(row, Cell::is_numeric) >= 2
}

fn is_names(row: &Row) -> bool {
    count(row, Cell::is_numeric) == 0 && count(row, |cell| cell == Cell::Text) >= 2
}

/// Whether a table of numbers begins within a header's length.
fn is_followed(rows: &[Row]) -> bool {
    let first = rows.iter().take(HEADER).position(is_data);
    first.is_some_and(|first| rows[first..].iter().take(FEWEST).filter(|row| is_data(row)).count() == FEWEST)
}
