//! Many rows at once: lines of plain numbers, read on all processors while the next ones are taken in.

use std::mem::{swap, take};
use std::num::NonZero;
use std::thread;

use super::row::RowPlan;
use crate::{
    error::FileError,
    input::{LONGEST_LINE, LineReader},
    table::{Columns, Heard},
};

/// Bytes that one thread reads at a time: much against the cost of a thread, little against a cache.
const SHARE: usize = 1 << 18;
/// Most threads; more wait for each other at what is done in turn.
const MOST_THREADS: usize = 8;

/// Columns of the rows that one thread has read.
type Part = Vec<Vec<f64>>;

/// Where reading by blocks came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stop {
    /// Too little of the file is left for a block.
    End,
    /// So many lines ahead hold something else than rows of plain numbers.
    Odd(usize),
}

/// Reads rows a block of lines at a time.
pub(crate) struct RowsAhead {
    /// The block that is being read.
    lines: Vec<u8>,
    /// What it becomes, a part for each thread; kept so that the memory serves again.
    parts: Vec<Part>,
    /// The block before, which is read.
    before: Vec<Part>,
    /// The block after it.
    next: Vec<u8>,
    has_room: bool,
}

impl RowsAhead {
    /// For rows of so many columns.
    pub(crate) fn new(columns: usize) -> Self {
        let threads = thread::available_parallelism().map_or(1, NonZero::get).min(MOST_THREADS);
        let parts = vec![vec![Vec::new(); columns]; threads];
        Self {
            lines: Vec::new(),
            before: parts.clone(),
            parts,
            next: Vec::new(),
            has_room: false,
        }
    }

    /// Reads blocks as long as all their lines are rows of plain numbers. Lines that are not read stay in the reader.
    pub(crate) fn read(
        &mut self,
        reader: &mut LineReader<'_>,
        plan: &RowPlan<'_>,
        read: &mut Columns,
        progress: &mut Heard<'_>,
    ) -> Result<Stop, FileError> {
        let block = SHARE * self.parts.len();
        reader.take_lines(block, &mut self.lines)?;
        let (first, total) = reader.progress();
        loop {
            if self.lines.len() < SHARE {
                self.push(reader, read);
                reader.put_back(&mut self.lines);
                return Ok(Stop::End);
            }
            let (lines, mut parts) = (take(&mut self.lines), take(&mut self.parts));
            let (plain, taken) = thread::scope(|scope| {
                let shares = shares(&lines, parts.len());
                let threads: Vec<_> = parts
                    .iter_mut()
                    .zip(shares)
                    .map(|(part, share)| scope.spawn(move || rows(plan, share, part)))
                    .collect();
                // Meanwhile the block before goes where it belongs, and the next one is taken in.
                self.push(reader, read);
                let taken = reader.take_lines(block, &mut self.next);
                let all = threads.into_iter().all(|thread| thread.join().unwrap_or(false));
                // A CR alone ends a line as well.
                (all && !has_lone_cr(&lines), taken)
            });
            (self.lines, self.parts) = (lines, parts);
            taken?;
            progress(reader.progress().0, total)?;
            if !plain {
                let odd = memchr::memchr_iter(b'\n', &self.lines).count();
                reader.put_back(&mut self.next);
                reader.put_back(&mut self.lines);
                return Ok(Stop::Odd(odd));
            }
            swap(&mut self.parts, &mut self.before);
            swap(&mut self.lines, &mut self.next);
            if !self.has_room {
                self.push(reader, read);
                read.reserve(first, total);
                self.has_room = true;
            }
        }
    }

    /// Adds the rows of the block before.
    fn push(&mut self, reader: &mut LineReader<'_>, read: &mut Columns) {
        for part in &mut self.before {
            let rows = part.first().map_or(0, Vec::len);
            if rows > 0 {
                read.push_block(part, reader.line() + 1);
                reader.count(rows);
            }
            part.iter_mut().for_each(Vec::clear);
        }
    }
}

/// Lines that end with LF in about equal parts.
fn shares(lines: &[u8], parts: usize) -> Vec<&[u8]> {
    let share = lines.len().div_ceil(parts);
    let mut rest = lines;
    let mut next = || {
        let from = share.min(rest.len());
        let end = memchr::memchr(b'\n', &rest[from..]).map_or(rest.len(), |end| from + end + 1);
        let (one, other) = rest.split_at(end);
        rest = other;
        one
    };
    (0..parts).map(|_| next()).collect()
}

fn has_lone_cr(lines: &[u8]) -> bool {
    memchr::memchr_iter(b'\r', lines).any(|at| lines.get(at + 1) != Some(&b'\n'))
}

/// Reads lines that end with LF into columns; `false` if one is not a row of plain numbers.
fn rows(plan: &RowPlan<'_>, lines: &[u8], columns: &mut [Vec<f64>]) -> bool {
    columns.iter_mut().for_each(Vec::clear);
    let mut row = vec![0.0; columns.len()];
    let mut rest = lines;
    while !rest.is_empty() {
        match plan.read_plain(rest, &mut row) {
            Some(length) if length <= LONGEST_LINE => rest = &rest[length..],
            _ => return false,
        }
        columns.iter_mut().zip(&row).for_each(|(column, value)| column.push(*value));
    }
    true
}
