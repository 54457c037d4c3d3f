//! Numbers in and out: anything that NumPy understands, as contiguous doubles.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

/// Doubles of one column. They are copied: Python may change an array while it is computed with.
///
/// An array of doubles is taken as it is; anything else goes through `palpate._arrays.as_doubles`, which says what is wrong
/// with what it cannot take.
pub(crate) fn doubles(values: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
    if let Ok(array) = values.cast_exact::<PyArray1<f64>>()
        && let Ok(array) = array.try_readonly()
    {
        return Ok(array.as_array().to_vec());
    }
    static AS_DOUBLES: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let as_doubles = AS_DOUBLES.import(values.py(), "palpate._arrays", "as_doubles")?;
    let array = as_doubles.call1((values, name))?;
    Ok(array.cast_into::<PyArray1<f64>>()?.try_readonly()?.as_array().to_vec())
}
