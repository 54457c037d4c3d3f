//! Shapes of time with their derivatives, all columns in one pass.
//!
//! Times t ≥ 0 and rates λ > 0 in each other's units. Derivatives are taken by ln λ, the number that fits search in.
//! The first `N` of the columns are filled; what is not requested is not computed.
//!
//! # Panics
//! All panic if the slices differ in length.

use super::elementary::{exp, ln, ln_1p};
use super::{fill, first};

/// φ = exp(−λ t) and ∂φ/∂ln λ = −λ t φ.
pub(crate) fn exponential_columns<const N: usize>(times: &[f64], rate: f64, columns: [&mut [f64]; N]) {
    fill(
        times,
        columns,
        #[inline(always)]
        |t| {
            let s = rate * t;
            let phi = exp(-s);
            first([phi, -s * phi])
        },
    );
}

/// The stretched exponential of Kohlrausch, Williams and Watts, φ = exp(−(λ t)^β), β > 0.
///
/// With s = λ t, u = s^β:  ∂φ/∂ln λ = −β u φ  and  ∂φ/∂β = −u ln(s) φ, both 0 at t = 0.
pub(crate) fn stretched_columns<const N: usize>(times: &[f64], rate: f64, exponent: f64, columns: [&mut [f64]; N]) {
    fill(
        times,
        columns,
        #[inline(always)]
        |t| first(stretched(rate * t, exponent)),
    );
}

#[inline(always)]
fn stretched(s: f64, exponent: f64) -> [f64; 3] {
    // The logarithm takes normal numbers only; what it says at s = 0 is not used.
    let log = ln(if s > f64::MIN_POSITIVE { s } else { f64::MIN_POSITIVE });
    let u = exp(exponent * log);
    let u = if s > 0.0 { u } else { 0.0 };
    let phi = exp(-u);
    let slope = u * phi;
    [phi, -exponent * slope, -log * slope]
}

/// ln(1 + λ t) and its derivative by ln λ, λ t/(1 + λ t).
pub(crate) fn logarithm_columns<const N: usize>(times: &[f64], rate: f64, columns: [&mut [f64]; N]) {
    fill(
        times,
        columns,
        #[inline(always)]
        |t| {
            let s = rate * t;
            first([ln_1p(s), s / (1.0 + s)])
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::tests::{assert_close, on_every_level};

    /// Of the times one in so many: an interpreter that looks for undefined behaviour needs no more.
    const STEP: usize = if cfg!(miri) { 12 } else { 1 };

    /// Zero, then four numbers a decade, from where nothing has happened to where nothing is left.
    fn times() -> Vec<f64> {
        let decades = (-48..=24).step_by(STEP).map(|i| 10f64.powf(f64::from(i) / 4.0));
        std::iter::once(0.0).chain(decades).collect()
    }

    /// Runs a kernel with `N` outputs on every instruction set; one vector an output.
    fn columns<const N: usize>(kernel: impl Fn([&mut [f64]; N])) -> Vec<Vec<f64>> {
        let count = times().len();
        let all = on_every_level(|| {
            let mut outputs = vec![f64::NAN; N * count];
            let mut rows = outputs.chunks_exact_mut(count);
            kernel(std::array::from_fn(|_| rows.next().unwrap()));
            outputs
        });
        all.chunks_exact(count).map(<[f64]>::to_vec).collect()
    }

    #[test]
    fn exponential_and_its_slope() {
        let found = columns::<2>(|all| exponential_columns(&times(), 0.7, all));
        let values = columns::<1>(|all| exponential_columns(&times(), 0.7, all));
        assert_eq!(found[0], values[0]);
        assert_eq!((found[0][0], found[1][0]), (1.0, 0.0));
        for (i, s) in times().iter().map(|t| 0.7 * t).enumerate() {
            let expected = if s > 708.0 { 0.0 } else { (-s).exp() };
            assert_close(found[0][i], expected, 4e-16, "φ");
            assert_close(found[1][i], -s * expected, 6e-16, "∂φ/∂ln λ");
        }
    }

    #[test]
    fn stretched_exponential_and_its_slopes() {
        for exponent in [0.05, 0.3, 0.5, 1.0, 1.7, 2.0] {
            let found = columns::<3>(|all| stretched_columns(&times(), 0.7, exponent, all));
            let values = columns::<1>(|all| stretched_columns(&times(), 0.7, exponent, all));
            assert_eq!(found[0], values[0]);
            assert_eq!([found[0][0], found[1][0], found[2][0]], [1.0, 0.0, 0.0]);
            for (i, s) in times().iter().map(|t| 0.7 * t).enumerate().skip(1) {
                let u = s.powf(exponent);
                let phi = if u > 708.0 { 0.0 } else { (-u).exp() };
                // The error of an exponent is one of its power, so that both logarithms multiply the last digit.
                let tolerance = 5e-16 * (2.0 + (u + 1.0) * (exponent * s.ln()).abs());
                assert_close(found[0][i], phi, tolerance.min(5e-16 * (2.0 + u * (2.0 + u.ln().abs()))), "φ");
                assert_close(found[1][i], -exponent * u * phi, tolerance, "∂φ/∂ln λ");
                assert_close(found[2][i], -u * s.ln() * phi, tolerance, "∂φ/∂β");
            }
        }
    }

    /// β = 1 is the exponential.
    #[test]
    fn stretched_exponential_ends_in_the_exponential() {
        let found = columns::<3>(|all| stretched_columns(&times(), 2.0, 1.0, all));
        let expected = columns::<2>(|all| exponential_columns(&times(), 2.0, all));
        for (i, t) in times().iter().enumerate() {
            let tolerance = 1e-15 * (1.0 + t * (1.0 + (2.0 * t.max(1e-300)).ln().abs()) + 30.0);
            assert_close(found[0][i], expected[0][i], tolerance, "φ");
            assert_close(found[1][i], expected[1][i], tolerance, "∂φ/∂ln λ");
        }
    }

    #[test]
    fn logarithm_and_its_slope() {
        let found = columns::<2>(|all| logarithm_columns(&times(), 3.0, all));
        let values = columns::<1>(|all| logarithm_columns(&times(), 3.0, all));
        assert_eq!(found[0], values[0]);
        assert_eq!((found[0][0], found[1][0]), (0.0, 0.0));
        for (i, s) in times().iter().map(|t| 3.0 * t).enumerate() {
            assert_close(found[0][i], s.ln_1p(), 4e-16, "ln(1 + λt)");
            assert_close(found[1][i], s / (1.0 + s), 4e-16, "∂/∂ln λ");
        }
    }

    #[test]
    fn slopes_are_difference_quotients() {
        const STEP: f64 = 1e-5;
        let times: Vec<f64> = (1..40).map(|i| 0.25 * f64::from(i)).collect();
        let stretched_at = |log_rate: f64, exponent: f64| {
            let mut value = vec![0.0; times.len()];
            stretched_columns(&times, log_rate.exp(), exponent, [&mut value]);
            value
        };
        let [mut phi, mut by_log_rate, mut by_exponent] = [vec![0.0; 39], vec![0.0; 39], vec![0.0; 39]];
        stretched_columns(&times, (-1.0f64).exp(), 0.6, [&mut phi, &mut by_log_rate, &mut by_exponent]);
        let by_rate = (stretched_at(-1.0 + STEP, 0.6), stretched_at(-1.0 - STEP, 0.6), by_log_rate);
        let by_power = (stretched_at(-1.0, 0.6 + STEP), stretched_at(-1.0, 0.6 - STEP), by_exponent);
        for (above, below, slope) in [by_rate, by_power] {
            for i in 0..times.len() {
                assert!(((above[i] - below[i]) / (2.0 * STEP) - slope[i]).abs() < 1e-9);
            }
        }
    }
}
