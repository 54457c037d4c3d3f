//! Slices of a batch or a sweep, and all of them as one table.

use std::path::PathBuf;

use palpate_jobs::input::{Described, NamedFile, NamedRecords};
use palpate_jobs::{Batch, Merge, Merged, Shard, Slice, forget};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::errors::{OptionError, failed, refused_plainly};
use crate::files::{BatchResult, FileOfPython, Given, all_laws, described_with, named, shard};
use crate::fits::fit_hold;
use crate::listed::Listed;
use crate::mappings::quantity;
use crate::report_files::csv_locale as readers;
use crate::work::writing_job;

/// Make one table of the shards of `batch` or `sweep`, byte for byte that of the whole at once: ``palpate merge``.
///
/// Parameters
/// ----------
/// folders
///     The folders that the shards had as their ``out``.
/// out
///     A table ending in .parquet or .csv; of a sweep in .parquet.
/// map
///     Maps over the positions of the curves of a batch, as for `batch`.
/// csv_locale
///     Language of the readers of a CSV, as for `Analysis.report`.
///
/// Returns
/// -------
/// BatchResult | tuple[int, int]
///     What `batch` or `sweep` of the whole returns.
///
/// Raises
/// ------
/// OptionError, OSError
///     A shard that is missing, there twice, of other files, settings or another version, or damaged; a table that cannot be written.
#[pyfunction]
#[pyo3(signature = (folders, out, *, map=None, csv_locale=None))]
pub(crate) fn merge<'py>(
    py: Python<'py>,
    folders: Vec<PathBuf>,
    out: PathBuf,
    map: Option<Vec<String>>,
    csv_locale: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let question = Merge {
        map: map.unwrap_or_default(),
        csv_locale: readers(csv_locale)?,
    };
    let table = out.clone();
    match writing_job(py, move |watch| question.run(&folders, &out, watch))?.result {
        Merged::Batch(done) => BatchResult::new(*done, &table).into_bound_py_any(py),
        Merged::Sweep(done) => (done.runs, done.refused).into_bound_py_any(py),
    }
}

/// A slice without its files: number, of, digest of the plan, how many files there are, its first one, and how many, start and end in shares
/// of the first and the last.
type SliceOfPython = (u32, u32, String, usize, usize, usize, f64, f64);

/// The paths that names lead to, in the order of a batch.
#[pyfunction]
pub(crate) fn _found(py: Python<'_>, paths: Vec<PathBuf>) -> PyResult<Vec<PathBuf>> {
    let found = py.detach(|| NamedRecords::find(paths, Default::default())).map_err(failed)?;
    Ok(found.names().map(PathBuf::from).collect())
}

/// The slices of files; each takes `count` of them from `first` on.
#[pyfunction]
pub(crate) fn _sliced(py: Python<'_>, files: Vec<FileOfPython>, of: u32) -> PyResult<Vec<SliceOfPython>> {
    let files: Vec<NamedFile> = files.into_iter().map(named).collect();
    let shards = Shard::all(of).map_err(|message| refused_plainly::<OptionError>(format!("shards: {message}")))?;
    let slices = py.detach(|| Slice::of(&files, shards)).map_err(failed)?;
    let stated = |slice: Slice| {
        let count = slice.files.len();
        (
            slice.shard.number(),
            slice.shard.of(),
            slice.plan_sha256,
            slice.total,
            slice.first,
            count,
            slice.start,
            slice.end,
        )
    };
    Ok(slices.into_iter().map(stated).collect())
}

/// A batch without its files, and the description of them.
fn question(
    test: Given<'_, '_>,
    columns: Given<'_, '_>,
    laws: Option<Listed<String>>,
    intervals: Option<&str>,
    fit_until_s: Option<f64>,
) -> PyResult<(Batch, Described)> {
    let question = Batch {
        laws: laws.map(|laws| all_laws(&laws)).transpose()?,
        intervals: intervals.map(fit_hold::intervals).transpose()?,
        fit_until_s,
        ..Batch::default()
    };
    Ok((question, described_with(test, None, columns)?))
}

/// Refuses what no slice could be analysed with.
#[pyfunction]
#[pyo3(signature = (*, test=None, columns=None, laws=None, intervals=None, fit_until_s=None))]
pub(crate) fn _checked(
    test: Given<'_, '_>,
    columns: Given<'_, '_>,
    laws: Option<Listed<String>>,
    intervals: Option<&str>,
    #[pyo3(from_py_with = quantity::seconds)] fit_until_s: Option<f64>,
) -> PyResult<()> {
    question(test, columns, laws, intervals, fit_until_s).map(drop)
}

/// Forgets a slice in the folder of all.
#[pyfunction]
pub(crate) fn _forget(py: Python<'_>, out: PathBuf, name: &str) -> PyResult<()> {
    let shard = shard(name)?;
    py.detach(move || forget(&out, shard)).map_err(failed)
}

/// Analyses a slice into the folder of all.
#[pyfunction]
#[pyo3(signature = (slice, files, out, *, test=None, columns=None, laws=None, intervals=None, fit_until_s=None, threads=1))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn _run_slice(
    py: Python<'_>,
    slice: SliceOfPython,
    files: Vec<FileOfPython>,
    out: PathBuf,
    test: Given<'_, '_>,
    columns: Given<'_, '_>,
    laws: Option<Listed<String>>,
    intervals: Option<&str>,
    #[pyo3(from_py_with = quantity::seconds)] fit_until_s: Option<f64>,
    threads: usize,
) -> PyResult<()> {
    let (number, of, plan_sha256, total, first, _, start, end) = slice;
    let slice = Slice {
        shard: shard(&format!("{number}/{of}"))?,
        plan_sha256,
        total,
        first,
        files: files.into_iter().map(named).collect(),
        start,
        end,
    };
    let (question, described) = question(test, columns, laws, intervals, fit_until_s)?;
    let question = Batch {
        threads: threads.try_into().ok(),
        ..question
    };
    writing_job(py, move |watch| question.run_slice(&slice, &described, &out, watch)).map(drop)
}
