//! Time stamps that repeat or step back, repaired where that is safe.

use super::{Clock, Correction, RecordError};

/// One row in this many may be out of order.
const ROWS_PER_LATE: usize = 50;
/// A step back by a larger share of the whole time is no slip of a buffer.
const BACK: f64 = 0.05;

/// Columns with one clock whose stamps rise from row to row, and what was done for it.
#[derive(Debug)]
pub(super) struct Repaired {
    pub(super) time: Vec<f64>,
    pub(super) columns: Vec<Vec<f64>>,
    pub(super) done: Vec<Correction>,
}

/// Sorts the few rows that a buffer wrote too late, then merges rows of equal stamps into their mean.
///
/// A clock that starts again, or goes back far, is an error: nothing says which of the runs is meant.
pub(super) fn repaired(clock: Clock, time: Vec<f64>, columns: Vec<Vec<f64>>) -> Result<Repaired, RecordError> {
    let mut repaired = Repaired {
        time,
        columns,
        done: Vec::new(),
    };
    if repaired.time.windows(2).all(|pair| pair[1] > pair[0]) {
        return Ok(repaired);
    }
    if repaired.time.len() > 2 && repaired.time.iter().all(|stamp| *stamp == repaired.time[0]) {
        return Err(RecordError::ClockStands {
            found: repaired.time[0],
            rows: repaired.time.len(),
        });
    }
    repaired.sort(clock)?;
    repaired.merge(clock);
    Ok(repaired)
}

impl Repaired {
    fn sort(&mut self, clock: Clock) -> Result<(), RecordError> {
        let time = &self.time;
        let (mut latest, mut late, mut largest) = (f64::NEG_INFINITY, 0, 0.0f64);
        let (mut first, mut earliest) = (None, f64::INFINITY);
        for (row, stamp) in time.iter().enumerate() {
            if *stamp < latest {
                late += 1;
                largest = largest.max(latest - stamp);
                first.get_or_insert(row);
            }
            latest = latest.max(*stamp);
            earliest = earliest.min(*stamp);
        }
        let Some(row) = first else { return Ok(()) };
        if ROWS_PER_LATE * late > time.len() || largest > BACK * (latest - earliest) {
            return Err(RecordError::ClockGoesBack {
                row,
                before: time[row - 1],
                found: time[row],
                late,
                rows: time.len(),
                largest,
            });
        }
        let mut order: Vec<usize> = (0..time.len()).collect();
        order.sort_by(|a, b| time[*a].total_cmp(&time[*b]));
        let sorted = |values: &Vec<f64>| order.iter().map(|row| values[*row]).collect();
        self.columns = self.columns.iter().map(sorted).collect();
        self.time = sorted(&self.time);
        self.done.push(Correction::StampsSorted {
            clock,
            rows: late,
            largest,
        });
        Ok(())
    }

    /// Needs stamps in order.
    fn merge(&mut self, clock: Clock) {
        let rows = self.time.len();
        let starts: Vec<usize> = (0..rows).filter(|row| *row == 0 || self.time[row - 1] < self.time[*row]).collect();
        if starts.len() == rows {
            return;
        }
        let ends = starts.iter().skip(1).copied().chain([rows]);
        let groups: Vec<(usize, usize)> = starts.iter().copied().zip(ends).collect();
        let same = |row: &usize| self.columns.iter().all(|values| values[*row] == values[row - 1]);
        let identical = groups.iter().map(|(start, end)| (start + 1..*end).filter(same).count()).sum();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let merged = |values: &Vec<f64>| -> Vec<f64> {
            // The mean of one value must be that value to the last bit.
            let value = |(start, end): &(usize, usize)| match end - start {
                1 => values[*start],
                _ => mean(&values[*start..*end]),
            };
            groups.iter().map(value).collect()
        };
        self.columns = self.columns.iter().map(merged).collect();
        self.time = starts.iter().map(|row| self.time[*row]).collect();
        self.done.push(Correction::StampsMerged {
            clock,
            rows,
            merged: rows - starts.len(),
            identical,
        });
    }
}
