//! Time stamps that repeat or step back, repaired where that is safe.

use std::ops::Range;

use super::coarse::{coarse_step, spread};
use super::{Clock, Correction, RecordError};

/// One row in this many may be out of order.
const ROWS_PER_LATE: usize = 50;
/// A step back by a larger share of the whole time is no slip of a buffer.
const BACK: f64 = 0.05;
/// Fewest steps back of rows in no order, and their least share of all; of those in reverse order it is one.
const UNORDERED: (usize, f64) = (8, 0.25);

/// Columns with one clock whose stamps rise from row to row, and what was done for it.
#[derive(Debug)]
pub(super) struct Repaired {
    pub(super) time: Vec<f64>,
    pub(super) columns: Vec<Vec<f64>>,
    pub(super) done: Vec<Correction>,
}

/// Sorts the few rows that a buffer wrote too late, then spreads the rows of a clock that is coarser than the sampling, or merges rows of equal
/// stamps into their mean.
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
        let steps = time.windows(2).filter(|pair| pair[1] < pair[0]).count();
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
            let (before, found, rows) = (time[row - 1], time[row], time.len());
            let share = steps as f64 / rows as f64;
            if steps >= UNORDERED.0 && (UNORDERED.1..1.0 - UNORDERED.1).contains(&share) {
                return Err(RecordError::NotInOrder {
                    row,
                    before,
                    found,
                    steps,
                    rows,
                });
            }
            return Err(RecordError::ClockGoesBack {
                row,
                before,
                found,
                late,
                rows,
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
        let groups: Vec<Range<usize>> = starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect();
        let same = |row: &usize| self.columns.iter().all(|values| values[*row] == values[row - 1]);
        let repeated: Vec<usize> =
            groups.iter().map(|group| (group.start + 1..group.end).filter(same).count()).collect();
        let repeats = |(group, repeated): (&Range<usize>, &usize)| 1 + repeated == group.len();
        let repeating = groups.iter().zip(&repeated).filter(|pair| repeats(*pair)).count();
        if let Some(step) = coarse_step(&self.time, &groups, repeating) {
            self.time = spread(&self.time, &groups, step);
            self.done.push(Correction::StampsSpread {
                clock,
                rows,
                stamps: groups.len(),
                step,
            });
            return;
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let merged = |values: &Vec<f64>| -> Vec<f64> {
            // The mean of one value must be that value to the last bit.
            let value = |group: &Range<usize>| match group.len() {
                1 => values[group.start],
                _ => mean(&values[group.clone()]),
            };
            groups.iter().map(value).collect()
        };
        self.columns = self.columns.iter().map(merged).collect();
        self.time = starts.iter().map(|row| self.time[*row]).collect();
        self.done.push(Correction::StampsMerged {
            clock,
            rows,
            merged: rows - starts.len(),
            identical: repeated.iter().sum(),
        });
    }
}
