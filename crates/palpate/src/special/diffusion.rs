//! Exchange of a sheet with both faces by diffusion.
//!
//! Crank, *The Mathematics of Diffusion* (1975), equations (4.18) and (4.20): what is left to exchange at time t.

use std::f64::consts::PI;

use crate::vector::elementary::exp;

/// Below this the faces do not feel each other: what the images add is below 2e-16 of the slope.
const FACES_APART_BELOW: f64 = 1.0 / 15.0;

/// φ = (8/π²) Σ exp(−k² s)/k² over odd k, and ∂φ/∂ln s; `s` = λt ≥ 0 with λ = π² D/L² (dimensionless).
///
/// φ falls from 1, at first as 1 − 4 √(s/π³). Relative error below 1e-14 in φ and in the derivative; at s = 1
/// φ = 0.298 203. Both are 0 from s = 700 on.
///
/// ```
/// use palpate::special::diffusion_decay;
/// assert!((diffusion_decay(1.0).0 - 0.298_203).abs() < 1e-6);
/// ```
#[must_use]
#[inline]
pub fn diffusion_decay(s: f64) -> (f64, f64) {
    if s < FACES_APART_BELOW {
        let lost = 4.0 * (s / (PI * PI * PI)).sqrt();
        return (1.0 - lost, -0.5 * lost);
    }
    // Terms k = 1, 3, 5, …: exp(−(k+2)² s) is exp(−k² s) times a step that shrinks by exp(−8s) a time.
    let mut term = exp(-s);
    let shrink = exp(-8.0 * s);
    let mut step = shrink;
    let (mut value, mut slope, mut k) = (0.0, 0.0, 1.0);
    loop {
        value += term / (k * k);
        slope += term;
        term *= step;
        step *= shrink;
        k += 2.0;
        // Of a time that is none, too.
        if term <= 1e-17 * slope || term.is_nan() {
            break;
        }
    }
    (8.0 / (PI * PI) * value, -8.0 / (PI * PI) * s * slope)
}

/// φ and ∂φ/∂ln λ at s = λtᵢ for every time; arguments as for [`diffusion_decay`].
///
/// # Panics
/// If the slices differ in length.
pub(crate) fn diffusion_decay_many(times: &[f64], rate: f64, value: &mut [f64], by_log_rate: &mut [f64]) {
    assert_eq!(times.len(), value.len(), "one output a time");
    assert_eq!(times.len(), by_log_rate.len(), "one output a time");
    for ((t, value), by_log_rate) in times.iter().zip(value).zip(by_log_rate) {
        (*value, *by_log_rate) = diffusion_decay(rate * t);
    }
}
