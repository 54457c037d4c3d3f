//! One hold as a call states it, and its fit.

use palpate::fit::{
    BootstrapOptions, Fit, IntervalMethod, LawOptions, Loss, NoiseChoice, SampleChoice, Samples, fit_law_watched,
};
use palpate::laws::Law;
use palpate::watch::{Unwatched, Watch};
use pyo3::prelude::*;

use crate::arrays::doubles;
use crate::errors::{FitError, OptionError, choice, one_of, refused_plainly, unfitted};
use crate::fits::fit::{FirstDate, PyFit};
use crate::work::{at_length, briefly};

/// What intervals rest on, as a keyword says it.
pub(crate) fn intervals(name: &str) -> PyResult<IntervalMethod> {
    let ways = [
        IntervalMethod::Automatic,
        IntervalMethod::Curvature,
        IntervalMethod::Profile,
        IntervalMethod::Bootstrap(BootstrapOptions::USUAL),
    ];
    one_of("intervals", &ways.map(|way| (way.name(), way)), name)
}

/// The loss of residuals, as a keyword says it.
pub(crate) fn loss(name: &str) -> PyResult<Loss> {
    choice("loss", &["squares", "huber", "tukey"], name)
}

/// Options of a fit as keywords say them.
#[derive(Clone)]
pub(crate) struct Requested {
    pub(crate) law: Law,
    pub(crate) options: LawOptions,
    /// Whether samples that lack a number are left out.
    pub(crate) omit_nan: bool,
}

/// What the keywords of `fit_hold` and `fit_many` say.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Keywords {
    law: String,
    response: String,
    fixed: Option<Vec<(String, f64)>>,
    bounds: Option<Vec<(String, (f64, f64))>>,
    loss: String,
    noise: String,
    confidence: f64,
    log_spaced: Option<usize>,
    intervals: String,
    nan: String,
}

impl Keywords {
    pub(crate) fn requested(self) -> PyResult<Requested> {
        let law = self.law.parse().map_err(refused_plainly::<OptionError>)?;
        if law == Law::Spectrum {
            let message = "the spectrum has no few parameters to estimate: palpate.compare fits and judges it";
            return Err(refused_plainly::<OptionError>(message));
        }
        let noises = [("residuals", NoiseChoice::FromResiduals), ("white", NoiseChoice::White)];
        let options = LawOptions {
            response: choice("response", &["relaxation", "creep"], &self.response)?,
            loss: loss(&self.loss)?,
            noise: one_of("noise", &noises, &self.noise)?,
            intervals: intervals(&self.intervals)?,
            fixed: self.fixed.unwrap_or_default(),
            bounds: self.bounds.unwrap_or_default(),
            samples: self.log_spaced.map_or(SampleChoice::All, SampleChoice::LogSpaced),
            confidence: self.confidence,
            ..LawOptions::default()
        };
        options.suit(law).map_err(unfitted)?;
        let omit_nan = one_of("nan", &[("raise", false), ("omit", true)], &self.nan)?;
        Ok(Requested { law, options, omit_nan })
    }
}

/// Standard deviations that weights, their inverses, stand for; with `omit_nan` that of a weight that is missing is too.
pub(crate) fn standard_deviations(weights: &[f64], omit_nan: bool) -> Result<Vec<f64>, String> {
    let is_known = |weight: &f64| (weight.is_finite() && *weight >= 0.0) || (omit_nan && weight.is_nan());
    match weights.iter().position(|weight| !is_known(weight)) {
        Some(index) => {
            let found = weights[index];
            Err(format!("weights: expected 1/σ, finite and 0 or more, found {found} at index {index}"))
        }
        None => Ok(weights.iter().map(|weight| weight.recip()).collect()),
    }
}

/// Those of one column of weights.
pub(crate) fn standard_deviations_of(weights: Option<&Bound<'_, PyAny>>, omit_nan: bool) -> PyResult<Option<Vec<f64>>> {
    let weights = weights.map(|weights| doubles(weights, "weights")).transpose()?;
    weights
        .map(|weights| standard_deviations(&weights, omit_nan).map_err(refused_plainly::<OptionError>))
        .transpose()
}

/// The columns without the rows in which any of them is NaN; columns of different lengths stay, for the fit to refuse.
pub(crate) fn without_nan(columns: &mut [&mut Vec<f64>]) {
    let Some(rows) = columns.first().map(|column| column.len()) else {
        return;
    };
    if columns.iter().any(|column| column.len() != rows) {
        return;
    }
    let kept: Vec<bool> = (0..rows).map(|row| columns.iter().all(|column| !column[row].is_nan())).collect();
    for column in columns {
        let mut kept = kept.iter();
        column.retain(|_| kept.next().is_some_and(|kept| *kept));
    }
}

/// Up to so many samples are fitted in a few milliseconds, without a thread.
const BRIEF: usize = 20_000;

/// About so many times as long as the fit a profile may take.
const FITS_OF_A_PROFILE: usize = 10;

/// Samples, with a standard deviation for each if they have some.
pub(crate) fn samples_of<'a>(
    times: &'a [f64],
    values: &'a [f64],
    standard_deviations: Option<&'a [f64]>,
) -> Samples<'a> {
    Samples {
        standard_deviations,
        ..Samples::new(times, values)
    }
}

/// One fit, of samples that are there.
pub(crate) fn fitted(
    times: &[f64],
    values: &[f64],
    standard_deviations: Option<&[f64]>,
    requested: &Requested,
    watch: &mut dyn Watch,
) -> Result<Fit, palpate::fit::FitError> {
    let samples = samples_of(times, values, standard_deviations);
    let fit = fit_law_watched(&samples, requested.law, &requested.options, watch)?;
    Ok(fit.within(&requested.options.bounds))
}

#[pyfunction]
pub(crate) fn fit_hold<'py>(
    py: Python<'py>,
    time_s: &Bound<'py, PyAny>,
    signal: &Bound<'py, PyAny>,
    weights: Option<&Bound<'py, PyAny>>,
    keywords: Keywords,
    first_date: Option<FirstDate>,
) -> PyResult<PyFit> {
    let (mut times, mut values) = (doubles(time_s, "time_s")?, doubles(signal, "signal")?);
    let requested = keywords.requested()?;
    let mut standard_deviations = standard_deviations_of(weights, requested.omit_nan)?;
    if let Some(standard_deviations) =
        standard_deviations.as_ref().filter(|standard_deviations| standard_deviations.len() != times.len())
    {
        let (weights, times) = (standard_deviations.len(), times.len());
        let message = format!("a fit needs as many weights as times, found {weights} and {times}");
        return Err(refused_plainly::<FitError>(message));
    }
    if requested.omit_nan {
        let columns = [&mut times, &mut values].into_iter().chain(&mut standard_deviations);
        without_nan(&mut columns.collect::<Vec<_>>());
    }
    let is_brief = match requested.options.intervals {
        IntervalMethod::Curvature => times.len() <= BRIEF,
        IntervalMethod::Automatic => times.len() <= BRIEF / FITS_OF_A_PROFILE,
        IntervalMethod::Profile | IntervalMethod::Bootstrap(_) => false,
    };
    let fit = move |watch: &mut dyn Watch| {
        let fit = fitted(&times, &values, standard_deviations.as_deref(), &requested, watch)?;
        let weights = standard_deviations.map(|found| found.iter().map(|deviation| deviation.recip()).collect());
        Ok(PyFit::new(fit, (times, values, weights), &requested.options, first_date))
    };
    let fit = match is_brief {
        true => briefly(py, || fit(&mut Unwatched))?,
        false => at_length(py, move |mut heard| fit(&mut heard))?,
    };
    fit.map_err(unfitted)
}
