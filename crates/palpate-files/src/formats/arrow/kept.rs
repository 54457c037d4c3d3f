//! Batches that stay in memory between the reads of several tests.
//!
//! Tests lie one behind the other or mixed, and each is read by itself. To look for each from the beginning of the file would cost the square
//! of its length, so batches stay for the tests that come next.

use std::ops::{ControlFlow, Range};

use arrow_array::RecordBatch;

use super::source::Source;
use crate::error::FileError;

/// Most bytes of the batches that stay (128 MiB); the first batch stays whatever it has.
const MOST_KEPT: usize = 128 << 20;

/// Successive batches of some columns.
#[derive(Default)]
pub(super) struct Kept {
    /// Indices of the columns, rising.
    columns: Vec<usize>,
    /// The rows that are here.
    rows: Range<u64>,
    /// First row and content.
    batches: Vec<(u64, RecordBatch)>,
    bytes: usize,
}

impl Kept {
    /// Makes sure that these rows are here, with as many behind them as there is room for; `false` where they are too many.
    pub(super) fn provide(&mut self, source: &Source, columns: &[usize], rows: &Range<u64>) -> Result<bool, FileError> {
        let same = self.columns == columns;
        if same && self.holds(rows) {
            return Ok(true);
        }
        if same && self.is_beyond(rows) {
            return Ok(false);
        }
        *self = Self {
            columns: columns.to_vec(),
            rows: rows.start..u64::MAX,
            ..Self::default()
        };
        source.visit(columns, rows.start..u64::MAX, &mut |first, batch, _| {
            let end = first.saturating_add(batch.num_rows() as u64);
            // Room of several columns may be one, and is then counted more than once.
            let bytes: usize = batch.columns().iter().map(|column| column.get_array_memory_size()).sum();
            if !self.batches.is_empty() && self.bytes.saturating_add(bytes) > MOST_KEPT {
                self.rows.end = first;
                return Ok(ControlFlow::Break(()));
            }
            self.bytes = self.bytes.saturating_add(bytes);
            self.batches.push((first, batch.clone()));
            self.rows.start = self.rows.start.min(first);
            self.rows.end = if self.bytes > MOST_KEPT { end } else { u64::MAX };
            Ok(if self.bytes > MOST_KEPT { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        })?;
        Ok(self.holds(rows))
    }

    fn holds(&self, rows: &Range<u64>) -> bool {
        self.rows.start <= rows.start && rows.end <= self.rows.end
    }

    /// Whether so many rows need more room than there is, going by those that are here.
    fn is_beyond(&self, rows: &Range<u64>) -> bool {
        let held: u64 = self.batches.iter().map(|(_, batch)| batch.num_rows() as u64).sum();
        let wanted = (rows.end - rows.start) as f64;
        self.rows.end < u64::MAX && wanted * self.bytes as f64 > MOST_KEPT as f64 * held as f64
    }

    /// The batch that holds a row, and its first row.
    pub(super) fn batch(&self, row: u64) -> Option<(u64, &RecordBatch)> {
        let end = |(first, batch): &(u64, RecordBatch)| first.saturating_add(batch.num_rows() as u64);
        let index = self.batches.partition_point(|kept| end(kept) <= row);
        self.batches.get(index).map(|(first, batch)| (*first, batch))
    }
}
