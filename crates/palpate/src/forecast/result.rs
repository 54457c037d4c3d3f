//! What a comparison says: a row a law, and which law to use.

use serde::{Deserialize, Serialize};

use super::{Criteria, ForwardScore, HoldForecast};
use crate::fit::{Fit, FitError, SpectrumFit};
use crate::laws::Law;

/// By what laws were ranked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ranking {
    /// By the forward score.
    Forward,
    /// By BIC at the effective number of samples: the hold is too short, or too noisy, to predict anything.
    Information,
}

/// One law on one hold.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Row {
    /// The law.
    pub law: Law,
    /// Its fit to the whole hold (for the spectrum see `spectrum`).
    pub fit: Result<Fit, FitError>,
    /// The spectrum, if that is the law.
    pub spectrum: Option<SpectrumFit>,
    /// Parameters that the data determine; not a whole one for a smoothed spectrum.
    pub effective_parameters: f64,
    /// Root mean square residual, in the unit of the signal.
    pub rmse: f64,
    /// Information criteria by their textbook definition, at the number of samples.
    pub criteria: Option<Criteria>,
    /// BIC at the effective number of samples, less the lowest.
    pub delta_bic: Option<f64>,
    /// What it predicts.
    pub forward: ForwardScore,
}

impl Row {
    /// Whether the law was fitted, to an optimum inside its range.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.spectrum.is_some() || self.fit.as_ref().is_ok_and(|fit| fit.termination.is_good())
    }

    /// Whether the law was fitted, wherever the fit ended.
    pub(super) fn was_fitted(&self) -> bool {
        self.spectrum.is_some() || self.fit.is_ok()
    }
}

/// Laws compared on one hold.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// One row a law, best first.
    pub rows: Vec<Row>,
    /// By what they are ranked.
    pub ranking: Ranking,
    /// Cut points, s after the first sample.
    pub cuts: Vec<f64>,
    /// Time from the first to the last sample, s.
    pub duration: f64,
    /// Change of the signal over the hold, in its unit: forward errors are shares of it.
    pub change: f64,
    /// Standard deviation of the noise, in the unit of the signal.
    pub noise: f64,
    /// Samples.
    pub samples: usize,
    /// Samples that count as independent, by the residuals of the closest fit.
    pub effective_samples: f64,
    /// What the hold will show next, from all laws together; `None` where it is too short, or nobody wants it.
    pub forecast: Option<HoldForecast>,
    /// Which law to use; `None` if none could be fitted.
    pub verdict: Option<Verdict>,
}

/// Certainty of a verdict, by its [probability](Verdict::probability).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Certainty {
    /// 90 % and more.
    Clear,
    /// 75 % and more.
    Likely,
    /// Less, nothing is held out, or every law is refuted.
    Open,
}

/// What stands against every law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reservation {
    /// Each is refuted by the hold itself: its BIC at the effective number of samples exceeds the lowest by more than 10.
    Refuted,
    /// The forecasts of each miss by more than a third of the change.
    Unpredictive,
    /// What the machine holds goes on in the hold, and the body answers that, too.
    DriveChanges,
}

/// Which law to use.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Verdict {
    /// The law with the lowest BIC among those that are not distinguishable from the best; the spectrum only if it is the only one.
    pub law: Law,
    /// All laws that are not distinguishable from the best, this one included, best first: by a test of their forecasts, or, where nothing
    /// is held out, with a BIC at most 6 above the lowest.
    pub indistinguishable: Vec<Law>,
    /// Probability that no law of those compared predicts what follows, up to two or three times the duration of the hold, with an error
    /// that is smaller by more than a fifth; from what came of measured and of simulated holds.
    pub probability: f64,
    /// Range of that probability: what measured holds alone and what simulated ones alone say.
    pub probability_range: (f64, f64),
    /// Certainty of the verdict.
    pub certainty: Certainty,
    /// What stands against this law and every other, so that it is the best approximation and no recommendation.
    pub reservation: Option<Reservation>,
    /// Cut points at which its error was within a fifth of the smallest.
    pub cuts_near_best: usize,
    /// What every other law costs: its error over that of the chosen one (forward), or its excess of BIC (information).
    pub costs: Vec<(Law, f64)>,
}

impl Verdict {
    /// States what stands against every law, so that none is recommended.
    pub(crate) fn reserve(&mut self, reservation: Reservation) {
        (self.reservation, self.certainty) = (Some(reservation), Certainty::Open);
    }
}
