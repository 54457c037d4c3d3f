//! Why there is no grip.

use crate::number::significant;
use crate::simulate::SimulateError;
use crate::watch::Cancelled;

/// Why there is no grip.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GripError {
    /// A number that describes no load, no gripper and no question.
    #[error("{name} must be {expected}, found {found}{unit}")]
    Number {
        /// What it is.
        name: &'static str,
        /// What it must be.
        expected: &'static str,
        /// What was given, SI.
        found: f64,
        /// Its unit, behind a blank.
        unit: &'static str,
    },
    /// A body that counts as bonded to its jaws.
    #[error("separation = false in the material: its contacts can pull, those of a grasp can only press")]
    Bonded,
    /// A squeeze that is beyond what the gripper may do.
    #[error("a {name} of {found} is beyond the limit of {limit}", found = reported(*found, unit), limit = reported(*limit, unit))]
    BeyondLimit {
        /// What goes too far.
        name: &'static str,
        /// What was requested or is met.
        found: f64,
        /// The limit.
        limit: f64,
        /// Unit, behind a blank.
        unit: &'static str,
    },
    /// No squeeze within the limits holds.
    #[error(
        "no squeeze within the limits holds: {needed:.4} N are needed, and {reached:.4} N are there {when} at the most ({by})",
        when = when(*duration)
    )]
    NoSqueeze {
        /// Force that is needed, N.
        needed: f64,
        /// The most there is at the end, N.
        reached: f64,
        /// How long it should hold, s; infinite for equilibrium forces, 0 for forces that are held.
        duration: f64,
        /// Which limit stops it.
        by: String,
    },
    /// A retreat that no squeeze within the limits prepares.
    #[error(
        "to begin the hold at {displacement} relaxed, the jaw would have to go beyond {limit} ({by})",
        displacement = reported(*displacement, " m"),
        limit = reported(*limit, " m")
    )]
    NoBackOff {
        /// Where the jaw is to hold, m.
        displacement: f64,
        /// How far it may go, m.
        limit: f64,
        /// What stops it there.
        by: String,
    },
    /// A band that squeezes cannot keep the force in.
    #[error(
        "the band from {low:.4} N to {high:.4} N is too narrow: {time:.3} s on, after {moves} moves, the next comes too soon, or is one too many"
    )]
    TooManyMoves {
        /// When, s.
        time: f64,
        /// How many.
        moves: usize,
        /// Lower edge, N.
        low: f64,
        /// Upper edge, N.
        high: f64,
    },
    /// A band whose lower edge does not carry the load.
    #[error("a band from {low:.4} N on lets the body slip: {needed:.4} N are needed")]
    BandSlips {
        /// Lower edge, N.
        low: f64,
        /// Force that is needed, N.
        needed: f64,
    },
    /// A confidence where there are no intervals.
    #[error("the calibration left a parameter open and has no intervals: no verdict holds with a confidence")]
    NoIntervals,
    /// A simulation that could not be run.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// Its watch ended it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl GripError {
    /// Whether the answer is no, and the question none to complain about.
    #[must_use]
    pub fn is_answer(&self) -> bool {
        matches!(
            self,
            Self::NoSqueeze { .. }
                | Self::NoBackOff { .. }
                | Self::BeyondLimit { .. }
                | Self::TooManyMoves { .. }
                | Self::BandSlips { .. }
        )
    }

    /// What would help.
    #[must_use]
    pub fn hint(&self) -> &'static str {
        match self {
            Self::NoSqueeze { .. } => {
                "allow a larger force or stroke, raise the friction, or take a lighter load or a lower safety factor"
            }
            Self::NoBackOff { .. } => "allow a larger stroke or force, close faster, or hold at a smaller squeeze",
            Self::BeyondLimit { .. } => "ask for less, or raise the limit",
            Self::TooManyMoves { .. } => "widen the band, allow shorter pauses, or hold the force",
            Self::BandSlips { .. } => "raise the lower edge of the band",
            Self::NoIntervals => {
                "leave the confidence out, so that the best estimate decides, or calibrate on a test that determines all parameters"
            }
            Self::Bonded => {
                "set separation = true under [contact] of the test description where the jaws only press, and calibrate again"
            }
            Self::Number { .. } | Self::Simulate(_) | Self::Cancelled(_) => "",
        }
    }
}

/// A number with its unit, lengths in mm.
fn reported(number: f64, unit: &str) -> String {
    let (number, unit) = if unit == " m" { (1e3 * number, " mm") } else { (number, unit) };
    format!("{}{unit}", significant(number, 4))
}

fn when(duration: f64) -> String {
    if duration == 0.0 {
        return "when the jaws stop".to_owned();
    }
    if duration.is_finite() { format!("after {duration} s") } else { "once relaxed".to_owned() }
}

/// Whether a number holds what is `expected` of it.
pub(super) fn check(
    name: &'static str,
    found: f64,
    unit: &'static str,
    expected: &'static str,
    holds: bool,
) -> Result<(), GripError> {
    holds.then_some(()).ok_or(GripError::Number {
        name,
        expected,
        found,
        unit,
    })
}

pub(super) fn at_least(name: &'static str, found: f64, least: f64, unit: &'static str) -> Result<(), GripError> {
    let expected = if least == 0.0 { "finite and not below 0" } else { "finite and not below 1" };
    check(name, found, unit, expected, found.is_finite() && found >= least)
}

pub(super) fn above_zero(name: &'static str, found: f64, unit: &'static str) -> Result<(), GripError> {
    check(name, found, unit, "finite and above 0", found.is_finite() && found > 0.0)
}

pub(super) fn check_confidence(confidence: f64) -> Result<(), GripError> {
    check("confidence", confidence, "", "between 0 and 1", confidence > 0.0 && confidence < 1.0)
}
