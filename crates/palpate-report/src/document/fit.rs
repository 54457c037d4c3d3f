//! One fit.

use std::collections::BTreeMap;

use palpate::analysis::{HoldAnalysis, HoldoutError, Signal};
use palpate::fit::{ExponentChoice, LatencyFit};

use crate::result::word;

documents! {
    /// The latency law fitted to one hold.
    FitDocument(fit: &LatencyFit, hold: &HoldAnalysis, delta_bic: Option<f64>, prediction: Option<HoldoutError>) with {
        let (is_strain, newtons) = (hold.signal == Signal::Strain, hold.force_per_signal);
        let of_any = [
            ("exponent", fit.exponent(), 1.0),
            ("equilibrium_force_n", fit.equilibrium(), newtons),
            ("excess_force_n", fit.amplitude(), newtons),
            ("relative_rate_per_s", fit.relative_rate(), 1.0),
        ];
        let of_strain = [
            ("equilibrium_strain", fit.equilibrium(), 1.0),
            ("excess_strain", fit.amplitude(), 1.0),
            ("rate_coefficient_per_s", fit.rate_coefficient(), 1.0),
        ];
        let parameters = || of_any.iter().chain(of_strain.iter().filter(|_| is_strain));
        let errors = parameters().filter_map(|(name, of, unit)| Some(((*name).to_owned(), of.standard_error? * unit)));
        let intervals = parameters().filter_map(|(name, of, unit)| {
            let (low, high) = of.interval?;
            Some(((*name).to_owned(), [low * unit, high * unit]))
        });
    } {
        /// Always `latency`.
        law: String = "latency".to_owned(),
        /// `time` (closed form against the signal) or `rate` (strain rate against strain).
        domain: String = word(fit.domain),
        /// n.
        exponent: f64 = fit.exponent().value,
        /// Whether n was given rather than found.
        exponent_fixed: bool = fit.choice() != ExponentChoice::Free,
        /// ε_e, where the signal is strain.
        equilibrium_strain: Option<f64> = is_strain.then_some(fit.equilibrium().value),
        /// Force at equilibrium, N.
        equilibrium_force_n: f64 = fit.equilibrium().value * newtons,
        /// Excess strain at the start of the fit, where the signal is strain.
        excess_strain: Option<f64> = is_strain.then_some(fit.amplitude().value),
        /// Excess force at the start of the fit, N.
        excess_force_n: f64 = fit.amplitude().value * newtons,
        /// λ, relative rate at the start of the fit, 1/s.
        relative_rate_per_s: f64 = fit.relative_rate().value,
        /// v, 1/s; only where the signal is strain.
        rate_coefficient_per_s: Option<f64> = is_strain.then_some(fit.rate_coefficient().value),
        /// Standard errors by the names above (white noise); a parameter without one is missing.
        standard_error: BTreeMap<String, f64> = errors.collect(),
        /// Confidence intervals by the names above, widened for correlated residuals.
        confidence_interval: BTreeMap<String, [f64; 2]> = intervals.collect(),
        /// Root mean square residual in the unit of the fitted quantity: strain, N, or 1/s in the rate domain.
        rmse: f64 = fit.rmse,
        /// Correlation of neighbouring residuals.
        residual_correlation: f64 = fit.residual_correlation,
        /// Samples fitted.
        samples: usize = fit.samples,
        /// Bayesian information criterion less the lowest of this hold (time domain).
        delta_bic: Option<f64> = delta_bic,
        /// Root mean square error beyond the fitted window as a share of the drop over the whole hold.
        prediction_error: Option<f64> = prediction.map(|prediction| prediction.relative),
        /// Why the fit ended: `converged`, `rate_at_bound`, `exponent_at_bound`, `equilibrium_at_bound`, `singular`, `iteration_limit`.
        termination: String = word(fit.termination),
    }
}
