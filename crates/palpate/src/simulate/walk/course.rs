//! What drives a contact.

use std::borrow::Cow;

use super::program::{StepEnd, ends_of};
use super::walker::{Visit, Walker};
use crate::contact::SimulationWork;
use crate::simulate::{ContactEvent, Drive, Layer, SimulateError};
use crate::watch::Stages;

/// Share of the work that finding the ends of steps is.
const SHARE: f64 = 0.2;

/// What drives a contact, with the times of its knots.
#[derive(Debug, Clone)]
pub(in crate::simulate) struct Course<'a> {
    pub(in crate::simulate) drive: Drive<'a>,
    times: Cow<'a, [f64]>,
    /// Where the steps of a program end.
    pub(in crate::simulate) ends: Vec<StepEnd>,
}

impl<'a> Course<'a> {
    /// The course of `model` under a drive. When the steps of a program end is found out by running it once, which costs next to
    /// nothing.
    pub(in crate::simulate) fn new(
        drive: Drive<'a>,
        model: &impl Layer,
        stages: &mut Stages<'_>,
    ) -> Result<Self, SimulateError> {
        let mut ends = Vec::new();
        let times = match drive {
            Drive::Motion(motion) => Cow::Borrowed(motion.times()),
            Drive::Force(history) => Cow::Borrowed(history.times()),
            Drive::Program(program) => {
                stages.enter(SHARE);
                ends = ends_of(program, model, stages)?;
                Cow::Owned([0.0].into_iter().chain(ends.iter().map(|end| end.time)).collect())
            }
        };
        Ok(Self { drive, times, ends })
    }

    /// Share of the time that has passed at `time` (s).
    pub(in crate::simulate) fn share(&self, time: f64) -> f64 {
        (time - self.start()) / (self.end() - self.start())
    }

    /// Times of the knots, s; of a program, the start and the ends of its steps.
    pub(in crate::simulate) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Time of the first knot, s.
    pub(in crate::simulate) fn start(&self) -> f64 {
        self.times[0]
    }

    /// Time of the last knot, s.
    pub(in crate::simulate) fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }
}

/// Walks through what drives the contact, handing every stretch to `visit` in order, and returns the events and the work.
pub(in crate::simulate) fn walk<'a, L: Layer>(
    drive: Drive<'_>,
    model: &'a L,
    visit: &'a mut Visit<'a, L>,
) -> Result<(Vec<ContactEvent>, SimulationWork), SimulateError> {
    let mut walker = Walker::new(model, visit);
    match drive {
        Drive::Motion(motion) => walker.travel(motion)?,
        Drive::Force(history) => walker.press(history)?,
        Drive::Program(program) => {
            walker.run(program)?;
        }
    }
    walker.work.events = walker.events.len() as u64;
    Ok((walker.events, walker.work))
}
