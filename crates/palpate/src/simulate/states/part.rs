//! A step of many contacts: what drives it, the memory that it works in, and how it is spread over cores.

use std::ops::Range;

use smallvec::SmallVec;

use crate::parallel::Threads;
use crate::simulate::StepError;
use crate::vector::LANES;

/// What a step of many contacts imposes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Imposed {
    /// Displacements of the jaws, m.
    Displacement,
    /// Forces, N.
    Force,
}

/// What happens to the others where a contact cannot take a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Refusal {
    /// No contact is stepped.
    #[default]
    All,
    /// The contact keeps its state, and the others are stepped.
    Masked,
}

/// A step of many contacts.
#[derive(Debug, Clone, Copy)]
pub struct ContactsStep<'a> {
    /// What `to` is.
    pub imposed: Imposed,
    /// Time steps, s: one for all contacts, or one each.
    pub dt: &'a [f64],
    /// Displacements (m) or forces (N) at the end of the step, one for all contacts, or one each. They go there at constant rate.
    pub to: &'a [f64],
    /// Equal parts that the step is taken in, 1 or more; 0 counts as 1.
    pub substeps: u32,
    /// What happens where a contact cannot take it.
    pub refusal: Refusal,
}

/// A step that one of several contacts cannot take; all of them are as before.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("contact {index}: {error}")]
pub struct OneStepError {
    /// Which contact, from 0.
    pub index: usize,
    /// Why it cannot.
    pub error: StepError,
}

impl ContactsStep<'_> {
    pub(super) fn parts(&self) -> u32 {
        self.substeps.max(1)
    }

    /// Time step and target of a contact.
    pub(super) fn of(&self, index: usize) -> (f64, f64) {
        (self.dt[index.min(self.dt.len() - 1)], self.to[index.min(self.to.len() - 1)])
    }
}

/// Consecutive contacts and the memory of their step.
pub(super) struct Part<'a> {
    /// Index of the first.
    pub(super) from: usize,
    /// The numbers of the states: a row for each, a column for each contact.
    pub(super) rows: SmallVec<[&'a mut [f64]; 8]>,
    pub(super) results: &'a mut [f64],
    pub(super) failed: &'a mut [bool],
}

impl<'a> Part<'a> {
    /// The contacts of a range.
    pub(super) fn of(
        range: Range<usize>,
        states: &'a mut [f64],
        results: &'a mut [f64],
        failed: &'a mut [bool],
    ) -> Self {
        let rows = states.chunks_exact_mut(results.len().max(1)).map(|row| &mut row[range.clone()]).collect();
        Self {
            from: range.start,
            rows,
            results: &mut results[range.clone()],
            failed: &mut failed[range],
        }
    }

    /// As many pieces as that, of about the same number of contacts.
    fn pieces(self, count: usize) -> Vec<Self> {
        let each = self.results.len().div_ceil(count).next_multiple_of(LANES);
        let (mut pieces, mut rest) = (Vec::with_capacity(count), self);
        while rest.results.len() > each {
            let (piece, others) = rest.split_at(each);
            pieces.push(piece);
            rest = others;
        }
        pieces.push(rest);
        pieces
    }

    fn split_at(self, at: usize) -> (Self, Self) {
        let (first, second): (SmallVec<_>, SmallVec<_>) = self.rows.into_iter().map(|row| row.split_at_mut(at)).unzip();
        let (results, failed) = (self.results.split_at_mut(at), self.failed.split_at_mut(at));
        let part = |from, rows, results, failed| Part {
            from,
            rows,
            results,
            failed,
        };
        (part(self.from, first, results.0, failed.0), part(self.from + at, second, results.1, failed.1))
    }
}

/// Contacts that are worth a thread of their own.
const LEAST: usize = 2048;

/// Contacts that are worth waking one.
const LEAST_ASLEEP: usize = 32768;

/// The same where they are stepped one by one.
const LEAST_ALONE: usize = 128;

/// Whether a step of so many contacts may be spread over cores.
pub(super) fn is_spread(count: usize, is_alone: bool) -> bool {
    count >= 2 * if is_alone { LEAST_ALONE } else { LEAST }
}

/// Steps the contacts of a part, on all threads if there are many; returns how many failed, or why the first one did.
pub(super) fn spread(
    threads: Threads<'_>,
    part: Part<'_>,
    is_alone: bool,
    work: &(impl Fn(Part<'_>) -> Result<usize, OneStepError> + Sync),
) -> Result<usize, OneStepError> {
    let count = part.results.len();
    if !is_spread(count, is_alone) {
        return work(part);
    }
    let least = match is_alone {
        true => LEAST_ALONE,
        false if threads.are_awake => LEAST,
        false => LEAST_ASLEEP,
    };
    let pieces = (count / least).clamp(1, threads.count());
    match pieces {
        1 => work(part),
        _ => threads.map(part.pieces(pieces), work).into_iter().sum(),
    }
}
