//! A noise that was found, and how sure it is.

use super::lags::Lags;
use super::model::NoiseModel;

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
