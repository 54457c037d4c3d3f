//! One fit.

use std::collections::BTreeMap;

use palpate::analysis::{HoldAnalysis, HoldoutError, Signal};
use palpate::fit::{Estimate, ExponentChoice, LatencyFit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::result::word;

/// The latency law fitted to one hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FitDocument {
    /// Always `latency`.
    pub law: String,
    /// `time` (closed form against the signal) or `rate` (strain rate against strain).
    pub domain: String,
    /// n.
    pub exponent: f64,
    /// Whether n was given rather than found.
    pub exponent_fixed: bool,
    /// ε_e, where the signal is strain.
    pub equilibrium_strain: Option<f64>,
    /// Force at equilibrium, N.
    pub equilibrium_force_n: f64,
    /// Excess strain at the start of the fit, where the signal is strain.
    pub excess_strain: Option<f64>,
    /// Excess force at the start of the fit, N.
    pub excess_force_n: f64,
    /// λ, relative rate at the start of the fit, 1/s.
    pub relative_rate_per_s: f64,
    /// v, 1/s; only where the signal is strain.
    pub rate_coefficient_per_s: Option<f64>,
    /// Standard errors by the names above (white noise); a number without one is missing.
    pub standard_error: BTreeMap<String, f64>,
    /// Confidence intervals by the names above, widened for correlated residuals.
    pub confidence_interval: BTreeMap<String, [f64; 2]>,
    /// Root mean square residual in the unit of the fitted quantity: strain, N, or 1/s in the rate domain.
    pub rmse: f64,
    /// Correlation of neighbouring residuals.
    pub residual_correlation: f64,
    /// Samples fitted.
    pub samples: usize,
    /// Bayesian information criterion less the lowest of this hold (time domain).
    pub delta_bic: Option<f64>,
    /// Root mean square error beyond the fitted window as a share of the drop over the whole hold.
    pub prediction_error: Option<f64>,
    /// Why the fit ended: `converged`, `rate_at_bound`, `exponent_at_bound`, `equilibrium_at_bound`, `singular`, `iteration_limit`.
    pub termination: String,
}

impl FitDocument {
    pub(super) fn new(
        fit: &LatencyFit,
        hold: &HoldAnalysis,
        delta_bic: Option<f64>,
        prediction: Option<HoldoutError>,
    ) -> Self {
        let is_strain = hold.signal == Signal::Strain;
        let newtons = hold.force_per_signal;
        let mut document = Self {
            law: "latency".to_owned(),
            domain: word(fit.domain),
            exponent: fit.exponent().value,
            exponent_fixed: fit.choice() != ExponentChoice::Free,
            equilibrium_strain: is_strain.then_some(fit.equilibrium().value),
            equilibrium_force_n: fit.equilibrium().value * newtons,
            excess_strain: is_strain.then_some(fit.amplitude().value),
            excess_force_n: fit.amplitude().value * newtons,
            relative_rate_per_s: fit.relative_rate().value,
            rate_coefficient_per_s: is_strain.then_some(fit.rate_coefficient().value),
            standard_error: BTreeMap::new(),
            confidence_interval: BTreeMap::new(),
            rmse: fit.rmse,
            residual_correlation: fit.residual_correlation,
            samples: fit.samples,
            delta_bic,
            prediction_error: prediction.map(|prediction| prediction.relative),
            termination: word(fit.termination),
        };
        document.note("exponent", fit.exponent(), 1.0);
        document.note("equilibrium_force_n", fit.equilibrium(), newtons);
        document.note("excess_force_n", fit.amplitude(), newtons);
        document.note("relative_rate_per_s", fit.relative_rate(), 1.0);
        if is_strain {
            document.note("equilibrium_strain", fit.equilibrium(), 1.0);
            document.note("excess_strain", fit.amplitude(), 1.0);
            document.note("rate_coefficient_per_s", fit.rate_coefficient(), 1.0);
        }
        document
    }

    fn note(&mut self, name: &str, estimate: Estimate, unit: f64) {
        if let Some(error) = estimate.standard_error {
            self.standard_error.insert(name.to_owned(), error * unit);
        }
        if let Some((low, high)) = estimate.interval {
            self.confidence_interval.insert(name.to_owned(), [low * unit, high * unit]);
        }
    }
}
