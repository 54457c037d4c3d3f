//! What keywords of the methods of a record say, and why a prediction is none.

use palpate::calibrate::CalibrateError;
use palpate::laws::Law;
use palpate::segment::ContactChoice;
use palpate::simulate::SimulateError;
use palpate_files::description::parse_touch;
use palpate_jobs::{ErrorKind, JobError};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedStr;

use crate::errors::{OptionError, refused_plainly};
use crate::files::all_laws;
use crate::mappings::quantity;

/// First touch as a keyword says it: a displacement (m), or a text.
pub(super) fn first_touch(touch: &Bound<'_, PyAny>) -> PyResult<ContactChoice> {
    match touch.extract::<PyBackedStr>() {
        Ok(text) => parse_touch(&text).map_err(|error| refused_plainly::<OptionError>(format!("touch: {error}"))),
        Err(_) => quantity::metres(touch).map(ContactChoice::Displacement).map_err(|error| {
            let message = format!("touch: expected a text or a displacement in m, found {}", touch.get_type());
            if error.is_instance_of::<PyTypeError>(touch.py()) {
                refused_plainly::<OptionError>(message)
            } else {
                error
            }
        }),
    }
}

/// Laws beside another, by their names.
pub(super) fn other_laws(names: &Bound<'_, PyAny>) -> PyResult<Vec<Law>> {
    let wrong = |_| refused_plainly::<OptionError>(format!("alternatives: expected a list of laws, found {names:?}"));
    all_laws(&names.extract::<Vec<String>>().map_err(wrong)?)
}

/// Why there is no prediction along a record.
pub(super) fn unpredicted(error: &CalibrateError) -> JobError {
    let kind = match error {
        CalibrateError::Cancelled(_) | CalibrateError::Simulate(SimulateError::Cancelled(_)) => ErrorKind::Cancelled,
        CalibrateError::NoDisplacement | CalibrateError::Analysis(_) => ErrorKind::Record,
        _ => ErrorKind::Model,
    };
    JobError::new(kind, error, error.hint())
}

/// What is wrong with an option.
pub(super) fn not_so(option: &str, message: &str, found: &str) -> PyErr {
    refused_plainly::<OptionError>(format!("{option}: {message}, found {found:?}"))
}
