//! Noise whose size changes along a hold: with the signal, as that of many sensors does, or with time.

use std::borrow::Cow;

use super::autoregression::innovations;
use super::course::{FARTHEST, NoiseCourse, NoiseFollows};
use crate::optimise::{Cholesky, Few};
use crate::statistics::{dot, mean};
use crate::vector::elementary::exp;
use crate::vector::{accelerated, extremes, multiply, shifted, sum};

/// Score of a change, in standard deviations, from which on it is one: 1 of 1,000 even noises.
const OBSERVED: f64 = 3.3;

/// The same from which on few samples leave a change possible.
const POSSIBLE: f64 = 1.5;

/// Fall of −2 ln L that a change has to bring to be as probable as none, and its bend to be taken in.
const EVIDENCE: f64 = 4.0;

/// Fewest samples of which the size is judged.
const FEWEST: usize = 30;

/// More samples than these observe every change that matters to an interval.
const FEW: usize = 400;

/// Least share of a sample that a fit leaves in its residual.
pub(super) const LEAST_LEFT: f64 = 0.05;

/// The standard deviation of each sample, of which the mean square is 1: over what a fit leaves of it in its residuals, where that is known.
///
/// ln σ² is a quadratic in the fitted values, or in the number of the sample if that explains more, or linear where no bend shows; its
/// coefficients are those of the largest likelihood of e²/σ² as a χ² of one degree of freedom (Harvey 1976).
pub(super) struct Spread {
    deviations: Vec<f64>,
    /// That the size changes at all.
    pub(super) probability: f64,
    /// The same at any value, in the units of the fitted values or numbers of samples.
    pub(super) course: NoiseCourse,
}

impl Spread {
    /// That of residuals with these partial autocorrelations; `None` where it is even. `leverages` are the shares of each sample that its fit takes
    /// up, which pulls the squares of its residuals down.
    ///
    /// Where they correlate, it is that of what each sample brings beyond its prediction by those before.
    pub(super) fn of(
        residuals: &[f64],
        fitted: &[f64],
        partial: &[f64],
        leverages: impl FnOnce() -> Option<Vec<f64>>,
    ) -> Option<Self> {
        let beyond = if partial.is_empty() {
            Cow::Borrowed(residuals)
        } else {
            Cow::Owned(innovations(residuals, partial))
        };
        let (samples, square) = (beyond.len(), dot(&beyond, &beyond) / beyond.len() as f64);
        if samples < FEWEST || square <= f64::MIN_POSITIVE * 1e20 {
            return None;
        }
        let mut squares = shifted(&beyond, 0.0, 1.0 / square);
        multiply(&mut squares, &beyond);
        let left: Option<Vec<f64>> = if partial.is_empty() && samples <= FEW { leverages() } else { None }
            .map(|taken| taken.iter().map(|share| (1.0 - share).max(LEAST_LEFT)).collect());
        if let Some(left) = &left {
            squares.iter_mut().zip(left).for_each(|(square, left)| *square /= left);
            let unit = 1.0 / mean(&squares);
            squares.iter_mut().for_each(|square| *square *= unit);
        }
        let numbers: Vec<f64> = (0..samples).map(|i| i as f64).collect();
        let regressors = [(NoiseFollows::Signal, fitted), (NoiseFollows::Time, &numbers)];
        let scored = regressors.map(|(follows, of)| (score(&squares, of).abs(), follows, of)).into_iter();
        let (score, follows, of) = scored
            .filter(|(score, ..)| score.is_finite())
            .max_by(|(one, ..), (other, ..)| one.total_cmp(other))?;
        let probability = if score > OBSERVED {
            1.0
        } else if score > POSSIBLE && samples <= FEW {
            1.0 / (1.0 + (-0.5 * (score * score - EVIDENCE)).exp())
        } else {
            return None;
        };
        let standard = standardised(of);
        let (mut variances, powers) = variances(&squares, &standard);
        let mean_left = match &left {
            Some(left) => dot(&variances, left) / sum(left),
            None => mean(&variances),
        };
        variances.iter_mut().for_each(|variance| *variance = (*variance / mean_left).sqrt());
        // a + b z + c z² with z = low + wide x.
        let ((low, high), [a, b, c]) = (extremes(&standard), powers);
        let wide = high - low;
        let course = NoiseCourse {
            follows,
            range: extremes(of),
            coefficients: [a + low * (b + low * c) - mean_left.ln(), wide * (b + 2.0 * low * c), wide * wide * c],
            probability,
        };
        Some(Self {
            deviations: variances,
            probability,
            course,
        })
    }

    /// Whether the residuals show it.
    pub(super) fn is_observed(&self) -> bool {
        self.probability >= 1.0
    }

    /// What has the size of the noise, in units of it.
    pub(super) fn even(&self, column: &[f64]) -> Vec<f64> {
        column.iter().zip(&self.deviations).map(|(value, deviation)| value / deviation).collect()
    }

    /// A column as noise of this size weighs it.
    pub(super) fn weighed(&self, column: &[f64]) -> Vec<f64> {
        column.iter().zip(&self.deviations).map(|(value, deviation)| value * deviation).collect()
    }
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

/// exp(a + b x + c x²) of the largest likelihood, without c where that explains as much; and a, b and c.
fn variances(squares: &[f64], of: &[f64]) -> (Vec<f64>, [f64; 3]) {
    let count = of.len() as f64;
    // x² without what 1 and x have of it.
    let bent: Vec<f64> = of.iter().map(|x| x * x).collect();
    let slope = dot(&bent, of) / count;
    let middle = mean(&bent);
    let bent: Vec<f64> = bent.iter().zip(of).map(|(square, x)| square - middle - slope * x).collect();
    let straight = likeliest(squares, [of, &bent], [0.0; 3], false);
    let bends = likeliest(squares, [of, &bent], straight.at, true);
    let best = if straight.deviance - bends.deviance > EVIDENCE { bends } else { straight };
    let [a, b, c] = best.at;
    (best.variances, [a - c * middle, b - c * slope, c])
}

/// Coefficients of ln σ², σ² of the samples, and −2 ln L.
struct Course {
    at: [f64; 3],
    variances: Vec<f64>,
    deviance: f64,
}

/// The course of the largest likelihood from a start on, with its bend or without.
fn likeliest(squares: &[f64], [of, bent]: [&[f64]; 2], start: [f64; 3], bends: bool) -> Course {
    const ROUNDS: usize = 50;
    /// Step of ln σ² that is nothing beside its error of √(2/N).
    const ENOUGH: f64 = 1e-4;
    let count = of.len() as f64;
    let powers = |[a, b, c]: [f64; 3], by: f64| -> Vec<f64> {
        let mut out = vec![0.0; of.len()];
        accelerated(
            #[inline(always)]
            || {
                for ((out, x), bent) in out.iter_mut().zip(of).zip(bent) {
                    *out = exp(by * (a + b * x + c * bent).clamp(-FARTHEST, FARTHEST));
                }
            },
        );
        out
    };
    let mut at = start;
    for _ in 0..ROUNDS {
        let mut beyond = powers(at, -1.0);
        multiply(&mut beyond, squares);
        // Newton's step: −2 ln L is convex.
        let columns = if bends { &[of, bent][..] } else { &[of] };
        let weighed: Vec<Vec<f64>> = columns
            .iter()
            .map(|column| {
                let mut weighed = column.to_vec();
                multiply(&mut weighed, &beyond);
                weighed
            })
            .collect();
        let sums: Few = std::iter::once(&beyond).chain(&weighed).map(|column| sum(column)).collect();
        let size = sums.len();
        let entry = |i: usize, j: usize| if j == 0 { sums[i] } else { dot(&weighed[i - 1], columns[j - 1]) };
        let curvature: Vec<f64> =
            (0..size * size).map(|at| entry((at / size).max(at % size), (at / size).min(at % size))).collect();
        let mut steps = sums.clone();
        // The columns sum up to 0.
        steps[0] -= count;
        let Some(factor) = Cholesky::new(&curvature, size) else {
            break;
        };
        factor.solve(&mut steps);
        let longest = steps.iter().map(|step| step.abs()).fold(0.0, f64::max);
        let shortened = 1.0f64.min(1.0 / longest.max(1e-300));
        at.iter_mut().zip(steps).for_each(|(at, step)| *at += shortened * step);
        if longest < ENOUGH {
            break;
        }
    }
    let variances = powers(at, 1.0);
    let deviance = variances.iter().zip(squares).map(|(variance, square)| variance.ln() + square / variance).sum();
    Course {
        at,
        variances,
        deviance,
    }
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
        let even = (0..1000)
            .filter(|seed| {
                Spread::of(&noise(&[1.0; 400], *seed), &signal, &[], || None).is_some_and(|found| found.is_observed())
            })
            .count();
        assert!(even <= 8, "{even} of 1000");
        let proportional: Vec<f64> = signal.iter().map(|y| y - 0.8).collect();
        let mean_square = dot(&proportional, &proportional) / 400.0;
        for seed in 0..20 {
            let found = Spread::of(&noise(&proportional, seed), &signal, &[], || None).unwrap();
            let unit = mean_square.sqrt();
            let off = found
                .deviations
                .iter()
                .zip(&proportional)
                .map(|(found, true_one)| (found * unit / true_one).ln().abs());
            let worst = off.fold(0.0, f64::max);
            assert!(worst < 0.7, "{seed}: {worst}");
            // The course is the same at every sample.
            for (i, deviation) in found.deviations.iter().enumerate() {
                let size = found.course.size(i as f64, signal[i]);
                assert!((size / deviation - 1.0).abs() < 1e-9, "{seed} {i}: {size} {deviation}");
            }
            assert!((dot(&found.deviations, &found.deviations) / 400.0 - 1.0).abs() < 1e-9);
        }
    }
    /// Of 50 samples of noise that follows the signal, most were of even noise, and intervals of the first amplitude held the truth in 64 of 100.
    #[test]
    fn few_samples_leave_a_change_possible_and_what_their_fit_takes_up_counts() {
        let signal = signal(50);
        let proportional: Vec<f64> = signal.iter().map(|y| y - 0.5).collect();
        // A fit of the first samples alone takes up most of them.
        let leverages: Vec<f64> = (0..50).map(|i| 0.9 * (-f64::from(i)).exp()).collect();
        let left = |seed: u64| -> Vec<f64> {
            noise(&proportional, seed)
                .iter()
                .zip(&leverages)
                .map(|(noise, taken)| noise * (1.0 - taken).sqrt())
                .collect()
        };
        let probability = |seed: u64, known: bool| {
            let found = Spread::of(&left(seed), &signal, &[], || known.then(|| leverages.clone()));
            found.map_or(0.0, |found| found.probability)
        };
        let mean_of = |known: bool| (0..200).map(|seed| probability(seed, known)).sum::<f64>() / 200.0;
        let (known, unknown) = (mean_of(true), mean_of(false));
        assert!(known > 0.7 && unknown < 0.75 && known > unknown + 0.08, "{known} {unknown}");
        let even = (0..200).map(|seed| {
            Spread::of(&noise(&[1.0; 50], seed), &signal, &[], || None).map_or(0.0, |found| found.probability)
        });
        let even = even.sum::<f64>() / 200.0;
        assert!(even < 0.12, "{even}");
    }
}
