//! Exceptions of the package, with the words of the command line.

use std::fmt::Display;
use std::io;

use palpate::analysis::{Finding, Severity};
use palpate::units::UnitError;
use palpate_files::description::{DescriptionError, KeyProblem};
use palpate_jobs::{ErrorKind, JobError};
use palpate_report::spelling::{spelled, with_flags};
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::{PyTypeInfo, create_exception};
use serde::de::DeserializeOwned;

create_exception!(
    palpate,
    PalpateError,
    PyValueError,
    "Anything that palpate refuses; the message ends in what would help."
);
create_exception!(palpate, RecordError, PalpateError, "A record that cannot be read, or has nothing to analyse.");
create_exception!(palpate, OptionError, PalpateError, "An argument that no computation can follow.");
create_exception!(palpate, ModelError, PalpateError, "Numbers that make no body, no law or no motion.");
create_exception!(palpate, FitError, PalpateError, "Samples that no law can be fitted to.");
create_exception!(
    palpate,
    PalpateWarning,
    PyUserWarning,
    "Something about a record, or about a question beyond it, that numbers alone do not tell."
);

/// An exception with a message and, on a line of its own, what would help.
pub(crate) fn refused<E: PyTypeInfo>(message: impl Display, hint: Option<impl Display>) -> PyErr {
    PyErr::new::<E, _>(reported(message, hint))
}

fn reported(message: impl Display, hint: Option<impl Display>) -> String {
    let text = hint.map_or(message.to_string(), |hint| format!("{message}\nhint: {hint}"));
    spelled(&in_keywords(&text), &keyword)
}

/// A text that names options as the command does, with keywords in their place.
pub(crate) fn in_keywords(text: &str) -> String {
    let known = ["⟨compare/creep⟩", "⟨compare/loss=huber⟩", "⟨compare/ramps=measured⟩", "⟨fit_until⟩"];
    let text = known
        .iter()
        .fold(text.to_owned(), |text, option| text.replace(&with_flags(option), &spelled(option, &keyword)));
    ["columns", "part"]
        .iter()
        .fold(text, |text, name| text.replace(&format!("--{name} \""), &format!("{name}=\"")))
}

/// An exception without a hint.
pub(crate) fn refused_plainly<E: PyTypeInfo>(message: impl Display) -> PyErr {
    refused::<E>(message, None::<&str>)
}

/// Why there is no fit: because of what was requested, or of the samples.
pub(crate) fn unfitted(error: palpate::fit::FitError) -> PyErr {
    use palpate::fit::FitError as Refused;
    match error {
        Refused::NoForm { .. }
        | Refused::UnknownParameter { .. }
        | Refused::FixedParameter { .. }
        | Refused::FixedOutsideBounds { .. }
        | Refused::HeldAmplitude { .. }
        | Refused::Bounds { .. }
        | Refused::Exponent { .. }
        | Refused::Confidence { .. } => refused_plainly::<OptionError>(error),
        _ => refused_plainly::<FitError>(error),
    }
}

/// Why a job gave nothing, with its options as keywords: an `OSError` where the operating system says so.
pub(crate) fn failed(error: JobError) -> PyErr {
    let JobError {
        kind,
        place,
        message,
        hint,
    } = error;
    let place = place.filter(|_| matches!(kind, ErrorKind::File(_)));
    let message = place.map_or(message.clone(), |place| format!("{place}: {message}"));
    let text = reported(message, hint);
    match kind {
        ErrorKind::Option => PyErr::new::<OptionError, _>(text),
        ErrorKind::File(kind) => io::Error::new(kind, text).into(),
        ErrorKind::Record | ErrorKind::Ended => PyErr::new::<RecordError, _>(text),
        ErrorKind::Model => PyErr::new::<ModelError, _>(text),
        ErrorKind::Fit => PyErr::new::<FitError, _>(text),
        ErrorKind::Report | ErrorKind::Cancelled => PyErr::new::<PalpateError, _>(text),
    }
}

/// What a file cannot be written for.
pub(crate) fn unwritten(error: JobError) -> PyErr {
    let message = error.to_string();
    PyErr::new::<PalpateError, _>(reported(message, error.hint))
}

/// An option of a job as a keyword, with its unit; thresholds of phases stand in the description of a test, which every job takes.
fn keyword(name: &str, value: Option<&str>) -> String {
    let (job, name) = name.split_once('/').map_or((None, name), |(job, name)| (Some(job), name));
    let unit = match name {
        "minimum_hold" | "tolerance" => return format!("phases.{name}"),
        "squeeze" | "stroke" | "depth" => "_m",
        "force" | "most_force" | "band" => "_n",
        "hold" | "close_within" | "shortest_pause" | "fit_until" | "at" => "_s",
        _ => "",
    };
    let written = match value {
        // A number without its unit, which the keyword has.
        Some("250g") if name == "mass" => "mass_kg=0.25".to_owned(),
        Some(value) if let Some(depth) = in_metres(name, value) => format!("{name}{unit}={depth}"),
        Some(value) => format!("{name}{unit}=\"{value}\""),
        None if job.is_some() => format!("{name}{unit}=True"),
        None => format!("{name}{unit}"),
    };
    match job {
        Some(job) => format!("{job}({written})"),
        None => written,
    }
}

/// A depth in metres, which its keyword takes as a number.
fn in_metres(name: &str, value: &str) -> Option<f64> {
    let millimetres: f64 = value.strip_suffix("mm").filter(|_| name == "depth")?.parse().ok()?;
    Some(millimetres / 1e3)
}

/// What is wrong with the text that a mapping was made to: it has keys as Python indexes them, and no lines that anybody wrote.
///
/// The paths of numbers to sweep are those of a description, whose lists count from 1.
pub(crate) fn of_mapping(error: DescriptionError) -> DescriptionError {
    let mut error = of_paths(error);
    if let DescriptionError::Key { place, problem } = &mut error
        && !place.key.starts_with("sweep.")
        && !matches!(problem, KeyProblem::UnknownParameter { .. })
    {
        place.key = indexed(&place.key);
        if let KeyProblem::Both(other) = problem {
            *other = indexed(other);
        }
    }
    error
}

/// The same of paths of numbers that stand beside a mapping.
pub(crate) fn of_paths(mut error: DescriptionError) -> DescriptionError {
    if let DescriptionError::Key { place, .. } = &mut error {
        place.line = None;
    }
    error
}

/// The path of a key with the entries of lists counted from 0: `step[1].hold` is the hold of the second step.
fn indexed(key: &str) -> String {
    let part = |part: &str| {
        let (number, rest) = part.split_once(']')?;
        let number: usize = number.parse().ok()?;
        Some(format!("[{}]{rest}", number.checked_sub(1)?))
    };
    let (first, others) = key.split_once('[').map_or((key, None), |(first, others)| (first, Some(others)));
    let others = others.into_iter().flat_map(|others| others.split('['));
    others.fold(first.to_owned(), |path, found| path + &part(found).unwrap_or_else(|| format!("[{found}")))
}

/// What else would help where the value of a key of a mapping is a number without its unit: a key that says the unit.
fn with_unit_in_key(error: &DescriptionError) -> Option<String> {
    let DescriptionError::Key {
        place,
        problem:
            KeyProblem::Quantity {
                found,
                error: UnitError::MissingUnit { dimension, .. },
            },
    } = error
    else {
        return None;
    };
    // The endings that `palpate._with_units` takes.
    let endings = [
        ("m", "m"),
        ("s", "s"),
        ("N", "n"),
        ("Pa", "pa"),
        ("m^2", "m2"),
        ("/s", "per_s"),
        ("m/s", "m_per_s"),
        ("N/s", "n_per_s"),
    ];
    let si = dimension.units().iter().find_map(|(unit, _)| endings.iter().find(|(symbol, _)| symbol == unit));
    let unit = si?.1;
    let key = place.key.rsplit('.').next()?;
    (place.line.is_none() && !found.starts_with('"')).then(|| format!("; or a number in SI: {key}_{unit} = {found}"))
}

/// What a description cannot be used for.
pub(crate) fn undescribed(error: DescriptionError) -> PyErr {
    let more = with_unit_in_key(&error).unwrap_or_default();
    let mut error = JobError::from(error);
    error.hint = error.hint.map(|hint| hint + &more);
    failed(error)
}

/// One of the choices of an option, by its name with hyphens.
pub(crate) fn choice<T: Clone + DeserializeOwned>(option: &str, names: &[&str], found: &str) -> PyResult<T> {
    let known = |word: String| serde_json::from_value(serde_json::Value::String(word)).ok();
    let chosen = |name: &&str| known(name.replace('-', "_")).or_else(|| known((*name).to_owned()));
    let choices: Vec<(&str, T)> = names.iter().filter_map(|name| Some((*name, chosen(name)?))).collect();
    one_of(option, &choices, found)
}

/// Likewise, of choices beside their names.
pub(crate) fn one_of<T: Clone>(option: &str, choices: &[(&str, T)], found: &str) -> PyResult<T> {
    let chosen = choices.iter().find(|(name, _)| *name == found).map(|(_, choice)| choice.clone());
    chosen.ok_or_else(|| {
        let names: Vec<String> = choices.iter().map(|(name, _)| format!("{name:?}")).collect();
        refused_plainly::<OptionError>(format!("{option} is one of {}, found {found:?}", names.join(", ")))
    })
}

/// Warns of the findings because of which numbers must not be used, each with what it means.
pub(crate) fn warn_of<'a>(py: Python<'_>, findings: impl IntoIterator<Item = &'a Finding>) -> PyResult<()> {
    for finding in findings.into_iter().filter(|finding| finding.severity() == Severity::Warning) {
        warn(py, &format!("{}: {}; {}", finding.code(), finding.observation(), finding.meaning()))?;
    }
    Ok(())
}

/// Warns in a sentence.
pub(crate) fn warn(py: Python<'_>, text: &str) -> PyResult<()> {
    let text = std::ffi::CString::new(text).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<PalpateWarning>(), &text, 1)
}
