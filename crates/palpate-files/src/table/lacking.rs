//! Rows in which a cell holds no number: left out where they are few.

use std::collections::BTreeMap;

use super::columns::{Columns, LackingRows};
use crate::error::FileError;

/// How many lines of such rows are named.
const NAMED: usize = 3;
/// Largest share of the rows that may lack a number, in percent. More are no slip of a logger: the file is not what it seems.
const MOST_PERCENT: usize = 3;

/// Such rows while a file is read, with what is wrong with the first.
#[derive(Default)]
pub(crate) struct Lacking {
    found: LackingRows,
    /// How many of them hold nothing at all in the chosen columns: points without a measurement, of which no number is lost.
    bare: usize,
    error: Option<FileError>,
    /// Of each column, by index, its cells without a number.
    columns: BTreeMap<usize, LackingRows>,
}

impl Lacking {
    /// Leaves out the row on a line, in which the cells of these columns hold no number.
    pub(crate) fn leave_out(
        &mut self,
        line: usize,
        cells: impl Iterator<Item = usize>,
        error: impl FnOnce() -> FileError,
    ) {
        for column in cells {
            let found = self.columns.entry(column).or_default();
            found.rows += 1;
            if found.lines.len() < NAMED {
                found.lines.push(line);
            }
        }
        self.found.rows += 1;
        if self.found.lines.len() < NAMED {
            self.found.lines.push(line);
        }
        self.error.get_or_insert_with(error);
    }

    /// Leaves out the row on a line, which holds nothing in the chosen columns.
    pub(crate) fn leave_out_bare(&mut self, line: usize) {
        self.found.rows += 1;
        self.bare += 1;
        if self.found.lines.len() < NAMED {
            self.found.lines.push(line);
        }
    }

    /// Notes them in the columns, or refuses the file where they are more than a few: for `many` cells of a column, by its index, of so many
    /// rows.
    pub(crate) fn noted(
        mut self,
        mut read: Columns,
        many: impl FnOnce(usize, LackingRows, usize) -> FileError,
    ) -> Result<Columns, FileError> {
        match self.error.take() {
            Some(error) if self.is_much(read.rows()) => {
                let rows = self.found.rows + read.rows();
                // The first of several alike.
                let worst = self.columns.into_iter().rev().max_by_key(|(_, found)| found.rows);
                Err(worst
                    .filter(|(_, found)| found.rows > 1)
                    .map_or(error, |(column, found)| many(column, found, rows)))
            }
            _ => {
                read.ignored.lacking = self.found;
                Ok(read)
            }
        }
    }
    /// Whether more than a few of so many rows that are kept and of those that lack a number lack one.
    fn is_much(&self, kept: usize) -> bool {
        let lacking = self.found.rows - self.bare;
        100 * lacking > MOST_PERCENT * (lacking + kept)
    }
}
