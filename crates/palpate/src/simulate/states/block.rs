//! Contacts of the latency law that stay in contact, side by side in vectors.

use super::parameters::{ContactParameter, Parameters};
use crate::contact::{Equilibrium, Shape, Specimen};
use crate::latency::lanes::{Power, by_power, each};
use crate::simulate::{ContactModel, Separation};
use crate::vector::LANES;
use crate::vector::elementary::{exp, ln, ln_1p};

/// Values of contacts side by side.
pub(super) type Lanes = [f64; LANES];

/// Values from a position on; the last of them also in place of those that are not there.
#[inline(always)]
pub(super) fn lanes(all: &[f64], from: usize) -> Lanes {
    let some = all.get(from..).unwrap_or_default();
    let last = all.len() - 1;
    some.first_chunk()
        .copied()
        .unwrap_or_else(|| std::array::from_fn(|lane| all[(from + lane).min(last)]))
}

/// Writes values from a position on, as many as there is room for.
#[inline(always)]
pub(super) fn store(all: &mut [f64], from: usize, values: &Lanes) {
    let Some(some) = all.get_mut(from..) else { return };
    match some.first_chunk_mut() {
        Some(chunk) => *chunk = *values,
        None => some.iter_mut().zip(values).for_each(|(slot, value)| *slot = *value),
    }
}

/// The bodies of contacts side by side: E ε A(u) of a ball, a pad or a prism, and where others begin that are stepped alone.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bodies {
    /// Share of the displacement that is one contact's.
    pub(super) share: Lanes,
    pub(super) per_depth: Lanes,
    pub(super) depth: Lanes,
    pub(super) modulus: Lanes,
    /// Twice the radius of a ball or a pad, 0 of another body.
    pub(super) diameter: Lanes,
    /// Whether the radius is the depth.
    is_ball: [bool; LANES],
    /// The contact area of a prism.
    pub(super) section: Lanes,
    /// Contact displacements from which on there is no body, and below which nothing holds on to it.
    pub(super) limit: Lanes,
    pub(super) lowest: Lanes,
    /// How far the layer may be stretched: nothing, or without end where it is bonded.
    pub(super) hold: Lanes,
}

/// Whether the force of a body is E ε A(u) with the area of a ball, a pad or a prism.
pub(super) fn is_plain(specimen: &Specimen) -> bool {
    matches!(specimen.shape(), Shape::Ball { .. } | Shape::Pad { .. } | Shape::Prism { .. })
        && *specimen.equilibrium() == Equilibrium::UniformStrain
}

impl Bodies {
    /// Of up to [`LANES`] bodies; the last of them also in place of those that are not there.
    pub(super) fn new(bodies: &[(&Specimen, Separation)]) -> Self {
        let of_each = |of: &dyn Fn(&Specimen, bool) -> f64| -> Lanes {
            std::array::from_fn(|lane| {
                let (specimen, separation) = bodies[lane.min(bodies.len() - 1)];
                of(specimen, separation == Separation::Bonded)
            })
        };
        Self {
            share: of_each(&|specimen, _| specimen.contact_displacement(1.0)),
            per_depth: of_each(&|specimen, _| 1.0 / specimen.depth()),
            depth: of_each(&|specimen, _| specimen.depth()),
            modulus: of_each(&|specimen, _| specimen.modulus()),
            diameter: of_each(&|specimen, _| match specimen.shape() {
                Shape::Ball { radius } | Shape::Pad { radius, .. } => 2.0 * radius,
                _ => 0.0,
            }),
            is_ball: std::array::from_fn(|lane| {
                matches!(bodies[lane.min(bodies.len() - 1)].0.shape(), Shape::Ball { .. })
            }),
            section: of_each(&|specimen, _| match specimen.shape() {
                Shape::Prism { area, .. } => *area,
                _ => 0.0,
            }),
            limit: of_each(&|specimen, bonded| match (is_plain(specimen), bonded && specimen.has_constant_section()) {
                // A body of another form is stepped alone.
                (false, _) => f64::NEG_INFINITY,
                (true, true) => f64::INFINITY,
                (true, false) => specimen.limit().at,
            }),
            lowest: of_each(&|specimen, bonded| {
                if bonded && !specimen.has_constant_section() { 0.0 } else { f64::NEG_INFINITY }
            }),
            hold: of_each(&|_, bonded| if bonded { f64::INFINITY } else { 0.0 }),
        }
    }

    /// With the values of parameters from contact `from` on.
    #[inline(always)]
    pub(super) fn set(&mut self, parameters: &Parameters, from: usize) {
        if let Some(modulus) = parameters.values(ContactParameter::Modulus) {
            self.modulus = lanes(modulus, from);
        }
        if let Some(radius) = parameters.values(ContactParameter::Radius) {
            for (lane, radius) in lanes(radius, from).into_iter().enumerate() {
                self.diameter[lane] = 2.0 * radius;
                if self.is_ball[lane] {
                    self.depth[lane] = radius;
                    self.per_depth[lane] = 1.0 / radius;
                    self.limit[lane] = if self.limit[lane] > 0.0 { radius } else { self.limit[lane] };
                }
            }
        }
    }

    /// The contact area at a contact displacement (m), and its slope.
    #[inline(always)]
    pub(super) fn area(&self, lane: usize, u: f64) -> (f64, f64) {
        let inside = if u > 0.0 { u } else { 0.0 };
        let (diameter, section) = (self.diameter[lane], self.section[lane]);
        let round = std::f64::consts::PI * inside * (diameter - inside);
        let growth = std::f64::consts::PI * (diameter - 2.0 * inside);
        let is_round = diameter > 0.0;
        (choose(is_round, round, section), choose(is_round, growth, 0.0))
    }

    /// `wrong`, or 1 where a contact displacement is none that vector code takes.
    #[inline(always)]
    pub(super) fn misfit(&self, lane: usize, u: f64, wrong: f64) -> f64 {
        let wrong = choose(u < self.limit[lane], wrong, 1.0);
        let wrong = choose(u >= self.lowest[lane], wrong, 1.0);
        self.farther(lane, u, wrong)
    }

    /// `wrong`, or 1 where a position is beyond [`FARTHEST`], or NaN.
    #[inline(always)]
    pub(super) fn farther(&self, lane: usize, position: f64, wrong: f64) -> f64 {
        choose(position.abs() < FARTHEST * self.depth[lane], wrong, 1.0)
    }
}

/// One of two numbers, without a branch.
#[inline(always)]
pub(super) fn choose(first: bool, yes: f64, no: f64) -> f64 {
    if first { yes } else { no }
}

/// `wrong`, or 1 where a time step is none.
#[inline(always)]
pub(super) fn misdated(dt: f64, wrong: f64) -> f64 {
    choose(dt < f64::INFINITY, choose(dt >= 0.0, wrong, 1.0), 1.0)
}

/// Whether none of the lanes is wrong.
#[inline(always)]
pub(super) fn all_right(wrong: &Lanes) -> bool {
    let [a, b, c, d, e, f, g, h] = *wrong;
    ((a + b) + (c + d)) + ((e + f) + (g + h)) == 0.0
}

/// Positions beyond so many depths of a body are refused: their forces might not be finite.
pub(super) const FARTHEST: f64 = 1e6;

/// The laws of contacts side by side, and their bodies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    pub(super) bodies: Bodies,
    power: Power,
    exponent: Lanes,
    rate_coefficient: Lanes,
    thickness: Lanes,
    per_thickness: Lanes,
    /// m
    layers: Lanes,
}

/// Contacts after a step.
pub(super) struct Moved {
    pub(super) jaw: Lanes,
    pub(super) behind: Lanes,
    pub(super) force: Lanes,
    /// 0 where the contact was closed all along, at values that can be; 1 elsewhere.
    pub(super) wrong: Lanes,
}

impl Block {
    /// Of up to [`LANES`] models; the last of them also in place of those that are not there.
    pub(super) fn new(models: &[ContactModel]) -> Self {
        let of_each = |of: &dyn Fn(&ContactModel) -> f64| -> Lanes {
            std::array::from_fn(|lane| of(&models[lane.min(models.len() - 1)]))
        };
        let exponent = of_each(&|model| model.law.exponent());
        let bodies: Vec<_> = models.iter().map(|model| (&model.specimen, model.separation)).collect();
        Self {
            bodies: Bodies::new(&bodies),
            power: Power::of(&exponent),
            exponent,
            rate_coefficient: of_each(&|model| model.law.rate_coefficient()),
            thickness: of_each(&|model| model.layers.thickness(model.specimen.depth())),
            per_thickness: of_each(&|model| 1.0 / model.layers.thickness(model.specimen.depth())),
            layers: of_each(&|model| model.layers.count()),
        }
    }

    /// With the values of parameters from contact `from` on.
    #[inline(always)]
    pub(super) fn with(&self, parameters: &Parameters, from: usize) -> Self {
        let mut block = self.clone();
        block.bodies.set(parameters, from);
        if let Some(exponent) = parameters.values(ContactParameter::Exponent) {
            block.exponent = lanes(exponent, from);
            block.power = Power::of(&block.exponent);
        }
        if let Some(rate_coefficient) = parameters.values(ContactParameter::RateCoefficient) {
            block.rate_coefficient = lanes(rate_coefficient, from);
        }
        if let Some(thickness) = parameters.values(ContactParameter::LayerThickness) {
            for (lane, thickness) in lanes(thickness, from).into_iter().enumerate() {
                block.layers[lane] = block.bodies.depth[lane] / thickness;
            }
        }
        for lane in 0..LANES {
            block.thickness[lane] = block.bodies.depth[lane] / block.layers[lane];
            block.per_thickness[lane] = 1.0 / block.thickness[lane];
        }
        block
    }

    /// A step in equal parts, in contact all along, in code for vectors; `to` is a displacement of the jaw (m).
    #[inline(always)]
    pub(super) fn moved(&self, (jaw, behind): (&Lanes, &Lanes), dt: &Lanes, to: &Lanes, substeps: u32) -> Moved {
        by_power!(self.power, power => self.moved_by(power, (jaw, behind), dt, to, substeps))
    }

    #[inline(always)]
    fn moved_by(&self, power: Power, (jaw, behind): (&Lanes, &Lanes), dt: &Lanes, to: &Lanes, substeps: u32) -> Moved {
        let target = each(
            #[inline(always)]
            |lane| to[lane] * self.bodies.share[lane],
        );
        if substeps == 1 {
            return self.pressed(power, (jaw, behind), dt, &target);
        }
        let part_dt = each(
            #[inline(always)]
            |lane| dt[lane] / f64::from(substeps),
        );
        let first = each(
            #[inline(always)]
            |lane| between(jaw[lane], target[lane], (1, substeps)),
        );
        let mut moved = self.pressed(power, (jaw, behind), &part_dt, &first);
        for step in 2..=substeps {
            let next = each(
                #[inline(always)]
                |lane| between(jaw[lane], target[lane], (step, substeps)),
            );
            let before = moved;
            moved = self.pressed(power, (&before.jaw, &before.behind), &part_dt, &next);
            moved.wrong = each(
                #[inline(always)]
                |lane| moved.wrong[lane] + before.wrong[lane],
            );
        }
        moved
    }

    /// In contact all along, as `ContactState` has it, to contact displacements `to` (m).
    #[inline(always)]
    fn pressed(&self, power: Power, (jaw, behind): (&Lanes, &Lanes), dt: &Lanes, to: &Lanes) -> Moved {
        let bodies = &self.bodies;
        // A loop for each line becomes vectors; one loop with conditions does not.
        let kick = each(
            #[inline(always)]
            |lane| 0.5 * ((to[lane] - jaw[lane]) * (self.layers[lane] - 1.0) * bodies.per_depth[lane]),
        );
        let excess = each(
            #[inline(always)]
            |lane| {
                (jaw[lane] - behind[lane]) * self.per_thickness[lane] - jaw[lane] * bodies.per_depth[lane] + kick[lane]
            },
        );
        let excess = each(
            #[inline(always)]
            |lane| self.relaxed(power, lane, excess[lane], dt[lane]) + kick[lane],
        );
        let left = each(
            #[inline(always)]
            |lane| to[lane] - self.thickness[lane] * (excess[lane] + to[lane] * bodies.per_depth[lane]),
        );
        let strain = each(
            #[inline(always)]
            |lane| (to[lane] - left[lane]) / self.thickness[lane],
        );
        let force = each(
            #[inline(always)]
            |lane| bodies.modulus[lane] * strain[lane] * bodies.area(lane, to[lane]).0,
        );
        let wrong = each(
            #[inline(always)]
            |lane| {
                let opened = choose(jaw[lane] + bodies.hold[lane] >= behind[lane], 0.0, 1.0);
                let opened = choose(to[lane] + bodies.hold[lane] >= left[lane], opened, 1.0);
                let is_near = bodies.farther(lane, behind[lane], bodies.farther(lane, jaw[lane], opened));
                choose(force[lane].abs() < f64::INFINITY, is_near, 1.0)
            },
        );
        let wrong = each(
            #[inline(always)]
            |lane| bodies.misfit(lane, to[lane], wrong[lane]),
        );
        let least = each(
            #[inline(always)]
            |lane| choose(bodies.hold[lane] > 0.0, f64::NEG_INFINITY, 0.0),
        );
        Moved {
            jaw: *to,
            behind: left,
            force: each(
                #[inline(always)]
                |lane| choose(strain[lane] > least[lane], force[lane], 0.0),
            ),
            wrong: each(
                #[inline(always)]
                |lane| misdated(dt[lane], wrong[lane]),
            ),
        }
    }

    /// Forces (N) and stiffnesses dF/dd (N/m) of states, as `ContactState` has them.
    #[inline(always)]
    pub(super) fn force_and_stiffness(&self, jaw: &Lanes, behind: &Lanes) -> (Lanes, Lanes) {
        let bodies = &self.bodies;
        let (mut forces, mut slopes) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let strain = (jaw[lane] - behind[lane]) / self.thickness[lane];
            let (area, growth) = bodies.area(lane, jaw[lane]);
            let growth = if jaw[lane] < 0.0 { 0.0 } else { bodies.modulus[lane] * growth };
            let force = bodies.modulus[lane] * strain * area;
            let slope = bodies.share[lane] * (bodies.modulus[lane] * area / self.thickness[lane] + growth * strain);
            let (bonded, is_off) = (bodies.hold[lane] > 0.0, jaw[lane] < behind[lane]);
            forces[lane] = if strain <= 0.0 && !bonded { 0.0 } else { force };
            slopes[lane] = if is_off && !bonded { 0.0 } else { slope };
        }
        (forces, slopes)
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

/// The position after `part` of a way from one to another, exactly there at its end.
#[inline(always)]
pub(super) fn between(from: f64, to: f64, (part, parts): (u32, u32)) -> f64 {
    let way = from + (to - from) * (f64::from(part) / f64::from(parts));
    if part == parts { to } else { way }
}
