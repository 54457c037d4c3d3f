//! The forward score of a law.

use serde::{Deserialize, Serialize};

use crate::fit::{Forecast, LawOptions, Samples, foretell};
use crate::laws::Law;

/// How well a law foretells a hold.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
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
            cuts.iter().map(|cut| foretell(samples, law, options, *cut).ok()).collect();
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
