//! Very long columns in bounded memory.
//!
//! A column may have 10⁸ rows and more. Beyond [`MOST_ROWS`] every two successive rows become their mean, and each
//! time the columns are full again, so that memory stays below a bound whatever the length of the file. The mean of
//! evenly spaced rows is what a recorder with a longer integration time would have written; how many rows each mean
//! is made of is in the result ([`Columns::averaged`]).

use super::Columns;

/// Most rows that are kept of a file (16,777,216). Of more, successive ones are averaged.
pub const MOST_ROWS: usize = 1 << 24;

/// Rows that wait for the mean they become part of.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Waiting {
    sums: Vec<f64>,
    rows: usize,
}

impl Columns {
    /// Adds a row to columns that are averaged already.
    pub(super) fn average(&mut self, row: &[f64]) {
        let waiting = &mut self.waiting;
        waiting.sums.resize(row.len(), 0.0);
        for (sum, value) in waiting.sums.iter_mut().zip(row) {
            *sum += value;
        }
        waiting.rows += 1;
        if waiting.rows == self.averaged {
            self.take_waiting();
        }
    }

    /// Rows left over at the end of the file become a mean of fewer.
    pub(super) fn take_waiting(&mut self) {
        let count = self.waiting.rows as f64;
        if self.waiting.rows == 0 {
            return;
        }
        for (values, sum) in self.values.iter_mut().zip(&mut self.waiting.sums) {
            values.push(*sum / count);
            *sum = 0.0;
        }
        self.waiting.rows = 0;
    }

    /// Makes every two rows their mean.
    pub(super) fn halve(&mut self) {
        for values in &mut self.values {
            let half = values.len() / 2;
            for i in 0..half {
                values[i] = 0.5 * values[2 * i] + 0.5 * values[2 * i + 1];
            }
            values.truncate(half);
        }
        self.averaged *= 2;
    }
}
