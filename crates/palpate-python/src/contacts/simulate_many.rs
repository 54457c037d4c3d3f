//! One protocol with many numbers.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::{ArrayRef, FixedSizeListArray, Float64Array, Int64Array, StringArray};
use arrow_schema::{DataType, Field};
use palpate::simulate::{Sampling, simulate};
use palpate::watch::{Cancelled, Progress};
use palpate_files::description::{Sweep, parse_runs};
use palpate_files::parquet_table::{Rows, Values};
use palpate_jobs::{sweep_fields, sweep_rows};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::prelude::*;

use super::protocol::StatedProtocol;
use crate::arrays::doubles;
use crate::errors::{ModelError, PalpateError, refused_plainly};
use crate::table::Table;
use crate::work::{Heard, at_length_reported, in_parallel};

/// Runs that are the work of one thread at a time.
const SHARE: u64 = 16;

/// Simulates a protocol in a file or in a text for many values of its numbers, in SI; a row a run.
#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "arguments of Python")]
pub(crate) fn simulate_many(
    py: Python<'_>,
    path: Option<PathBuf>,
    text: Option<String>,
    numbers: Vec<(String, Bound<'_, PyAny>)>,
    times_s: Option<&Bound<'_, PyAny>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Table> {
    let protocol = StatedProtocol::new(path, text)?;
    let numbers = numbers.iter().map(|(name, values)| Ok((name.clone(), doubles(values, name)?)));
    let numbers: Vec<(String, Vec<f64>)> = numbers.collect::<PyResult<_>>()?;
    let times = times_s.map(|times| doubles(times, "times_s")).transpose()?;
    let run = move |heard: Heard| {
        let sweep = protocol.parsed_with(&numbers, |text, path| parse_runs(text, path, &numbers))?;
        simulated(&sweep, &protocol.path, times.as_deref(), &heard)
    };
    at_length_reported(py, progress.as_ref(), run)?
}

/// A row for each run; with `times` the forces then.
fn simulated(sweep: &Sweep, path: &Path, times: Option<&[f64]>, heard: &Heard) -> PyResult<Table> {
    if let Some(times) = times {
        // Times outside the motion are wrong for all runs alike, but for those whose holds are swept.
        let base = &sweep.base;
        simulate(base.drive(), &base.contact, &Sampling::Times(times.to_vec()))
            .map_err(refused_plainly::<ModelError>)?;
    }
    let times = times.unwrap_or_default();
    let share = |share: u64| {
        let runs = share * SHARE..((share + 1) * SHARE).min(sweep.runs);
        let (Rows { columns }, forces) = sweep_rows(sweep, path, runs, times, &mut |_: Progress<'_>| heard.step())?;
        Ok((columns, forces))
    };
    let shares = (0..sweep.runs.div_ceil(SHARE)).into_par_iter().map(share);
    let shares = in_parallel(|| shares.collect::<Result<Vec<_>, Cancelled>>());
    let shares = shares.map_err(refused_plainly::<PalpateError>)?.map_err(refused_plainly::<PalpateError>)?;
    let fields = sweep_fields(sweep);
    let columns = fields.iter().enumerate().map(|(index, field)| {
        let parts = shares.iter().filter_map(|(columns, _)| columns.get(index));
        (field.name.as_str(), joined(parts))
    });
    let mut columns: Vec<(&str, ArrayRef)> = columns.collect();
    if !times.is_empty() {
        let all = shares.iter().flat_map(|(_, forces)| forces);
        columns.push(("force_n", lists(all, times.len())?));
    }
    Table::of(columns)
}

/// The parts of one column as one.
fn joined<'a>(parts: impl Iterator<Item = &'a Values>) -> ArrayRef {
    let (mut counts, mut numbers, mut texts) = (Vec::new(), Vec::new(), Vec::new());
    for part in parts {
        match part {
            Values::Count(values) => counts.extend_from_slice(values),
            Values::OptionalCount(values) => numbers.extend(values.iter().map(|value| value.map(|count| count as f64))),
            Values::Number(values) => numbers.extend_from_slice(values),
            Values::Text(values) => texts.extend_from_slice(values),
        }
    }
    if !texts.is_empty() {
        return Arc::new(StringArray::from(texts));
    }
    if counts.is_empty() {
        Arc::new(Float64Array::from(numbers))
    } else {
        Arc::new(Int64Array::from(counts))
    }
}

/// Rows of `samples` numbers each.
fn lists<'a>(rows: impl Iterator<Item = &'a Option<Vec<f64>>>, samples: usize) -> PyResult<ArrayRef> {
    let (mut flat, mut valid) = (Vec::new(), Vec::new());
    for row in rows {
        valid.push(row.is_some());
        match row {
            Some(row) => flat.extend_from_slice(row),
            None => flat.extend(std::iter::repeat_n(f64::NAN, samples)),
        }
    }
    let item = Arc::new(Field::new("item", DataType::Float64, false));
    let width = i32::try_from(samples).map_err(refused_plainly::<PyRuntimeError>)?;
    let list = FixedSizeListArray::try_new(item, width, Arc::new(Float64Array::from(flat)), Some(valid.into()));
    Ok(Arc::new(list.map_err(refused_plainly::<PyRuntimeError>)?))
}
