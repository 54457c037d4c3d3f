//! The closed form for many times at once.
//!
//! A hold has a thousand samples and a fit asks for all of them at every step, so this is the kernel that
//! the speed of identification hangs on. A call of `powf` a sample is slower than NumPy; instead
//!
//! - n = 1, 2, 3, 5 use one exponential, division or root a sample, the fourth root by Newton's method,
//! - any other n uses a branch-free logarithm and exponential.
//!
//! All columns come from one pass, as vector code of whatever the machine has. Values agree with the one-at-a-time
//! functions to a few units in the last place.

use super::LatencyLaw;
use crate::vector::elementary::{Logarithm, exp};
use crate::vector::{fill, first, in_place};

/// (n − 1) λt beyond which the logarithm is taken of this.
const LARGEST: f64 = 1e308;

/// φ(λ tᵢ; n) for every time; arguments as for [`decay`](super::decay), `out` as long as `times`.
///
/// # Panics
/// If the slices differ in length.
pub fn decay_many(times: &[f64], rate: f64, exponent: f64, out: &mut [f64]) {
    decay_columns(times, rate, exponent, [out]);
}

impl LatencyLaw {
    /// Replaces every elapsed time (s) by the excess strain then, as [`excess_after`](Self::excess_after).
    pub(crate) fn relax(&self, initial: f64, elapsed: &mut [f64]) {
        let (rate, exponent) = (self.relative_rate(initial), self.exponent());
        in_place(elapsed, |times, phi| decay_many(times, rate, exponent, phi));
        elapsed.iter_mut().for_each(|phi| *phi *= initial);
    }

    /// Appends the strain rate at every one of the excess strains, as [`rate`](Self::rate).
    pub(crate) fn extend_rates(&self, excess: &[f64], out: &mut Vec<f64>) {
        let v = self.rate_coefficient();
        // The choice of exponent stands outside the loop, so that the common ones run as vector code.
        match self.exponent() {
            1.0 => out.extend(excess.iter().map(|x| -v * x)),
            3.0 => out.extend(excess.iter().map(|x| -v * (x * x * x))),
            5.0 => out.extend(excess.iter().map(|x| -v * ((x * x) * (x * x) * x))),
            _ => out.extend(excess.iter().map(|x| self.rate(*x))),
        }
    }
}

/// The first `N` of φ, ∂φ/∂ln λ and ∂φ/∂n for every time; arguments as for [`decay_many`].
///
/// Only requested outputs are computed.
///
/// # Panics
/// If the slices differ in length, or more than three are given.
pub fn decay_columns<const N: usize>(times: &[f64], rate: f64, exponent: f64, columns: [&mut [f64]; N]) {
    let p = exponent - 1.0;
    let inverse = 1.0 / p;
    // One loop for every kind of root, so that no loop has a branch.
    match exponent {
        1.0 => fill(
            times,
            columns,
            #[inline(always)]
            |t| first(exponential(rate * t)),
        ),
        2.0 => fill_by_root(
            times,
            rate,
            p,
            columns,
            #[inline(always)]
            |w, _| {
                let r = 1.0 / w;
                (r, r)
            },
        ),
        3.0 => fill_by_root(
            times,
            rate,
            p,
            columns,
            #[inline(always)]
            |w, _| {
                let r = 1.0 / w;
                (r.sqrt(), r)
            },
        ),
        5.0 => fill_by_root(
            times,
            rate,
            p,
            columns,
            #[inline(always)]
            |w, _| {
                let y = inverse_fourth_root(w);
                (y, (y * y) * (y * y))
            },
        ),
        _ => fill_by_root(
            times,
            rate,
            p,
            columns,
            #[inline(always)]
            |w, log| (exp(-log.value() * inverse), 1.0 / w),
        ),
    }
}

/// n ≠ 1 with the `root` of [`power`].
#[inline(always)]
fn fill_by_root<const N: usize>(
    times: &[f64],
    rate: f64,
    p: f64,
    columns: [&mut [f64]; N],
    root: impl Fn(f64, Logarithm) -> (f64, f64) + Copy,
) {
    fill(
        times,
        columns,
        #[inline(always)]
        |t| first(power(rate * t, p, root)),
    );
}

/// n = 1: φ = e⁻ˢ, ∂φ/∂ln λ = −s φ, ∂φ/∂n = φ s²/2, grouped so that no product overflows.
#[inline(always)]
fn exponential(s: f64) -> [f64; 3] {
    let phi = exp(-s);
    [phi, -s * phi, 0.5 * (s * phi) * s]
}

/// p = n − 1 ≠ 0, z = p s: φ and 1/(1 + z) = `root`(1 + z, ln(1 + z)), ∂φ/∂ln λ = −s φ/(1 + z), and
/// ∂φ/∂n = φ [ln(1 + z) − z/(1 + z)]/p²; all 0 past the finite end, z ≤ −1.
///
/// Near z = 0 the difference in brackets cancels. With q = z/(2 + z) it is 2 artanh(q) − 2q/(1 + q)
/// = q² [2/(1 + q) + (2 artanh(q) − 2q)/q²], which does not, wherever the logarithm needs no power of two.
#[inline(always)]
fn power(s: f64, p: f64, root: impl Fn(f64, Logarithm) -> (f64, f64)) -> [f64; 3] {
    let z = p * s;
    let z = if z < LARGEST { z } else { LARGEST };
    let log = Logarithm::of_one_plus(z);
    let (phi, r) = root(1.0 + z, log);
    let phi = if z > -1.0 { phi } else { 0.0 };
    let slope = -(s * r) * phi;
    let q = log.quotient / p;
    let near = q * q * ((2.0 + z) * r + log.tail);
    let far = (log.value() - z * r) / p / p;
    let bend = phi * if log.power == 0.0 { near } else { far };
    // φ = 0 only past the finite end or far below the smallest double.
    if phi == 0.0 { [phi, 0.0, 0.0] } else { [phi, slope, bend] }
}

/// w^(−¼) for normal w > 0, to some two units in the last place: half the time of a division and two square roots.
///
/// The bits of w, as a number, are nearly its logarithm; what they give is off by up to 3 %. Each of two rounds takes
/// (1 − e)^(−¼) = 1 + e/4 + 5e²/32 + 15e³/128 + … with e = 1 − w y⁴, to 2·10⁻⁵ and to rounding.
#[inline(always)]
fn inverse_fourth_root(w: f64) -> f64 {
    /// 5/4 of the bits of one, less what makes the largest errors on both sides alike.
    const FIRST: u64 = (1f64.to_bits() / 4) * 5 - LESS;
    const LESS: u64 = 1 << 48;
    let off = |y: f64| {
        let square = y * y;
        1.0 - w * (square * square)
    };
    let closer = |y: f64| {
        let e = off(y);
        y + y * e * (0.25 + e * (0.156_25 + e * 0.117_187_5))
    };
    closer(closer(f64::from_bits(FIRST - (w.to_bits() >> 2))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::latency::decay;
    use crate::vector::tests::on_every_level;

    /// φ, ∂φ/∂ln λ and ∂φ/∂n at s = λt from the standard library; near n = 1 the last is a power series in z = (n − 1) s,
    /// s² φ Σ_{k≥2} (−1)^k (k−1)/k · z^(k−2).
    fn one_at_a_time(s: f64, exponent: f64) -> [f64; 3] {
        let (value, p) = (decay(s, exponent), exponent - 1.0);
        let z = p * s;
        let series = || (2..19).rev().fold(0.0, |sum, k| f64::from(k - 1) / f64::from(k) - z * sum);
        let far = || ((z.ln_1p() - z / (1.0 + z)) / p) / p;
        match value {
            0.0 => [0.0; 3],
            _ => [value, -(s / (1.0 + z)) * value, value * if z.abs() < 0.1 { s * s * series() } else { far() }],
        }
    }

    #[test]
    fn many_at_once_equal_one_at_a_time() {
        let times: Vec<f64> = (0..101).map(|i| 0.3 * f64::from(i)).collect();
        for exponent in [0.4, 0.8, 0.999_999, 1.0, 1.0 + 1e-13, 1.000_001, 1.5, 2.0, 3.0, 4.4, 5.0, 7.0, 30.0] {
            let found = on_every_level(|| {
                let mut out = [vec![0.0; 101], vec![0.0; 101], vec![0.0; 101]];
                decay_columns(&times, 0.7, exponent, out.each_mut().map(Vec::as_mut_slice));
                out.concat()
            });
            for (i, t) in times.iter().enumerate() {
                let [value, by_log_rate, by_exponent] = one_at_a_time(0.7 * t, exponent);
                assert!((found[i] - value).abs() <= 2e-14 * value, "n={exponent} t={t}");
                assert!((found[101 + i] - by_log_rate).abs() <= 4e-14 * by_log_rate.abs());
                assert!((found[202 + i] - by_exponent).abs() <= 1e-12 * by_exponent.abs());
            }
        }
    }

    #[test]
    fn inverse_fourth_roots_match_the_standard_library() {
        for i in 0..200_000 {
            let w = 10f64.powf(f64::from(i) * 1.54e-3);
            let expected = 1.0 / w.sqrt().sqrt();
            let found = inverse_fourth_root(w);
            assert!((found - expected).abs() <= 7e-16 * expected, "{w:e}: {found:e} {expected:e}");
        }
        assert_eq!((inverse_fourth_root(1.0), inverse_fourth_root(16.0)), (1.0, 0.5));
    }

    #[test]
    fn values_alone_and_in_place_are_the_same_numbers() {
        let times: Vec<f64> = (0..600).map(|i| 0.02 * f64::from(i)).collect();
        for exponent in [0.5, 1.0, 2.0, 3.0, 4.33, 5.0] {
            let [mut alone, mut value, mut slope] = [vec![0.0; 600], vec![0.0; 600], vec![0.0; 600]];
            let mut replaced = times.clone();
            decay_many(&times, 0.7, exponent, &mut alone);
            decay_columns(&times, 0.7, exponent, [&mut value, &mut slope]);
            in_place(&mut replaced, |times, phi| decay_many(times, 0.7, exponent, phi));
            assert_eq!((&alone, &alone), (&value, &replaced), "n = {exponent}");
        }
    }
}
