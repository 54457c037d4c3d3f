//! Noise whose size changes along a hold: with the signal, as that of many sensors does, or with time.

use std::borrow::Cow;

use super::autoregression::innovations;
use crate::statistics::{dot, mean};
use crate::vector::elementary::exp;
use crate::vector::{accelerated, multiply, shifted, sum};

/// Score of a change, in standard deviations, from which on it is one: 1 of 1,000 even noises.
const OBSERVED: f64 = 3.3;

/// Fewest samples of which the size is judged.
const FEWEST: usize = 30;

/// Largest ln of a variance over the mean.
const FARTHEST: f64 = 14.0;

/// The standard deviation of each sample, of which the mean square is 1.
///
/// ln σ² is a quadratic in the fitted values, or in the number of the sample if that explains more; its coefficients are those of the
/// largest likelihood of e²/σ² as a χ² of one degree of freedom (Harvey 1976).
pub(super) struct Spread(Vec<f64>);

impl Spread {
    /// That of residuals with these partial autocorrelations; `None` where it is even.
    ///
    /// Where they correlate, it is that of what each sample brings beyond its prediction by those before.
    pub(super) fn of(residuals: &[f64], fitted: &[f64], partial: &[f64]) -> Option<Self> {
        let beyond = if partial.is_empty() {
            Cow::Borrowed(residuals)
        } else {
            Cow::Owned(innovations(residuals, partial))
        };
        let square = dot(&beyond, &beyond) / beyond.len() as f64;
        if beyond.len() < FEWEST || square <= f64::MIN_POSITIVE * 1e20 {
            return None;
        }
        let mut squares = shifted(&beyond, 0.0, 1.0 / square);
        multiply(&mut squares, &beyond);
        let numbers: Vec<f64> = (0..residuals.len()).map(|i| i as f64).collect();
        let regressors = [fitted, &numbers];
        let scored = regressors.map(|of| (score(&squares, of).abs(), of)).into_iter();
        let (score, of) =
            scored.filter(|(score, _)| score.is_finite()).max_by(|(one, _), (other, _)| one.total_cmp(other))?;
        (score > OBSERVED).then(|| Self(deviations(&squares, &standardised(of))))
    }

    /// What has the size of the noise, in units of it.
    pub(super) fn even(&self, column: &[f64]) -> Vec<f64> {
        column.iter().zip(&self.0).map(|(value, deviation)| value / deviation).collect()
    }

    /// A column as noise of this size weighs it.
    pub(super) fn weighed(&self, column: &[f64]) -> Vec<f64> {
        column.iter().zip(&self.0).map(|(value, deviation)| value * deviation).collect()
    }
}

/// JᵀVJ of white noise with V = diag(e²/(1 − h)²), h the leverages: HC3 of MacKinnon and White (1985), which needs no course of the size.
pub(super) fn by_residuals(columns: &[&[f64]], amplitudes: &[f64], inverse: &[f64], residuals: &[f64]) -> Vec<f64> {
    /// Least of 1 − h.
    const LEAST: f64 = 0.05;
    let size = columns.len();
    let linear = size - amplitudes.len();
    let factor = |column: usize| if column < linear { 1.0 } else { amplitudes[column - linear] };
    let factors: Vec<f64> = (0..size).map(factor).collect();
    let mut filling = vec![0.0; size * size];
    let mut row = vec![0.0; size];
    for (sample, residual) in residuals.iter().enumerate() {
        row.iter_mut()
            .zip(columns)
            .zip(&factors)
            .for_each(|((entry, column), by)| *entry = by * column[sample]);
        let leverage: f64 = inverse.chunks_exact(size).zip(&row).map(|(line, entry)| entry * dot(line, &row)).sum();
        let variance = (residual / (1.0 - leverage).max(LEAST)).powi(2);
        for (line, one) in filling.chunks_exact_mut(size).zip(&row) {
            line.iter_mut().zip(&row).for_each(|(sum, other)| *sum += variance * one * other);
        }
    }
    filling
}

/// Values less their mean over their deviation.
fn standardised(values: &[f64]) -> Vec<f64> {
    let centred = shifted(values, sum(values) / values.len() as f64, 1.0);
    let deviation = (dot(&centred, &centred) / values.len() as f64).sqrt();
    centred.iter().map(|value| value / deviation).collect()
}

/// How far squares of mean 1 follow a regressor, in standard deviations (Koenker 1981).
fn score(squares: &[f64], of: &[f64]) -> f64 {
    let (count, middle) = (of.len() as f64, sum(of) / of.len() as f64);
    let (together, own, along) = (dot(squares, of), dot(squares, squares), dot(of, of));
    (together - count * middle) / ((own - count) * (along / count - middle * middle)).sqrt()
}

/// Square roots of exp(a + b x + c x²) of the largest likelihood.
fn deviations(squares: &[f64], of: &[f64]) -> Vec<f64> {
    const ROUNDS: usize = 50;
    let count = of.len() as f64;
    // x² without what 1 and x have of it.
    let bent: Vec<f64> = of.iter().map(|x| x * x).collect();
    let slope = dot(&bent, of) / count;
    let middle = mean(&bent);
    let bent: Vec<f64> = bent.iter().zip(of).map(|(square, x)| square - middle - slope * x).collect();
    let size = dot(&bent, &bent);
    let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
    let powers = |[a, b, c]: [f64; 3], by: f64| -> Vec<f64> {
        let mut out = vec![0.0; of.len()];
        accelerated(
            #[inline(always)]
            || {
                for ((out, x), bent) in out.iter_mut().zip(of).zip(&bent) {
                    *out = exp(by * (a + b * x + c * bent).clamp(-FARTHEST, FARTHEST));
                }
            },
        );
        out
    };
    for _ in 0..ROUNDS {
        let mut beyond = powers([a, b, c], -1.0);
        multiply(&mut beyond, squares);
        let beyond = shifted(&beyond, 1.0, 1.0);
        let steps = [mean(&beyond), dot(&beyond, of) / count, dot(&beyond, &bent) / size.max(f64::MIN_POSITIVE)];
        // Fisher's steps are long where the size is far from even.
        let shortened = 1.0f64.min(1.0 / steps.iter().map(|step| step.abs()).fold(0.0, f64::max).max(1e-300));
        (a, b, c) = (a + shortened * steps[0], b + shortened * steps[1], c + shortened * steps[2]);
        if steps.iter().all(|step| step.abs() < 1e-6) {
            break;
        }
    }
    let mut found = powers([a, b, c], 0.5);
    let unit = (dot(&found, &found) / count).sqrt();
    found.iter_mut().for_each(|deviation| *deviation /= unit);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_problems::Rng;

    /// Noise of these standard deviations.
    fn noise(deviations: &[f64], seed: u64) -> Vec<f64> {
        let mut random = Rng::new(seed);
        deviations.iter().map(|deviation| deviation * random.normal()).collect()
    }

    fn signal(samples: usize) -> Vec<f64> {
        (0..samples).map(|i| 1.0 + (-5.0 * i as f64 / samples as f64).exp()).collect()
    }

    #[test]
    fn even_noise_has_no_course_and_that_which_follows_the_signal_has() {
        let signal = signal(400);
        let even = (0..1000).filter(|seed| Spread::of(&noise(&[1.0; 400], *seed), &signal, &[]).is_some()).count();
        assert!(even <= 8, "{even} of 1000");
        let proportional: Vec<f64> = signal.iter().map(|y| y - 0.8).collect();
        let mean_square = dot(&proportional, &proportional) / 400.0;
        for seed in 0..20 {
            let found = Spread::of(&noise(&proportional, seed), &signal, &[]).unwrap();
            let unit = mean_square.sqrt();
            let off = found.0.iter().zip(&proportional).map(|(found, true_one)| (found * unit / true_one).ln().abs());
            let worst = off.fold(0.0, f64::max);
            assert!(worst < 0.7, "{seed}: {worst}");
            assert!((dot(&found.0, &found.0) / 400.0 - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn hc3_of_a_mean_is_that_of_the_jackknife() {
        // Of one constant column h = 1/N, and Σ e²/(1 − 1/N)² / N² the variance of the mean.
        let residuals = noise(&[2.0; 50], 3);
        let middle = mean(&residuals);
        let left: Vec<f64> = residuals.iter().map(|value| value - middle).collect();
        let ones = [1.0; 50];
        let filling = by_residuals(&[&ones], &[], &[1.0 / 50.0], &left);
        let without = |skip: usize| (50.0 * middle - residuals[skip]) / 49.0;
        let jackknife: f64 = (0..50).map(|skip| (without(skip) - middle).powi(2)).sum();
        assert!((filling[0] / 2500.0 / jackknife - 1.0).abs() < 1e-12);
    }
}
