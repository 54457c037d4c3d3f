//! What drives a contact.

use super::{ForceHistory, Motion};

/// A motion of the jaw, or a force on the contact.
#[derive(Debug, Clone, Copy)]
pub(super) enum Course<'a> {
    Motion(&'a Motion),
    Force(&'a ForceHistory),
}

impl Course<'_> {
    /// Times of the knots, s.
    pub(super) fn times(&self) -> &[f64] {
        match self {
            Self::Motion(motion) => motion.times(),
            Self::Force(history) => history.times(),
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
