//! The contact layers of a group of contacts, through a stretch in which every jaw keeps its speed.
//!
//! The equations and variables are those of `crate::contact`: closed form in a hold, y = −ln|1 − x/x*| in a ramp, the law expanded to second
//! order once x* is near. Here lanes go side by side: each has its own exponent, rate coefficient, drive, duration and steps.

use fearless_simd::Simd;

use crate::contact::{is_kinked, longest_step, rest_of};
use crate::latency::lanes::{BLOCK, Power, attraction, block, by_power, each, relaxed, steady_excess};
use crate::ode::Lanes;
use crate::vector::elementary::{exp, exp_m1, ln_1p};

/// Contacts that go through a kernel together: enough vectors in flight that none waits for the other.
pub(super) const GROUP: usize = 32;

/// Distance from the steady state, times n, below which the law expanded to second order is exact to rounding.
const NEAR: f64 = 3e-4;

/// Tolerance of a step, relative to what the excess passes through.
const TOLERANCE: f64 = 1e-12;

/// The laws of a group.
#[derive(Debug, Clone)]
pub(super) struct Laws {
    pub(super) power: Power,
    pub(super) exponent: [f64; GROUP],
    pub(super) rate_coefficient: [f64; GROUP],
}

/// A solver for the ramps of a group, kept from stretch to stretch.
#[derive(Debug)]
pub(super) struct ContactLayers {
    pub(super) excess: [f64; GROUP],
    ramps: Lanes<GROUP>,
}

impl ContactLayers {
    /// Relaxed contacts.
    pub(super) fn new() -> Self {
        Self {
            excess: [0.0; GROUP],
            ramps: Lanes::new(1),
        }
    }

    /// Goes on for `elapsed` (s) under the drives g (1/s); lanes with no time to pass stay as they are.
    #[inline(always)]
    pub(super) fn advance<S: Simd>(&mut self, simd: S, laws: &Laws, drive: &[f64; GROUP], elapsed: &[f64; GROUP]) {
        let before = self.excess;
        let (mut holds, mut moves) = (false, false);
        for lane in 0..GROUP {
            holds |= elapsed[lane] > 0.0 && drive[lane] == 0.0;
            moves |= elapsed[lane] > 0.0 && drive[lane] != 0.0;
        }
        if holds {
            let mut held = [0.0; GROUP];
            by_power!(laws.power, power => for lane in 0..GROUP {
                held[lane] = relaxed(power, before[lane], laws.exponent[lane], laws.rate_coefficient[lane], elapsed[lane]);
            });
            for lane in 0..GROUP {
                let is_held = elapsed[lane] > 0.0 && drive[lane] == 0.0;
                self.excess[lane] = if is_held { held[lane] } else { before[lane] };
            }
        }
        if moves {
            let mut active = [0.0; GROUP];
            for lane in 0..GROUP {
                active[lane] = if drive[lane] == 0.0 { 0.0 } else { elapsed[lane] };
            }
            let moved = self.ramped(simd, laws, &before, drive, &active);
            for lane in 0..GROUP {
                self.excess[lane] = if active[lane] > 0.0 { moved[lane] } else { self.excess[lane] };
            }
        }
    }

    /// The excess strains at the end of ramps; of no meaning in lanes with no time to pass.
    #[inline(always)]
    fn ramped<S: Simd>(
        &mut self,
        simd: S,
        laws: &Laws,
        initial: &[f64; GROUP],
        drive: &[f64; GROUP],
        elapsed: &[f64; GROUP],
    ) -> [f64; GROUP] {
        let n = &laws.exponent;
        let (mut steady, mut side, mut until) = ([1.0; GROUP], [1.0; GROUP], [0.0; GROUP]);
        let (mut reach, mut far, mut start) = ([1.0; GROUP], [0.0; GROUP], [0.0; GROUP]);
        for lane in 0..GROUP {
            let moves = elapsed[lane] > 0.0;
            let g = if moves { drive[lane] } else { laws.rate_coefficient[lane] };
            steady[lane] = steady_excess(g, n[lane], laws.rate_coefficient[lane]);
            let z = if moves { initial[lane] / steady[lane] } else { 0.0 };
            side[lane] = if z > 1.0 { -1.0 } else { 1.0 };
            until[lane] = g / steady[lane] * elapsed[lane];
            let passes = if z.abs() > until[lane] { z.abs() } else { until[lane] };
            reach[lane] = if passes < 1.0 { passes } else { 1.0 };
            // z may be far below 1, where 1 − z would lose it.
            let beyond = if z > 1.0 { z - 2.0 } else { -z };
            let y = -ln_1p(if z == 1.0 { 0.0 } else { beyond });
            let least = if n[lane] > 1.0 { n[lane] } else { 1.0 };
            far[lane] = ln_1p(least / NEAR - 1.0);
            // A ramp that begins at its steady state has come near it as far as a double can tell.
            start[lane] = if z == 1.0 { 700.0 } else { y };
        }
        self.ramps.state.copy_from_slice(&start);
        let mut slope = [0.0; GROUP];
        slopes(laws, &side, &start, &mut slope);
        let mut width = [0.0; GROUP];
        for lane in 0..GROUP {
            let first = 0.5 / slope[lane];
            width[lane] = if first < until[lane] { first } else { until[lane] };
        }
        self.ramps.restart(width);
        // Where the power is not smooth at rest, steps shrink towards it and grow away from it.
        let (mut passes, mut rest, mut any_passes) = ([false; GROUP], [0.0; GROUP], false);
        for lane in 0..GROUP {
            let z = -exp_m1(-start[lane]);
            passes[lane] = side[lane] > 0.0 && is_kinked(n[lane], z) && elapsed[lane] > 0.0;
            any_passes |= passes[lane];
        }
        if any_passes {
            for lane in 0..GROUP {
                rest[lane] = rest_of(n[lane], reach[lane]);
            }
        }
        loop {
            let (mut going, mut target) = (false, until);
            if any_passes {
                slopes(laws, &side, &self.ramps.state, &mut slope);
            }
            for lane in 0..GROUP {
                let y = self.ramps.state[lane];
                // An error of y matters as far as it moves x = x* (1 ∓ e^(−y)).
                let ease = exp(y);
                let ease = if ease < 1.0 { 1.0 } else { ease };
                self.ramps.tolerance[lane] = TOLERANCE * reach[lane] * if ease > 1e9 { 1e9 } else { ease };
                let time = self.ramps.time[lane];
                target[lane] = if y < far[lane] { until[lane] } else { time };
                if passes[lane] {
                    let longest = time + longest_step(-exp_m1(-y), slope[lane], rest[lane]);
                    target[lane] = if longest < target[lane] { longest } else { target[lane] };
                }
                going |= self.ramps.time[lane] < target[lane];
            }
            if !going {
                break;
            }
            self.ramps.step(
                simd,
                &target,
                #[inline(always)]
                |_, y, out| slopes(laws, &side, y, out),
            );
        }
        let mut excess = [0.0; GROUP];
        for lane in 0..GROUP {
            let y = self.ramps.state[lane];
            let close = -side[lane] * exp(-y);
            let left = until[lane] - self.ramps.time[lane];
            let lost = exp_m1(-n[lane] * left);
            let deviation = close * (1.0 + lost) / (1.0 - 0.5 * (n[lane] - 1.0) * close * lost);
            let path = if side[lane] > 0.0 { -exp_m1(-y) } else { 1.0 + close };
            excess[lane] = steady[lane] * if left > 0.0 { 1.0 + deviation } else { path };
        }
        excess
    }
}

/// ẏ in units of g/x*.
#[inline(always)]
fn slopes(laws: &Laws, side: &[f64; GROUP], y: &[f64], out: &mut [f64]) {
    by_power!(laws.power, power => for at in (0..GROUP).step_by(BLOCK) {
        let (y, side, n) = (block(y, at), block(side, at), block(&laws.exponent, at));
        let slopes = each(
            #[inline(always)]
            |lane| {
                let distance = side[lane] * exp(-y[lane]);
                // Powers that are not whole tell z far below 1 from 0.
                let z = if power == Power::Any && side[lane] > 0.0 { -exp_m1(-y[lane]) } else { 1.0 - distance };
                attraction(power, z, distance, n[lane])
            },
        );
        out[at..at + BLOCK].copy_from_slice(&slopes);
    });
}
