//! How noise correlates, by sample; a noise that was found.

use serde::{Deserialize, Serialize};

use crate::statistics::dot;

/// How residuals correlate with their neighbours, by sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseModel {
    /// Not at all.
    #[default]
    White,
    /// AR(1): ρ^k at k samples.
    Autoregressive {
        /// ρ, 0 to 1.
        correlation: f64,
    },
    /// White noise and AR(1): s ρ^k at k samples.
    WhiteAndAutoregressive {
        /// ρ, 0 to 1.
        correlation: f64,
        /// s, the share of the correlated part in the variance, 0 to 1.
        share: f64,
    },
}

impl NoiseModel {
    /// ρ and s.
    pub(crate) fn parameters(self) -> (f64, f64) {
        match self {
            Self::White => (0.0, 0.0),
            Self::Autoregressive { correlation } => (correlation, 1.0),
            Self::WhiteAndAutoregressive { correlation, share } => (correlation, share),
        }
    }

    /// Equivalent number of independent samples among `samples` of this noise: N / (1 + 2 s ρ/(1 − ρ)), at least two.
    ///
    /// ```
    /// use palpate::fit::NoiseModel;
    /// let noise = NoiseModel::Autoregressive { correlation: 0.5 };
    /// assert_eq!(noise.effective_samples(300), 100.0);
    /// ```
    #[must_use]
    pub fn effective_samples(self, samples: usize) -> f64 {
        let (correlation, share) = self.parameters();
        (samples as f64 / (1.0 + 2.0 * share * correlation / (1.0 - correlation))).max(2.0)
    }
}

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

/// The noise of a fit: a model, its variance, and how sure both are.
#[derive(Debug, Clone)]
pub(crate) struct Noise {
    pub(crate) model: NoiseModel,
    /// σ².
    pub(crate) variance: f64,
    /// The model with its variance one standard error away, in each direction in which it is uncertain.
    pub(crate) beside: Vec<(NoiseModel, f64)>,
}

impl Noise {
    /// White noise that left these residuals.
    pub(crate) fn white(lags: &Lags, freedom: f64) -> Self {
        Self {
            model: NoiseModel::White,
            variance: lags.square / freedom,
            beside: Vec::new(),
        }
    }
}
