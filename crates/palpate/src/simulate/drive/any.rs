//! Whatever drives a contact.

use super::history::ForceHistory;
use super::motion::Motion;
use super::program::ProgramStep;

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
