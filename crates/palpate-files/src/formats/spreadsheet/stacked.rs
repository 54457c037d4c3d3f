//! Tables one below the other in a sheet.

use super::{
    cell::Value,
    sample::{Row, Sample},
    table::{self, FoundTables, Table},
};
use crate::table::{ReadOptions, RowKind, Starts};

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

/// Where a second table begins, and any further one.
fn starts(rows: &[Row]) -> Vec<usize> {
    let mut starts = Starts::default();
    rows.iter().filter_map(|row| starts.next(kind(row))).collect()
}

fn kind(row: &Row) -> RowKind {
    let labels = |(_, value): &(u32, Value)| value.text().ends_with(':');
    RowKind::of(row.cells.iter().map(|(_, value)| value.class()), row.cells.first().is_some_and(labels))
}
