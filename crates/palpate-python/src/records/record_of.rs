//! A record of columns that Python has, checked, with where it comes from.

use palpate::record::{Record as Measured, RecordError as Unlike};
use palpate::watch::{Unwatched, Watch};
use palpate_jobs::input::record_sha256;
use palpate_report::result::Input;
use pyo3::prelude::*;

use crate::errors::{PalpateError, RecordError, refused, refused_plainly};
use crate::records::columns::Columns;
use crate::work::{at_length, briefly};

/// Samples that are checked and digested in a few milliseconds.
const BRIEF: usize = 100_000;

/// The title of a record of arrays that has none, the default of `title`.
const UNTITLED: &str = "record";

/// A record of columns of Python: time, displacement, force.
pub(super) fn record_of(
    py: Python<'_>,
    (time, displacement, force): Columns,
    title: &str,
) -> PyResult<(Measured, Input)> {
    let is_brief = time.len() <= BRIEF;
    let make = move |watch: &mut dyn Watch| {
        let record = Measured::new(time, displacement, force)?;
        let sha256 = record_sha256(&record, watch);
        Ok((record, sha256))
    };
    let made = match is_brief {
        true => briefly(py, move || make(&mut Unwatched))?,
        false => at_length(py, move |mut heard| make(&mut heard))?,
    };
    let (record, sha256) = made.map_err(|error: Unlike| refused::<RecordError>(&error, Some(error.hint())))?;
    let input = Input {
        path: "arrays".to_owned(),
        // What tells one of several from the others.
        part: Some(title.to_owned()).filter(|title| title != UNTITLED),
        sha256: sha256.map_err(refused_plainly::<PalpateError>)?,
        test_sha256: None,
        air_run_sha256: None,
        then_sha256: None,
        depends_on_sha256: None,
        rows: record.len(),
        rows_averaged: 1,
        x_m: None,
        y_m: None,
        map_index: None,
        test: None,
        title: title.to_owned(),
    };
    Ok((record, input))
}
