//! Information criteria, and the forward score of a law.

use serde::{Deserialize, Serialize};

use crate::fit::{Forecast, LawOptions, Samples, forecast};
use crate::laws::Law;

/// Information criteria of a least-squares fit; only differences between laws on the same samples mean anything.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Criteria {
    /// Akaike's, N ln(RSS/N) + 2p.
    pub aic: f64,
    /// Akaike's with the correction of Hurvich and Tsai (1989) for few samples, AIC + 2p (p + 1)/(N − p − 1); infinite where N ≤ p + 1.
    pub aicc: f64,
    /// Schwarz's (1978), N ln(RSS/N) + p ln N.
    pub bic: f64,
}

/// The criteria of a fit of `parameters` parameters to `samples` samples with a residual square of `residual_square`.
///
/// For Gaussian noise of unknown size, up to a constant that all laws share. `parameters` counts the parameters of the law, not
/// the noise: the convention of lmfit, to whose values these are equal. `samples` may be an effective parameter, where neighbours
/// repeat each other.
///
/// ```
/// use palpate::forecast::criteria;
/// let c = criteria(0.5, 100.0, 3.0);
/// assert!((c.bic - (100.0 * 0.005f64.ln() + 3.0 * 100f64.ln())).abs() < 1e-9);
/// assert!((c.aicc - c.aic - 24.0 / 96.0).abs() < 1e-9);
/// ```
#[must_use]
pub fn criteria(residual_square: f64, samples: f64, parameters: f64) -> Criteria {
    let misfit = samples * (residual_square / samples).ln();
    let aic = misfit + 2.0 * parameters;
    let left = samples - parameters - 1.0;
    Criteria {
        aic,
        aicc: if left > 0.0 { aic + 2.0 * parameters * (parameters + 1.0) / left } else { f64::INFINITY },
        bic: misfit + parameters * samples.ln(),
    }
}

/// How well a law predicts a hold.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ForwardScore {
    /// One forecast a cut point; `None` where the first part could not be fitted.
    pub forecasts: Vec<Option<Forecast>>,
    /// Root mean square error over the change of the signal in the whole hold, averaged over the cut points (as a root mean
    /// square); `None` if a forecast is missing.
    pub score: Option<f64>,
}

impl ForwardScore {
    /// Forecasts of a law from each cut point (s after the first sample), in units of `change`, that of the signal.
    #[must_use]
    pub fn of(samples: &Samples<'_>, law: Law, options: &LawOptions, cuts: &[f64], change: f64) -> Self {
        let forecasts: Vec<Option<Forecast>> =
            cuts.iter().map(|cut| forecast(samples, law, options, *cut).ok()).collect();
        let squares: Option<f64> = forecasts.iter().map(|forecast| forecast.map(|f| (f.rmse / change).powi(2))).sum();
        let score = squares.filter(|_| !cuts.is_empty()).map(|square| (square / cuts.len() as f64).sqrt());
        Self {
            forecasts,
            score: score.filter(|score| score.is_finite()),
        }
    }

    /// Error at cut point `index` over `change`.
    #[must_use]
    pub fn relative(&self, index: usize, change: f64) -> Option<f64> {
        self.forecasts.get(index).copied().flatten().map(|forecast| forecast.rmse / change)
    }
}
