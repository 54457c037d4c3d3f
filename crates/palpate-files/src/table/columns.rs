//! Columns of numbers, as any format gives them, in bounded memory.
//!
//! A column may have 10⁸ rows and more. Beyond [`MOST_ROWS`] every two successive rows become their mean, and each
//! time the columns are full again, so that memory stays below a bound whatever the length of the file. The mean of
//! evenly spaced rows is what a recorder with a longer integration time would have written; how many rows each mean
//! is made of is in the result ([`Columns::averaged`]).

use crate::input::Excerpt;

/// Most rows that are kept of a file (16,777,216). Of more, successive ones are averaged.
pub const MOST_ROWS: usize = 1 << 24;

/// Columns of numbers read from a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// One vector a chosen column, in the order chosen; all of one clock have the same length. From text every value is finite.
    pub values: Vec<Vec<f64>>,
    /// How many successive rows of the file each value is the mean of; 1 up to [`MOST_ROWS`].
    pub averaged: usize,
    /// What was passed over behind the first row.
    pub ignored: IgnoredLines,
    /// Size of the file in bytes.
    pub bytes: u64,
    rows: usize,
    runs: Vec<Run>,
    /// Most rows that are kept.
    most: usize,
    /// The sums over rows that wait for the mean they become part of, and how many rows these are.
    sums: Vec<f64>,
    waiting: usize,
}

/// Lines passed over behind the first row of data.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct IgnoredLines {
    /// How many blank lines there are, wherever they stand.
    pub blank: usize,
    /// How many lines behind the first row are comments.
    pub comments: usize,
    /// Lines at the very end that are no data.
    pub footer: Option<Footer>,
    /// Rows of data in which a cell holds no number.
    pub lacking: LackingRows,
}

/// Lines at the very end of a file that are no data.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Footer {
    /// First of these lines, from 1.
    pub first_line: usize,
    /// How many there are, blank ones aside.
    pub lines: usize,
    /// The first of them, shortened.
    pub sample: String,
}

/// Rows that were left out because a cell of theirs is empty or says that there is no number.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LackingRows {
    /// How many.
    pub rows: usize,
    /// The first of their lines, from 1.
    pub lines: Vec<usize>,
}

/// Rows on successive lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Run {
    /// Index of the first row.
    row: usize,
    /// Line it stands on.
    line: usize,
}

/// Most runs of rows whose lines are remembered; beyond them errors name no line.
const MOST_RUNS: usize = 1 << 20;

impl Columns {
    /// No rows yet of `count` columns.
    pub(crate) fn of(count: usize) -> Self {
        Self {
            values: vec![Vec::new(); count],
            averaged: 1,
            most: MOST_ROWS,
            ..Self::default()
        }
    }

    /// Number of rows of the file that were read, of the clock that has most; [`values`](Self::values) has fewer where they are averaged.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The line (from 1) of the file or sheet that the value with index `index` (from 0), or the first that went into
    /// it, stands on; `None` behind the last one and in formats without lines.
    #[must_use]
    pub fn line_of(&self, index: usize) -> Option<usize> {
        let row = index.checked_mul(self.averaged)?;
        let behind = self.runs.partition_point(|run| run.row <= row);
        let run = self.runs.get(behind.checked_sub(1)?)?;
        let known = row < self.rows && (behind < self.runs.len() || self.runs.len() < MOST_RUNS);
        known.then(|| run.line + (row - run.row))
    }

    /// The same, read from an excerpt of the file.
    pub(crate) fn of_excerpt(mut self, excerpt: &Excerpt) -> Self {
        let line_of = |line: usize| excerpt.line(line).0;
        self.ignored.footer.iter_mut().for_each(|footer| footer.first_line = line_of(footer.first_line));
        self.ignored.lacking.lines.iter_mut().for_each(|line| *line = line_of(*line));
        let runs = std::mem::take(&mut self.runs);
        let ends = runs.iter().skip(1).map(|run| run.row).chain([self.rows]);
        for (run, end) in runs.iter().zip(ends) {
            let mut row = run.row;
            while row < end && self.runs.len() < MOST_RUNS {
                let (line, following) = excerpt.line(run.line + (row - run.row));
                self.runs.push(Run { row, line });
                row = row.saturating_add(following).saturating_add(1);
            }
        }
        self
    }

    /// Adds a row that stands on a line of the file.
    #[inline]
    pub(crate) fn push(&mut self, row: &[f64], line: usize) {
        self.note_line(line);
        self.push_values(row);
    }

    /// Adds rows, given by columns, that stand on lines from `line` on.
    pub(crate) fn push_block(&mut self, block: &[Vec<f64>], line: usize) {
        self.note_line(line);
        let rows = block.first().map_or(0, Vec::len);
        let held = self.values.first().map_or(0, Vec::len);
        if self.averaged == 1 && held + rows < self.most {
            self.values.iter_mut().zip(block).for_each(|(values, more)| values.extend_from_slice(more));
            self.rows += rows;
        } else {
            let mut row = vec![0.0; block.len()];
            for index in 0..rows {
                row.iter_mut().zip(block).for_each(|(cell, column)| *cell = column[index]);
                self.push_values(&row);
            }
        }
    }

    /// Notes the line of the row that comes next, if it does not follow the one before.
    #[inline]
    fn note_line(&mut self, line: usize) {
        let row = self.rows;
        let follows = self.runs.last().is_some_and(|run| run.line + (row - run.row) == line);
        if !follows && self.runs.len() < MOST_RUNS {
            self.runs.push(Run { row, line });
        }
    }

    /// Adds a row of a format without lines.
    #[inline]
    pub(crate) fn push_values(&mut self, row: &[f64]) {
        self.rows += 1;
        if self.averaged > 1 {
            self.average(row);
        } else {
            for (values, &value) in self.values.iter_mut().zip(row) {
                values.push(value);
            }
        }
        if self.values.first().is_some_and(|values| values.len() >= self.most) {
            self.halve();
        }
    }

    /// The columns of several clocks as one: for each column in the order chosen, the clock that it is the next of.
    #[cfg(feature = "robot-log")]
    pub(crate) fn of_clocks(mut clocks: Vec<Self>, order: &[usize]) -> Self {
        clocks.iter_mut().for_each(Self::finish);
        let rows = clocks.iter().map(|clock| clock.rows).max().unwrap_or(0);
        let averaged = clocks.iter().map(|clock| clock.averaged).max().unwrap_or(1);
        let mut values: Vec<_> = clocks.into_iter().map(|clock| clock.values.into_iter()).collect();
        Self {
            values: order.iter().filter_map(|clock| values.get_mut(*clock)?.next()).collect(),
            averaged,
            rows,
            ..Self::default()
        }
    }

    /// Makes room for as many rows as the file should have, going by those read from its first `done` bytes, so
    /// that growing does not copy what is there.
    pub(crate) fn reserve(&mut self, done: u64, total: u64) {
        let rows = self.rows;
        let left = total.saturating_sub(done) as f64;
        let more = rows as f64 * left / done.max(1) as f64 * 1.02;
        let more = (more as usize).min(self.most.saturating_sub(rows));
        for values in &mut self.values {
            values.reserve(more);
        }
    }

    /// The end of the file: what waits for a mean is written, and memory that is not needed is given back.
    pub(crate) fn finish(&mut self) {
        self.take_waiting();
        for values in &mut self.values {
            values.shrink_to_fit();
        }
    }

    /// Adds a row to columns that are averaged already.
    fn average(&mut self, row: &[f64]) {
        self.sums.resize(row.len(), 0.0);
        for (sum, value) in self.sums.iter_mut().zip(row) {
            *sum += value;
        }
        self.waiting += 1;
        if self.waiting == self.averaged {
            self.take_waiting();
        }
    }

    /// Rows that remain at the end of the file become a mean of fewer.
    fn take_waiting(&mut self) {
        let count = self.waiting as f64;
        if self.waiting == 0 {
            return;
        }
        for (values, sum) in self.values.iter_mut().zip(&mut self.sums) {
            values.push(*sum / count);
            *sum = 0.0;
        }
        self.waiting = 0;
    }

    /// Makes every two rows their mean.
    fn halve(&mut self) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_beyond_the_most_become_means_and_keep_their_lines() {
        let most = 1 << 10;
        let mut columns = Columns { most, ..Columns::of(2) };
        let rows = 5 * most / 2 + 3;
        for row in 0..rows {
            columns.push(&[row as f64, 2.0], row + 10);
        }
        columns.finish();
        assert_eq!((columns.rows(), columns.averaged), (rows, 4));
        assert_eq!(columns.values[0].len(), rows.div_ceil(4));
        // Means of 0..4, of 4..8, and of the three rows that remain.
        let last = rows - rows % 4;
        assert_eq!(columns.values[0][..2], [1.5, 5.5]);
        let left = (last..rows).map(|row| row as f64).sum::<f64>() / (rows - last) as f64;
        assert_eq!(columns.values[0].last(), Some(&left));
        assert!(columns.values[1].iter().all(|value| *value == 2.0));
        assert_eq!((columns.line_of(0), columns.line_of(2)), (Some(10), Some(18)));
        assert_eq!(columns.line_of(rows), None);
    }
}
