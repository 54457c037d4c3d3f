//! Numbers in and out: anything that NumPy understands, as contiguous doubles. Ctrl-C is heard while many of them are copied.

use numpy::ndarray::Axis;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

/// Numbers that are copied or computed in some milliseconds.
pub(crate) const AT_ONCE: usize = 1 << 18;

/// Doubles of one column. They are copied: Python may change an array while it is computed with.
///
/// An array of doubles is taken as it is; anything else goes through `palpate._arrays.as_doubles`, which says what is wrong
/// with what it cannot take.
pub(crate) fn doubles(values: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
    if let Ok(array) = values.cast_exact::<PyArray1<f64>>() {
        return copied(array);
    }
    static AS_DOUBLES: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let as_doubles = AS_DOUBLES.import(values.py(), "palpate._arrays", "as_doubles")?;
    let array = as_doubles.call1((values, name))?;
    copied(&array.cast_into::<PyArray1<f64>>()?)
}

fn copied(array: &Bound<'_, PyArray1<f64>>) -> PyResult<Vec<f64>> {
    let values = array.try_readonly()?;
    let values = values.as_array();
    let mut all = Vec::with_capacity(values.len());
    for some in values.axis_chunks_iter(Axis(0), AT_ONCE) {
        array.py().check_signals()?;
        match some.as_slice() {
            Some(some) => all.extend_from_slice(some),
            None => all.extend(some),
        }
    }
    Ok(all)
}

/// An array of values.
pub(crate) fn array<T: Element>(
    py: Python<'_>,
    mut values: impl ExactSizeIterator<Item = T>,
) -> PyResult<Bound<'_, PyArray1<T>>> {
    let mut all = Vec::with_capacity(values.len());
    while values.len() > 0 {
        py.check_signals()?;
        all.extend(values.by_ref().take(AT_ONCE));
    }
    Ok(PyArray1::from_vec(py, all))
}
