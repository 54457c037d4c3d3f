//! Any law fitted to a hold.

use super::robust::{near, without_far};
use crate::fit::{Fit, FitError, Fitted, IntervalMethod, LawOptions, Loss, SampleChoice, Samples, build, search};
use crate::laws::Law;
use crate::optimise::Effort;
use crate::watch::{Unwatched, Watch};

/// Fits a law to a hold: no starting values.
///
/// For given nonlinear parameters the law is linear in the others, which are solved for (variable projection, Golub and Pereyra
/// 1973). The nonlinear ones are searched on a coarse grid and refined by damped Gauss–Newton steps, in units of the
/// hold's own duration and range, so that no choice of units changes the answer. Rates are sought from 10⁻³ per duration to 10³ per first
/// sample step.
///
/// An optimum that lies at the edge of what was searched, or that several parameters reach together, is returned with its
/// [`Termination`](crate::fit::Termination) and without errors; nothing that did not converge has any.
///
/// ```
/// use palpate::fit::{LawOptions, Samples, fit_law};
/// use palpate::laws::Law;
/// // 1 + 2 exp(−t/3) + 4 exp(−t/40)
/// let times: Vec<f64> = (0..400).map(|i| 0.5 * f64::from(i)).collect();
/// let values: Vec<f64> = times.iter().map(|t| 1.0 + 2.0 * (-t / 3.0).exp() + 4.0 * (-t / 40.0).exp()).collect();
/// let fit = fit_law(&Samples::new(&times, &values), Law::Prony { terms: 2 }, &LawOptions::default())?;
/// assert!((fit.value("time_constant_1_s").unwrap() - 3.0).abs() < 1e-8);
/// assert!((fit.value("amplitude_2").unwrap() - 4.0).abs() < 1e-8);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for samples that no law can be fitted to, for a law without a form for the response, and for options that name a parameter
/// the law does not have.
pub fn fit_law(samples: &Samples<'_>, law: Law, options: &LawOptions) -> Result<Fit, FitError> {
    fit_law_watched(samples, law, options, &mut Unwatched)
}

/// [`fit_law`] with a watch, which hears of every evaluation of the law over the samples.
///
/// # Errors
/// As [`fit_law`], and [`FitError::Cancelled`].
pub fn fit_law_watched(
    samples: &Samples<'_>,
    law: Law,
    options: &LawOptions,
    watch: &mut dyn Watch,
) -> Result<Fit, FitError> {
    Effort::watched(watch, |effort| found(samples, law, options, effort))
}

fn found(samples: &Samples<'_>, law: Law, options: &LawOptions, effort: &mut Effort<'_>) -> Result<Fit, FitError> {
    let mut fitted = Fitted::new(samples, law, options, effort)?;
    let mut fit = fitted.report(law, options, effort)?;
    match options.intervals {
        IntervalMethod::Automatic if fitted.bends(&fit) => fitted.profile(&mut fit, options, effort)?,
        IntervalMethod::Automatic | IntervalMethod::Curvature => {}
        IntervalMethod::Profile => fitted.profile(&mut fit, options, effort)?,
        IntervalMethod::Bootstrap(how) => {
            let drawn = fitted.resample(&fit, options, &how, effort)?;
            fit.parameters.iter_mut().zip(drawn).for_each(|(parameter, drawn)| parameter.estimate = drawn);
            fit.interval_method = options.intervals;
        }
    }
    Ok(fit)
}

impl Fitted {
    /// Finds the parameters of a law.
    pub(crate) fn new(
        samples: &Samples<'_>,
        law: Law,
        options: &LawOptions,
        effort: &mut Effort<'_>,
    ) -> Result<Self, FitError> {
        let form = options.form(law)?;
        let chosen = chosen(samples, options.samples)?;
        let samples = &chosen.samples(samples);
        let mut fitted = match options.loss {
            Loss::Squares => {
                let (model, scaled) = build(form, samples, options)?;
                let solution = search(&model, &scaled, options.most_iterations, effort)?.ok_or(FitError::NoDecay)?;
                Self {
                    model,
                    scaled,
                    solution,
                    counted: None,
                }
            }
            Loss::Huber | Loss::Tukey => {
                let nearer = without_far(samples.values);
                let values = nearer.as_deref().unwrap_or(samples.values);
                let (model, nearer) = build(form, &Samples { values, ..*samples }, options)?;
                let all = nearer.of(samples);
                let near = near(&nearer, &all, model.linear() + model.free().len());
                Self::resisting(&model, all, near.as_ref(), options, effort)?
            }
        };
        fitted.arrange();
        Ok(fitted)
    }
}

/// Samples that were picked, if not all.
struct Chosen(Option<[Vec<f64>; 3]>);

impl Chosen {
    fn samples<'a>(&'a self, all: &Samples<'a>) -> Samples<'a> {
        match &self.0 {
            None => *all,
            Some([times, values, standard_deviations]) => Samples {
                times,
                values,
                standard_deviations: all.standard_deviations.map(|_| standard_deviations.as_slice()),
            },
        }
    }
}

fn chosen(samples: &Samples<'_>, choice: SampleChoice) -> Result<Chosen, FitError> {
    let SampleChoice::LogSpaced(count) = choice else {
        return Ok(Chosen(None));
    };
    samples.check(1)?;
    let times = samples.times;
    let mut kept = vec![0];
    let (first, last) = (times[1] - times[0], times[times.len() - 1] - times[0]);
    for i in 0..count.max(2) {
        let at = first * (last / first).powf(i as f64 / (count.max(2) - 1) as f64);
        let after = times.partition_point(|t| t - times[0] < at).min(times.len() - 1);
        let before =
            after - usize::from(after > 1 && at - (times[after - 1] - times[0]) < times[after] - times[0] - at);
        if kept.last().is_some_and(|last| *last < before) {
            kept.push(before);
        }
    }
    let pick = |column: &[f64]| kept.iter().map(|i| column[*i]).collect::<Vec<f64>>();
    let standard_deviations = samples.standard_deviations.map_or_else(Vec::new, pick);
    Ok(Chosen(Some([pick(times), pick(samples.values), standard_deviations])))
}
