//! Rows in which a cell holds no number: left out where they are few.

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
}

impl Lacking {
    /// Leaves out the row on a line.
    pub(crate) fn leave_out(&mut self, line: usize, error: impl FnOnce() -> FileError) {
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

    /// Notes them in the columns, or refuses the file where they are more than a few.
    pub(crate) fn noted(mut self, mut read: Columns) -> Result<Columns, FileError> {
        match self.error.take() {
            Some(error) if self.is_much(read.rows()) => Err(error),
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
