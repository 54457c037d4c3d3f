//! What an observer says after a tick.

use serde::{Deserialize, Serialize};

use super::kept::Kept;
use crate::fit::Estimate;
use crate::grip::TimeToSlip;

/// What happens at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ContactPhase {
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Held {
    /// The displacement: the force relaxes.
    #[default]
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

/// When the force has relaxed to the force of slip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum SlipForecast {
    /// Not known yet: no hold, too little of it, or a force that may be at its peak, or has begun to fall.
    Unknown,
    /// At the requested confidence. The force never reaches it in a force hold, or if the equilibrium force is above it.
    Known {
        /// Best value, from now on.
        best: TimeToSlip,
        /// Lower end of its interval.
        low: TimeToSlip,
        /// Upper end.
        high: TimeToSlip,
    },
}

impl SlipForecast {
    /// Not by relaxation.
    pub(super) const NEVER: Self = Self::Known {
        best: TimeToSlip::Never,
        low: TimeToSlip::Never,
        high: TimeToSlip::Never,
    };
}

/// Warnings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Slip {
    /// Nothing to warn of.
    #[default]
    None,
    /// Within the time to warn slip cannot be excluded.
    Soon,
    /// The force of something that was held is at or below the force of slip, in whatever phase.
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

/// Report of an observer after a tick, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Observation {
    /// When, s.
    pub time: f64,
    /// What happens.
    pub phase: ContactPhase,
    /// What is held; `None` outside a hold.
    pub held: Option<Held>,
    /// When the hold began, s.
    pub held_since: Option<f64>,
    /// Filtered force when the hold began, N.
    pub held_force: Option<f64>,
    /// True on the one tick at which a hold is detected.
    pub began: bool,
    /// Filtered force, N: the fitted curve within a hold as long as the readings follow it, the output of a filter elsewhere.
    pub force: f64,
    /// Equilibrium force of a position hold, N; `None` until its interval is narrower than the force itself.
    pub equilibrium_force: Option<Estimate>,
    /// Force in excess of equilibrium, N.
    pub excess_force: Option<Estimate>,
    /// Strain in excess of equilibrium; only with a material.
    pub excess_strain: Option<Estimate>,
    /// Current relative rate at which the excess falls: v|x|ⁿ⁻¹ in 1/s.
    pub relative_rate: Option<f64>,
    /// Creep speed (m/s) in a force hold.
    pub creep_rate: Option<Estimate>,
    /// Time to slip; `None` without a slip force.
    pub time_to_slip: Option<SlipForecast>,
    /// Warning.
    pub slip: Slip,
}
