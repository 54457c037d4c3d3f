//! What a fit says.

use serde::{Deserialize, Serialize};

use super::NoiseModel;
use super::separable::{Termination, Work};
use crate::latency::decay;
use crate::laws::ExponentChoice;

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
    /// Confidence interval for residuals that correlate as they do ([`NoiseModel`]); in ln for numbers that cannot change sign.
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
    /// How residuals correlate; intervals rest on it.
    pub noise: NoiseModel,
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

    /// Samples that count as independent, given how residuals correlate.
    #[must_use]
    pub fn effective_samples(&self) -> f64 {
        self.noise.effective_samples(self.samples)
    }
}
