//! A law fitted to a hold, with its samples.

use numpy::{PyArray1, PyArray2};
use palpate::analysis::unexplained_noise;
use palpate::fit::{Estimate, Fit, LawOptions, Parameter, ParameterRole};
use palpate::forecast::{Criteria, criteria};
use palpate::number::significant;
use palpate_report::result::word;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyList};
use serde::{Deserialize, Serialize};

use crate::arrays::{array, doubles};
use crate::errors::{OptionError, refused_plainly};
use crate::fits::estimate::{PyEstimate, reported, unit_word};
use crate::shown::shown;
use crate::table::Table;
use crate::work::{briefly, plain};

/// A law fitted to a hold: estimates with errors and intervals, covariance, why it ended.
///
/// Examples
/// --------
/// >>> import numpy as np, palpate
/// >>> t = np.linspace(0.0, 40.0, 400)
/// >>> fit = palpate.fit_hold(t, 1 + 2 * np.exp(-t / 8), law="standard-linear-solid")
/// >>> fit.estimates["time_constant_s"].unit, fit.is_good, round(float(fit.predict([80.0])[0]), 4)
/// ('s', True, 1.0001)
#[pyclass(name = "Fit", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts")]
pub(crate) struct PyFit {
    fit: Fit,
    samples: Fitted,
    bounds: Vec<Bounds>,
    fixed: Vec<(String, f64)>,
    first_date: Option<FirstDate>,
}

/// A date in ns since 1970, and whether it has a time zone.
pub(crate) type FirstDate = (i64, bool);

/// Both ends of what a parameter could be, by its name; none where an end was open.
type Bounds = (String, [Option<f64>; 2]);

/// The samples of a fit, one column each; weights are 1/σ.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
struct Fitted {
    times: Vec<f64>,
    values: Vec<f64>,
    weights: Option<Vec<f64>>,
}

/// What a pickle holds of a fit.
#[derive(Deserialize)]
struct Parts {
    fit: Fit,
    samples: Fitted,
    #[serde(default)]
    bounds: Vec<Bounds>,
    #[serde(default)]
    fixed: Vec<(String, f64)>,
    #[serde(default)]
    first_date: Option<FirstDate>,
}

impl TryFrom<Parts> for PyFit {
    type Error = &'static str;

    fn try_from(parts: Parts) -> Result<Self, Self::Error> {
        let Parts {
            fit,
            samples,
            bounds,
            fixed,
            first_date,
        } = parts;
        let count = samples.times.len();
        let is_valid = samples.values.len() == count
            && samples.weights.as_ref().is_none_or(|weights| weights.len() == count)
            && fit.samples <= count;
        if is_valid {
            Ok(Self {
                fit,
                samples,
                bounds,
                fixed,
                first_date,
            })
        } else {
            Err("a time and a value for each sample of a fit")
        }
    }
}

impl PyFit {
    /// A fit with its samples, times, values and weights, and what was required of it.
    pub(crate) fn new(
        fit: Fit,
        (times, values, weights): (Vec<f64>, Vec<f64>, Option<Vec<f64>>),
        options: &LawOptions,
        first_date: Option<FirstDate>,
    ) -> Self {
        let end = |end: f64| Some(end).filter(|end| end.is_finite());
        let bounds = options.bounds.iter().map(|(name, (low, high))| (name.clone(), [end(*low), end(*high)]));
        Self {
            fit,
            samples: Fitted { times, values, weights },
            bounds: bounds.collect(),
            fixed: options.fixed.clone(),
            first_date,
        }
    }

    /// A fit to samples at times since `start`, on the clock of that.
    pub(crate) fn since(start: f64, fit: &Fit, elapsed: &[f64], values: &[f64]) -> Self {
        let samples = Fitted {
            times: elapsed.iter().map(|time| start + time).collect(),
            values: values.to_vec(),
            weights: None,
        };
        let mut fit = fit.clone();
        fit.start += start;
        Self {
            fit,
            samples,
            bounds: Vec::new(),
            fixed: Vec::new(),
            first_date: None,
        }
    }

    /// The fitted curve at the times of the samples.
    fn curve(&self) -> Vec<f64> {
        let elapsed: Vec<f64> = self.samples.times.iter().map(|time| time - self.fit.start).collect();
        self.fit.predict_many(&elapsed)
    }

    /// Standard deviations of the noise of samples at these times: that of the root mean square weight over their share of it, between
    /// samples that count as between their two, and beyond them as of the nearest.
    fn deviations(&self, weights: &[f64], elapsed: &[f64]) -> Vec<f64> {
        let mean = self.fit.uncertainty.as_ref().map_or(0.0, |uncertainty| uncertainty.deviation);
        let counting: Vec<(f64, f64)> = self
            .samples
            .times
            .iter()
            .copied()
            .zip(weights.iter().copied())
            .filter(|(_, weight)| *weight > 0.0)
            .collect();
        let squares: f64 = counting.iter().map(|(_, weight)| weight * weight).sum();
        let of_one = mean * (squares / counting.len() as f64).sqrt();
        let at = |elapsed: &f64| {
            let time = elapsed + self.fit.start;
            let after = counting.partition_point(|(there, _)| *there < time);
            let (left, right) = (counting[after.saturating_sub(1)], counting[after.min(counting.len() - 1)]);
            let share = if right.0 > left.0 { (time - left.0) / (right.0 - left.0) } else { 0.0 };
            of_one * (1.0 / left.1 + share * (1.0 / right.1 - 1.0 / left.1))
        };
        elapsed.iter().map(at).collect()
    }

    fn criteria(&self) -> Criteria {
        criteria(self.fit.residual_square, self.fit.samples as f64, self.fit.free_parameters() as f64)
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

/// A square of parameters as an array.
pub(crate) fn square<'py>(py: Python<'py>, rows: &[Vec<f64>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    Ok(PyArray2::from_vec2(py, rows)?)
}

shown! {
    PyFit: self
    arrays {
        /// Times of the samples on their own clock, s.
        time_s: self.samples.times.clone(),
        /// The samples.
        signal: self.samples.values.clone(),
        /// The fitted curve at those times.
        best_fit: self.curve(),
        /// Signal less fitted curve.
        residual: self.samples.values.iter().zip(self.curve()).map(|(value, best)| value - best).collect::<Vec<f64>>(),
    }
    values {
        /// 1/σ of every sample as it was given; None where all count alike.
        weights<'py>(py): Option<Bound<'py, PyArray1<f64>>> =
            self.samples.weights.as_ref().map(|weights| PyArray1::from_slice(py, weights)),
        /// Akaike's information criterion, N ln(RSS/N) + 2p; only differences between laws on the same samples mean anything.
        aic: f64 = self.criteria().aic,
        /// Schwarz's, N ln(RSS/N) + p ln N.
        bic: f64 = self.criteria().bic,
        /// Name of the law, such as "latency" or "prony:2".
        law: String = self.fit.law.to_string(),
        /// What was searched, in the order of `covariance`, with its scale: "equilibrium", "ln relative_rate_per_s", "-ln time_constant_s".
        searched: Vec<String> = self.fit.searched.clone(),
        /// Sum of squared residuals, weighted as the samples were.
        residual_square: f64 = self.fit.residual_square,
        /// Root mean square residual, in the unit of the signal.
        rmse: f64 = self.fit.rmse,
        /// Correlation of neighbouring residuals.
        residual_correlation: f64 = self.fit.residual_correlation,
        /// The noise that the residuals show: "white", "AR(1)", "white and AR(1)", "1/f^1.0" and so on, with ", uneven" where its size
        /// follows the signal or time.
        noise: String = self.fit.noise_in_words(),
        /// Samples that count as independent under that noise.
        effective_samples: f64 = self.fit.effective_samples(),
        /// Probability that this noise leaves such residuals (Ljung and Box, 20 lags); None for fewer than 100 samples and for uneven times.
        noise_p_value: Option<f64> = self.fit.noise_p_value,
        /// Method of the intervals: "curvature", "profile" or "bootstrap".
        interval_method: String = self.fit.interval_method.name().to_owned(),
        /// Samples fitted.
        samples: usize = self.fit.samples,
        /// Time of the first sample on the clock of the samples, s.
        start_s: f64 = self.fit.start,
        /// Time from the first to the last sample, s.
        duration_s: f64 = self.fit.duration,
        /// Why the fit ended: "converged", or what kept it from that.
        termination: String = word(self.fit.termination),
        /// Whether it ended at an optimum inside the range that was searched.
        is_good: bool = self.fit.termination.is_good(),
        /// Every parameter of the law by its name.
        estimates<'py>(py): PyResult<Bound<'py, PyDict>> = {
            let estimate = |parameter: &Parameter| PyEstimate::of(parameter.estimate, unit_word(parameter.unit));
            self.fit.parameters.iter().map(|parameter| (parameter.name.to_string(), estimate(parameter))).into_py_dict(py)
        },
        /// The parameters of the law by name, those that were held included: what its function in `palpate.laws` takes.
        parameters<'py>(py): PyResult<Bound<'py, PyDict>> = self.fit.parameters.iter()
            .filter(|parameter| parameter.role != ParameterRole::Derived)
            .map(|parameter| (parameter.name.to_string(), parameter.estimate.value))
            .into_py_dict(py),
        /// Bounds of parameters as they were given, by name: lower and upper end, None where it is open.
        bounds<'py>(py): PyResult<Bound<'py, PyDict>> =
            self.bounds.iter().map(|(name, [low, high])| (name, (*low, *high))).into_py_dict(py),
        /// Values that parameters were held at with `fixed`, by name.
        fixed<'py>(py): PyResult<Bound<'py, PyDict>> =
            self.fixed.iter().map(|(name, value)| (name, *value)).into_py_dict(py),
        /// Covariance of `searched` for residuals that correlate as they do; None where the data leave a parameter open.
        covariance<'py>(py): PyResult<Option<Bound<'py, PyArray2<f64>>>> =
            self.fit.covariance().map(|rows| square(py, rows)).transpose(),
        /// The same as if the residuals were white noise: what most other software states.
        white_covariance<'py>(py): PyResult<Option<Bound<'py, PyArray2<f64>>>> =
            self.fit.white_covariance.as_ref().map(|rows| square(py, rows)).transpose(),
        /// Correlations of the searched parameters.
        correlation<'py>(py): PyResult<Option<Bound<'py, PyArray2<f64>>>> =
            self.fit.correlation().as_ref().map(|rows| square(py, rows)).transpose(),
    }

    /// The signal at times of the record; with `interval`, also its confidence band.
    ///
    /// Parameters
    /// ----------
    /// time_s : float or array_like, shape (N,), optional
    ///     Time on the clock of the samples that were fitted, s, or a duration on it; dates where the samples had dates, with a
    ///     time zone where those had one. Before the first sample the signal is that at the start, at inf it is the limit of the law,
    ///     at NaN it is NaN. Without any, the times of the samples.
    /// elapsed_s : float or array_like, shape (N,), optional
    ///     Instead of `time_s`: time since the first sample, s.
    /// interval : float, optional
    ///     Coverage of the band, between 0 and 1.
    /// of : str
    ///     Band of the "curve", or of a "sample" with the noise of the fitted ones: with weights that of those before and after it,
    ///     linear in between.
    ///     Under a robust loss too the noise of a "sample" is that of all measured ones, outliers included.
    ///
    /// Returns
    /// -------
    /// float or ndarray, shape (N,), or three of them
    ///     The curve; with `interval` the curve, the lower and the upper end of the band.
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     A coverage outside 0 to 1, another word, both of `time_s` and `elapsed_s`; dates where the samples had none, or with a time zone where
    ///     those had none, and the other way; an infinite time of a law without a limit.
    #[pyo3(signature = (time_s=None, *, elapsed_s=None, interval=None, of="curve"))]
    fn predict<'py>(
        &self,
        py: Python<'py>,
        time_s: Option<&Bound<'py, PyAny>>,
        elapsed_s: Option<&Bound<'py, PyAny>>,
        interval: Option<f64>,
        of: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        let ((mut elapsed, is_scalar), start) = match (time_s, elapsed_s) {
            (Some(times), None) => (times_of(times, "predict(time_s)", self.first_date)?, self.fit.start),
            (None, Some(elapsed)) => (times_of(elapsed, "predict(elapsed_s)", None)?, 0.0),
            (None, None) => ((self.samples.times.clone(), false), self.fit.start),
            (Some(_), Some(_)) => {
                let message = "predict takes either time_s, on the clock of the record, or elapsed_s, since its first sample";
                return Err(refused_plainly::<OptionError>(message));
            }
        };
        let shaped = |values: Bound<'py, PyArray1<f64>>| {
            if is_scalar { values.get_item(0)?.call_method0("item") } else { Ok(values.into_any()) }
        };
        let sample = match of {
            "curve" => false,
            "sample" => true,
            other => {
                let message = format!("of is \"curve\" or \"sample\", found {other:?}");
                return Err(refused_plainly::<OptionError>(message));
            }
        };
        for some in elapsed.chunks_mut(AT_ONCE) {
            py.check_signals()?;
            some.iter_mut().for_each(|time| *time -= start);
        }
        if elapsed.contains(&f64::INFINITY) && !self.fit.predict(f64::INFINITY).is_finite() {
            let message = format!("predict: expected finite times of {}, which has no limit, found inf", self.fit.law);
            return Err(refused_plainly::<OptionError>(message));
        }
        let Some(confidence) = interval else {
            let mut values = Vec::with_capacity(elapsed.len());
            for some in elapsed.chunks(AT_ONCE) {
                py.check_signals()?;
                briefly(py, || values.extend(self.fit.predict_many(some)))?;
            }
            return shaped(PyArray1::from_vec(py, values));
        };
        let fit = self.with_confidence(confidence)?;
        let mut estimates: Vec<Estimate> = Vec::with_capacity(elapsed.len());
        for some in elapsed.chunks(AT_ONCE) {
            // A band of millions of samples takes seconds: Ctrl-C is heard in between.
            py.check_signals()?;
            let predicted = || match (sample, &self.samples.weights) {
                (false, _) => fit.predict_intervals(some),
                (true, None) => fit.predict_samples(some),
                (true, Some(weights)) => fit.predict_samples_with(some, &self.deviations(weights, some)),
            };
            briefly(py, || estimates.extend(predicted()))?;
        }
        let column = |pick: fn(&Estimate) -> f64| shaped(array(py, estimates.iter().map(pick))?);
        let value = column(|estimate| estimate.value)?;
        let low = column(|estimate| estimate.interval.map_or(f64::NAN, |interval| interval.0))?;
        let high = column(|estimate| estimate.interval.map_or(f64::NAN, |interval| interval.1))?;
        Ok((value, low, high).into_pyobject(py)?.into_any())
    }

    /// The first date of the samples in ns since 1970, and whether it has a time zone; None where their times were none.
    #[getter]
    fn _first_date(&self) -> Option<FirstDate> {
        self.first_date
    }

    /// The fit as text, in the manner of lmfit.
    fn report(&self) -> String {
        report(&self.fit)
    }

    fn __len__(&self) -> usize {
        self.samples.times.len()
    }

    /// Columns ``time_s``, ``signal``, ``best_fit`` and ``residual`` as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        Table::of(self.columns())
    }

    /// Everything about the fit but its samples as plain objects: also ``bounds``, both ends by name, and ``fixed``, values by name.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let all = plain(py, &self.fit)?;
        let ends = |[low, high]: &[Option<f64>; 2]| PyList::new(py, [*low, *high]);
        let bounds = self.bounds.iter().map(|(name, pair)| Ok((name, ends(pair)?)));
        all.set_item("bounds", bounds.collect::<PyResult<Vec<_>>>()?.into_py_dict(py)?)?;
        all.set_item("fixed", self.fixed.iter().map(|(name, value)| (name, *value)).into_py_dict(py)?)?;
        Ok(all)
    }

    /// What is to be heeded where no noise model describes the residuals, and what it means; None otherwise.
    #[getter]
    fn _noise_remark(&self) -> Option<(String, &'static str)> {
        unexplained_noise(&self.fit)
    }

    fn __repr__(&self) -> String {
        let parameter = |parameter: &Parameter| format!("{}={}", parameter.name, reported(&parameter.estimate, 4));
        let parameters: Vec<String> = self.fit.parameters.iter().map(parameter).collect();
        let remark = unexplained_noise(&self.fit).map_or_else(String::new, |(observed, _)| format!("; {observed}"));
        format!("<palpate.Fit {}: {}; {}{remark}>", self.fit.law, parameters.join(", "), word(self.fit.termination))
    }
}

/// Times to evaluate at on the clock of samples whose first date is this, s, and whether it is a single one.
pub(crate) fn times_of(
    values: &Bound<'_, PyAny>,
    name: &str,
    first_date: Option<FirstDate>,
) -> PyResult<(Vec<f64>, bool)> {
    if values.is_exact_instance_of::<PyArray1<f64>>() {
        return Ok((doubles(values, name)?, false));
    }
    let arrays = values.py().import("palpate._arrays")?;
    let (times, is_scalar) = arrays.call_method1("at_times", (values, name, first_date))?.extract()?;
    Ok((doubles(&times, name)?, is_scalar))
}

fn report(fit: &Fit) -> String {
    let mut out = format!(
        "[[Model]]\n    {}\n[[Fit Statistics]]\n    # data points      = {}\n    # variables        = {}\n    chi-square         = {}\n    root mean square   = {}\n    ended              = {}\n[[Variables]]\n",
        fit.law,
        fit.samples,
        fit.free_parameters(),
        significant(fit.residual_square, 6),
        significant(fit.rmse, 6),
        word(fit.termination),
    );
    let width = fit.parameters.iter().map(|parameter| parameter.name.to_string().len()).max().unwrap_or(0) + 1;
    for parameter in &fit.parameters {
        let (name, estimate) = (format!("{}:", parameter.name), &parameter.estimate);
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
    if let Some((observed, meaning)) = unexplained_noise(fit) {
        out.push_str(&format!("[[Noise]]\n    {observed}; {meaning}\n"));
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

/// Samples whose bands are computed in some milliseconds.
const AT_ONCE: usize = 10_000;
