//! The beginning of a sheet.

use std::{collections::BTreeSet, ops::ControlFlow};

use super::{
    book::Book,
    cell::{Cell, Value},
};
use crate::error::FileError;

/// Most rows looked at; what they do not show of a table, more would not either.
const MOST_ROWS: usize = 4000;
/// Most cells looked at, a long text as several.
const MOST_CELLS: usize = 400_000;

/// The first rows of a sheet, those without a cell left out.
pub(super) struct Sample {
    pub(super) rows: Vec<Row>,
    /// All of the sheet is in the sample.
    pub(super) whole: bool,
}

/// A row of a sheet.
#[derive(Clone)]
pub(super) struct Row {
    /// Its number, from 0.
    pub(super) number: u32,
    /// Columns from 0 and what they hold, left to right.
    pub(super) cells: Vec<(u32, Value)>,
}

impl Row {
    pub(super) fn value(&self, column: u32) -> Option<&Value> {
        let index = self.cells.binary_search_by_key(&column, |(own, _)| *own).ok()?;
        Some(&self.cells[index].1)
    }
}

impl Sample {
    /// Takes the beginning of a sheet, from row `skip` (from 0) on.
    pub(super) fn take(book: &dyn Book, sheet: usize, skip: u32) -> Result<Self, FileError> {
        let mut sample = Self {
            rows: Vec::new(),
            whole: true,
        };
        let mut cells = 0;
        book.visit(sheet, &mut |cell: Cell, _, _| {
            if cell.row < skip {
                return Ok(ControlFlow::Continue(()));
            }
            let begins = sample.rows.last().is_none_or(|row| row.number != cell.row);
            if begins && (sample.rows.len() == MOST_ROWS || cells > MOST_CELLS) {
                sample.whole = false;
                return Ok(ControlFlow::Break(()));
            }
            if begins {
                sample.rows.push(Row {
                    number: cell.row,
                    cells: Vec::new(),
                });
            }
            cells += cell.value.weight();
            if let Some(row) = sample.rows.last_mut() {
                row.cells.push((cell.column, cell.value));
            }
            Ok(ControlFlow::Continue(()))
        })?;
        Ok(sample)
    }

    /// The columns that hold anything in the rows from index `first` on, each once, in their order.
    pub(super) fn columns(&self, first: usize) -> Vec<u32> {
        let rows = self.rows.iter().skip(first);
        let columns: BTreeSet<u32> = rows.flat_map(|row| row.cells.iter().map(|(column, _)| *column)).collect();
        columns.into_iter().collect()
    }
}
