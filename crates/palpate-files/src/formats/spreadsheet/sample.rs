//! The beginning of a sheet, and of each table in it.

use std::{collections::BTreeSet, ops::ControlFlow};

use super::{
    book::Book,
    cell::{Cell, Value},
};
use crate::{
    error::FileError,
    table::{RowKind, Starts},
};

/// Most rows of a table that are looked at; what they do not show of it, more would not either.
const MOST_ROWS: usize = 4000;
/// Rows that are looked at of any table.
const ALWAYS: usize = 64;
/// Most cells of a sheet that are looked at beyond these, a long text as several.
const MOST_CELLS: usize = 400_000;

/// The first rows of a sheet, or of a table in it, those without a cell left out.
#[derive(Default)]
pub(super) struct Sample {
    pub(super) rows: Vec<Row>,
    /// There are more rows.
    pub(super) cut: bool,
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

    fn weight(&self) -> usize {
        self.cells.iter().map(|(_, value)| value.weight()).sum()
    }

    fn kind(&self) -> RowKind {
        let labels = |(_, value): &(u32, Value)| value.text().ends_with(':');
        RowKind::of(self.cells.iter().map(|(_, value)| value.class()), self.cells.first().is_some_and(labels))
    }
}

/// The tables that stand one below the other in a sheet, as far as rows show it: where the names of columns stand below numbers.
#[derive(Default)]
struct Stack {
    starts: Starts,
    rows: usize,
    cells: usize,
    pieces: Vec<Sample>,
    last: Sample,
    /// Rows that belong to the last piece, or begin the next one.
    pending: Vec<Row>,
    /// How many cells they have.
    pending_cells: usize,
    /// Index of the first of them.
    pending_from: usize,
}

impl Stack {
    fn add(&mut self, row: Row) {
        let start = self.starts.next(row.kind());
        self.rows += 1;
        self.pending_cells += row.weight();
        self.pending.push(row);
        if let Some(start) = start {
            self.settle(start);
            self.pieces.push(std::mem::take(&mut self.last));
        }
        // Rows without end between two tables tell nothing of the second.
        let is_long = self.pending.len() > MOST_ROWS || self.pending_cells > MOST_CELLS;
        let until = if is_long { self.rows } else { self.starts.behind() };
        self.settle(until);
    }

    /// Gives the pending rows before this one to the last piece.
    fn settle(&mut self, until: usize) {
        let count = until.saturating_sub(self.pending_from).min(self.pending.len());
        for row in self.pending.drain(..count) {
            let cells = row.weight();
            self.pending_cells -= cells;
            let is_room = self.last.rows.len() < ALWAYS || self.last.rows.len() < MOST_ROWS && self.cells <= MOST_CELLS;
            if !is_room || self.last.cut {
                self.last.cut = true;
                continue;
            }
            self.cells += cells;
            self.last.rows.push(row);
        }
        self.pending_from += count;
    }

    fn ended(mut self) -> Vec<Sample> {
        self.settle(self.rows);
        self.pieces.push(self.last);
        self.pieces
    }
}

impl Sample {
    /// Goes through a sheet from row `skip` (from 0) on, and takes the beginning of each table that may stand below another.
    ///
    /// # Errors
    /// Of the rows of the first table that are looked at; what comes behind is for those to refuse who read it.
    pub(super) fn take(book: &dyn Book, sheet: usize, skip: u32) -> Result<Vec<Self>, FileError> {
        let (mut stack, mut row): (Stack, Option<Row>) = (Stack::default(), None);
        let visited = book.visit(sheet, &mut |cell: Cell, _, _| {
            if cell.row < skip {
                return Ok(ControlFlow::Continue(()));
            }
            if let Some(done) = row.take_if(|row| row.number != cell.row) {
                stack.add(done);
            }
            let begun = row.get_or_insert_with(|| Row {
                number: cell.row,
                cells: Vec::new(),
            });
            begun.cells.push((cell.column, cell.value));
            Ok(ControlFlow::Continue(()))
        });
        match visited {
            Err(error) if stack.pieces.is_empty() && !stack.last.cut => return Err(error),
            Err(_) => stack.last.cut = true,
            Ok(()) => row.into_iter().for_each(|row| stack.add(row)),
        }
        Ok(stack.ended())
    }

    /// The first rows of all pieces of a sheet, as one.
    pub(super) fn joined(pieces: Vec<Self>) -> Self {
        let mut joined = Self::default();
        for piece in pieces {
            if joined.cut {
                break;
            }
            joined.cut = piece.cut || joined.rows.len() + piece.rows.len() > MOST_ROWS;
            let room = MOST_ROWS - joined.rows.len();
            joined.rows.extend(piece.rows.into_iter().take(room));
        }
        joined
    }

    /// The columns that hold anything in the rows from index `first` on, each once, in their order.
    pub(super) fn columns(&self, first: usize) -> Vec<u32> {
        let rows = self.rows.iter().skip(first);
        let columns: BTreeSet<u32> = rows.flat_map(|row| row.cells.iter().map(|(column, _)| *column)).collect();
        columns.into_iter().collect()
    }
}
