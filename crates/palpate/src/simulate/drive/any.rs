//! Whatever drives a contact.

use serde::{Deserialize, Serialize};

use super::{ForceHistory, Motion};

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

/// One step of a program.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ProgramStep {
    /// Move the jaw to a displacement `to` (m) at `rate` (m/s, above 0).
    Move {
        /// Displacement of the jaw at the end, m.
        to: f64,
        /// Speed of the jaw, m/s.
        rate: f64,
    },
    /// Move the jaw at `rate` (m/s, above 0), on or back, until the contact force is `force` (N); the moment is found to the last bit.
    MoveToForce {
        /// Force at the end, N.
        force: f64,
        /// Speed of the jaw, m/s.
        rate: f64,
    },
    /// Position hold for `duration` (s): the force relaxes.
    HoldPosition {
        /// How long, s.
        duration: f64,
    },
    /// Bring the force to `to` (N) at `rate` (N/s, above 0).
    Press {
        /// Force at the end, N.
        to: f64,
        /// Rate of the force, N/s.
        rate: f64,
    },
    /// Force hold for `duration` (s): the body creeps, or recovers if the force is zero.
    HoldForce {
        /// How long, s.
        duration: f64,
    },
}

impl ProgramStep {
    /// What is wrong with its numbers, whatever the body.
    pub(in crate::simulate) fn check(self) -> Result<(), (&'static str, f64, &'static str)> {
        let positive = |name, found: f64, unit| {
            if found.is_finite() && found > 0.0 { Ok(()) } else { Err((name, found, unit)) }
        };
        let finite = |name, found: f64, unit| if found.is_finite() { Ok(()) } else { Err((name, found, unit)) };
        match self {
            Self::Move { to, rate } => finite("displacement", to, "m").and(positive("rate", rate, "m/s")),
            Self::MoveToForce { force, rate } => finite("force", force, "N").and(positive("rate", rate, "m/s")),
            Self::Press { to, rate } => finite("force", to, "N").and(positive("rate", rate, "N/s")),
            Self::HoldPosition { duration } | Self::HoldForce { duration } => positive("duration", duration, "s"),
        }
    }
}
