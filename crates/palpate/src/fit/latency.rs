//! The latency law fitted to a signal over time: y(t) = y_e + Δ φ(t; λ, n).

use std::ops::Deref;

use serde::{Deserialize, Serialize};

use super::{Estimate, Fit, FitError, FitOptions, ParameterKind, Samples, fit_law_watched};
use crate::latency::decay;
use crate::laws::{ExponentChoice, Law};
use crate::watch::{Unwatched, Watch};

/// Fits the latency law to a hold: equations (4) and (5), no starting values.
///
/// `times` in s rise from the start of the hold (their first value is its zero); `values` are strain, force or
/// stress, one a time. With [`ExponentChoice::Free`] the exponent is sought in `options.exponent_range`.
///
/// For given (λ, n) the model is linear in (y_e, Δ). Variable projection leaves ln λ, or (ln λ, n): a coarse grid
/// finds the valleys, a damped Gauss–Newton search their bottoms, and the lowest one is returned. The search is made in
/// units of the hold's own duration and range, so no choice of units changes the answer.
///
/// λ is sought from 10⁻³ per duration of the hold to 10³ per first sample step; an optimum at either end is reported as
/// [`Termination::RateAtBound`](crate::fit::Termination::RateAtBound), with no errors, because the data then leave the law open.
///
/// ```
/// use palpate::fit::{ExponentChoice, FitOptions, fit_hold};
/// // 0.2 + 0.1 (1 + 4 · 0.5 t)^(-1/4): n = 5, λ = 0.5 per second
/// let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
/// let values: Vec<f64> = times.iter().map(|t| 0.2 + 0.1 * (1.0 + 2.0 * t).powf(-0.25)).collect();
/// let fit = fit_hold(&times, &values, ExponentChoice::Free, &FitOptions::default())?;
/// assert!((fit.exponent().value - 5.0).abs() < 1e-6);
/// assert!((fit.equilibrium().value - 0.2).abs() < 1e-8);
/// // v = λ/Δ⁴
/// assert!((fit.rate_coefficient().value / 5000.0 - 1.0).abs() < 1e-4);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for unequal lengths, fewer samples than parameters plus one, values that are not finite, times that do not
/// rise, an exponent that is no number above zero, or values that are all the same.
pub fn fit_hold(
    times: &[f64],
    values: &[f64],
    choice: ExponentChoice,
    options: &FitOptions,
) -> Result<LatencyFit, FitError> {
    fit_hold_watched(times, values, choice, options, &mut Unwatched)
}

/// [`fit_hold`] with a watch, which hears of every evaluation of the law over the samples.
///
/// # Errors
/// As [`fit_hold`], and [`FitError::Cancelled`].
pub fn fit_hold_watched(
    times: &[f64],
    values: &[f64],
    choice: ExponentChoice,
    options: &FitOptions,
    watch: &mut dyn Watch,
) -> Result<LatencyFit, FitError> {
    options.check(choice)?;
    let (law, law_options) = (Law::Latency { exponent: choice }, options.of_latency(choice));
    let fit = fit_law_watched(&Samples::new(times, values), law, &law_options, watch)?;
    LatencyFit::new(fit).ok_or(FitError::NoDecay)
}

/// The latency law fitted to one hold: a [`Fit`] read by the names of its parameters.
///
/// The signal may be strain, force or stress: they differ by a constant factor during a hold. `equilibrium` and
/// `amplitude` have its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct LatencyFit {
    fit: Fit,
    choice: ExponentChoice,
    /// y_e, Δ, λ, v and n.
    parameters: [Estimate; 5],
}

impl LatencyFit {
    /// Reads a fit of the latency law; `None` if it is one of another law.
    #[must_use]
    pub fn new(fit: Fit) -> Option<Self> {
        let Law::Latency { exponent: choice } = fit.law else {
            return None;
        };
        let parameter = |kind: ParameterKind| fit.parameter(kind).map(|parameter| parameter.estimate);
        let parameters = [
            parameter(ParameterKind::Equilibrium)?,
            parameter(ParameterKind::Amplitude)?,
            parameter(ParameterKind::RelativeRate)?,
            parameter(ParameterKind::RateCoefficient)?,
            match choice {
                ExponentChoice::Fixed(n) => Estimate::fixed(n),
                ExponentChoice::Free => parameter(ParameterKind::Exponent)?,
            },
        ];
        Some(Self {
            fit,
            choice,
            parameters,
        })
    }

    /// Whether n was given.
    #[must_use]
    pub fn choice(&self) -> ExponentChoice {
        self.choice
    }

    /// n.
    #[must_use]
    pub fn exponent(&self) -> Estimate {
        self.parameters[4]
    }

    /// y_e, the value that the signal tends to.
    #[must_use]
    pub fn equilibrium(&self) -> Estimate {
        self.parameters[0]
    }

    /// Δ = y(0) − y_e, the excess at the start of the fit.
    #[must_use]
    pub fn amplitude(&self) -> Estimate {
        self.parameters[1]
    }

    /// λ = v |Δ|ⁿ⁻¹ in 1/s, the relative rate at the start.
    #[must_use]
    pub fn relative_rate(&self) -> Estimate {
        self.parameters[2]
    }

    /// v in 1/s (in units of signal^(1−n)/s if the signal is not strain).
    #[must_use]
    pub fn rate_coefficient(&self) -> Estimate {
        self.parameters[3]
    }

    /// The signal a time `elapsed` (s) after the start of the fit.
    #[must_use]
    pub fn predict(&self, elapsed: f64) -> f64 {
        let phi = decay(self.relative_rate().value * elapsed.max(0.0), self.exponent().value);
        self.equilibrium().value + self.amplitude().value * phi
    }
}

impl Deref for LatencyFit {
    type Target = Fit;

    fn deref(&self) -> &Fit {
        &self.fit
    }
}

/// One exponent that was tried.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// n.
    pub exponent: f64,
    /// Whether n was estimated rather than given.
    pub free: bool,
    /// Root mean square residual, in the unit of the signal.
    pub rmse: f64,
    /// Bayesian information criterion less the lowest of all candidates, at the effective number of samples.
    pub delta_bic: f64,
    /// Whether the fit is not distinguishable from the best one.
    pub indistinguishable: bool,
}

/// What [`select_order`] found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct OrderSelection {
    /// All candidates in the order given.
    pub candidates: Vec<Candidate>,
    /// Index of the lowest listed exponent that is not distinguishable from the best one.
    pub lowest_order: Option<usize>,
    /// Index of the candidate with the lowest information criterion among those whose fit ended well.
    pub preferred: Option<usize>,
    /// Samples that count as independent in these comparisons.
    pub effective_samples: f64,
}

impl OrderSelection {
    /// Index of the candidate to use: the lowest order, unless the preferred one is better than it by more than counts as evidence.
    #[must_use]
    pub fn recommended(&self) -> Option<usize> {
        let criterion =
            |index: usize| self.candidates.get(index).map_or(f64::INFINITY, |candidate| candidate.delta_bic);
        match (self.lowest_order, self.preferred) {
            (Some(lowest), Some(best)) if criterion(lowest) - criterion(best) > EVIDENCE => Some(best),
            (lowest, best) => lowest.or(best),
        }
    }
}

/// A difference of the criterion that counts as evidence ("positive" in the scale of Kass and Raftery).
const EVIDENCE: f64 = 2.0;

/// Compares fits of one hold with different exponents: the paper's "lowest order which fits the best", made precise.
///
/// BIC = N_e ln(RSS/N) + p ln N_e, with N_e the number of independent samples that the best fit's residuals allow. A listed
/// exponent is not distinguishable from the best if its criterion is within 2 of it; the lowest such is `lowest_order`. The
/// preferred candidate has the lowest criterion of all, a free exponent included, which pays for its extra parameter.
#[must_use]
pub fn select_order(fits: &[LatencyFit]) -> OrderSelection {
    let best = fits.iter().min_by(|a, b| a.residual_square.total_cmp(&b.residual_square));
    let effective = best.map_or(0.0, |fit| fit.effective_samples());
    // Noise-free records leave rounding only; below this share of the signal all residuals are equal.
    let floor = |fit: &LatencyFit| {
        let scale = fit.amplitude().value.abs() + fit.equilibrium().value.abs();
        (1e-9 * scale).powi(2) * fit.samples as f64
    };
    let criterion = |fit: &LatencyFit| {
        let square = fit.residual_square.max(floor(fit));
        effective * (square / fit.samples as f64).ln() + fit.free_parameters() as f64 * effective.ln()
    };
    let listed = |fit: &LatencyFit| matches!(fit.choice(), ExponentChoice::Fixed(_));
    let lowest = fits.iter().map(criterion).fold(f64::INFINITY, f64::min);
    let lowest_listed = fits.iter().filter(|fit| listed(fit)).map(criterion).fold(f64::INFINITY, f64::min);
    let candidates: Vec<Candidate> = fits
        .iter()
        .map(|fit| Candidate {
            exponent: fit.exponent().value,
            free: !listed(fit),
            rmse: fit.rmse,
            delta_bic: criterion(fit) - lowest,
            indistinguishable: criterion(fit) - lowest_listed <= EVIDENCE,
        })
        .collect();
    let order = |a: &usize, b: &usize| candidates[*a].exponent.total_cmp(&candidates[*b].exponent);
    let lowest_order = (0..fits.len()).filter(|&i| listed(&fits[i]) && candidates[i].indistinguishable).min_by(order);
    // A fit that ended at the edge of its range has no errors to go with its parameters.
    let any_good = fits.iter().any(|fit| fit.termination.is_good());
    let preferred = (0..fits.len())
        .filter(|&i| fits[i].termination.is_good() || !any_good)
        .min_by(|a, b| candidates[*a].delta_bic.total_cmp(&candidates[*b].delta_bic));
    OrderSelection {
        lowest_order,
        preferred,
        effective_samples: effective,
        candidates,
    }
}
