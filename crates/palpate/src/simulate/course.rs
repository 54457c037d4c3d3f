//! What drives a contact.

use std::borrow::Cow;

use super::layer::Layer;
use super::program::ends_of;
use super::{ForceHistory, Motion, ProgramStep, SimulateError};

/// What drives a contact: a motion of the jaw, a force on the contact, or a program of steps in both.
///
/// The simulations take anything that turns into it: `&Motion`, `&ForceHistory`, and a slice, array or vector of [`ProgramStep`] by
/// reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive<'a> {
    /// The jaw moves.
    Motion(&'a Motion),
    /// The contact is pressed.
    Force(&'a ForceHistory),
    /// One step after the other, from time 0 with the jaw at first touch.
    Program(&'a [ProgramStep]),
}

impl<'a> From<&'a Motion> for Drive<'a> {
    fn from(motion: &'a Motion) -> Self {
        Self::Motion(motion)
    }
}

impl<'a> From<&'a ForceHistory> for Drive<'a> {
    fn from(history: &'a ForceHistory) -> Self {
        Self::Force(history)
    }
}

impl<'a> From<&'a [ProgramStep]> for Drive<'a> {
    fn from(program: &'a [ProgramStep]) -> Self {
        Self::Program(program)
    }
}

impl<'a, const N: usize> From<&'a [ProgramStep; N]> for Drive<'a> {
    fn from(program: &'a [ProgramStep; N]) -> Self {
        Self::Program(program)
    }
}

impl<'a> From<&'a Vec<ProgramStep>> for Drive<'a> {
    fn from(program: &'a Vec<ProgramStep>) -> Self {
        Self::Program(program)
    }
}

/// What drives a contact, with the times of its knots.
#[derive(Debug, Clone)]
pub(super) struct Course<'a> {
    pub(super) drive: Drive<'a>,
    times: Cow<'a, [f64]>,
}

impl<'a> Course<'a> {
    /// The course of `model` under a drive. When the steps of a program end is found out by running it once, which costs next to
    /// nothing.
    pub(super) fn new(drive: Drive<'a>, model: &impl Layer) -> Result<Self, SimulateError> {
        let times = match drive {
            Drive::Motion(motion) => Cow::Borrowed(motion.times()),
            Drive::Force(history) => Cow::Borrowed(history.times()),
            Drive::Program(program) => {
                let ends = ends_of(program, model)?;
                Cow::Owned([0.0].into_iter().chain(ends.iter().map(|end| end.time)).collect())
            }
        };
        Ok(Self { drive, times })
    }

    /// Times of the knots, s; of a program, the start and the ends of its steps.
    pub(super) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Time of the first knot, s.
    pub(super) fn start(&self) -> f64 {
        self.times[0]
    }

    /// Time of the last knot, s.
    pub(super) fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }
}
