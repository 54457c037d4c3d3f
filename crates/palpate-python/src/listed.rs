//! Lists among the arguments of a call.

use std::num::NonZeroUsize;
use std::ops::Deref;

use pyo3::Borrowed;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::errors::{OptionError, refused, refused_plainly};

/// A list; a word of Python is a list of letters, but no list of names.
pub(crate) struct Listed<T>(pub(crate) Vec<T>);

impl<T> Deref for Listed<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<'py, T: FromPyObjectOwned<'py>> FromPyObject<'_, 'py> for Listed<T> {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let wrong = || -> PyResult<PyErr> {
            let found = value.repr()?;
            let kind = if value.is_instance_of::<PyString>() { "a list of names" } else { "a list" };
            let help = "put one into brackets: [one]";
            Ok(refused::<OptionError>(format!("expected {kind}, found {found}"), Some(help)))
        };
        if value.is_instance_of::<PyString>() {
            return Err(wrong()?);
        }
        match value.try_iter() {
            Ok(items) => {
                items.map(|item| item?.extract().or_else(|_| Err(wrong()?))).collect::<PyResult<_>>().map(Self)
            }
            Err(_) => Err(wrong()?),
        }
    }
}

/// A number of threads.
pub(crate) struct Threads(pub(crate) NonZeroUsize);

impl FromPyObject<'_, '_> for Threads {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        match value.extract::<usize>().ok().and_then(NonZeroUsize::new) {
            Some(threads) => Ok(Self(threads)),
            None => {
                let message = format!("threads: expected a number of threads, 1 or more, found {}", value.repr()?);
                Err(refused_plainly::<OptionError>(message))
            }
        }
    }
}
