//! What an observer says after a tick.

use serde::{Deserialize, Serialize};

use super::kept::{Kept, kept};

/// What happens at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Phase {
    /// No contact: the force is within its noise of zero.
    #[default]
    Free,
    /// The jaw closes, or the force rises.
    Loading,
    /// Displacement or force is held.
    Holding,
    /// The jaw opens, or the force falls as no body relaxes.
    Unloading,
}

/// What is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Held {
    /// The displacement: the force relaxes.
    Displacement,
    /// The force: the displacement creeps.
    Force,
}

impl Kept for Held {
    fn keep(&self, into: &mut Vec<u8>) {
        (*self == Self::Force).keep(into);
    }

    fn read(from: &mut &[u8]) -> Option<Self> {
        Some(if bool::read(from)? { Self::Force } else { Self::Displacement })
    }
}

/// A value and its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Uncertain {
    /// Best value.
    pub value: f64,
    /// Standard deviation.
    pub deviation: f64,
}
kept!(Uncertain: value, deviation);

/// How long until the force has relaxed to the force of slip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum TimeToSlip {
    /// Not known yet: no hold, or too little of it.
    Unknown,
    /// Not by relaxation: with the confidence that was asked for the equilibrium force is above, or the force is held.
    Never,
    /// After a time.
    After {
        /// Best value, s; `None` where the best equilibrium is above the force of slip.
        value: Option<f64>,
        /// Lower end of the interval, s.
        low: f64,
        /// Upper end, s; `None` where never is inside the interval.
        high: Option<f64>,
    },
}

/// Warnings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Slip {
    /// Nothing to warn of.
    #[default]
    None,
    /// Within the time to warn slip cannot be excluded.
    Soon,
    /// The force is at or below the force of slip.
    Slipping,
}

impl Kept for Slip {
    fn keep(&self, into: &mut Vec<u8>) {
        (*self as u8).keep(into);
    }

    fn read(from: &mut &[u8]) -> Option<Self> {
        let number = u8::read(from)?;
        [Self::None, Self::Soon, Self::Slipping].into_iter().find(|slip| *slip as u8 == number)
    }
}

/// What an observer says after a tick; SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// When, s.
    pub time: f64,
    /// What happens.
    pub phase: Phase,
    /// What is held; `None` outside a hold.
    pub held: Option<Held>,
    /// When the hold began, s.
    pub held_since: Option<f64>,
    /// True on the one tick that says that a hold began.
    pub began: bool,
    /// The force without its noise, N: the fitted curve inside a hold, a filter's elsewhere.
    pub force: f64,
    /// The force that a displacement hold tends to, N; `None` until its interval is narrower than the force itself.
    pub equilibrium_force: Option<Uncertain>,
    /// Force in excess of equilibrium, N.
    pub excess_force: Option<Uncertain>,
    /// Strain in excess of equilibrium; only a material tells it.
    pub excess_strain: Option<Uncertain>,
    /// Rate at which the excess falls now, in shares of itself: v|x|ⁿ⁻¹ in 1/s.
    pub relative_rate: Option<f64>,
    /// Speed of the creep (m/s) while the force is held.
    pub creep_rate: Option<Uncertain>,
    /// How long until slip; `None` where no force of slip was given.
    pub time_to_slip: Option<TimeToSlip>,
    /// Warning.
    pub slip: Slip,
}
