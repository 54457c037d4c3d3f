//! The contact layers of a group of contacts, through a stretch in which every jaw keeps its speed.
//!
//! The equations and variables are those of `crate::contact`: closed form in a hold, z = x/x* in a ramp, the law expanded to second order once
//! x* is near. Here lanes go side by side: each has its own exponent, rate coefficient, drive, duration and steps.

use fearless_simd::Simd;

use crate::contact::{is_kinked, longest_step, rest_of};
use crate::latency::lanes::{BLOCK, Power, block, by_power, each, relaxed, signed_power, steady_excess};
use crate::ode::Lanes;
use crate::vector::elementary::exp_m1;

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
        let (mut steady, mut until, mut reach) = ([1.0; GROUP], [0.0; GROUP], [1.0; GROUP]);
        let (mut near, mut start) = ([0.0; GROUP], [0.0; GROUP]);
        for lane in 0..GROUP {
            let moves = elapsed[lane] > 0.0;
            let g = if moves { drive[lane] } else { laws.rate_coefficient[lane] };
            steady[lane] = steady_excess(g, n[lane], laws.rate_coefficient[lane]);
            start[lane] = if moves { initial[lane] / steady[lane] } else { 0.0 };
            until[lane] = g / steady[lane] * elapsed[lane];
            let z = start[lane].abs();
            let passes = if z > until[lane] { z } else { until[lane] };
            reach[lane] = if passes < 1.0 { passes } else { 1.0 };
            near[lane] = NEAR / if n[lane] > 1.0 { n[lane] } else { 1.0 };
            // The law itself where it is no more than of second order.
            near[lane] = if n[lane] == 1.0 { f64::INFINITY } else { near[lane] };
        }
        self.ramps.state.copy_from_slice(&start);
        let mut speed = [0.0; GROUP];
        speeds(laws, &start, &mut speed);
        let mut width = [0.0; GROUP];
        for lane in 0..GROUP {
            let first = 0.5 * ((1.0 - start[lane]) / speed[lane]);
            width[lane] = if first < until[lane] { first } else { until[lane] };
        }
        self.ramps.restart(width);
        // Where the power is not smooth at rest, steps shrink towards it and grow away from it.
        let (mut passes, mut rest, mut any_passes) = ([false; GROUP], [0.0; GROUP], false);
        for lane in 0..GROUP {
            passes[lane] = start[lane] <= 1.0 && is_kinked(n[lane], start[lane]) && elapsed[lane] > 0.0;
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
                speeds(laws, &self.ramps.state, &mut speed);
            }
            for lane in 0..GROUP {
                let z = self.ramps.state[lane];
                let distance = (1.0 - z).abs();
                self.ramps.tolerance[lane] = TOLERANCE * reach[lane] * if distance > 1.0 { distance } else { 1.0 };
                let time = self.ramps.time[lane];
                let is_far = (distance > near[lane]) & !((n[lane] == 2.0) & (z >= 0.0));
                target[lane] = if is_far { until[lane] } else { time };
                if passes[lane] {
                    let longest = time + longest_step(z, speed[lane], rest[lane], time);
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
                |_, z, out| speeds(laws, z, out),
            );
        }
        let mut excess = [0.0; GROUP];
        for lane in 0..GROUP {
            let z = self.ramps.state[lane];
            let left = until[lane] - self.ramps.time[lane];
            let left = if left > 0.0 { left } else { 0.0 };
            let (deviation, change) = (z - 1.0, exp_m1(-n[lane] * left));
            let bend = 0.5 * (n[lane] - 1.0) * deviation;
            let slower = 1.0 - bend * change;
            let small = z + deviation * (1.0 + bend) * change / slower;
            let large = 1.0 + deviation * (1.0 + change) / slower;
            let moved = if z.abs() < 0.5 { small } else { large };
            excess[lane] = steady[lane] * if left > 0.0 { moved } else { z };
        }
        excess
    }
}

/// ż in units of g/x*.
#[inline(always)]
fn speeds(laws: &Laws, z: &[f64], out: &mut [f64]) {
    by_power!(laws.power, power => for at in (0..GROUP).step_by(BLOCK) {
        let (z, n) = (block(z, at), block(&laws.exponent, at));
        let speeds = each(
            #[inline(always)]
            |lane| 1.0 - signed_power(power, z[lane], n[lane], 0.0),
        );
        out[at..at + BLOCK].copy_from_slice(&speeds);
    });
}
