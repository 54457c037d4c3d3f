//! Where the states of contacts are: in Rust, until Python wants them as an array.

use std::fmt::Display;

use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2, PyReadwriteArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::errors::{OptionError, refused_plainly};

/// The numbers of states: a row for each number, a column for each contact.
///
/// That nobody else uses an array takes as long to find out as a step of some contacts, so that there is none before it is wanted.
pub(super) enum Memory {
    /// Numbers that nobody else sees.
    Own(Lined),
    /// An array of Python's; Python may have changed what it is, so that it is looked at again.
    Array(Py<PyAny>),
}

/// Numbers that begin at a cache line: vectors of eight that cross one take longer to load and to store.
pub(super) struct Lined {
    numbers: Vec<f64>,
    from: usize,
}

impl Lined {
    pub(super) fn new(numbers: &[f64]) -> Self {
        /// Bytes of a cache line, and the numbers less one that lie in it.
        const LINE: usize = 64;
        const BEFORE: usize = LINE / size_of::<f64>() - 1;
        let mut lined: Vec<f64> = Vec::with_capacity(numbers.len() + BEFORE);
        let from = lined.as_ptr().align_offset(LINE).min(BEFORE);
        lined.resize(from, 0.0);
        lined.extend_from_slice(numbers);
        Self { numbers: lined, from }
    }

    fn slice(&self) -> &[f64] {
        &self.numbers[self.from..]
    }

    fn slice_mut(&mut self) -> &mut [f64] {
        &mut self.numbers[self.from..]
    }
}

/// States that are read.
pub(super) enum Reading<'a, 'py> {
    Own(&'a [f64]),
    Array(PyReadonlyArray2<'py, f64>),
}

/// States that are written to.
pub(super) enum Writing<'a, 'py> {
    Own(&'a mut [f64]),
    Array(PyReadwriteArray2<'py, f64>),
}

impl Memory {
    /// As an array, from now on.
    pub(super) fn array<'py>(&mut self, py: Python<'py>, shape: [usize; 2]) -> PyResult<&Bound<'py, PyAny>> {
        if let Self::Own(numbers) = self {
            let array = PyArray2::<f64>::zeros(py, shape, false);
            array.try_readwrite().map_err(in_use)?.as_slice_mut()?.copy_from_slice(numbers.slice());
            *self = Self::Array(array.into_any().unbind());
        }
        match self {
            Self::Array(array) => Ok(array.bind(py)),
            Self::Own(_) => unreachable!("made an array above"),
        }
    }

    pub(super) fn read<'py>(&self, py: Python<'py>, shape: [usize; 2]) -> PyResult<Reading<'_, 'py>> {
        match self {
            Self::Own(numbers) => Ok(Reading::Own(numbers.slice())),
            Self::Array(array) => checked(array.bind(py), shape)?.try_readonly().map_err(in_use).map(Reading::Array),
        }
    }

    pub(super) fn write<'py>(&mut self, py: Python<'py>, shape: [usize; 2]) -> PyResult<Writing<'_, 'py>> {
        match self {
            Self::Own(numbers) => Ok(Writing::Own(numbers.slice_mut())),
            Self::Array(array) => checked(array.bind(py), shape)?.try_readwrite().map_err(in_use).map(Writing::Array),
        }
    }

    /// Whether both are one array.
    pub(super) fn is(&self, other: &Self) -> bool {
        matches!((self, other), (Self::Array(one), Self::Array(other)) if one.is(other))
    }
}

impl Reading<'_, '_> {
    pub(super) fn slice(&self) -> PyResult<&[f64]> {
        match self {
            Self::Own(numbers) => Ok(numbers),
            Self::Array(array) => Ok(array.as_slice()?),
        }
    }
}

impl Writing<'_, '_> {
    pub(super) fn slice(&mut self) -> PyResult<&mut [f64]> {
        match self {
            Self::Own(numbers) => Ok(numbers),
            Self::Array(array) => Ok(array.as_slice_mut()?),
        }
    }
}

/// The array, if it is still what it was made as.
fn checked<'a, 'py>(array: &'a Bound<'py, PyAny>, shape: [usize; 2]) -> PyResult<&'a Bound<'py, PyArray2<f64>>> {
    match array.cast::<PyArray2<f64>>() {
        Ok(array) if array.shape() == shape && array.is_c_contiguous() => Ok(array),
        _ => {
            let message = format!("state: expected its base to be an array of {shape:?} doubles, found it changed");
            Err(refused_plainly::<OptionError>(message))
        }
    }
}

fn in_use(error: impl Display) -> PyErr {
    refused_plainly::<OptionError>(format!("state: expected states that nobody uses, found: {error}"))
}
