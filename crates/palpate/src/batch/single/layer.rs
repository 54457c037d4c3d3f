//! Contact layers of a group in single precision, through a stretch in which every jaw keeps its speed.
//!
//! Strains are in units of e = u/depth at the largest displacement u of a contact, so that ẋ = g − v sgn(x)|x|ⁿ becomes
//!
//! ż = γ − κ sgn(z)|z|ⁿ,  γ = u̇₁ (m − 1)/u,  κ = v eⁿ⁻¹.
//!
//! What has been summed up is kept in double precision; what a stretch adds is worked out in single precision, to a few 10⁻⁷ of itself.

use super::ramp::{Column, FARTHEST, LANES, Place, gained};
use crate::latency::lanes::{Power, by_power};
use crate::vector::elementary;
use crate::vector::single::{exp, exp_m1, ln, ln_1p};

/// Exponents whose accuracy was measured.
const EXPONENTS: std::ops::RangeInclusive<f64> = 0.5..=8.0;

/// Where numbers of a law and a motion stay far inside the range of single precision.
const LARGEST: f64 = 1e30;

/// Largest logarithm of a steady excess in units of e.
const WIDEST: f32 = 40.0;

/// Excess strains below this move nothing: neither they nor their seventh powers matter beside 1.
const STILL: f32 = 1e-9;

/// The contact layers of a group.
#[derive(Debug)]
pub(super) struct ContactLayers {
    power: Power,
    exponent: Column,
    /// n − 1, which may be small beside n.
    less_one: Column,
    /// κ, 1/s.
    rate: [f64; LANES],
    /// e and z; z is NaN where single precision does not do.
    unit: [f64; LANES],
    excess: [f64; LANES],
}

impl ContactLayers {
    /// Relaxed contacts with these exponents, rate coefficients (1/s) and largest strains u/depth.
    #[inline(always)]
    pub(super) fn new(n: &[f64; LANES], v: &[f64; LANES], largest: &[f64; LANES]) -> Self {
        let (mut unit, mut excess) = ([0.0; LANES], [0.0; LANES]);
        let (mut exponent, mut less_one, mut rate) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            unit[lane] = if largest[lane] > f64::MIN_POSITIVE { largest[lane] } else { f64::MIN_POSITIVE };
            let log_rate = elementary::ln(v[lane]) + (n[lane] - 1.0) * elementary::ln(unit[lane]);
            rate[lane] = elementary::exp(log_rate);
            exponent[lane] = n[lane] as f32;
            less_one[lane] = (n[lane] - 1.0) as f32;
            excess[lane] = if EXPONENTS.contains(&n[lane]) { 0.0 } else { f64::NAN };
        }
        Self {
            power: Power::of(n),
            exponent,
            less_one,
            rate,
            unit,
            excess,
        }
    }

    /// Excess strains, NaN where single precision does not do.
    #[inline(always)]
    pub(super) fn strains(&self) -> [f64; LANES] {
        let mut strains = [0.0; LANES];
        for ((strain, z), unit) in strains.iter_mut().zip(&self.excess).zip(&self.unit) {
            *strain = z * unit;
        }
        strains
    }

    /// Goes on for `elapsed` (s) under the drives g (1/s); lanes with no time to pass stay as they are.
    #[inline(always)]
    pub(super) fn advance(&mut self, drive: &[f64; LANES], elapsed: &[f64; LANES]) {
        let (mut holds, mut moves) = (false, false);
        for lane in 0..LANES {
            holds |= elapsed[lane] > 0.0 && drive[lane] == 0.0;
            moves |= elapsed[lane] > 0.0 && drive[lane] != 0.0;
        }
        let mut gain = [0.0; LANES];
        if moves {
            gain = self.moved(drive, elapsed);
        }
        if holds {
            let held = self.held(elapsed);
            for lane in 0..LANES {
                gain[lane] = if drive[lane] == 0.0 { held[lane] } else { gain[lane] };
            }
        }
        for lane in 0..LANES {
            self.excess[lane] += if elapsed[lane] > 0.0 { gain[lane] } else { 0.0 };
        }
    }

    /// What holds add to z: z expm1(−ln(1 + (n − 1) λt)/(n − 1)) with λ = κ|z|ⁿ⁻¹, equations (4) and (5).
    #[inline(always)]
    fn held(&self, elapsed: &[f64; LANES]) -> [f64; LANES] {
        let (mut relative, mut size) = ([0.0; LANES], [0.0; LANES]);
        let mut gain = [0.0; LANES];
        for lane in 0..LANES {
            let passed = self.rate[lane] * elapsed[lane];
            let passed = if passed > 1.0 / LARGEST { passed } else { 0.0 };
            relative[lane] = if passed < LARGEST { passed as f32 } else { f32::NAN };
            let z = self.excess[lane].abs() as f32;
            size[lane] = if z > STILL { z } else { STILL };
        }
        let mut loss = [0.0; LANES];
        by_power!(self.power, power => for lane in 0..LANES {
            let (p, square) = (self.less_one[lane], size[lane] * size[lane]);
            let s = relative[lane] * match power {
                Power::One => 1.0,
                Power::Two => size[lane],
                Power::Three => square,
                Power::Five => square * square,
                Power::Any => exp(p * ln(size[lane])),
            };
            let beyond = p * s;
            // Past the finite end of n < 1 nothing is left.
            let log = ln_1p(if beyond > -1.0 { beyond } else { 0.0 });
            let log = if beyond.abs() < 1e-30 { s } else { log / p };
            loss[lane] = if beyond > -1.0 { exp_m1(-log) } else { -1.0 };
            loss[lane] = if s >= 0.0 { loss[lane] } else { f32::NAN };
        });
        for lane in 0..LANES {
            gain[lane] = self.excess[lane] * f64::from(loss[lane]);
        }
        gain
    }

    /// What ramps add to z.
    #[inline(always)]
    fn moved(&self, drive: &[f64; LANES], elapsed: &[f64; LANES]) -> [f64; LANES] {
        let mut place = Place {
            excess: [0.0; LANES],
            distance: [1.0; LANES],
        };
        let (mut steady, mut time, mut gain) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let moves = (elapsed[lane] > 0.0) & (drive[lane] != 0.0);
            // γ in 1/s; a lane that does not move takes numbers that do no harm.
            let speed = if moves { drive[lane] / self.unit[lane] } else { self.rate[lane] };
            let ratio = speed.abs() / self.rate[lane];
            let fits = (ratio > 1.0 / LARGEST) & (ratio < LARGEST) & (self.rate[lane] < LARGEST);
            let log = ln(if fits { ratio as f32 } else { 1.0 }) / self.exponent[lane];
            let fits = fits & (log.abs() < WIDEST);
            let size = exp(log);
            steady[lane] = f64::from(if speed < 0.0 { -size } else { size });
            let z = self.excess[lane] / steady[lane];
            let passes = speed / steady[lane] * elapsed[lane];
            let passes = if passes < LARGEST { passes } else { LARGEST };
            time[lane] = if moves { passes as f32 } else { 0.0 };
            let distance = 1.0 - z;
            let z = if z.abs() < 1e-30 { 0.0 } else { z as f32 };
            let fits = fits & (z.abs() < FARTHEST);
            place.excess[lane] = if fits { z } else { 0.0 };
            place.distance[lane] = if fits { distance as f32 } else { 1.0 };
            steady[lane] = if fits { steady[lane] } else { f64::NAN };
        }
        let gained = gained(self.power, &self.exponent, place, time);
        for lane in 0..LANES {
            gain[lane] = steady[lane] * f64::from(gained[lane]);
        }
        gain
    }
}
