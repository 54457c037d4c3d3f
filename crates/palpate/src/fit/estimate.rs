//! A value and how sure it is.

use serde::{Deserialize, Serialize};

/// A number with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// Standard error from the curvature at the optimum, s² (JᵀJ)⁻¹ with s² = RSS/(N − p): white noise is assumed.
    /// `None` for a fixed number, or where the data do not determine it.
    pub standard_error: Option<f64>,
    /// Confidence interval for residuals that correlate as they do ([`NoiseModel`](crate::fit::NoiseModel)); in ln for numbers that cannot change sign.
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

/// A confidence interval whose ends the data may leave open.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Lower end; `None` if no value is too low.
    pub low: Option<f64>,
    /// Upper end; `None` if no value is too high.
    pub high: Option<f64>,
}

impl Interval {
    /// Nothing is known.
    pub(crate) const OPEN: Self = Self { low: None, high: None };
}
