//! What drives a contact.

use super::{ForceHistory, Motion, ProgramStep};

/// A motion of the jaw, a force on the contact, or a program of both with the ends of its steps.
#[derive(Debug, Clone, Copy)]
pub(super) enum Course<'a> {
    Motion(&'a Motion),
    Force(&'a ForceHistory),
    Program(&'a [ProgramStep], &'a [f64]),
}

impl Course<'_> {
    /// Times of the knots, s; of a program, the start and the ends of its steps.
    pub(super) fn times(&self) -> &[f64] {
        match self {
            Self::Motion(motion) => motion.times(),
            Self::Force(history) => history.times(),
            Self::Program(_, times) => times,
        }
    }

    /// Time of the first knot, s.
    pub(super) fn start(&self) -> f64 {
        self.times()[0]
    }

    /// Time of the last knot, s.
    pub(super) fn end(&self) -> f64 {
        self.times()[self.times().len() - 1]
    }
}
