//! Arrays of many contacts that are computed with where they lie: a copy would take as long as a step.

use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadwriteArray1, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyFloat;

use crate::arrays::doubles;
use crate::errors::{OptionError, refused_plainly};
use crate::mappings::{is_with_unit, units};

/// Numbers that are copied in less time than Rust takes to see that nobody else writes to them.
const FEW: usize = 64;

/// Values of contacts: one for all, an array of Python's, or a copy.
pub(super) enum Values<'py> {
    One([f64; 1]),
    Array(PyReadonlyArray1<'py, f64>),
    Copy(Vec<f64>),
}

impl<'py> Values<'py> {
    /// One number for all contacts, or an array of one for each.
    ///
    /// Many doubles one behind the other are read where they lie, unless a step writes there.
    pub(super) fn new(values: &Bound<'py, PyAny>, name: &str, count: usize) -> PyResult<Self> {
        if let Ok(one) = values.cast_exact::<PyFloat>() {
            return Ok(Self::One([one.extract()?]));
        }
        let found = match values.cast::<PyUntypedArray>() {
            Ok(array) if array.ndim() > 0 => Self::of_array(values, name)?,
            _ if is_with_unit(values)? => {
                let bare = units(values)?.call_method1("in_si", (values, name))?;
                return Self::new(&bare, name, count);
            }
            _ => match values.extract::<f64>() {
                Ok(one) => Self::One([one]),
                Err(_) => Self::Copy(doubles(values, name)?),
            },
        };
        match found.slice().len() {
            length if length == count || length == 1 => Ok(found),
            length => {
                let message = format!("{name}: expected one number or {count}, one a contact, found {length}");
                Err(refused_plainly::<OptionError>(message))
            }
        }
    }

    fn of_array(values: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        if let Ok(array) = values.cast_exact::<PyArray1<f64>>() {
            if array.len() <= FEW
                && let Ok(copy) = array.to_vec()
            {
                return Ok(Self::Copy(copy));
            }
            match array.try_readonly() {
                Ok(array) if array.as_slice().is_ok() => return Ok(Self::Array(array)),
                Ok(_) => {}
                // It shares its memory with the states.
                Err(_) => return Ok(Self::Copy(doubles(&values.call_method0("copy")?, name)?)),
            }
        }
        Ok(Self::Copy(doubles(values, name)?))
    }

    pub(super) fn slice(&self) -> &[f64] {
        match self {
            Self::One(one) => one,
            // Checked when it was made.
            Self::Array(array) => array.as_slice().unwrap_or_default(),
            Self::Copy(values) => values,
        }
    }

    /// A value for each of so many contacts.
    pub(super) fn each(self, count: usize) -> Vec<f64> {
        match self.slice() {
            [one] => vec![*one; count],
            all => all.to_vec(),
        }
    }
}

/// An array for results: that of the caller, or a new one.
pub(super) fn results<'py>(
    py: Python<'py>,
    out: Option<&Bound<'py, PyAny>>,
    count: usize,
) -> PyResult<(Bound<'py, PyArray1<f64>>, PyReadwriteArray1<'py, f64>)> {
    let Some(out) = out else {
        let array = PyArray1::zeros(py, count, false);
        let writable = array.try_readwrite().map_err(refused_plainly::<OptionError>)?;
        return Ok((array, writable));
    };
    let refused = |found: &str| {
        let message = format!("out: expected a writable array of {count} doubles one behind the other, found {found}");
        refused_plainly::<OptionError>(message)
    };
    let Ok(array) = out.cast_exact::<PyArray1<f64>>() else {
        return Err(refused(&describe(out)));
    };
    if array.len() != count || !array.is_contiguous() {
        return Err(refused(&describe(out)));
    }
    let Ok(mut writable) = array.try_readwrite() else {
        return Err(refused("one that is read-only, or shares its memory with the states or with values of the step"));
    };
    match writable.as_slice_mut().is_ok() {
        true => Ok((array.clone(), writable)),
        false => Err(refused("one at an odd address")),
    }
}

/// What an object is, for messages.
fn describe(found: &Bound<'_, PyAny>) -> String {
    match found.cast::<PyUntypedArray>() {
        Ok(array) => format!("shape {:?} of {}, strides {:?} bytes", array.shape(), array.dtype(), array.strides()),
        Err(_) => found.get_type().to_string(),
    }
}

/// Marks of contacts.
pub(super) fn marks<'py>(mask: &Bound<'py, PyAny>, count: usize) -> PyResult<Vec<bool>> {
    let found = match mask.cast_exact::<PyArray1<bool>>() {
        Ok(array) => array.clone(),
        Err(_) => {
            let array = mask.py().import("numpy")?.call_method1("asarray", (mask,))?;
            let refused = || {
                let message = format!("mask: expected {count} truth values, one a contact, found {}", describe(&array));
                refused_plainly::<OptionError>(message)
            };
            array.cast::<PyArray1<bool>>().map_err(|_| refused())?.clone()
        }
    };
    let found: Vec<bool> = found.try_readonly().map_err(refused_plainly::<OptionError>)?.as_array().to_vec();
    match found.len() == count {
        true => Ok(found),
        false => {
            let message = format!("mask: expected {count} truth values, one a contact, found {}", found.len());
            Err(refused_plainly::<OptionError>(message))
        }
    }
}
