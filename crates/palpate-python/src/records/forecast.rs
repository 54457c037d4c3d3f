//! What a hold will show next.

use palpate::fit::{LawOptions, Samples};
use palpate::forecast::{CompareOptions, HoldForecast, TriedHold};
use pyo3::prelude::*;

use super::compare::quantity_of;
use crate::arrays::doubles;
use crate::errors::{FitError, OptionError, refused, refused_plainly};
use crate::files::all_laws;
use crate::fits::fit::{FirstDate, times_of};
use crate::fits::fit_hold::{samples_of, standard_deviations_of};
use crate::listed::Listed;
use crate::table::{Table, columns};
use crate::work::at_length;

/// Times that all laws are computed at in some milliseconds.
const SOME: usize = 1 << 14;

/// What a hold will show next, from all laws together: each counts as much as it helps to predict the hold so far.
///
/// Parameters
/// ----------
/// time_s, signal, weights : array_like, shape (N,)
///     As for `fit_hold`.
/// at_s : float or array_like
///     Times to predict, on the clock of ``time_s``, none before its last: the hold itself is what was fitted. Durations are times on that
///     clock too, and so are dates where ``time_s`` has dates, with a time zone where those have one.
/// laws
///     Names of laws; if left out, all that suit.
/// quantity
///     As for `compare`.
/// others : list of (time_s, signal)
///     Other holds of the same body, the nearest first. Laws are weighed by what they have predicted of them too: of each that is longer by
///     half, what its first part of the same duration says of the rest counts most. Where two or more are, their courses, scaled to this
///     hold, are combined with the laws, as far as half of them reach. On measured records of several holds the median of the error over
///     that of the best law was 1.06 with others and 1.9 without.
/// confidence
///     Of the band. One of 0.95 covered 95 % of what followed in 19 of 20 of the measured holds on which its width was set, up to
///     three times their duration.
///
/// Returns
/// -------
/// Table
///     ``at_s``, ``value``, and the band for a sample, ``low`` to ``high``, in the unit of the signal.
///
/// Raises
/// ------
/// FitError
///     A hold that no law can be fitted to, or that is too short to try a forecast on it.
/// OptionError
///     A law, a quantity, a time or a confidence that makes no sense.
///
/// Examples
/// --------
/// >>> import numpy as np, palpate
/// >>> t = np.linspace(0.0, 10.0, 200)
/// >>> force = 1 + 2 / (1 + 0.5 * t)
/// >>> table = palpate.forecast(t, force, at_s=[20.0, 30.0])
/// >>> [round(float(value), 2) for value in table["value"]]
/// [1.18, 1.12]
/// >>> before = [(t, 2 + 4 / (1 + 0.5 * t)), (t, 3 + 5 / (1 + 0.5 * t))]
/// >>> table = palpate.forecast(t[:20], force[:20], at_s=[10.0], others=before)
/// >>> round(float(table["value"][0]), 2), round(float(force[-1]), 2)
/// (1.33, 1.33)
#[pyfunction]
#[pyo3(signature = (time_s, signal, at_s, *, laws=None, weights=None, quantity="force", others=None, confidence=0.95))]
#[expect(
    clippy::needless_pass_by_value,
    clippy::too_many_arguments,
    reason = "arguments of Python"
)]
pub(crate) fn forecast(
    py: Python<'_>,
    time_s: &Bound<'_, PyAny>,
    signal: &Bound<'_, PyAny>,
    at_s: &Bound<'_, PyAny>,
    laws: Option<Listed<String>>,
    weights: Option<&Bound<'_, PyAny>>,
    quantity: &str,
    others: Option<Listed<Bound<'_, PyAny>>>,
    confidence: f64,
) -> PyResult<Table> {
    let (times, values) = (doubles(time_s, "time_s")?, doubles(signal, "signal")?);
    let (at, _) = times_of(at_s, "at_s", first_date(time_s)?)?;
    let standard_deviations = standard_deviations_of(weights, false)?;
    let others: Vec<Hold> =
        others.as_deref().unwrap_or_default().iter().enumerate().map(hold_of).collect::<PyResult<_>>()?;
    let (_, response) = quantity_of(quantity)?;
    if !(confidence > 0.0 && confidence < 1.0) {
        let message = format!("confidence: expected a number between 0 and 1, found {confidence}");
        return Err(refused_plainly::<OptionError>(message));
    }
    let last = times.last().copied().unwrap_or(f64::NEG_INFINITY);
    if let Some(early) = at.iter().find(|time| !time.is_finite() || **time < last) {
        let message = format!("at_s: expected times from the last sample on, at {last} s, found {early} s");
        return Err(refused::<OptionError>(
            message,
            Some("the curve of a law within the hold is that of fit_hold(...).predict"),
        ));
    }
    let mut options = CompareOptions {
        laws: all_laws(laws.as_deref().unwrap_or_default())?,
        ..CompareOptions::default()
    };
    options.fit = LawOptions {
        response,
        ..LawOptions::default()
    };
    let made = at_length(py, move |mut heard| {
        let samples = samples_of(&times, &values, standard_deviations.as_deref());
        let mut tried = |samples| TriedHold::of(samples, &options.laws(), &options.fit, &mut heard);
        let hold = tried(samples).map_err(|error| (None, error))?;
        let tried = others
            .iter()
            .enumerate()
            .map(|(index, (t, y))| tried(Samples::new(t, y)).map_err(|error| (Some(index), error)));
        let others: Vec<_> = tried.collect::<Result<_, _>>()?;
        let found = HoldForecast::beside(&hold, &others.iter().collect::<Vec<_>>(), &mut heard);
        let found = found.map_err(|error| (None, error))?;
        let Some(found) = found else { return Ok(None) };
        let elapsed: Vec<f64> = at.iter().map(|time| time - times[0]).collect();
        let mut forecasts = Vec::with_capacity(at.len());
        for some in elapsed.chunks(SOME) {
            heard.look().map_err(|ended| (None, ended.into()))?;
            forecasts.extend(found.at_times(some, confidence));
        }
        Ok(Some((at, forecasts)))
    })?;
    let made = made.map_err(|(other, error): (Option<usize>, palpate::fit::FitError)| {
        let place = other.map_or_else(String::new, |index| format!("others[{index}]: "));
        refused_plainly::<FitError>(format!("{place}{error}"))
    })?;
    let Some((at, forecasts)) = made else {
        let message = "expected a hold whose beginning tells something of its end, found one that is too short or does not change";
        return Err(refused::<FitError>(message, Some("give the hold more samples")));
    };
    let rows: Vec<_> = at.into_iter().zip(forecasts).collect();
    Table::of(columns!(rows, row => at_s = row.0, value = row.1.value, low = row.1.low, high = row.1.high))
}

/// The first date of a column of times; none of numbers.
fn first_date(time_s: &Bound<'_, PyAny>) -> PyResult<Option<FirstDate>> {
    time_s.py().import("palpate._arrays")?.call_method1("first_date", (time_s,))?.extract()
}

/// Times, s, and signal.
type Hold = (Vec<f64>, Vec<f64>);

/// One of the other holds.
fn hold_of((index, pair): (usize, &Bound<'_, PyAny>)) -> PyResult<Hold> {
    let Ok((time_s, signal)) = pair.extract::<(Bound<'_, PyAny>, Bound<'_, PyAny>)>() else {
        let message =
            format!("others[{index}]: expected a pair of times and signal, found {}", pair.get_type().name()?);
        return Err(refused::<OptionError>(message, Some("others=[(time_s, signal), …]")));
    };
    Ok((
        doubles(&time_s, &format!("others[{index}] time_s"))?,
        doubles(&signal, &format!("others[{index}] signal"))?,
    ))
}
