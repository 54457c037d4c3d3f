//! Any law fitted to a hold.

use super::fitted::Fitted;
use crate::fit::{Fit, FitError, IntervalMethod, LawOptions, Samples};
use crate::laws::Law;
use crate::optimise::Work;
use crate::watch::{Unwatched, Watch};

/// Fits a law to a hold: no starting values.
///
/// For given nonlinear numbers the law is linear in the others, which are solved for (variable projection, Golub and Pereyra
/// 1973). The nonlinear ones are searched on a coarse grid and refined by damped Gauss–Newton steps, in units of the
/// hold's own duration and range, so that no choice of units changes the answer. Rates are sought from 10⁻³ per duration to 10³ per first
/// sample step.
///
/// An optimum that lies at the edge of what was searched, or that several numbers reach together, is returned with its
/// [`Termination`](crate::fit::Termination) and without errors; nothing that did not converge has any.
///
/// ```
/// use palpate::fit::{LawOptions, Samples, fit_law};
/// use palpate::laws::Law;
/// // 1 + 2 exp(−t/3) + 4 exp(−t/40)
/// let times: Vec<f64> = (0..400).map(|i| 0.5 * f64::from(i)).collect();
/// let values: Vec<f64> = times.iter().map(|t| 1.0 + 2.0 * (-t / 3.0).exp() + 4.0 * (-t / 40.0).exp()).collect();
/// let fit = fit_law(&Samples::new(&times, &values), Law::Prony { terms: 2 }, &LawOptions::default())?;
/// assert!((fit.value("time_1").unwrap() - 3.0).abs() < 1e-8);
/// assert!((fit.value("amplitude_2").unwrap() - 4.0).abs() < 1e-8);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for samples that no law can be fitted to, for a law without a form for the response, and for options that name a number
/// the law does not have.
pub fn fit_law(samples: &Samples<'_>, law: Law, options: &LawOptions) -> Result<Fit, FitError> {
    fit_law_watched(samples, law, options, &mut Unwatched)
}

/// [`fit_law`] with a watch, which intervals by profiles and by resampling are long enough for.
///
/// # Errors
/// As [`fit_law`], and [`FitError::Cancelled`].
pub fn fit_law_watched(
    samples: &Samples<'_>,
    law: Law,
    options: &LawOptions,
    watch: &mut dyn Watch,
) -> Result<Fit, FitError> {
    let mut work = Work::default();
    let mut fitted = Fitted::new(samples, law, options, &mut work)?;
    let mut fit = fitted.report(law, options, work);
    match options.intervals {
        IntervalMethod::Curvature => {}
        IntervalMethod::Profile => fitted.profile(&mut fit, options, watch)?,
        IntervalMethod::Bootstrap(how) => {
            let drawn = fitted.resample(&fit, options, &how, watch)?;
            fit.parameters.iter_mut().zip(drawn.numbers).for_each(|(parameter, (_, drawn))| {
                parameter.estimate = drawn;
            });
        }
    }
    Ok(fit)
}
