//! The standard deviation of a parameter between specimens, with its interval.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::calibrate::problem::{dot, sum_of_squares};
use crate::optimise::Cholesky;

/// How much a parameter differs between specimens: τ, the standard deviation of its natural logarithm (0.1: by 10 %, to first order).
///
/// The estimates y of the k specimens have the errors of their records, of covariance V, beside the spread: the generalised
/// statistic of Cochran
///
/// ```text
/// Q(τ²) = yᵀP y,   P = W − W 1 (1ᵀW 1)⁻¹ 1ᵀW,   W = (V + τ² I)⁻¹
/// ```
///
/// follows χ² of k − 1 degrees of freedom at the true τ² where spread and errors are normal. It falls with τ²: the estimate is where
/// Q = k − 1 (Paule and Mandel 1982), the ends of the interval are where Q is at the quantiles of χ² (Viechtbauer 2007). Without errors of
/// the records that is the interval of a standard deviation by χ².
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// τ, 0 or more.
    pub deviation: f64,
    /// Its confidence interval; (0, 0) of estimates that differ less than all but few of such errors would have it.
    pub interval: (f64, f64),
}

impl Spread {
    /// Of the logarithms of one parameter.
    pub(super) fn of(apart: &Differences, confidence: f64) -> Self {
        let freedom = apart.values.len() as f64;
        let quantile = |share: f64| ChiSquared::new(freedom).map_or(f64::NAN, |chi| chi.inverse_cdf(share));
        let tail = 0.5 * (1.0 - confidence);
        let at = |target: f64| apart.variance_at(target).sqrt();
        Self {
            deviation: at(freedom),
            interval: (at(quantile(1.0 - tail)), at(quantile(tail))),
        }
    }

    /// Whether the records show a difference between specimens: the interval excludes 0.
    ///
    /// ```
    /// use palpate::calibrate::Spread;
    /// assert!(!Spread { deviation: 0.02, interval: (0.0, 0.1) }.is_distinguishable());
    /// ```
    #[must_use]
    pub fn is_distinguishable(&self) -> bool {
        self.interval.0 > 0.0
    }
}

/// The probability of estimates that differ as much as these, if they were estimates of one value: Cochran's test.
pub(super) fn one_value_p(apart: &Differences) -> Option<f64> {
    let chi = ChiSquared::new(apart.values.len() as f64).ok()?;
    let found = apart.statistic(0.0);
    found.is_finite().then(|| chi.sf(found))
}

/// How estimates y of k records differ: Ay with orthonormal rows of A that sum to 0 (Helmert's), and the covariance A V Aᵀ of its errors.
///
/// An error that all records have in common cancels here, before any matrix is inverted; what only one record has, or what one cause changes more in
/// one than in another, stays. Then Q(τ²) = (Ay)ᵀ(A V Aᵀ + τ² I)⁻¹ Ay, which is yᵀP y.
pub(super) struct Differences {
    values: Vec<f64>,
    /// Row by row.
    errors: Vec<f64>,
}

impl Differences {
    /// Of estimates with the covariance of their scatter, row by row, and what one standard uncertainty of each cause of further errors changes
    /// of them.
    pub(super) fn new(values: &[f64], scatter: &[f64], causes: &[Vec<f64>]) -> Self {
        let size = values.len();
        let rows: Vec<Vec<f64>> = scatter.chunks_exact(size).map(contrasts).collect();
        let column = |j: usize| contrasts(&rows.iter().map(|row| row[j]).collect::<Vec<f64>>());
        let mut errors: Vec<f64> = (0..size - 1).flat_map(column).collect();
        for cause in causes.iter().map(|cause| contrasts(cause)) {
            let products = cause.iter().flat_map(|a| cause.iter().map(move |b| a * b));
            errors.iter_mut().zip(products).for_each(|(entry, product)| *entry += product);
        }
        Self {
            values: contrasts(values),
            errors,
        }
    }

    /// Q(τ²); without end where estimates without error differ.
    fn statistic(&self, variance: f64) -> f64 {
        let size = self.values.len();
        let mut total = self.errors.clone();
        (0..size).for_each(|i| total[i * (size + 1)] += variance);
        let Some(factor) = Cholesky::new(&total, size) else {
            return f64::INFINITY;
        };
        let mut solved = self.values.clone();
        factor.solve(&mut solved);
        dot(&self.values, &solved)
    }

    /// τ² with Q(τ²) = target; 0 where Q is below it everywhere.
    fn variance_at(&self, target: f64) -> f64 {
        // Errors that vanish against the spread, or all of it: Q ≤ square/τ².
        let mut high = sum_of_squares(&self.values) / target;
        if high <= 0.0 || self.statistic(0.0) <= target {
            return 0.0;
        }
        // Estimates without any error: a share that rounding does not see.
        let mut low = 1e-14 * high;
        if self.statistic(low) <= target {
            return low;
        }
        // Q falls from low to high; halving the logarithm is exact enough and cannot fail.
        while high / low > 1.0 + 1e-12 {
            let middle = (low * high).sqrt();
            if middle <= low || middle >= high {
                break;
            }
            if self.statistic(middle) > target { low = middle } else { high = middle }
        }
        (low * high).sqrt()
    }
}

/// A y: of each value but the first the difference from the mean of those before it, by √(i/(i + 1)) of variance 1.
fn contrasts(values: &[f64]) -> Vec<f64> {
    let mut mean = values[0];
    let mut apart = Vec::with_capacity(values.len() - 1);
    for (index, value) in values.iter().enumerate().skip(1) {
        let before = index as f64;
        apart.push((value - mean) * (before / (before + 1.0)).sqrt());
        mean += (value - mean) / (before + 1.0);
    }
    apart
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_problems::Rng;

    /// With errors that vanish the estimate is the sample standard deviation, the interval that of χ²: of four degrees of freedom
    /// 0.484419 and 11.143287 (NIST/SEMATECH e-Handbook, 1.3.6.7.4, 0.484 and 11.143).
    #[test]
    fn without_errors_it_is_the_interval_of_a_standard_deviation() {
        let values = [1.0, 1.3, 0.7, 1.1, 1.05];
        let mean = values.iter().sum::<f64>() / 5.0;
        let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        for errors in [vec![0.0; 25], (0..25).map(|at| if at % 6 == 0 { 1e-12 } else { 0.0 }).collect()] {
            let found = Spread::of(&Differences::new(&values, &errors, &[]), 0.95);
            assert!((found.deviation - (square / 4.0).sqrt()).abs() < 1e-9, "{found:?}");
            assert!((found.interval.0 / (square / 11.143_287).sqrt() - 1.0).abs() < 1e-6, "{found:?}");
            assert!((found.interval.1 / (square / 0.484_419).sqrt() - 1.0).abs() < 1e-6, "{found:?}");
        }
    }

    /// The error that all estimates have in common, as from a shared parameter, is no spread.
    #[test]
    fn a_common_error_changes_nothing() {
        let values = [1.0, 1.3, 0.7, 1.1, 1.05];
        let with =
            |common: f64| -> Vec<f64> { (0..25).map(|at| common + if at % 6 == 0 { 0.01 } else { 0.0 }).collect() };
        let (without, beside) = {
            let of = |common: f64| Spread::of(&Differences::new(&values, &with(common), &[]), 0.95);
            (of(0.0), of(0.5))
        };
        assert!((without.deviation - beside.deviation).abs() < 1e-8, "{without:?} {beside:?}");
        assert!((without.interval.1 - beside.interval.1).abs() < 1e-8);
    }

    #[test]
    fn intervals_cover_with_errors_of_different_size() {
        let (tau, deviations) = (0.1, [0.02, 0.1, 0.15, 0.05, 0.08]);
        let errors: Vec<f64> =
            (0..25).map(|at| if at % 6 == 0 { f64::powi(deviations[at / 6], 2) } else { 0.0 }).collect();
        let mut rng = Rng::new(7);
        let mut covered = 0;
        for _ in 0..2000 {
            let values: Vec<f64> = deviations.iter().map(|error| tau * rng.normal() + error * rng.normal()).collect();
            let found = Spread::of(&Differences::new(&values, &errors, &[]), 0.95);
            covered += usize::from(found.interval.0 <= tau && tau <= found.interval.1);
        }
        // 95 % of 2000 ± 3 standard deviations of the count.
        assert!((1871..=1929).contains(&covered), "{covered}");
    }

    #[test]
    fn estimates_within_their_errors_have_no_spread() {
        let errors: Vec<f64> = (0..9).map(|at| if at % 4 == 0 { 0.04 } else { 0.0 }).collect();
        let found = Spread::of(&Differences::new(&[1.0, 1.05, 0.98], &errors, &[]), 0.95);
        assert_eq!((found.deviation, found.is_distinguishable()), (0.0, false));
        assert!(found.interval.1 > 0.1);
        // (0.0, 0.05, −0.02)²/0.04 about their mean: Q = 0.065, and exp(−Q/2) for two degrees of freedom.
        let p = one_value_p(&Differences::new(&[1.0, 1.05, 0.98], &errors, &[])).unwrap();
        assert!((p - (-0.5 * 0.0026 / 0.04_f64).exp()).abs() < 1e-9, "{p}");
    }
}
