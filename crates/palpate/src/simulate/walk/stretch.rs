//! A stretch of time in which nothing changes its course.

use serde::{Deserialize, Serialize};

use crate::contact::UnderForce;
use crate::simulate::layer::{InMotion, Layer};

/// A contact that was lost or regained.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContactEvent {
    /// Lost or regained.
    pub kind: ContactEventKind,
    /// When, s.
    pub time: f64,
    /// Displacement of the surface (and of one contact's share of the jaw) at that moment, m.
    pub contact_displacement: f64,
}

/// What happened to the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactEventKind {
    /// The jaw left the body.
    Lost,
    /// The jaw met the body again.
    Regained,
}

/// A stretch of time over which the jaw moves at constant speed, or its force changes at a constant rate, and the contact does not change
/// its state.
pub(in crate::simulate) struct Stretch<L: Layer> {
    pub(in crate::simulate) start: f64,
    pub(in crate::simulate) end: f64,
    /// Share of one contact at `start`, m.
    pub(in crate::simulate) contact_from: f64,
    /// Speed of one contact's share, m/s; of a force, at the start.
    pub(in crate::simulate) contact_speed: f64,
    pub(in crate::simulate) state: StretchState<L>,
}

pub(in crate::simulate) enum StretchState<L: Layer> {
    Touching(L::Moving),
    Forced(L::Forced),
    Free { surface: L::Surface, since: f64 },
}

impl<L: Layer> Stretch<L> {
    /// One contact's share of the jaw's travel at `time`, m.
    pub(in crate::simulate) fn jaw_at(&self, time: f64) -> f64 {
        if let StretchState::Forced(forced) = &self.state {
            return forced.displacement_at(time - self.start);
        }
        if self.contact_speed == 0.0 {
            return self.contact_from;
        }
        self.contact_from + self.contact_speed * (time - self.start)
    }

    /// Contact force (N) at its end, where the jaw is at contact displacement `u` (m).
    pub(in crate::simulate) fn end_force(&self, model: &L, u: f64) -> f64 {
        let elapsed = self.end - self.start;
        match &self.state {
            StretchState::Touching(piece) => force_of(model, &piece.excess_at(elapsed), u),
            StretchState::Forced(forced) => forced.force_at(elapsed),
            StretchState::Free { .. } => 0.0,
        }
    }
}

/// Contact force (N) with an excess of the layer and the jaw at contact displacement `u` (m).
pub(in crate::simulate) fn force_of<L: Layer>(model: &L, excess: &L::Excess, u: f64) -> f64 {
    let specimen = model.specimen();
    let (even, excess) = (specimen.equilibrium_strain(u), model.strain_of(excess, u));
    let strain = excess + even;
    // What two numbers leave of each other when they cancel is no force.
    let none = strain.abs() <= 16.0 * f64::EPSILON * (excess.abs() + even.abs());
    if none { 0.0 } else { specimen.force(strain, u) }
}
