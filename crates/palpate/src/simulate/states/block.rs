//! Contacts of the latency law that stay in contact, side by side in vectors.

use super::lanes::{Column, Lanes};
use crate::contact::{Equilibrium, Shape, Specimen};
use crate::latency::lanes::Power;
use crate::simulate::{ContactModel, Separation};
use crate::vector::LANES;
use crate::vector::elementary::{exp, ln, ln_1p};

/// The bodies of contacts side by side: E ε A(u) of a ball, a pad or a prism, and where others begin that are stepped alone.
///
/// Numbers begin at a cache line: a load of eight that crosses one takes twice as long.
#[derive(Debug, Clone, PartialEq)]
#[repr(align(64))]
pub(super) struct Bodies {
    /// Share of the displacement that is one contact's.
    pub(super) share: Lanes,
    pub(super) per_depth: Lanes,
    pub(super) depth: Lanes,
    /// [`FARTHEST`] depths.
    far: Lanes,
    pub(super) modulus: Lanes,
    /// Twice the radius of a ball or a pad, 0 of another body.
    pub(super) diameter: Lanes,
    /// The contact area of a prism.
    pub(super) section: Lanes,
    /// Contact displacements from which on there is no body, and below which nothing holds on to it.
    pub(super) limit: Lanes,
    pub(super) lowest: Lanes,
    /// How far the layer may be stretched: nothing, or without end where it is bonded.
    pub(super) hold: Lanes,
    /// The same with the sign of a stretch.
    pub(super) slack: Lanes,
}

/// Whether the force of a body is E ε A(u) with the area of a ball, a pad or a prism.
pub(super) fn is_plain(specimen: &Specimen) -> bool {
    matches!(specimen.shape(), Shape::Ball { .. } | Shape::Pad { .. } | Shape::Prism { .. })
        && *specimen.equilibrium() == Equilibrium::UniformStrain
}

/// Whether a body is none that there is.
pub(super) fn is_extreme(specimen: &Specimen) -> bool {
    let reach = specimen.depth();
    !(specimen.force(1.0, 0.999 * reach).abs() < 1e100 && (1e-50..1e50).contains(&reach))
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
            far: of_each(&|specimen, _| FARTHEST * specimen.depth()),
            modulus: of_each(&|specimen, _| specimen.modulus()),
            diameter: of_each(&|specimen, _| match specimen.shape() {
                Shape::Ball { radius } | Shape::Pad { radius, .. } => 2.0 * radius,
                _ => 0.0,
            }),
            section: of_each(&|specimen, _| match specimen.shape() {
                Shape::Prism { area, .. } => *area,
                _ => 0.0,
            }),
            limit: of_each(&|specimen, bonded| match bonded && specimen.has_constant_section() {
                // A body of another form, or of no size that there is, is stepped alone.
                _ if !is_plain(specimen) || is_extreme(specimen) => f64::NEG_INFINITY,
                true => FARTHEST * specimen.depth(),
                false => specimen.limit().at.min(FARTHEST * specimen.depth()),
            }),
            lowest: of_each(&|specimen, bonded| match bonded && !specimen.has_constant_section() {
                true => 0.0,
                false => -FARTHEST * specimen.depth(),
            }),
            hold: of_each(&|_, bonded| if bonded { f64::INFINITY } else { 0.0 }),
            slack: of_each(&|_, bonded| if bonded { f64::NEG_INFINITY } else { 0.0 }),
        }
    }

    /// The contact area at a contact displacement (m), and its slope.
    #[inline(always)]
    pub(super) fn area(&self, lane: usize, u: f64) -> (f64, f64) {
        let inside = if u > 0.0 { u } else { 0.0 };
        // Both are loaded before the choice: a load behind it is one under a mask.
        let (diameter, section) = (self.diameter[lane], self.section[lane]);
        let round = std::f64::consts::PI * inside * (diameter - inside);
        let growth = std::f64::consts::PI * (diameter - 2.0 * inside);
        if diameter > 0.0 { (round, growth) } else { (section, 0.0) }
    }

    /// Whether vector code takes a contact displacement.
    #[inline(always)]
    pub(super) fn fits(&self, lane: usize, u: f64) -> bool {
        (u < self.limit[lane]) & (u >= self.lowest[lane])
    }

    /// Whether the sum of some distances is below [`FARTHEST`], and a number.
    #[inline(always)]
    pub(super) fn is_near(&self, lane: usize, distances: f64) -> bool {
        distances < self.far[lane]
    }

    /// Whether contacts take a step in equal parts, as far as their places and the time tell.
    #[inline(always)]
    pub(super) fn take(&self, (jaw, behind): (Lanes, Lanes), (dt, to): (Lanes, Lanes), parts: u32) -> bool {
        let mut is_right = true;
        for lane in 0..LANES {
            let u = to[lane] * self.share[lane];
            let first = between(jaw[lane], u, (1, parts));
            let is_near = self.is_near(lane, jaw[lane].abs() + behind[lane].abs());
            is_right &= is_near & self.fits(lane, u) & self.fits(lane, first) & is_step(dt[lane]);
        }
        is_right
    }

    /// How many blocks of contacts one after the other take a step.
    #[inline(always)]
    pub(super) fn taken_in_row<'a>(
        bodies: impl Fn(usize) -> &'a Self,
        (jaws, behinds): (&[Lanes], &[Lanes]),
        (dt, to): (Column<'_>, Column<'_>),
        parts: u32,
    ) -> usize {
        let (dt, to) = (dt.rows(), to.rows());
        for (index, (jaw, behind)) in jaws.iter().zip(behinds).enumerate() {
            if !bodies(index).take((*jaw, *behind), (dt.block(index), to.block(index)), parts) {
                return index;
            }
        }
        jaws.len()
    }

    /// Strains, or sums of them, from which on a contact pulls or presses.
    #[inline(always)]
    pub(super) fn least(&self, lane: usize) -> f64 {
        if self.hold[lane] > 0.0 { f64::NEG_INFINITY } else { 0.0 }
    }
}

/// Whether there is such a time step.
#[inline(always)]
pub(super) fn is_step(dt: f64) -> bool {
    // A bound that is no infinity: with one the compiler looks at the bits, which takes four times as long.
    (0.0..=f64::MAX).contains(&dt)
}

/// Which contacts are to be stepped alone.
pub(super) type Marks = [bool; LANES];

/// Layers that no body has.
pub(super) const MOST_LAYERS: f64 = 1e50;

/// Positions beyond so many depths of a body are refused: their forces might not be finite.
pub(super) const FARTHEST: f64 = 1e6;

/// The laws of contacts side by side, and their bodies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    pub(super) bodies: Bodies,
    pub(super) power: Power,
    exponent: Lanes,
    rate_coefficient: Lanes,
    /// (n − 1) v; to the bit the product in `LatencyLaw` where it is used, because n − 1 is 1, 2 or 4 there.
    pub(super) rate: Lanes,
    pub(super) thickness: Lanes,
    pub(super) per_thickness: Lanes,
    /// m
    layers: Lanes,
    /// Half of the excess strain that a displacement brings, 1/m.
    pub(super) half_drive: Lanes,
}

/// Contacts after a step.
#[derive(Clone, Copy)]
pub(super) struct Moved {
    pub(super) jaw: Lanes,
    pub(super) behind: Lanes,
    pub(super) force: Lanes,
    /// Whether all were closed all along, at values that can be.
    pub(super) is_right: bool,
    /// Those that were not.
    pub(super) wrong: Marks,
}

impl Block {
    /// Of up to [`LANES`] models; the last of them also in place of those that are not there.
    pub(super) fn new(models: &[ContactModel]) -> Self {
        let of_each = |of: &dyn Fn(&ContactModel) -> f64| -> Lanes {
            std::array::from_fn(|lane| of(&models[lane.min(models.len() - 1)]))
        };
        let exponent = of_each(&|model| model.law.exponent());
        let bodies: Vec<_> = models.iter().map(|model| (&model.specimen, model.separation)).collect();
        let mut bodies = Bodies::new(&bodies);
        for (lane, limit) in bodies.limit.iter_mut().enumerate() {
            let layers = models[lane.min(models.len() - 1)].layers.count();
            *limit = if layers > MOST_LAYERS { f64::NEG_INFINITY } else { *limit };
        }
        Self {
            bodies,
            power: Power::of(&exponent),
            exponent,
            rate_coefficient: of_each(&|model| model.law.rate_coefficient()),
            rate: of_each(&|model| (model.law.exponent() - 1.0) * model.law.rate_coefficient()),
            thickness: of_each(&|model| model.layers.thickness(model.specimen.depth())),
            per_thickness: of_each(&|model| 1.0 / model.layers.thickness(model.specimen.depth())),
            layers: of_each(&|model| model.layers.count()),
            half_drive: of_each(&|model| 0.5 * (model.layers.drive(1.0, 1.0) * (1.0 / model.specimen.depth()))),
        }
    }

    /// Steps blocks one after the other as long as all of their contacts stay in contact and have this power; returns how many.
    ///
    /// Nothing else is in the loop, so that all of it is in registers.
    #[inline(always)]
    pub(super) fn moved_in_row<'a>(
        block: impl Fn(usize) -> &'a Self,
        power: Power,
        (jaws, behinds, forces): (&mut [Lanes], &mut [Lanes], &mut [Lanes]),
        steps: impl Iterator<Item = (Lanes, Lanes)>,
        parts: u32,
    ) -> usize {
        let count = jaws.len();
        for (index, (((jaw, behind), force), step)) in jaws.iter_mut().zip(behinds).zip(forces).zip(steps).enumerate() {
            let block = block(index);
            if block.power != power {
                return index;
            }
            let moved = block.moved(power, (*jaw, *behind), step, parts);
            if !moved.is_right {
                return index;
            }
            (*jaw, *behind, *force) = (moved.jaw, moved.behind, moved.force);
        }
        count
    }

    /// A step in equal parts, in contact all along, in code for vectors; `to` is a displacement of the jaw (m), `power` that of the block.
    #[inline(always)]
    pub(super) fn moved(&self, power: Power, state: (Lanes, Lanes), (dt, to): (Lanes, Lanes), parts: u32) -> Moved {
        let mut target = [0.0; LANES];
        for lane in 0..LANES {
            target[lane] = to[lane] * self.bodies.share[lane];
        }
        if parts == 1 {
            return self.pressed(power, state, dt, target);
        }
        let part_dt = dt.map(|dt| dt / f64::from(parts));
        let mut moved = Moved {
            jaw: state.0,
            behind: state.1,
            force: [0.0; LANES],
            is_right: true,
            wrong: [false; LANES],
        };
        for part in 1..=parts {
            let mut next = [0.0; LANES];
            for lane in 0..LANES {
                next[lane] = between(state.0[lane], target[lane], (part, parts));
            }
            let before = moved;
            moved = self.pressed(power, (before.jaw, before.behind), part_dt, next);
            moved.is_right &= before.is_right;
            for (mark, before) in moved.wrong.iter_mut().zip(before.wrong) {
                *mark |= before;
            }
        }
        moved
    }

    /// A step of contacts of which some are closed all along and some open all along, in equal parts.
    #[inline(always)]
    pub(super) fn moved_or_freed(&self, power: Power, state: (Lanes, Lanes), to: (Lanes, Lanes), parts: u32) -> Moved {
        let mut moved = self.moved(power, state, to, parts);
        if (0..LANES).any(|lane| moved.wrong[lane] && state.0[lane] < state.1[lane]) {
            let freed = self.freed(power, state, to, parts);
            for lane in 0..LANES {
                if moved.wrong[lane] && !freed.wrong[lane] {
                    (moved.jaw[lane], moved.behind[lane], moved.force[lane]) =
                        (freed.jaw[lane], freed.behind[lane], 0.0);
                    moved.wrong[lane] = false;
                }
            }
        }
        moved
    }

    /// As [`moved`](Self::moved) for jaws that are off their bodies all along: the surfaces relax on their own.
    #[inline(always)]
    fn freed(&self, power: Power, (jaw, behind): (Lanes, Lanes), (dt, to): (Lanes, Lanes), parts: u32) -> Moved {
        let bodies = &self.bodies;
        let (mut jaws, mut surfaces, mut wrong) = (jaw, behind, [false; LANES]);
        for part in 1..=parts {
            for lane in 0..LANES {
                let (from, before, depth) = (jaws[lane], surfaces[lane], bodies.depth[lane]);
                let u = between(jaw[lane], to[lane] * bodies.share[lane], (part, parts));
                let time = dt[lane] / f64::from(parts) / self.layers[lane];
                let after = depth * self.relaxed(power, lane, before / depth, time);
                // Where the jaw ends as `ContactState` has it.
                let is_off = (from < before) & (after > from + (u - from)) & (after >= u) & (bodies.hold[lane] == 0.0);
                let is_near = bodies.is_near(lane, from.abs() + before.abs()) & bodies.fits(lane, u);
                wrong[lane] |= !(is_off & is_near & is_step(dt[lane]));
                (jaws[lane], surfaces[lane]) = (u, after);
            }
        }
        Moved {
            jaw: jaws,
            behind: surfaces,
            force: [0.0; LANES],
            is_right: !wrong.contains(&true),
            wrong,
        }
    }

    /// In contact all along, as `ContactState` has it, to contact displacements `to` (m).
    #[inline(always)]
    fn pressed(&self, power: Power, (jaw, behind): (Lanes, Lanes), dt: Lanes, to: Lanes) -> Moved {
        let bodies = &self.bodies;
        let (mut left, mut forces, mut wrong) = ([0.0; LANES], [0.0; LANES], [false; LANES]);
        let mut is_right = true;
        for lane in 0..LANES {
            let (from, held, u) = (jaw[lane], behind[lane], to[lane]);
            let (per_depth, slack) = (bodies.per_depth[lane], bodies.slack[lane]);
            let (thickness, per_thickness) = (self.thickness[lane], self.per_thickness[lane]);
            let kick = (u - from) * self.half_drive[lane];
            let gap = from - held;
            let excess = gap * per_thickness - from * per_depth + kick;
            let square = excess * excess;
            let excess = self.relaxed(power, lane, excess, dt[lane]) + kick;
            let node = u - thickness * (excess + u * per_depth);
            let strain = (u - node) * per_thickness;
            let is_closed = (gap >= slack) & (u - node >= slack);
            // A state beyond all measure has an excess strain beyond it, unless both of its numbers hide that from each other.
            let is_near = (square < FARTHEST * FARTHEST) & bodies.fits(lane, u);
            // The force is finite where all of this is: bodies and layers beyond all measure are stepped alone. At no strain it is 0.
            let is_fine = is_closed & is_near & is_step(dt[lane]);
            left[lane] = node;
            forces[lane] = bodies.modulus[lane] * strain * bodies.area(lane, u).0;
            is_right &= is_fine;
            wrong[lane] = !is_fine;
        }
        Moved {
            jaw: to,
            behind: left,
            force: forces,
            is_right,
            wrong,
        }
    }

    /// Forces (N) and stiffnesses dF/dd (N/m) of states, as `ContactState` has them.
    #[inline(always)]
    pub(super) fn force_and_stiffness(&self, jaw: &Lanes, behind: &Lanes) -> (Lanes, Lanes) {
        let bodies = &self.bodies;
        let (mut forces, mut slopes) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let per_thickness = self.per_thickness[lane];
            let strain = (jaw[lane] - behind[lane]) * per_thickness;
            let (area, growth) = bodies.area(lane, jaw[lane]);
            let growth = if jaw[lane] < 0.0 { 0.0 } else { bodies.modulus[lane] * growth };
            let force = bodies.modulus[lane] * strain * area;
            let slope = bodies.share[lane] * (bodies.modulus[lane] * area * per_thickness + growth * strain);
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
        let (v, rate, a) = (self.rate_coefficient[lane], self.rate[lane], x.abs());
        match power {
            Power::One => x * exp(-(v * dt)),
            Power::Two => x / (1.0 + rate * a * dt),
            Power::Three => x / (1.0 + rate * (a * a) * dt).sqrt(),
            Power::Five => x / (1.0 + rate * ((a * a) * (a * a)) * dt).sqrt().sqrt(),
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
