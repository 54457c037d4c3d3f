//! Fits of an analysis on their own, with their samples on the clock of the record.

use palpate::analysis::{Analysis, HoldAnalysis};
use palpate::fit::Fit;
use palpate::laws::Law;
use pyo3::Borrowed;
use pyo3::prelude::*;
use pyo3::types::PyBool;

use crate::errors::{FitError, OptionError, refused, refused_plainly};
use crate::fits::fit::PyFit;

/// The laws fitted to a hold, the exponents of the latency law first; the spectrum, which has no few parameters, is none of them.
fn fits(hold: &HoldAnalysis) -> impl Iterator<Item = &Fit> {
    let compared = hold.comparison.iter().flat_map(|found| &found.rows);
    let compared = compared.filter(|row| row.spectrum.is_none()).filter_map(|row| row.fit.as_ref().ok());
    hold.fits.iter().map(|fit| &**fit).chain(compared)
}

/// The recommended law of a hold, or else the latency law with the preferred exponent.
fn recommended(hold: &HoldAnalysis) -> Option<&Fit> {
    let law = hold.comparison.as_ref().and_then(|found| found.verdict.as_ref()).map(|verdict| verdict.law);
    let fitted = |law: Law| fits(hold).find(|fit| fit.law == law);
    law.and_then(fitted).or_else(|| hold.preferred().map(|fit| &**fit))
}

fn with_samples(hold: &HoldAnalysis, fit: &Fit) -> PyFit {
    PyFit::since(hold.fit_start, fit, &hold.times[..hold.fitted], &hold.values[..hold.fitted])
}

/// The number of a hold as a call states it: a whole number, or what it is instead.
pub(super) struct HoldNumber(Result<i64, String>);

impl HoldNumber {
    pub(super) const FIRST: Self = Self(Ok(1));
}

impl FromPyObject<'_, '_> for HoldNumber {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let number = if value.is_instance_of::<PyBool>() { None } else { value.extract().ok() };
        let found = || Ok::<_, PyErr>(value.repr()?.to_string());
        Ok(Self(number.map_or_else(|| found().map(Err), |number| Ok(Ok(number)))?))
    }
}

/// The fit of a law to the hold with this number; of the recommended law without a name.
pub(super) fn fit_of(analysis: &Analysis, HoldNumber(number): HoldNumber, law: Option<&str>) -> PyResult<PyFit> {
    let numbered = |number: i64| analysis.holds.iter().find(|hold| usize::try_from(number) == Ok(hold.number));
    let Some(hold) = number.as_ref().ok().and_then(|number| numbered(*number)) else {
        let found = number.map_or_else(|found| found, |number| number.to_string());
        let message = format!("hold: expected a whole number from 1 to {}, found {found}", analysis.holds.len());
        return Err(refused::<OptionError>(message, Some("analysis.holds lists the holds; index is their number")));
    };
    let number = hold.number;
    let Some(best) = recommended(hold) else {
        let message = format!("hold {number}: expected a force that relaxes, found no law fitted to it");
        return Err(refused::<FitError>(message, Some("its findings say why: analysis.findings")));
    };
    let Some(name) = law else {
        return Ok(with_samples(hold, best));
    };
    let law: Law = name.parse().map_err(refused_plainly::<OptionError>)?;
    let Some(fit) = fits(hold).find(|fit| fit.law == law) else {
        let mut names: Vec<String> = fits(hold).map(|fit| fit.law.to_string()).collect();
        names.sort();
        names.dedup();
        let message =
            format!("law: expected one that was fitted to hold {number} ({}), found {name:?}", names.join(", "));
        let hint = "fit another to the same samples: palpate.fit_hold(fit.time_s, fit.signal, law=...)";
        return Err(refused::<OptionError>(message, Some(hint)));
    };
    Ok(with_samples(hold, fit))
}

/// A fitted law over a hold: number of the hold, name of the law, times (s) and force (N).
pub(super) type Curve = (usize, String, Vec<f64>, Vec<f64>);

/// The recommended law over every hold that has one.
pub(super) fn curves(analysis: &Analysis) -> Vec<Curve> {
    let curve = |hold: &HoldAnalysis| {
        let (fit, elapsed) = (recommended(hold)?, &hold.times[..hold.fitted]);
        let forces = fit.predict_many(elapsed).iter().map(|value| hold.force_per_signal * value).collect();
        let times = elapsed.iter().map(|time| hold.fit_start + time).collect();
        Some((hold.number, fit.law.to_string(), times, forces))
    };
    analysis.holds.iter().filter_map(curve).collect()
}
