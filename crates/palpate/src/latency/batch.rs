//! The closed form for many times at once.
//!
//! A hold has a thousand samples and a fit asks for all of them at every step, so this is the kernel that
//! the speed of identification hangs on. A call of `powf` a sample is slower than NumPy; instead
//!
//! - n = 1, 2, 3, 5 use one exponential, division or root a sample,
//! - any other n uses branch-free logarithm and exponential that the compiler turns into vector code.
//!
//! Both agree with the one-at-a-time functions to a few units in the last place.

use super::decay::{SERIES_BELOW, decay, exponent_series};
use crate::special::elementary::{exp, ln_1p, map};

/// Below this |n − 1| the exponential replaces the power: they differ by less than 1e-13 wherever φ is not zero.
const EXPONENTIAL_WITHIN: f64 = 1e-16;

/// φ(λ tᵢ; n) for every time; arguments as for [`decay`], `out` as long as `times`.
///
/// # Panics
/// If the slices differ in length.
pub fn decay_many(times: &[f64], rate: f64, exponent: f64, out: &mut [f64]) {
    out.copy_from_slice(times);
    decay_in_place(out, rate, exponent);
}

/// Replaces every time by φ(λ t; n).
pub(crate) fn decay_in_place(times: &mut [f64], rate: f64, exponent: f64) {
    let p = exponent - 1.0;
    if p.abs() <= EXPONENTIAL_WITHIN {
        map(times, |t| exp(-rate * t));
    } else if exponent == 2.0 {
        map(times, |t| 1.0 / (1.0 + rate * t));
    } else if exponent == 3.0 {
        map(times, |t| (1.0 / (1.0 + 2.0 * (rate * t))).sqrt());
    } else if exponent == 5.0 {
        map(times, |t| (1.0 / (1.0 + 4.0 * (rate * t))).sqrt().sqrt());
    } else if p > 0.0 {
        let inverse = 1.0 / p;
        map(times, |t| exp(-ln_1p(p * rate * t) * inverse));
    } else {
        map(times, |t| decay(rate * t, exponent));
    }
}

/// φ, ∂φ/∂ln λ and ∂φ/∂n for every time; arguments as for [`decay_many`].
///
/// # Panics
/// If the slices differ in length.
pub fn decay_with_gradient_many(
    times: &[f64],
    rate: f64,
    exponent: f64,
    value: &mut [f64],
    by_log_rate: &mut [f64],
    by_exponent: &mut [f64],
) {
    decay_with_log_rate_many(times, rate, exponent, value, by_log_rate);
    assert_eq!(times.len(), by_exponent.len(), "one output a time");
    let p = exponent - 1.0;
    for ((&t, &phi), out) in times.iter().zip(value.iter()).zip(by_exponent.iter_mut()) {
        let s = rate * t;
        let z = p * s;
        *out = if phi == 0.0 {
            0.0
        } else if z.abs() < SERIES_BELOW {
            phi * s * s * exponent_series(z)
        } else {
            phi * ((ln_1p_any(z) - z / (1.0 + z)) / p) / p
        };
    }
}

/// φ and ∂φ/∂ln λ for every time.
///
/// # Panics
/// If the slices differ in length.
pub fn decay_with_log_rate_many(times: &[f64], rate: f64, exponent: f64, value: &mut [f64], by_log_rate: &mut [f64]) {
    assert_eq!(times.len(), value.len(), "one output a time");
    assert_eq!(times.len(), by_log_rate.len(), "one output a time");
    match exponent {
        2.0 => by_root(times, rate, 1.0, value, by_log_rate, |r| r),
        3.0 => by_root(times, rate, 2.0, value, by_log_rate, f64::sqrt),
        5.0 => by_root(times, rate, 4.0, value, by_log_rate, |r| r.sqrt().sqrt()),
        _ => {
            decay_many(times, rate, exponent, value);
            let p = exponent - 1.0;
            for ((&t, &phi), slope) in times.iter().zip(value.iter()).zip(by_log_rate.iter_mut()) {
                let s = rate * t;
                // φ = 0 only past the finite end (n < 1) or far below the smallest double.
                *slope = if phi == 0.0 { 0.0 } else { -s * phi / (1.0 + p * s) };
            }
        }
    }
}

/// φ = root(r) and ∂φ/∂ln λ = −s φ r, both from the one division r = 1/(1 + p s).
#[inline(always)]
fn by_root(times: &[f64], rate: f64, p: f64, value: &mut [f64], by_log_rate: &mut [f64], root: impl Fn(f64) -> f64) {
    for ((&t, phi), slope) in times.iter().zip(value.iter_mut()).zip(by_log_rate.iter_mut()) {
        let s = rate * t;
        let r = 1.0 / (1.0 + p * s);
        *phi = root(r);
        *slope = -s * *phi * r;
    }
}

/// ln(1 + z) for any z > −1.
fn ln_1p_any(z: f64) -> f64 {
    if z >= 0.0 { ln_1p(z) } else { z.ln_1p() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::latency::decay_with_gradient;

    #[test]
    fn many_at_once_equal_one_at_a_time() {
        let times: Vec<f64> = (0..101).map(|i| 0.3 * f64::from(i)).collect();
        let mut out = [vec![0.0; 101], vec![0.0; 101], vec![0.0; 101]];
        for exponent in [0.4, 0.999_999, 1.0, 1.0 + 1e-13, 1.000_001, 1.5, 2.0, 3.0, 4.4, 5.0, 7.0, 30.0] {
            let [value, by_rate, by_exponent] = &mut out;
            decay_with_gradient_many(&times, 0.7, exponent, value, by_rate, by_exponent);
            for (i, t) in times.iter().enumerate() {
                let one = decay_with_gradient(0.7 * t, exponent);
                assert!((value[i] - one.value).abs() <= 2e-14 * one.value, "n={exponent} t={t}");
                assert!((by_rate[i] - one.by_log_rate).abs() <= 4e-14 * one.by_log_rate.abs());
                assert!((by_exponent[i] - one.by_exponent).abs() <= 1e-12 * one.by_exponent.abs());
            }
        }
    }
}
