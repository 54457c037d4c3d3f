//! One fit.

use palpate::analysis::{HoldAnalysis, HoldoutError};
use palpate::fit::{LatencyFit, ParameterKind};

use crate::result::{Parameters, formula, parameters_of, word};

documents! {
    /// The latency law fitted to one hold.
    FitDocument(fit: &LatencyFit, hold: &HoldAnalysis, delta_bic: Option<f64>, prediction: Option<HoldoutError>) with {
        let is_good = fit.termination.is_good() || fit.equilibrium().standard_error.is_some();
        let newtons = |value: f64| Some(value * hold.force_per_signal).filter(|_| is_good);
        let relative_rmse = hold.relative_rmse(fit).filter(|share| share.is_finite());
        let equilibrium = fit.parameters.iter().find(|parameter| parameter.name.kind == ParameterKind::Equilibrium);
        let scatter = equilibrium.and_then(|found| found.parts.as_ref().map_or(found.estimate.standard_error, |parts| parts.scatter));
        let pascals = |value: f64| newtons(value).zip(hold.force_per_modulus).map(|(force, per_modulus)| force / per_modulus);
        let modulus = pascals(fit.equilibrium().value).filter(|modulus| *modulus > 0.0);
    } {
        /// `latency:N` with the exponent given, `latency` with the exponent estimated.
        law: String = fit.law.to_string(),
        /// `time` (closed form against the signal) or `rate` (strain rate against strain).
        domain: String = word(fit.domain),
        /// The law with its parameter values; t from the start of the fit.
        formula: String = formula(fit, hold.signal.into()),
        /// Parameters of the law by name, in the unit of the signal where they have one.
        parameters: Parameters = parameters_of(fit, hold.signal.into()),
        /// The equilibrium as a force, N; `null` where it is not determined.
        equilibrium_force_n: Option<f64> = newtons(fit.equilibrium().value),
        /// Excess force at the start of the fit, N; `null` where it is not determined.
        excess_force_n: Option<f64> = newtons(fit.amplitude().value),
        /// Young's modulus that the equilibrium force implies, Pa; `null` where that force is none of a body that is pressed.
        equilibrium_modulus_pa?: Option<f64> = modulus,
        /// Its standard error, Pa: of the equilibrium force, of first touch where that was found, and of the instrument.
        equilibrium_modulus_standard_error_pa?: Option<f64> = scatter.and_then(pascals).zip(modulus).map(
            |(scatter, modulus)| scatter.hypot(modulus * hold.modulus_error.unwrap_or(0.0))
        ),
        /// Root mean square residual in the unit of the fitted quantity: strain, N, or 1/s in the rate domain.
        rmse: f64 = fit.rmse,
        /// The same as a share of the change of the signal over the fitted samples; `null` in the rate domain.
        relative_rmse: Option<f64> = relative_rmse,
        /// Correlation of neighbouring residuals.
        residual_correlation: f64 = fit.residual_correlation,
        /// The noise that the residuals show: `white`, `AR(1)`, `white and AR(1)`, `1/f^1.0`, …, with `, uneven` where its size follows the
        /// signal or time. Standard errors and intervals are for this noise and others that are likely.
        noise: String = fit.noise_in_words(),
        /// Samples that count as independent under that noise.
        effective_samples: f64 = fit.effective_samples(),
        /// Probability that this noise leaves such residuals (Ljung and Box, 20 lags); `null` for fewer than 100 samples and for uneven times.
        noise_p_value: Option<f64> = fit.noise_p_value,
        /// Method of the intervals: `curvature`, `profile` or `bootstrap`.
        interval_method: String = fit.interval_method.name().to_owned(),
        /// Samples fitted.
        samples: usize = fit.samples,
        /// Bayesian information criterion less the lowest of this hold (time domain).
        delta_bic: Option<f64> = delta_bic,
        /// Held-out error: root mean square error beyond the fitted window as a share of the change over the whole hold.
        holdout_error: Option<f64> = prediction.map(|prediction| prediction.relative),
        /// Why the fit ended: `converged`, `rate_at_bound`, `exponent_at_bound`, `equilibrium_at_bound`, `singular`, `iteration_limit`.
        termination: String = word(fit.termination),
    }
}
