//! Jobs from files to files and to text, as the command does them.

use std::path::{Path, PathBuf};

use palpate::laws::Law;
use palpate_files::description::read_material;
use palpate_jobs::input::{Described, NamedRecords, OpenedFile};
use palpate_jobs::output::write_bundle;
use palpate_jobs::{Batch, Convert, HoldSeen, Inspect, Reproduce, Seen, Sweep, WatchLog};
use palpate_report::document::{WatchDocument, WatchSummaryDocument};
use palpate_report::study::Pictures;
use pyo3::prelude::*;

use crate::errors::{OptionError, failed, refused_plainly};
use crate::work::{at_length_told, job, plain};

/// What is said about the records in a file.
type Said = (Option<PathBuf>, Option<String>);

/// Its description; `part` is the one that is meant.
pub(crate) fn described(path: Option<&Path>, text: Option<String>, part: Option<&str>) -> PyResult<Described> {
    match (path, text) {
        (None, Some(text)) => Described::parse(text, part),
        (path, _) => Described::read(path, part),
    }
    .map_err(failed)
}

/// Likewise, of arguments of Python.
fn all_said(((path, text), part): (Said, Option<String>)) -> PyResult<Described> {
    described(path.as_deref(), text, part.as_deref())
}

/// A law by its name.
pub(crate) fn law(name: &str) -> PyResult<Law> {
    name.parse().map_err(refused_plainly::<OptionError>)
}

/// What is in a file of records, as text.
#[pyfunction]
pub(crate) fn inspect(py: Python<'_>, path: PathBuf, said: Said, part: Option<String>) -> PyResult<String> {
    let described = all_said((said, part))?;
    job(py, move |watch| {
        let found = Inspect::default().run(&OpenedFile::open(&path, &described)?, watch)?.result;
        found.refused.map_or(Ok(found.text), Err)
    })
}

/// Writes the one record of a file as a table in SI.
#[pyfunction]
pub(crate) fn convert(py: Python<'_>, path: PathBuf, out: PathBuf, said: Said, part: Option<String>) -> PyResult<()> {
    let described = all_said((said, part))?;
    job(py, move |watch| Convert {}.run(&OpenedFile::open(&path, &described)?, watch)?.result.write(&out))
}

/// Analyses records into one table; the rows that it has, and why some tests gave none.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
#[expect(clippy::needless_pass_by_value, reason = "arguments of Python")]
pub(crate) fn batch(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    out: PathBuf,
    said: Said,
    laws: Option<Vec<String>>,
    fit_until_s: Option<f64>,
    restart: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<(usize, Vec<String>)> {
    let described = all_said((said, None))?;
    let laws = laws.map(|laws| laws.iter().map(|name| law(name)).collect::<PyResult<_>>()).transpose()?;
    let job = Batch {
        laws,
        fit_until_s,
        restart,
        ..Batch::default()
    };
    let done = at_length_told(py, progress.as_ref(), move |mut heard| {
        job.run(NamedRecords::find(&paths, described)?, &out, &mut heard)
    })?;
    let done = done.map_err(failed)?.result;
    Ok((done.rows, done.failures.into_iter().map(|refused| refused.message).collect()))
}

/// Simulates the runs of a sweep into one table; how many runs it has, and how many were refused.
#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "arguments of Python")]
pub(crate) fn sweep(
    py: Python<'_>,
    path: PathBuf,
    out: PathBuf,
    figure: Option<PathBuf>,
    show: Option<String>,
    restart: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<(u64, u64)> {
    let usual = Sweep::default();
    let job = Sweep {
        show: show.unwrap_or(usual.show),
        restart,
        threads: None,
    };
    let done = at_length_told(py, progress.as_ref(), move |mut heard| {
        job.run(&path, Some(&out), figure.as_deref(), &mut heard)
    })?;
    let done = done.map_err(failed)?.result;
    Ok((done.runs, done.refused))
}

/// Reproduces the paper's study into a folder; whether every check passes.
#[pyfunction]
pub(crate) fn reproduce(py: Python<'_>, folder: PathBuf, png: bool) -> PyResult<bool> {
    job(py, move |watch| {
        let done = Reproduce {}.run(watch)?;
        write_bundle(&folder, &done.bundle(Pictures { png })?)?;
        Ok(done.result.all_passed())
    })
}

/// What an observer reports of a recorded log, an object each.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn watch<'py>(
    py: Python<'py>,
    path: PathBuf,
    said: Said,
    part: Option<String>,
    material: Option<PathBuf>,
    exponent: Option<f64>,
    slip_force_n: Option<f64>,
    warn_before_s: Option<f64>,
    every_s: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let described = all_said((said, part))?;
    let usual = WatchLog::default();
    let log = WatchLog {
        exponent: exponent.unwrap_or(usual.exponent),
        slip_force_n,
        warn_before_s: warn_before_s.unwrap_or(usual.warn_before_s),
        every_s: every_s.unwrap_or(usual.every_s),
        ..usual
    };
    let lines = job(py, move |watch| {
        let material = material.as_deref().map(read_material).transpose()?;
        let opened = OpenedFile::open(&path, &described)?;
        let measured = opened.measurement(opened.only()?, watch)?;
        let (place, mut lines) = (path.display().to_string(), Vec::new());
        let holds = log.run((&measured.record, &place), material, watch, |seen: Seen| {
            lines.extend(seen.document());
            true
        })?;
        let holds = holds.result.iter().map(HoldSeen::document).collect();
        lines.push(WatchDocument::Summary(WatchSummaryDocument::new(holds)));
        Ok(lines)
    })?;
    plain(py, &lines)
}
