//! The latency law fitted to a signal over time: y(t) = y_e + Δ φ(t; λ, n).

use std::ops::Deref;

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
/// [`FitError`] for unequal lengths, fewer samples than numbers plus one, values that are not finite, times that do not
/// rise, an exponent that is no number above zero, or values that are all the same.
pub fn fit_hold(
    times: &[f64],
    values: &[f64],
    choice: ExponentChoice,
    options: &FitOptions,
) -> Result<LatencyFit, FitError> {
    fit_hold_watched(times, values, choice, options, &mut Unwatched)
}

/// [`fit_hold`] with a watch, which intervals by profiles and by resampling are long enough for.
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
    numbers: [Estimate; 5],
}

impl LatencyFit {
    /// Reads a fit of the latency law; `None` if it is one of another law.
    #[must_use]
    pub fn new(fit: Fit) -> Option<Self> {
        let Law::Latency { exponent: choice } = fit.law else {
            return None;
        };
        let number = |kind: ParameterKind| fit.parameter(kind).map(|parameter| parameter.estimate);
        let numbers = [
            number(ParameterKind::Equilibrium)?,
            number(ParameterKind::Amplitude)?,
            number(ParameterKind::RelativeRate)?,
            number(ParameterKind::RateCoefficient)?,
            match choice {
                ExponentChoice::Fixed(n) => Estimate::fixed(n),
                ExponentChoice::Free => number(ParameterKind::Exponent)?,
            },
        ];
        Some(Self { fit, choice, numbers })
    }

    /// Whether n was given.
    #[must_use]
    pub fn choice(&self) -> ExponentChoice {
        self.choice
    }

    /// n.
    #[must_use]
    pub fn exponent(&self) -> Estimate {
        self.numbers[4]
    }

    /// y_e, the value that the signal tends to.
    #[must_use]
    pub fn equilibrium(&self) -> Estimate {
        self.numbers[0]
    }

    /// Δ = y(0) − y_e, the excess at the start of the fit.
    #[must_use]
    pub fn amplitude(&self) -> Estimate {
        self.numbers[1]
    }

    /// λ = v |Δ|ⁿ⁻¹ in 1/s, the relative rate at the start.
    #[must_use]
    pub fn relative_rate(&self) -> Estimate {
        self.numbers[2]
    }

    /// v in 1/s (in units of signal^(1−n)/s if the signal is not strain).
    #[must_use]
    pub fn rate_coefficient(&self) -> Estimate {
        self.numbers[3]
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
