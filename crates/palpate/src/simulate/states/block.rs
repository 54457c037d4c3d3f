//! Contacts that stay in contact, side by side in vectors.

use crate::contact::{Equilibrium, Shape};
use crate::latency::lanes::{Power, by_power};
use crate::simulate::{ContactModel, Separation};
use crate::vector::LANES;
use crate::vector::elementary::{exp, ln, ln_1p};

/// Numbers of contacts side by side.
type Lanes = [f64; LANES];

/// Numbers from a place on; the last of them also in place of those that are not there.
#[inline(always)]
pub(super) fn lanes(all: &[f64], from: usize) -> Lanes {
    let some = all.get(from..).unwrap_or_default();
    let last = all.len() - 1;
    some.first_chunk()
        .copied()
        .unwrap_or_else(|| std::array::from_fn(|lane| all[(from + lane).min(last)]))
}

/// The numbers of the models of contacts side by side.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    power: Power,
    exponent: Lanes,
    rate_coefficient: Lanes,
    /// Share of the displacement that is one contact's.
    share: Lanes,
    per_depth: Lanes,
    thickness: Lanes,
    per_thickness: Lanes,
    /// m − 1.
    layers_behind: Lanes,
    modulus: Lanes,
    /// Twice the radius of a ball or a pad, 0 for another body.
    diameter: Lanes,
    /// The contact area of a prism.
    section: Lanes,
    /// Contact displacements from which on there is no body, and below which nothing holds on to it.
    limit: Lanes,
    lowest: Lanes,
    /// How far the layer may be stretched, m: nothing, or without end where it is bonded.
    hold: Lanes,
}

/// Contacts after a step.
pub(super) struct Moved {
    pub(super) jaw: Lanes,
    pub(super) behind: Lanes,
    pub(super) force: Lanes,
    /// Whether the contact was closed all along, at numbers that can be.
    pub(super) stays: [bool; LANES],
}

impl Block {
    /// Of up to [`LANES`] models; the last of them also in place of those that are not there.
    pub(super) fn new(models: &[ContactModel]) -> Self {
        let each = |of: &dyn Fn(&ContactModel) -> f64| -> Lanes {
            std::array::from_fn(|lane| of(&models[lane.min(models.len() - 1)]))
        };
        let exponent = each(&|model| model.law.exponent());
        let is_bonded = |model: &ContactModel| model.separation == Separation::Bonded;
        let is_prism = |model: &ContactModel| model.specimen.has_constant_section();
        Self {
            power: Power::of(&exponent),
            exponent,
            rate_coefficient: each(&|model| model.law.rate_coefficient()),
            share: each(&|model| model.specimen.contact_displacement(1.0)),
            per_depth: each(&|model| 1.0 / model.specimen.depth()),
            thickness: each(&|model| model.layers.thickness(model.specimen.depth())),
            per_thickness: each(&|model| 1.0 / model.layers.thickness(model.specimen.depth())),
            layers_behind: each(&|model| model.layers.count() - 1.0),
            modulus: each(&|model| model.specimen.modulus()),
            diameter: each(&|model| match model.specimen.shape() {
                Shape::Ball { radius } | Shape::Pad { radius, .. } => 2.0 * radius,
                _ => 0.0,
            }),
            section: each(&|model| match model.specimen.shape() {
                Shape::Prism { area, .. } => *area,
                _ => 0.0,
            }),
            limit: each(&|model| {
                let plain =
                    matches!(model.specimen.shape(), Shape::Ball { .. } | Shape::Pad { .. } | Shape::Prism { .. })
                        && *model.specimen.equilibrium() == Equilibrium::UniformStrain;
                match (plain, is_bonded(model) && is_prism(model)) {
                    // A body of another form is stepped alone.
                    (false, _) => f64::NEG_INFINITY,
                    (true, true) => f64::INFINITY,
                    (true, false) => model.specimen.limit().at,
                }
            }),
            lowest: each(&|model| if is_bonded(model) && !is_prism(model) { 0.0 } else { f64::NEG_INFINITY }),
            hold: each(&|model| if is_bonded(model) { f64::INFINITY } else { 0.0 }),
        }
    }

    /// In contact all along, in code for vectors.
    #[inline(always)]
    pub(super) fn moved(&self, state: (&Lanes, &Lanes), dt: &Lanes, to: &Lanes) -> Moved {
        by_power!(self.power, power => self.pressed(power, state, dt, to))
    }

    /// In contact all along, as `ContactState` has it.
    #[inline(always)]
    fn pressed(&self, power: Power, (jaw, behind): (&Lanes, &Lanes), dt: &Lanes, to: &Lanes) -> Moved {
        let mut moved = Moved {
            jaw: [0.0; LANES],
            behind: [0.0; LANES],
            force: [0.0; LANES],
            stays: [false; LANES],
        };
        for lane in 0..LANES {
            let (per_depth, per_thickness) = (self.per_depth[lane], self.per_thickness[lane]);
            let u = to[lane] * self.share[lane];
            let kick = 0.5 * ((u - jaw[lane]) * self.layers_behind[lane] * per_depth);
            let excess = (jaw[lane] - behind[lane]) * per_thickness - jaw[lane] * per_depth + kick;
            let excess = self.relaxed(power, lane, excess, dt[lane]) + kick;
            let left = u - self.thickness[lane] * (excess + u * per_depth);
            let strain = (u - left) / self.thickness[lane];
            let inside = if u > 0.0 { u } else { 0.0 };
            let round = std::f64::consts::PI * inside * (self.diameter[lane] - inside);
            let area = if self.diameter[lane] > 0.0 { round } else { self.section[lane] };
            let force = self.modulus[lane] * strain * area;
            (moved.jaw[lane], moved.behind[lane]) = (u, left);
            moved.force[lane] = if strain <= 0.0 && self.hold[lane] == 0.0 { 0.0 } else { force };
            moved.stays[lane] = (jaw[lane] + self.hold[lane] >= behind[lane])
                & (u + self.hold[lane] >= left)
                & (u < self.limit[lane])
                & (u >= self.lowest[lane])
                & (u > f64::NEG_INFINITY)
                & (dt[lane] >= 0.0)
                & (dt[lane] < f64::INFINITY);
        }
        moved
    }

    /// An excess strain after some time, [`LatencyLaw::excess_after`](crate::latency::LatencyLaw::excess_after).
    #[inline(always)]
    fn relaxed(&self, power: Power, lane: usize, x: f64, dt: f64) -> f64 {
        /// Largest argument of the logarithm.
        const LARGEST: f64 = 1e308;
        let (v, a) = (self.rate_coefficient[lane], x.abs());
        match power {
            Power::One => x * exp(-(v * dt)),
            Power::Two => x / (1.0 + v * a * dt),
            Power::Three => x / (1.0 + 2.0 * (v * (a * a) * dt)).sqrt(),
            Power::Five => x / (1.0 + 4.0 * (v * ((a * a) * (a * a)) * dt)).sqrt().sqrt(),
            Power::Any => {
                let p = self.exponent[lane] - 1.0;
                let base = if a < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { a };
                let s = v * exp(p * ln(base)) * dt;
                let z = if p * s < LARGEST { p * s } else { LARGEST };
                let some = if z > -1.0 { z } else { -0.5 };
                let decayed = exp(-ln_1p(some) / p);
                let decayed = if z == 0.0 { exp(-s) } else { decayed };
                let decayed = if z > -1.0 { decayed } else { 0.0 };
                if a == 0.0 { 0.0 } else { x * decayed }
            }
        }
    }
}
