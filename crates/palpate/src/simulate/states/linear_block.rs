//! Contacts of linear laws that stay in contact, side by side in vectors.

use smallvec::SmallVec;

use super::block::{Bodies, Marks};
use super::lanes::Lanes;
use crate::simulate::Memory;
use crate::simulate::linear::LinearStepper;
use crate::vector::LANES;
use crate::vector::elementary::exp_m1;

/// Contacts side by side.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LinearBlock {
    pub(super) bodies: Bodies,
    /// Whether q is the equilibrium force.
    pub(super) is_of_force: [bool; LANES],
    /// g and λ of each term; 0 and 1 where a law has fewer.
    terms: Vec<(Lanes, Lanes)>,
}

impl LinearBlock {
    pub(super) fn new(contacts: &[LinearStepper], terms: usize) -> Self {
        let at = |lane: usize| contacts[lane.min(contacts.len() - 1)].contact();
        let bodies: Vec<_> = contacts.iter().map(|of| (&of.contact().specimen, of.contact().separation)).collect();
        let term = |k: usize| {
            let of = |lane: usize| at(lane).law.terms().get(k).map_or((0.0, 1.0), |term| (term.overshoot, term.rate));
            (std::array::from_fn(|lane| of(lane).0), std::array::from_fn(|lane| of(lane).1))
        };
        Self {
            bodies: Bodies::new(&bodies),
            is_of_force: std::array::from_fn(|lane| at(lane).memory == Memory::Force),
            terms: (0..terms).map(term).collect(),
        }
    }

    /// How memories fade over time steps.
    #[inline(always)]
    pub(super) fn fadings(&self, dt: &Lanes, fadings: &mut Fadings) {
        fadings.clear();
        for (overshoot, rate) in &self.terms {
            let (mut kept, mut gained) = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                let z = rate[lane] * dt[lane];
                let change = exp_m1(-z);
                kept[lane] = 1.0 + change;
                gained[lane] = if z > 0.0 { -overshoot[lane] * change / z } else { overshoot[lane] };
            }
            fadings.push((kept, gained));
        }
    }
}

/// What memories keep, and what they gain of a change of q, term by term.
pub(super) type Fadings = SmallVec<[(Lanes, Lanes); 8]>;

/// Contacts in the middle of a step.
pub(super) struct Moving<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) is_of_force: &'a [bool; LANES],
    pub(super) jaw: Lanes,
    pub(super) force: Lanes,
    /// Those that were not closed all along, at values that can be.
    pub(super) wrong: Marks,
}

impl Moving<'_> {
    /// q + Σ x_k with the memories in lanes, and S, the force per sum.
    #[inline(always)]
    fn value(&self, lane: usize, u: f64) -> (f64, f64) {
        let even = u * self.bodies.per_depth[lane];
        let stiffness = self.bodies.modulus[lane] * self.bodies.area(lane, u).0;
        // Beyond first touch a body whose contact grows has no force to remember: it is stepped alone.
        match self.is_of_force[lane] {
            true => (stiffness * even, 1.0),
            false => (even, stiffness),
        }
    }

    /// To contact displacements `to` (m), in contact all along.
    #[inline(always)]
    pub(super) fn press(&mut self, memory: &mut [Lanes], fadings: &[(Lanes, Lanes)], to: &Lanes) {
        let (mut sums, mut changes, mut scales) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let mut before = [0.0; LANES];
        for lane in 0..LANES {
            let (from, (value, scale)) = (self.value(lane, self.jaw[lane]).0, self.value(lane, to[lane]));
            (before[lane], sums[lane], changes[lane], scales[lane]) = (from, value, value - from, scale);
        }
        for (x, (kept, gained)) in memory.iter_mut().zip(fadings) {
            for lane in 0..LANES {
                before[lane] += x[lane];
                x[lane] = kept[lane] * x[lane] + gained[lane] * changes[lane];
                sums[lane] += x[lane];
            }
        }
        for lane in 0..LANES {
            let (bodies, u, from) = (self.bodies, to[lane], self.jaw[lane]);
            let (force, hold) = (scales[lane] * sums[lane], bodies.hold[lane]);
            let is_closed = (before[lane] + hold >= 0.0) & (sums[lane] + hold >= 0.0);
            // Beyond first touch a body whose contact grows has no force to remember.
            let lowest = if u < from { u } else { from };
            let can_be = !self.is_of_force[lane] | (bodies.section[lane] > 0.0) | (lowest >= 0.0);
            let is_near = bodies.is_near(lane, from.abs()) & bodies.fits(lane, u);
            let is_right = is_closed & can_be & is_near & (force.abs() < f64::INFINITY);
            self.force[lane] = if sums[lane] > bodies.least(lane) { force } else { 0.0 };
            self.wrong[lane] |= !is_right;
        }
        self.jaw = *to;
    }
}
