//! The contact layer, whichever law it obeys.
//!
//! The walk through a drive asks for no more than this: the layer while the jaw moves, under a force, and the surface without a jaw.

use super::{Separation, SimulationWork};
use crate::contact::{Specimen, Stopped, UnderForce};

/// The layer through a straight piece of motion, a time `elapsed` (s) after its start.
pub(super) trait InMotion {
    type Excess;

    fn excess_at(&self, elapsed: f64) -> Self::Excess;
    /// Excess strain.
    fn strain_at(&self, elapsed: f64) -> f64;
    /// Appends the excess strain at times (s) in a piece that began at `start`.
    fn extend_strains(&self, start: f64, times: &[f64], strains: &mut Vec<f64>);
    /// Times (s from its start) between which it is smooth.
    fn step_ends(&self) -> Vec<f64>;
}

/// A contact with a law of its layer.
pub(super) trait Layer {
    /// What the layer has in excess of equilibrium.
    type Excess: Clone;
    /// What stands behind the layer and does not jump with the force.
    type Behind;
    /// The layer through a straight piece of motion.
    type Moving: InMotion<Excess = Self::Excess>;
    /// What such pieces leave to later ones.
    type Known: Default;
    /// The layer under a force that goes straight.
    type Forced: UnderForce<Excess = Self::Excess, Behind = Self::Behind>;
    /// The surface without a jaw.
    type Surface: Clone;

    fn specimen(&self) -> &Specimen;
    fn separation(&self) -> Separation;
    fn is_bonded(&self) -> bool {
        self.separation() == Separation::Bonded
    }

    /// Whether the jaw may go back to contact displacement `u` (m).
    fn can_go_back_to(&self, _: f64) -> bool {
        true
    }

    /// The farthest travel (m of contact displacement) that one piece of motion follows with the accuracy of the law.
    fn farthest_piece(&self) -> f64 {
        f64::INFINITY
    }

    fn relaxed(&self) -> Self::Excess;
    /// Excess strain at contact displacement `u` (m).
    fn strain_of(&self, excess: &Self::Excess, u: f64) -> f64;
    fn is_finite(excess: &Self::Excess) -> bool;
    fn behind(&self, excess: &Self::Excess, u: f64) -> Self::Behind;
    /// What one contact of a body of constant section stores, J, whose stiffness is E A (N).
    fn stored(&self, excess: &Self::Excess, u: f64, stiffness: f64) -> f64;

    /// From contact displacement `from` (m) at `speed` (m/s) for `duration` (s).
    fn moving(
        &self,
        excess: &Self::Excess,
        line: (f64, f64),
        duration: f64,
        known: &mut Self::Known,
        work: &mut SimulationWork,
    ) -> Self::Moving;
    /// Appends the excess strain at times (s) in a piece that began at `start`, and the rates (1/s) of the whole strain at `speed` (m/s), with
    /// the jaw at `places` (m).
    fn extend(
        &self,
        piece: &Self::Moving,
        start_and_speed: (f64, f64),
        times_and_places: (&[f64], &[f64]),
        strains: &mut Vec<f64>,
        rates: &mut Vec<f64>,
    );
    /// When (s) the strain of the layer reaches zero in a piece between two times, with the jaw at `jaw` and going at `speed` (m/s).
    fn loss(&self, piece: &Self::Moving, times: (f64, f64), speed: f64, jaw: &impl Fn(f64) -> f64) -> Option<f64>;

    fn forced(
        &self,
        forces: (f64, f64),
        behind: &Self::Behind,
        duration: f64,
        work: &mut SimulationWork,
    ) -> Result<Self::Forced, Stopped>;

    /// The surface that the jaw leaves at contact displacement `u` (m); `None` if the numbers ran out.
    fn left(&self, excess: &Self::Excess, u: f64) -> Option<Self::Surface>;
    fn surface(&self, surface: &Self::Surface, elapsed: f64) -> f64;
    /// Excess of the layer of a surface that is met at contact displacement `u` (m).
    fn met(&self, surface: &Self::Surface, elapsed: f64, u: f64) -> Self::Excess;
    /// When between two times (s) the jaw, going at `speed` (m/s), meets the surface, which is on its own since `since` (s).
    fn meeting(
        &self,
        surface: &Self::Surface,
        since: f64,
        times: (f64, f64),
        speed: f64,
        jaw: &impl Fn(f64) -> f64,
    ) -> Option<f64>;
}

/// When (s into a piece of `duration`) the strain of the layer reaches zero; `gain` is its rate, `ends` those of the integration steps.
///
/// Only a retreating jaw can lose the contact, and there the strain is either falling or rises once and then falls (its second derivative
/// has one sign), so that a change of sign shows at the ends of the steps.
pub(super) fn lost(
    ends: impl Iterator<Item = f64>,
    duration: f64,
    speed: f64,
    strain: impl Fn(f64) -> f64,
    gain: impl Fn(f64) -> f64,
) -> Option<f64> {
    if speed >= 0.0 {
        return None;
    }
    let mut touching = 0.0;
    for elapsed in ends.chain([duration]) {
        if elapsed <= duration && strain(elapsed) < 0.0 {
            if touching == 0.0 && strain(0.0) <= 0.0 && gain(0.0) > 0.0 {
                // Just met and still gaining on the jaw: it is lost after the strain has risen, if that is more than rounding.
                if gain(elapsed) < 0.0 {
                    touching = crossing(0.0, elapsed, &gain);
                }
                if strain(touching) <= 0.0 {
                    touching = 0.0;
                    continue;
                }
            }
            return Some(if strain(touching) <= 0.0 { touching } else { crossing(touching, elapsed, strain) });
        }
        touching = elapsed;
    }
    None
}

/// When between two times (s) the jaw, going at `speed` (m/s), meets a surface that is at `place` (m) at a time and goes back at `pace`
/// (m/s, below zero) from a place.
pub(super) fn meeting(
    place: impl Fn(f64) -> f64,
    pace: impl Fn(f64) -> f64,
    (start, mut end): (f64, f64),
    speed: f64,
    jaw: &impl Fn(f64) -> f64,
) -> Option<f64> {
    let lead = |time: f64| jaw(time) - place(time);
    if speed < 0.0 {
        // The surface slows down as it recovers, so the jaw's lead rises while the surface is the faster one
        // and falls afterwards: only that first part can hold the meeting.
        let faster = |time: f64| speed - pace(place(time));
        if faster(start) <= 0.0 {
            return None;
        }
        if faster(end) < 0.0 {
            end = crossing(start, end, faster);
        }
    }
    if lead(end) < 0.0 || (lead(end) == 0.0 && speed < 0.0) {
        return None;
    }
    Some(if lead(start) >= 0.0 { start } else { crossing(start, end, |time| -lead(time)) })
}

/// Where a function that is positive at `positive` and negative at `negative` changes sign, by bisection to the last bit.
pub(super) fn crossing(mut positive: f64, mut negative: f64, f: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = 0.5 * (positive + negative);
        if middle <= positive.min(negative) || middle >= positive.max(negative) {
            return negative;
        }
        if f(middle) > 0.0 {
            positive = middle;
        } else {
            negative = middle;
        }
    }
}
