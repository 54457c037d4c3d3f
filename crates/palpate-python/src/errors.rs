//! Exceptions of the package, with the words of the command line.

use std::fmt::Display;
use std::io;

use palpate::analysis::Finding;
use palpate_files::FileError;
use palpate_files::description::DescriptionError;
use palpate_files::record::ReadError;
use palpate_jobs::{JobError, spelled};
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::{PyTypeInfo, create_exception};

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
    PyErr::new::<E, _>(told(message, hint))
}

fn told(message: impl Display, hint: Option<impl Display>) -> String {
    match hint {
        Some(hint) => format!("{message}\nhint: {hint}"),
        None => message.to_string(),
    }
}

/// An exception without a hint.
pub(crate) fn refused_plainly<E: PyTypeInfo>(message: impl Display) -> PyErr {
    refused::<E>(message, None::<&str>)
}

/// Why there is no fit: because of what was asked, or of the samples.
pub(crate) fn unfitted(error: palpate::fit::FitError) -> PyErr {
    use palpate::fit::FitError as Refused;
    match error {
        Refused::NoForm { .. }
        | Refused::UnknownNumber { .. }
        | Refused::FixedNumber { .. }
        | Refused::HeldAmplitude { .. }
        | Refused::Bounds { .. }
        | Refused::Exponent { .. }
        | Refused::Confidence { .. } => refused_plainly::<OptionError>(error),
        _ => refused_plainly::<FitError>(error),
    }
}

/// What a file cannot be read for: an `OSError` where the operating system says so.
pub(crate) fn unread(error: &ReadError) -> PyErr {
    let told = told(error, error.hint());
    match error {
        ReadError::File(FileError::NotFound { source, .. } | FileError::Unreadable { source, .. }) => {
            io::Error::new(source.kind(), told).into()
        }
        ReadError::File(FileError::Directory { .. }) => io::Error::new(io::ErrorKind::IsADirectory, told).into(),
        _ => PyErr::new::<RecordError, _>(told),
    }
}

/// What a description cannot be used for: an `OSError` where the operating system says so.
pub(crate) fn undescribed(error: DescriptionError) -> PyErr {
    let told = told(&error, error.hint());
    match error {
        DescriptionError::NotFound { source, .. } | DescriptionError::Unreadable { source, .. } => {
            io::Error::new(source.kind(), told).into()
        }
        DescriptionError::Directory { .. } => io::Error::new(io::ErrorKind::IsADirectory, told).into(),
        _ => PyErr::new::<OptionError, _>(told),
    }
}

/// What a file cannot be written for.
pub(crate) fn unwritten(error: &JobError) -> PyErr {
    refused::<PalpateError>(error, error.hint.as_deref().map(|hint| spelled(hint, &|name, _| name.to_owned())))
}

/// Warns of findings, each with what it means.
pub(crate) fn warn_of<'a>(py: Python<'_>, findings: impl IntoIterator<Item = &'a Finding>) -> PyResult<()> {
    for finding in findings {
        warn(py, &format!("{}: {}; {}", finding.code(), finding.seen(), finding.meaning()))?;
    }
    Ok(())
}

/// Warns in a sentence.
pub(crate) fn warn(py: Python<'_>, text: &str) -> PyResult<()> {
    let text = std::ffi::CString::new(text).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<PalpateWarning>(), &text, 1)
}
