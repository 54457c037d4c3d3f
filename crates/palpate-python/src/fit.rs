//! Laws fitted to holds.

use std::borrow::Cow;

use numpy::{PyArray1, PyArray2};
use palpate::fit::{
    BootstrapOptions, Estimate, Fit, IntervalMethod, LawOptions, Loss, NoiseChoice, NumberUnit, SampleChoice, Samples,
    fit_law,
};
use palpate::laws::{Law, Response};
use palpate::number::{significant, with_error};
use palpate_report::result::word;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};

use crate::arrays::doubles;
use crate::errors::{FitError, OptionError, refused_plainly, unfitted};
use crate::work::{Made, briefly};

/// A number that was found or given.
#[pyclass(name = "Estimate", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(crate) struct PyEstimate {
    pub(crate) estimate: Estimate,
    pub(crate) unit: Cow<'static, str>,
}

#[pymethods]
impl PyEstimate {
    /// The best value.
    #[getter]
    fn value(&self) -> f64 {
        self.estimate.value
    }

    /// Standard error for white noise; None for a number that was given, or that the data leave open.
    #[getter]
    fn standard_error(&self) -> Option<f64> {
        self.estimate.standard_error
    }

    /// Confidence interval for noise as the residuals show it.
    #[getter]
    fn interval(&self) -> Option<(f64, f64)> {
        self.estimate.interval
    }

    /// Unit in words: "signal", "s", "1/s", "signal/s", "1", "signal^(1-n)/s", "signal/s^alpha"; "m", "N" or "Pa" of a material.
    #[getter]
    fn unit(&self) -> &str {
        &self.unit
    }

    fn __float__(&self) -> f64 {
        self.estimate.value
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        let (estimate, unit) = serde_json::from_str(json).map_err(refused_plainly::<FitError>)?;
        Ok(Self { estimate, unit })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        let json = serde_json::to_string(&(self.estimate, &self.unit)).map_err(refused_plainly::<FitError>)?;
        Ok((py.get_type::<Self>().getattr("_from_json")?, (json,)))
    }

    fn __repr__(&self) -> String {
        match self.estimate.standard_error {
            Some(error) => with_error(self.estimate.value, error),
            None => significant(self.estimate.value, 6),
        }
    }
}

fn unit_word(unit: NumberUnit) -> &'static str {
    match unit {
        NumberUnit::Signal => "signal",
        NumberUnit::Second => "s",
        NumberUnit::PerSecond => "1/s",
        NumberUnit::SignalPerSecond => "signal/s",
        NumberUnit::One => "1",
        NumberUnit::RateCoefficient => "signal^(1-n)/s",
        NumberUnit::SignalPerPower => "signal/s^alpha",
    }
}

/// A law fitted to a hold: estimates with errors and intervals, covariance, why it ended.
///
/// Examples
/// --------
/// >>> import numpy as np, palpate
/// >>> t = np.linspace(0.0, 40.0, 400)
/// >>> fit = palpate.fit_hold(t, 1 + 2 * np.exp(-t / 8), law="standard-linear-solid")
/// >>> fit.estimates["time"].unit, fit.is_good, round(float(fit.predict([80.0])[0]), 4)
/// ('s', True, 1.0001)
#[pyclass(name = "Fit", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(crate) struct PyFit {
    fit: Fit,
}

fn unequal(what: &str, found: usize, times: usize) -> PyErr {
    refused_plainly::<FitError>(format!("a fit needs as many {what} as times, found {found} and {times}"))
}

impl PyFit {
    fn json(&self) -> PyResult<String> {
        serde_json::to_string(&self.fit).map_err(refused_plainly::<FitError>)
    }

    fn with_confidence(&self, confidence: f64) -> PyResult<Fit> {
        if !(confidence > 0.0 && confidence < 1.0) {
            let message = format!("an interval covers a share between 0 and 1, found {confidence}");
            return Err(refused_plainly::<OptionError>(message));
        }
        let mut fit = self.fit.clone();
        if let Some(uncertainty) = &mut fit.uncertainty {
            uncertainty.confidence = confidence;
        }
        Ok(fit)
    }
}

#[pymethods]
impl PyFit {
    /// Name of the law, such as "latency" or "prony:2".
    #[getter]
    fn law(&self) -> String {
        self.fit.law.to_string()
    }

    /// Every number of the law by its name.
    #[getter]
    fn estimates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for number in &self.fit.parameters {
            let estimate = PyEstimate {
                estimate: number.estimate,
                unit: unit_word(number.unit).into(),
            };
            dict.set_item(number.name.to_string(), estimate)?;
        }
        Ok(dict)
    }

    /// Values of all numbers by name.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for number in &self.fit.parameters {
            dict.set_item(number.name.to_string(), number.estimate.value)?;
        }
        Ok(dict)
    }

    /// Intervals by profiles, where these were asked for, by name; None for an end that the data leave open.
    #[getter]
    fn profiles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, interval) in &self.fit.profiles {
            dict.set_item(name.to_string(), (interval.low, interval.high))?;
        }
        Ok(dict)
    }

    /// Names of the numbers that were searched, in the order of `covariance`.
    #[getter]
    fn parameters(&self) -> Vec<String> {
        self.fit.searched.clone()
    }

    /// Covariance of the searched numbers; None where the data leave one open.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.fit.covariance.as_ref().map(|rows| Ok(PyArray2::from_vec2(py, rows)?)).transpose()
    }

    /// Correlations of the searched numbers.
    #[getter]
    fn correlation<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.fit.correlation().as_ref().map(|rows| Ok(PyArray2::from_vec2(py, rows)?)).transpose()
    }

    /// Sum of squared residuals, weighted as the samples were.
    #[getter]
    fn residual_square(&self) -> f64 {
        self.fit.residual_square
    }

    /// Root mean square residual, in the unit of the signal.
    #[getter]
    fn rmse(&self) -> f64 {
        self.fit.rmse
    }

    /// Correlation of neighbouring residuals.
    #[getter]
    fn residual_correlation(&self) -> f64 {
        self.fit.residual_correlation
    }

    /// Samples fitted.
    #[getter]
    fn samples(&self) -> usize {
        self.fit.samples
    }

    /// Time from the first to the last sample, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.fit.duration
    }

    /// Why the fit ended: "converged", or what kept it from that.
    #[getter]
    fn termination(&self) -> String {
        word(self.fit.termination)
    }

    /// Whether it ended at an optimum inside the range that was searched.
    #[getter]
    fn is_good(&self) -> bool {
        self.fit.termination.is_good()
    }

    /// The signal at times after the first sample; with `interval`, also its confidence band.
    ///
    /// Parameters
    /// ----------
    /// elapsed_s : array_like, shape (N,)
    ///     Time since the start of the hold, s; before it the signal is that at the start, at NaN it is NaN.
    /// interval : float, optional
    ///     Coverage of the band, between 0 and 1.
    /// of : str
    ///     Band of the "curve", or of a "sample" with the noise of the fitted ones.
    ///
    /// Returns
    /// -------
    /// ndarray, shape (N,), or three of them
    ///     The curve; with `interval` the curve, the lower and the upper end of the band.
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     A coverage that is no share, a word that is none of the two.
    #[pyo3(signature = (elapsed_s, *, interval=None, of="curve"))]
    fn predict<'py>(
        &self,
        py: Python<'py>,
        elapsed_s: &Bound<'py, PyAny>,
        interval: Option<f64>,
        of: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let elapsed = doubles(elapsed_s, "elapsed_s")?;
        let sample = match of {
            "curve" => false,
            "sample" => true,
            other => {
                let message = format!("of is \"curve\" or \"sample\", found {other:?}");
                return Err(refused_plainly::<OptionError>(message));
            }
        };
        let Some(confidence) = interval else {
            let values = briefly(py, || self.fit.predict_many(&elapsed))?;
            return Ok(PyArray1::from_vec(py, values).into_any());
        };
        let fit = self.with_confidence(confidence)?;
        let estimate = |t: &f64| if sample { fit.predict_sample(*t) } else { fit.predict_interval(*t) };
        let mut estimates: Vec<Estimate> = Vec::with_capacity(elapsed.len());
        for some in elapsed.chunks(AT_ONCE) {
            // A band of millions of samples takes seconds: Ctrl-C is heard in between.
            py.check_signals()?;
            briefly(py, || estimates.extend(some.iter().map(estimate)))?;
        }
        let column = |pick: fn(&Estimate) -> f64| PyArray1::from_iter(py, estimates.iter().map(pick));
        let value = column(|estimate| estimate.value);
        let low = column(|estimate| estimate.interval.map_or(f64::NAN, |interval| interval.0));
        let high = column(|estimate| estimate.interval.map_or(f64::NAN, |interval| interval.1));
        Ok((value, low, high).into_pyobject(py)?.into_any())
    }

    /// The fit as text, in the manner of lmfit.
    fn report(&self) -> String {
        let fit = &self.fit;
        let mut out = format!(
            "[[Model]]\n    {}\n[[Fit Statistics]]\n    # data points      = {}\n    # variables        = {}\n    chi-square         = {}\n    root mean square   = {}\n    ended              = {}\n[[Variables]]\n",
            fit.law,
            fit.samples,
            fit.free_numbers(),
            significant(fit.residual_square, 6),
            significant(fit.rmse, 6),
            word(fit.termination),
        );
        let width = fit.parameters.iter().map(|number| number.name.to_string().len()).max().unwrap_or(0) + 1;
        for number in &fit.parameters {
            let (name, estimate) = (format!("{}:", number.name), &number.estimate);
            let value = significant(estimate.value, 8);
            let error = match estimate.standard_error {
                Some(error) if estimate.value != 0.0 => {
                    let share = 100.0 * (error / estimate.value).abs();
                    format!(" +/- {} ({share:.2}%)", significant(error, 6))
                }
                Some(error) => format!(" +/- {}", significant(error, 6)),
                None => String::new(),
            };
            out.push_str(&format!("    {name:<width$} {value}{error}\n"));
        }
        if let Some(rows) = fit.correlation() {
            let mut pairs: Vec<(f64, String)> = Vec::new();
            for (i, row) in rows.iter().enumerate() {
                for (j, entry) in row.iter().enumerate().skip(i + 1) {
                    pairs.push((*entry, format!("C({}, {})", fit.searched[i], fit.searched[j])));
                }
            }
            pairs.retain(|(entry, _)| entry.abs() >= 0.1);
            pairs.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
            if !pairs.is_empty() {
                out.push_str("[[Correlations]] (unreported correlations are < 0.100)\n");
            }
            for (entry, pair) in pairs {
                out.push_str(&format!("    {pair} = {entry:+.4}\n"));
            }
        }
        out
    }

    /// Everything about the fit as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (self.json()?,))
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        let fit = serde_json::from_str(json).map_err(refused_plainly::<FitError>)?;
        Ok(Self { fit })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        let make = py.get_type::<Self>().getattr("_from_json")?;
        Ok((make, (self.json()?,)))
    }

    fn __repr__(&self) -> String {
        let numbers = self.fit.parameters.iter().map(|number| {
            let estimate = &number.estimate;
            let value = match estimate.standard_error {
                Some(error) => with_error(estimate.value, error),
                None => significant(estimate.value, 4),
            };
            format!("{}={value}", number.name)
        });
        let numbers: Vec<String> = numbers.collect();
        format!("<palpate.Fit {}: {}; {}>", self.fit.law, numbers.join(", "), word(self.fit.termination))
    }
}

/// Samples whose bands are computed in some milliseconds.
const AT_ONCE: usize = 10_000;

/// Options of a fit as keywords say them.
#[derive(Clone)]
pub(crate) struct Asked {
    pub(crate) law: Law,
    pub(crate) options: LawOptions,
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
}

impl Keywords {
    pub(crate) fn asked(self) -> PyResult<Asked> {
        let word = |name: &str, found: &str, known: &str| {
            refused_plainly::<OptionError>(format!("{name} is one of {known}, found {found:?}"))
        };
        let law = self.law.parse().map_err(refused_plainly::<OptionError>)?;
        if law == Law::Spectrum {
            let message = "the spectrum has no few numbers to estimate: palpate.compare fits and judges it";
            return Err(refused_plainly::<OptionError>(message));
        }
        let response = match self.response.as_str() {
            "relaxation" => Response::Relaxation,
            "creep" => Response::Creep,
            other => return Err(word("response", other, "\"relaxation\", \"creep\"")),
        };
        let loss = match self.loss.as_str() {
            "squares" => Loss::Squares,
            "huber" => Loss::Huber,
            "tukey" => Loss::Tukey,
            other => return Err(word("loss", other, "\"squares\", \"huber\", \"tukey\"")),
        };
        let noise = match self.noise.as_str() {
            "residuals" => NoiseChoice::FromResiduals,
            "white" => NoiseChoice::White,
            other => return Err(word("noise", other, "\"residuals\", \"white\"")),
        };
        let intervals = match self.intervals.as_str() {
            "curvature" => IntervalMethod::Curvature,
            "profile" => IntervalMethod::Profile,
            "bootstrap" => IntervalMethod::Bootstrap(BootstrapOptions::default()),
            other => return Err(word("intervals", other, "\"curvature\", \"profile\", \"bootstrap\"")),
        };
        let options = LawOptions {
            response,
            intervals,
            fixed: self.fixed.unwrap_or_default(),
            bounds: self.bounds.unwrap_or_default(),
            loss,
            noise,
            samples: self.log_spaced.map_or(SampleChoice::All, SampleChoice::LogSpaced),
            confidence: self.confidence,
            ..LawOptions::default()
        };
        options.suit(law).map_err(unfitted)?;
        Ok(Asked { law, options })
    }
}

/// Standard deviations that weights, their inverses, stand for.
pub(crate) fn deviations(weights: &[f64]) -> Result<Vec<f64>, String> {
    match weights.iter().position(|weight| !(weight.is_finite() && *weight >= 0.0)) {
        Some(index) => {
            let found = weights[index];
            Err(format!("weights: expected 1/σ, finite and 0 or more, found {found} at index {index}"))
        }
        None => Ok(weights.iter().map(|weight| weight.recip()).collect()),
    }
}

/// Those of one column of weights.
pub(crate) fn deviations_of(weights: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Vec<f64>>> {
    let weights = weights.map(|weights| doubles(weights, "weights")).transpose()?;
    weights.map(|weights| deviations(&weights).map_err(refused_plainly::<OptionError>)).transpose()
}

/// One fit, of samples that are there.
pub(crate) fn fitted(
    times: &[f64],
    values: &[f64],
    deviations: Option<&[f64]>,
    asked: &Asked,
) -> Result<Fit, palpate::fit::FitError> {
    let samples = Samples::new(times, values);
    let samples = deviations.map_or(samples, |deviations| samples.with_deviations(deviations));
    fit_law(&samples, asked.law, &asked.options)
}

#[pyfunction]
pub(crate) fn fit_hold<'py>(
    py: Python<'py>,
    time_s: &Bound<'py, PyAny>,
    signal: &Bound<'py, PyAny>,
    weights: Option<&Bound<'py, PyAny>>,
    keywords: Keywords,
) -> PyResult<PyFit> {
    let (times, values) = (doubles(time_s, "time_s")?, doubles(signal, "signal")?);
    let deviations = deviations_of(weights)?;
    if let Some(deviations) = deviations.as_ref().filter(|deviations| deviations.len() != times.len()) {
        return Err(unequal("weights", deviations.len(), times.len()));
    }
    let asked = keywords.asked()?;
    let fit = briefly(py, || fitted(&times, &values, deviations.as_deref(), &asked))?;
    Ok(PyFit {
        fit: fit.map_err(unfitted)?,
    })
}
