//! The records of the suite, by number.

use palpate::random::{Rng, seed_of};
use palpate::record::Record;

use super::others::{none, press};
use super::protocols::squeeze;
use super::record::TrueHold;

/// A record and the truth about it.
#[derive(Debug, Clone)]
pub struct Labelled {
    /// What it is like.
    pub kind: Kind,
    /// Noise as a share of the range of each column.
    pub noise: f64,
    /// What was measured.
    pub record: Record,
    /// The true holds.
    pub holds: Vec<TrueHold>,
}

/// What a record is like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Up, or down, in steps.
    Stairs,
    /// Two levels, again and again.
    Cycles,
    /// Any level after any other.
    UpAndDown,
    /// Ramps of a few samples or none.
    FastRamps,
    /// Ramps longer than the holds.
    SlowRamps,
    /// Holds over two decades.
    UnevenHolds,
    /// A servo that overshoots and settles.
    Servo,
    /// The force is held.
    ForceHeld,
    /// No hold: a triangle.
    Triangle,
    /// No hold: a sine.
    Sine,
    /// No hold: ramps of different speeds.
    Ramps,
    /// No hold: nothing but noise.
    Still,
    /// No hold: slower and slower, but never still.
    Creeping,
    /// One hold of a crosshead whose encoder is noisy.
    NoisyCrosshead,
    /// A jaw that swings as it arrives.
    Chatter,
    /// Ramps that vibrate.
    Ripple,
    /// No hold: approach and retraction of an AFM.
    AfmCurve,
}

impl Kind {
    /// In the words of a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stairs => "stairs",
            Self::Cycles => "cycles of two levels",
            Self::UpAndDown => "up and down",
            Self::FastRamps => "ramps of 0.3 to 3 samples",
            Self::SlowRamps => "ramps 1 to 8 times the holds",
            Self::UnevenHolds => "holds over two decades",
            Self::Servo => "servo overshoots and settles",
            Self::ForceHeld => "force held, jaw creeps",
            Self::Triangle => "none: triangle",
            Self::Sine => "none: sine",
            Self::Ramps => "none: ramps",
            Self::Still => "none: noise",
            Self::Creeping => "none: creep",
            Self::NoisyCrosshead => "noisy crosshead, one hold",
            Self::Chatter => "jaw swings as it arrives",
            Self::Ripple => "ramps that ripple",
            Self::AfmCurve => "none: AFM approach and retraction",
        }
    }
}

/// Kinds in the order in which records take turns: seventeen with holds to three without.
const TURNS: [Kind; 20] = [
    Kind::Stairs,
    Kind::Cycles,
    Kind::UpAndDown,
    Kind::FastRamps,
    Kind::SlowRamps,
    Kind::UnevenHolds,
    Kind::Servo,
    Kind::ForceHeld,
    Kind::Triangle,
    Kind::Stairs,
    Kind::UpAndDown,
    Kind::SlowRamps,
    Kind::UnevenHolds,
    Kind::Servo,
    Kind::Sine,
    Kind::FastRamps,
    Kind::ForceHeld,
    Kind::Cycles,
    Kind::SlowRamps,
    Kind::Ramps,
];

/// Levels of noise, which change when all kinds had their turn.
pub const NOISES: [f64; 5] = [0.0, 1e-4, 1e-3, 3e-3, 1e-2];

/// Record `number` of the suite; every one is its own source of chance.
pub fn labelled(number: u64) -> Labelled {
    let mut random = Rng::new(seed_of(20_240, number));
    let turn = (number / 20) as usize;
    let kind = match TURNS[(number % 20) as usize] {
        Kind::Ramps if turn % 3 == 1 => Kind::Still,
        Kind::Ramps if turn % 3 == 2 => Kind::Creeping,
        kind => kind,
    };
    let noise = NOISES[turn % NOISES.len()];
    match kind {
        Kind::ForceHeld => press(noise, &mut random),
        Kind::Triangle | Kind::Sine | Kind::Ramps | Kind::Still | Kind::Creeping => none(kind, noise, &mut random),
        _ => squeeze(kind, noise, &mut random),
    }
}
