//! The closed form of the law fitted to a signal over time: y(t) = y_e + Δ φ(t; λ, n).

use super::estimates::{Domain, Estimate, LatencyFit};
use super::law_fit::{LawFit, fit_law};
use super::samples::Samples;
use super::{FitError, FitOptions, LawOptions};
use crate::laws::{ExponentChoice, Law};

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
/// [`Termination::RateAtBound`](super::Termination::RateAtBound), with no errors, because the data then leave the law open.
///
/// ```
/// use palpate::fit::{ExponentChoice, FitOptions, fit_hold};
/// // 0.2 + 0.1 (1 + 4 · 0.5 t)^(-1/4): n = 5, λ = 0.5 per second
/// let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
/// let values: Vec<f64> = times.iter().map(|t| 0.2 + 0.1 * (1.0 + 2.0 * t).powf(-0.25)).collect();
/// let fit = fit_hold(&times, &values, ExponentChoice::Free, &FitOptions::default())?;
/// assert!((fit.exponent.value - 5.0).abs() < 1e-6);
/// assert!((fit.equilibrium.value - 0.2).abs() < 1e-8);
/// // v = λ/Δ⁴
/// assert!((fit.rate_coefficient.value / 5000.0 - 1.0).abs() < 1e-4);
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
    options.check()?;
    if let ExponentChoice::Fixed(n) = choice
        && !(n.is_finite() && n > 0.0)
    {
        return Err(FitError::Exponent { found: n });
    }
    let mut law_options = LawOptions {
        confidence: options.confidence,
        most_iterations: options.most_iterations,
        ..LawOptions::default()
    };
    if choice == ExponentChoice::Free {
        law_options.bounds.push(("exponent".to_owned(), options.exponent_range));
    }
    let fit = fit_law(&Samples::new(times, values), Law::Latency { exponent: choice }, &law_options)?;
    Ok(LatencyFit::from_law(fit, choice))
}

impl LatencyFit {
    /// A fit of the latency law read as what it is.
    fn from_law(fit: LawFit, choice: ExponentChoice) -> Self {
        let estimate = |name: &str| fit.estimate(name).copied().unwrap_or(Estimate::fixed(f64::NAN));
        Self {
            domain: Domain::Time,
            choice,
            exponent: match choice {
                ExponentChoice::Fixed(n) => Estimate::fixed(n),
                ExponentChoice::Free => estimate("exponent"),
            },
            equilibrium: estimate("equilibrium"),
            amplitude: estimate("amplitude"),
            relative_rate: estimate("relative_rate"),
            rate_coefficient: estimate("rate_coefficient"),
            covariance: fit.covariance,
            residual_square: fit.residual_square,
            rmse: fit.rmse,
            residual_correlation: fit.residual_correlation,
            noise: fit.noise,
            samples: fit.samples,
            termination: fit.termination,
            work: fit.work,
        }
    }
}
