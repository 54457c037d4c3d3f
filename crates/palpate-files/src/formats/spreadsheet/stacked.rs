//! Tables one below the other in a sheet.

use super::{
    sample::Sample,
    table::{self, FoundTables, Table},
};
use crate::table::ReadOptions;

/// The tables of the pieces of a sheet that stand one below the other, each with what stands beside it; empty unless two of them or
/// more have names of columns with a time among them.
pub(super) fn find(pieces: &[Sample], options: &ReadOptions) -> Vec<FoundTables> {
    if pieces.len() < 2 {
        return Vec::new();
    }
    let next = pieces.iter().skip(1).map(|piece| piece.rows.first().map(|row| row.number)).chain([None]);
    let found = pieces.iter().zip(next).map(|(piece, next)| {
        let mut tables = table::find(piece, options);
        let end = next.unwrap_or(u32::MAX);
        tables.tables.iter_mut().for_each(|table| table.rows.iter_mut().for_each(|rows| rows.end = end));
        tables
    });
    let found: Vec<FoundTables> = found.collect();
    let is_timed = |found: &&FoundTables| found.tables.iter().any(Table::names_time);
    if found.iter().filter(is_timed).count() < 2 {
        return Vec::new();
    }
    found
}
