//! Sums of products of residuals with those after them.

use crate::statistics::dot;

/// Sums of products of residuals with those after them.
pub(crate) struct Lags {
    /// Σ rᵢ².
    pub(crate) square: f64,
    /// Σ rᵢ rᵢ₊₁ over it.
    pub(crate) first: f64,
    /// Σ rᵢ rᵢ₊₂ over it.
    pub(crate) second: f64,
}

impl Lags {
    pub(crate) fn of(residuals: &[f64]) -> Self {
        let square = dot(residuals, residuals);
        let correlation = |lag: usize| match residuals.get(lag..) {
            Some(later) if square > 0.0 => (dot(later, &residuals[..later.len()]) / square).clamp(-1.0, 1.0),
            _ => 0.0,
        };
        Self {
            square,
            first: correlation(1),
            second: correlation(2),
        }
    }
}
