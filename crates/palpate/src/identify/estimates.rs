//! What a fit says.

use serde::{Deserialize, Serialize};

use super::separable::{Solution, Termination, Work};
use crate::latency::decay;
use crate::laws::ExponentChoice;
use crate::statistics::{coverage_factor, effective_count, lag_one_correlation};

/// In which plane a law was fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Domain {
    /// The closed form, equations (4) and (5), against the signal over time.
    Time,
    /// Equation (10) against strain rate over strain, as the paper does; biased by noise in both.
    Rate,
}

/// A number with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// Standard error from the curvature at the optimum, s² (JᵀJ)⁻¹ with s² = RSS/(N − p): white noise is assumed.
    /// `None` for a fixed number, or where the data do not determine it.
    pub standard_error: Option<f64>,
    /// Confidence interval; widened for correlated residuals, and in ln for numbers that cannot change sign.
    pub interval: Option<(f64, f64)>,
}

impl Estimate {
    /// A number that was given, not found.
    #[must_use]
    pub fn fixed(value: f64) -> Self {
        Self {
            value,
            standard_error: None,
            interval: None,
        }
    }
}

/// Order of the rows and columns of [`LatencyFit::covariance`] in the time domain; a fixed exponent has no row.
pub const PARAMETERS: [&str; 4] = ["equilibrium", "amplitude", "log_relative_rate", "exponent"];

/// The latency law fitted to one hold.
///
/// The signal may be strain, force or stress: they differ by a constant factor during a hold. `equilibrium` and
/// `amplitude` have its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LatencyFit {
    /// In which plane.
    pub domain: Domain,
    /// Whether n was given.
    pub choice: ExponentChoice,
    /// n.
    pub exponent: Estimate,
    /// y_e, the value that the signal tends to.
    pub equilibrium: Estimate,
    /// Δ = y(0) − y_e, the excess at the start of the fit.
    pub amplitude: Estimate,
    /// λ = v |Δ|ⁿ⁻¹ in 1/s, the relative rate at the start.
    pub relative_rate: Estimate,
    /// v in 1/s (in units of signal^(1−n)/s if the signal is not strain).
    pub rate_coefficient: Estimate,
    /// Covariance in the order of [`PARAMETERS`] (time domain) or equilibrium, ln v, exponent (rate domain).
    pub covariance: Option<Vec<Vec<f64>>>,
    /// Sum of squared residuals.
    pub residual_square: f64,
    /// Root mean square residual √(RSS/N).
    pub rmse: f64,
    /// Correlation of neighbouring residuals; near 0 for white noise, near 1 where the law misses the shape.
    pub residual_correlation: f64,
    /// Samples fitted.
    pub samples: usize,
    /// Why it ended.
    pub termination: Termination,
    /// What it cost.
    pub work: Work,
}

impl LatencyFit {
    /// Numbers found from the data.
    #[must_use]
    pub fn parameters(&self) -> usize {
        match self.choice {
            ExponentChoice::Fixed(_) => 3,
            ExponentChoice::Free => 4,
        }
    }

    /// The signal a time `elapsed` (s) after the start of the fit.
    #[must_use]
    pub fn predict(&self, elapsed: f64) -> f64 {
        let phi = decay(self.relative_rate.value * elapsed.max(0.0), self.exponent.value);
        self.equilibrium.value + self.amplitude.value * phi
    }

    /// Samples that count as independent, given how neighbouring residuals correlate.
    #[must_use]
    pub fn effective_samples(&self) -> f64 {
        effective_count(self.samples, self.residual_correlation)
    }
}

/// How a number is brought to its interval.
#[derive(Clone, Copy)]
pub(super) enum Scale {
    /// Symmetric about the value.
    Linear,
    /// Symmetric about ln of the value, for rates and exponents.
    Log,
}

/// Turns variances into estimates.
pub(super) struct Uncertainty {
    pub(super) variance: f64,
    pub(super) factor: f64,
    pub(super) correlation: f64,
}

impl Uncertainty {
    pub(super) fn new(solution: &Solution, confidence: f64) -> Self {
        let samples = solution.residuals.len();
        let parameters = solution.linear.len() + solution.nonlinear.len();
        let correlation = lag_one_correlation(&solution.residuals);
        // Neighbours that repeat each other carry less: the interval is as wide as the independent samples make it.
        let effective = effective_count(samples, correlation);
        let widening = (samples as f64 / effective).sqrt();
        Self {
            variance: solution.variance,
            factor: coverage_factor(confidence, (effective - parameters as f64).max(1.0)) * widening,
            correlation,
        }
    }

    /// An estimate of `value` with this gradient (of ln value on the logarithmic scale) by numbers of this covariance.
    pub(super) fn of(&self, value: f64, gradient: &[f64], covariance: &[Vec<f64>], scale: Scale) -> Estimate {
        let size = gradient.len();
        let sum: f64 = (0..size)
            .map(|i| (0..size).map(|j| gradient[i] * covariance[i][j] * gradient[j]).sum::<f64>())
            .sum();
        if sum == 0.0 {
            return Estimate::fixed(value);
        }
        self.estimate(value, sum / self.variance, scale)
    }

    /// An estimate of `value` whose natural scale has variance `inverse_normal` × s².
    pub(super) fn estimate(&self, value: f64, inverse_normal: f64, scale: Scale) -> Estimate {
        let deviation = (inverse_normal * self.variance).sqrt();
        let half = deviation * self.factor;
        let (standard_error, interval) = match scale {
            Scale::Linear => (deviation, (value - half, value + half)),
            Scale::Log => (value.abs() * deviation, (value * (-half).exp(), value * half.exp())),
        };
        let good = standard_error.is_finite() && interval.0.is_finite() && interval.1.is_finite();
        Estimate {
            value,
            standard_error: good.then_some(standard_error),
            interval: good.then_some(interval),
        }
    }
}

/// A quadratic form: variance of Σ wᵢ pᵢ.
pub(super) fn variance_of(weights: &[f64], covariance: &[f64]) -> f64 {
    let size = weights.len();
    let mut sum = 0.0;
    for i in 0..size {
        for j in 0..size {
            sum += weights[i] * covariance[i * size + j] * weights[j];
        }
    }
    sum
}
