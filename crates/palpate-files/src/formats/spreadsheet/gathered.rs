//! The cells of several tables of one sheet, gathered in one go through it.
//!
//! Tables lie side by side or one below the other, and each is read by itself. To go through the sheet for each would cost the square of its
//! size.

use std::{
    collections::{BTreeMap, HashMap},
    ops::ControlFlow,
};

use super::{book::Book, cell::Cell, table::Table};
use crate::error::FileError;

/// Most cells that stay in memory, a long text as several.
const MOST_CELLS: usize = 2 << 20;

/// The cells of successive tables of one sheet.
#[derive(Default)]
pub(super) struct Gathered {
    sheet: usize,
    /// By the number of the table in the workbook.
    cells: BTreeMap<usize, Vec<Cell>>,
}

impl Gathered {
    /// The cells of a table, and with them those of the tables behind it in the sheet as far as there is room; `None` where there is not even
    /// room for the one. `tables` are those of the sheet from this one on, with their numbers.
    pub(super) fn of<'t>(
        &mut self,
        book: &dyn Book,
        (sheet, number): (usize, usize),
        tables: impl Iterator<Item = (usize, &'t Table)>,
    ) -> Result<Option<&[Cell]>, FileError> {
        if self.sheet != sheet || !self.cells.contains_key(&number) {
            self.sheet = sheet;
            self.cells = gather(book, sheet, tables)?;
        }
        Ok(self.cells.get(&number).map(Vec::as_slice))
    }
}

/// First row, row behind the last one, number of the table.
type Stretch = (u32, u32, usize);

fn gather<'t>(
    book: &dyn Book,
    sheet: usize,
    tables: impl Iterator<Item = (usize, &'t Table)>,
) -> Result<BTreeMap<usize, Vec<Cell>>, FileError> {
    let mut columns: HashMap<u32, Vec<Stretch>> = HashMap::new();
    let mut gathered = BTreeMap::new();
    for (number, table) in tables {
        gathered.insert(number, Vec::new());
        for place in &table.places {
            let stretches = table.rows.iter().map(|rows| (rows.start, rows.end, number));
            columns.entry(*place).or_default().extend(stretches);
        }
    }
    columns.values_mut().for_each(|stretches| stretches.sort_unstable());
    let mut held = 0;
    book.visit(sheet, &mut |cell, _, _| {
        let Some(stretches) = columns.get(&cell.column) else {
            return Ok(ControlFlow::Continue(()));
        };
        let behind = stretches.partition_point(|(first, _, _)| *first <= cell.row);
        let stretch = behind.checked_sub(1).map(|index| stretches[index]).filter(|(_, end, _)| cell.row < *end);
        if let Some(cells) = stretch.and_then(|(_, _, number)| gathered.get_mut(&number)) {
            held += cell.value.weight();
            cells.push(cell);
        }
        while held > MOST_CELLS {
            // The first table is the one that is wanted now.
            let Some((_, dropped)) = gathered.pop_last() else { break };
            held -= dropped.iter().map(|cell| cell.value.weight()).sum::<usize>();
        }
        Ok(if gathered.is_empty() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    })?;
    Ok(gathered)
}
