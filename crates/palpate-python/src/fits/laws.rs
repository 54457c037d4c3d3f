//! Laws as functions of arrays.

use numpy::PyArray1;
use palpate::latency::decay_many;
use palpate::laws::Law;
use pyo3::prelude::*;

use crate::arrays::{AT_ONCE, doubles};
use crate::errors::{ModelError, refused_plainly};
use crate::mappings::quantity;

/// y_e + Δ φ(t; λ, n) with φ = (1 + (n − 1) λ t)^(−1/(n − 1)).
#[pyfunction]
pub(crate) fn latency<'py>(
    py: Python<'py>,
    elapsed_s: &Bound<'py, PyAny>,
    equilibrium: f64,
    amplitude: f64,
    #[pyo3(from_py_with = quantity::per_second)] relative_rate_per_s: f64,
    exponent: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    if !(exponent.is_finite() && exponent > 0.0) {
        return Err(refused_plainly::<ModelError>(format!("the exponent must be above 0, found {exponent}")));
    }
    if !(relative_rate_per_s.is_finite() && relative_rate_per_s >= 0.0) {
        let message = format!("the relative rate must be 0 or more, found {relative_rate_per_s}");
        return Err(refused_plainly::<ModelError>(message));
    }
    // The values take the place of their times: one array of a gigabyte is enough.
    let mut values = doubles(elapsed_s, "elapsed_s")?;
    let mut decayed = vec![0.0; values.len().min(AT_ONCE)];
    for values in values.chunks_mut(AT_ONCE) {
        py.check_signals()?;
        py.detach(|| {
            // Before the hold the excess is that at its start; a time that is none has no value.
            let held: Vec<f64> = values.iter().map(|time| time.max(0.0)).collect();
            let decayed = &mut decayed[..held.len()];
            decay_many(&held, relative_rate_per_s, exponent, decayed);
            for (value, decayed) in values.iter_mut().zip(decayed) {
                *value = if value.is_nan() { f64::NAN } else { equilibrium + amplitude * *decayed };
            }
        });
    }
    Ok(PyArray1::from_vec(py, values))
}

/// Names of laws as `law=` takes them; N and K stand for parameters.
#[pyfunction]
pub(crate) fn law_names() -> Vec<&'static str> {
    Law::NAMES.to_vec()
}
