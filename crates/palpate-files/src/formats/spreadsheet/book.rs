//! What a workbook of any make can do.

use std::ops::ControlFlow;

use super::cell::Cell;
use crate::error::FileError;

/// Most sheets of a workbook that are looked at.
pub(super) const MOST_SHEETS: usize = 4096;

/// A sheet by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Sheet {
    pub(super) name: String,
    /// Why it holds no cells: a chart, a macro.
    pub(super) other: Option<&'static str>,
}

/// What is given of every cell: the cell, bytes done of the sheet, bytes of the sheet.
pub(super) type Visitor<'a> = dyn FnMut(Cell, u64, u64) -> Result<ControlFlow<()>, FileError> + 'a;

/// A workbook whose sheets are known and whose cells are read as they are requested.
pub(super) trait Book: Send + Sync {
    /// Its sheets in their order.
    fn sheets(&self) -> &[Sheet];

    /// Days before 1 January 1970 on which it counts day 0.
    fn days_to_epoch(&self) -> f64;

    /// Visits the cells of a sheet that are not empty, row by row, until the visitor breaks off.
    fn visit(&self, sheet: usize, each: &mut Visitor<'_>) -> Result<(), FileError>;
}

/// Days from 31 December 1899, less the 29 February 1900 that there never was, to 1 January 1970.
pub(super) const DAYS_FROM_1900: f64 = 25_569.0;
/// Days from 1 January 1904 to 1 January 1970.
pub(super) const DAYS_FROM_1904: f64 = 24_107.0;
