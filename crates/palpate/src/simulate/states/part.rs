//! A step of many contacts: what drives it, the memory that it works in, and how it is spread over cores.

use std::ops::Range;

use smallvec::SmallVec;

use crate::parallel::both;
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

/// Contacts that one core steps at once where there are several.
const AT_ONCE: usize = 32768;

/// The same where they are stepped one by one.
const ALONE_AT_ONCE: usize = 256;

/// Whether a step of so many contacts is spread over cores.
pub(super) fn is_spread(count: usize, is_alone: bool) -> bool {
    count > at_once(is_alone)
}

fn at_once(is_alone: bool) -> usize {
    if is_alone { ALONE_AT_ONCE } else { AT_ONCE }
}

/// Steps the contacts of a part, on all cores if there are many; returns how many failed, or why the first one did.
pub(super) fn spread(
    part: Part<'_>,
    is_alone: bool,
    work: &(impl Fn(Part<'_>) -> Result<usize, OneStepError> + Sync),
) -> Result<usize, OneStepError> {
    let count = part.results.len();
    if !is_spread(count, is_alone) {
        return work(part);
    }
    let (first, second) = part.split_at((count / 2).next_multiple_of(LANES));
    let (first, second) = both(|| spread(first, is_alone, work), || spread(second, is_alone, work));
    Ok(first? + second?)
}
