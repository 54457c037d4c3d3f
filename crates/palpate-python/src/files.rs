//! Jobs from files to files and to text, as the command does them.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use palpate::laws::Law;
use palpate::segment::HoldStart;
use palpate_files::description::{NamedColumns, parse_hold_start, parse_test, read_material};
use palpate_jobs::input::{Described, Fetch, NamedFile, NamedRecords, OpenedFile};
use palpate_jobs::output::write_bundle;
use palpate_jobs::{
    Batch, BatchAnswer, Batched, Convert, CurveMap, HoldObserved, Inspect, Observed, Reproduce, Results, Shard,
    WatchLog,
};
use palpate_report::document::{WatchDocument, WatchSummaryDocument};
use palpate_report::study::reproduction_bundle;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyMapping};
use serde::{Deserialize, Serialize};

use crate::errors::{OptionError, PalpateError, failed, of_mapping, refused_plainly, undescribed};
use crate::fits::fit_hold;
use crate::listed::{Listed, Threads};
use crate::mappings::quantity;
use crate::report_files::{csv_locale as readers, file_options};
use crate::shown::shown;
use crate::table::{Table, columns};
use crate::work::{job, plain, writing_job};

/// An argument of Python of several kinds.
pub(crate) type Given<'py, 'a> = Option<&'a Bound<'py, PyAny>>;

/// A path, or a text, as a function of the package tells of what was given.
pub(crate) fn stated(tell: &str, given: &Bound<'_, PyAny>) -> PyResult<(Option<PathBuf>, Option<String>)> {
    given.py().import("palpate._descriptions")?.call_method1(tell, (given,))?.extract()
}

/// A file of records as the package tells it apart: by its path, by a name and its bytes, or by a name, a size and what fetches its bytes.
#[derive(FromPyObject)]
pub(crate) enum FileOfPython {
    Here(PathBuf, Option<Vec<u8>>),
    Remote(PathBuf, u64, Py<PyAny>),
}

/// Calls a function of Python for the bytes of a file.
#[derive(Debug)]
struct Fetched(Py<PyAny>);

impl Fetch for Fetched {
    fn fetch(&self) -> io::Result<Vec<u8>> {
        // An error of the operating system keeps its kind.
        Ok(Python::attach(|py| self.0.call0(py)?.extract(py))?)
    }
}

pub(crate) fn named(file: FileOfPython) -> NamedFile {
    match file {
        FileOfPython::Here(name, Some(bytes)) => NamedFile::Bytes(name, bytes.into()),
        FileOfPython::Here(name, None) => NamedFile::Path(name),
        FileOfPython::Remote(name, size, fetch) => NamedFile::Remote(name, size, Arc::new(Fetched(fetch))),
    }
}

/// The file of a record: a path, bytes, or an object that is read, with the name that is given beside it.
pub(crate) fn record_file(given: &Bound<'_, PyAny>, name: Option<&str>) -> PyResult<NamedFile> {
    given
        .py()
        .import("palpate._files")?
        .call_method1("record_file", (given, name))?
        .extract()
        .map(named)
}

/// Several files of records.
pub(crate) fn record_files(given: &Bound<'_, PyAny>) -> PyResult<Vec<NamedFile>> {
    let found: Vec<FileOfPython> =
        given.py().import("palpate._files")?.call_method1("record_files", (given,))?.extract()?;
    Ok(found.into_iter().map(named).collect())
}

/// The description of records in a file, with the part that is meant, and the path that it has.
pub(crate) fn described(test: Given<'_, '_>, part: Given<'_, '_>) -> PyResult<(Described, Option<PathBuf>)> {
    let part = part.map(|part| part.str()?.extract::<String>()).transpose()?;
    let (path, text) = test.map(|test| stated("described", test)).transpose()?.unwrap_or_default();
    Ok((read_or_parsed(path.as_deref(), text, part.as_deref())?, path))
}

/// Likewise, with columns that are named beside it.
pub(crate) fn described_with(test: Given<'_, '_>, part: Given<'_, '_>, columns: Given<'_, '_>) -> PyResult<Described> {
    Ok(described(test, part)?.0.with_columns(named_columns(columns)?.as_ref()))
}

/// The columns that an argument names: a text as the command takes it, or a mapping from quantities to "name:unit".
fn named_columns(columns: Given<'_, '_>) -> PyResult<Option<NamedColumns>> {
    let Some(columns) = columns else { return Ok(None) };
    let text = match columns.cast::<PyMapping>() {
        Ok(mapping) => {
            let entry = |item: Bound<'_, PyAny>| {
                let (quantity, column): (String, String) = item.extract()?;
                Ok(format!("{quantity}={column}"))
            };
            let entries: PyResult<Vec<String>> = mapping.items()?.iter().map(entry).collect();
            entries?.join(",")
        }
        Err(_) => columns.extract()?,
    };
    NamedColumns::parse(&text).map(Some).map_err(refused_plainly::<OptionError>)
}

/// The description in a file or in a text.
pub(crate) fn read_or_parsed(path: Option<&Path>, text: Option<String>, part: Option<&str>) -> PyResult<Described> {
    match text {
        Some(text) => {
            parse_test(&text, Path::new("test")).map_err(of_mapping).map_err(undescribed)?;
            Described::parse(text, part)
        }
        None => Described::read(path, part),
    }
    .map_err(failed)
}

/// A law by its name.
pub(crate) fn law(name: &str) -> PyResult<Law> {
    name.parse().map_err(refused_plainly::<OptionError>)
}

/// Laws by their names.
pub(crate) fn all_laws(names: &[String]) -> PyResult<Vec<Law>> {
    names.iter().map(|name| law(name)).collect()
}

/// A shard as its text states it.
pub(crate) fn shard(text: &str) -> PyResult<Shard> {
    text.parse().map_err(|message: String| refused_plainly::<OptionError>(format!("shard: {message}")))
}

/// What is in a file of records: columns, sampling, phases; the text of ``palpate inspect``.
///
/// Parameters
/// ----------
/// path, name, test, part, columns
///     As for `read`.
///
/// Returns
/// -------
/// str
///
/// Raises
/// ------
/// RecordError, OptionError, OSError
///     As for `read`.
#[pyfunction]
#[pyo3(signature = (path, *, name=None, test=None, part=None, columns=None))]
pub(crate) fn inspect(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    name: Option<&str>,
    test: Given<'_, '_>,
    part: Given<'_, '_>,
    columns: Given<'_, '_>,
) -> PyResult<String> {
    let (file, described) = (record_file(path, name)?, described_with(test, part, columns)?);
    job(py, move |watch| {
        let found = Inspect::default().run(&OpenedFile::named(&file, &described)?, watch)?.result;
        let text = found.text();
        found.refused.map_or(Ok(text), Err)
    })
}

/// Write the record in a file of any format as a plain table in SI, with where it comes from: ``palpate convert``.
///
/// Parameters
/// ----------
/// path, name, test, part, columns
///     As for `read`.
/// out
///     A file ending in .csv, .xlsx, .parquet or .json; it appears whole or not at all.
/// csv_locale
///     Language of the readers of a CSV, as for `Analysis.report`.
///
/// Returns
/// -------
/// Path
///     The file.
///
/// Raises
/// ------
/// RecordError, OptionError, OSError
///     As for `read`; also a name that says no format.
#[pyfunction]
#[pyo3(signature = (path, out, *, name=None, test=None, part=None, columns=None, csv_locale=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn convert(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    out: PathBuf,
    name: Option<&str>,
    test: Given<'_, '_>,
    part: Given<'_, '_>,
    columns: Given<'_, '_>,
    csv_locale: Option<&str>,
) -> PyResult<PathBuf> {
    let (file, described) = (record_file(path, name)?, described_with(test, part, columns)?);
    let convert = Convert {
        csv_locale: readers(csv_locale)?,
    };
    let read = job(py, move |watch| convert.run(&OpenedFile::named(&file, &described)?, watch))?.result;
    writing_job(py, move |watch| {
        read.write(&out, watch)?;
        Ok(out)
    })
}

/// Analyse many records into one table, a row per hold and law: ``palpate batch``.
///
/// What is done is kept beside the table: a batch that was ended goes on where it stood.
///
/// Parameters
/// ----------
/// paths
///     Files, folders with files, or patterns; also bytes and objects that are read, as for `read`, or a mapping from names to these.
///     A zip archive of several files gives the tests in all of them.
/// out
///     A table ending in .parquet or .csv.
/// test
///     Test description of all of them.
/// columns
///     As for `read`.
/// laws
///     Laws to fit besides the latency law.
/// intervals
///     Method of the intervals of fits: "automatic" (if left out), "curvature", "profile" or "bootstrap".
/// fit_until_s
///     Fit only this long from the start of each hold, s.
/// hold_start
///     Where the fit of a hold starts: "peak", "settled" or "peak + 0.5 s"; that of the description, or "peak", if left out.
/// map
///     Quantities to draw as maps over the positions of the curves, by the names that `BatchResult.map` takes; each goes into a file
///     beside the table, or into FILE (.svg, .png or .pdf) of "NAME=FILE".
/// csv_locale
///     Language of the readers of a CSV, as for `Analysis.report`.
/// restart
///     Whether all records are analysed again, whatever was done before.
/// shard
///     "3/40": analyse only the third of 40 slices of the files, equal in bytes, into the folder `out` that all slices share; `merge` makes
///     one table of them.
/// threads
///     How many records are analysed side by side; as many as there are processors if left out. The table does not depend on it.
///
/// Returns
/// -------
/// BatchResult
///     The law recommended on the most holds, its parameters over them, the most frequent findings, and the tests without rows.
///
/// Raises
/// ------
/// OptionError, OSError
///     A description or a law that is wrong, a table that cannot be written.
#[pyfunction]
#[pyo3(signature = (paths, out, *, test=None, columns=None, laws=None, intervals=None, fit_until_s=None, hold_start=None, map=None, csv_locale=None, restart=false, shard=None, threads=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn batch(
    py: Python<'_>,
    paths: &Bound<'_, PyAny>,
    out: PathBuf,
    test: Given<'_, '_>,
    columns: Given<'_, '_>,
    laws: Option<Listed<String>>,
    intervals: Option<&str>,
    #[pyo3(from_py_with = quantity::seconds)] fit_until_s: Option<f64>,
    hold_start: Option<&str>,
    map: Option<Vec<String>>,
    csv_locale: Option<&str>,
    restart: bool,
    shard: Option<&str>,
    threads: Option<Threads>,
) -> PyResult<BatchResult> {
    let (files, described) = (record_files(paths)?, described_with(test, None, columns)?);
    let question = Batch {
        laws: laws.map(|laws| all_laws(&laws)).transpose()?,
        intervals: intervals.map(fit_hold::intervals).transpose()?,
        fit_until_s,
        hold_start: hold_start.map(start_of_holds).transpose()?,
        map: map.unwrap_or_default(),
        csv_locale: readers(csv_locale)?,
        restart,
        shard: shard.map(self::shard).transpose()?,
        threads: threads.map(|threads| threads.0),
    };
    let table = out.clone();
    let done = writing_job(py, move |watch| question.run(NamedRecords::find(files, described)?, &out, watch))?;
    Ok(BatchResult::new(done.result, &table))
}

/// Where the fit of a hold starts, as a keyword says it.
pub(crate) fn start_of_holds(text: &str) -> PyResult<HoldStart> {
    parse_hold_start(text).map_err(|error| refused_plainly::<OptionError>(format!("hold_start: {error}")))
}

impl BatchResult {
    pub(crate) fn new(done: Batched, table: &Path) -> Self {
        let table = table.to_string_lossy().into_owned();
        Self {
            answer: done.answer,
            rows: done.rows,
            map: done.map,
            table,
            failures: done.failures.into_iter().map(|refused| refused.message).collect(),
        }
    }
}

/// What a batch found over all holds; ``print(result)`` shows what ``palpate batch`` prints.
#[pyclass(frozen, eq, name = "BatchResult", module = "palpate")]
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct BatchResult {
    answer: BatchAnswer,
    rows: usize,
    map: CurveMap,
    table: String,
    failures: Vec<String>,
}

/// Wherever their tables stand.
impl PartialEq for BatchResult {
    fn eq(&self, other: &Self) -> bool {
        (self.rows, &self.answer, &self.map, &self.failures) == (other.rows, &other.answer, &other.map, &other.failures)
    }
}

shown! {
    BatchResult: self
    values {
        /// The law that is recommended on the most holds; None where none was fitted.
        law: Option<&str> = self.answer.laws.first().map(|(law, _)| law.as_str()),
        /// Every recommended law with the number of holds that it is recommended for, the most first.
        laws<'py>(py): PyResult<Bound<'py, PyDict>> = self.answer.laws.clone().into_py_dict(py),
        /// The parameters of that law over those holds, a row each: ``parameter``, ``unit``, ``median``, ``lower_quartile``,
        /// ``upper_quartile``, ``holds``.
        parameters: PyResult<Table> = Table::of(columns!(&self.answer.parameters, spread =>
            parameter = spread.name.clone(), unit = spread.unit.clone(), median = spread.quartiles[1],
            lower_quartile = spread.quartiles[0], upper_quartile = spread.quartiles[2], holds = spread.holds
        )),
        /// The most frequent findings by code, with the number of holds that have them.
        findings<'py>(py): PyResult<Bound<'py, PyDict>> = self.answer.findings.clone().into_py_dict(py),
        /// Holds in all.
        holds: usize = self.answer.holds,
        /// Holds without a fitted law.
        unfitted: usize = self.answer.unfitted,
        /// Tests without a hold; each has one row, whose ``termination`` says why.
        without_hold: usize = self.answer.without_hold,
        /// Median of Young's modulus of the first loading ramp over the tests that have one, Pa.
        loading_modulus_pa: Option<f64> = self.answer.loading_modulus.as_ref().map(|found| found.quartiles[1]),
        /// Path of the table, as given: ``pandas.read_parquet(result.table)``.
        table: &str = &self.table,
        /// Rows of the table.
        rows: usize = self.rows,
        /// Why tests gave no rows, a sentence each.
        failures: Vec<String> = self.failures.clone(),
    }

    /// A map of a quantity over the positions of the curves, as SVG.
    ///
    /// Parameters
    /// ----------
    /// quantity : str
    ///     A parameter of the law recommended for the first hold of each curve, or a column of the table, by its name; "v", "n" and "E"
    ///     stand for ``rate_coefficient_per_s``, ``exponent`` and ``loading_modulus_pa``.
    ///
    /// Returns
    /// -------
    /// str
    ///     Cells where the positions form a grid, otherwise points, with a bar of colours.
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     No curve has a position, or none a value of that name.
    fn map(&self, quantity: &str) -> PyResult<String> {
        let figure = self.map.figure(quantity, "map").map_err(failed)?;
        figure.to_svg().map_err(refused_plainly::<PalpateError>)
    }

    fn __str__(&self) -> String {
        self.answer.text()
    }

    fn __repr__(&self) -> String {
        let law = self.law().unwrap_or("none");
        format!("<palpate.BatchResult of {} holds: law {law}, {} failures>", self.holds(), self.failures.len())
    }
}

/// Judge every claim of the paper, or its conclusions on a record, into a folder: ``palpate reproduce``.
///
/// Parameters
/// ----------
/// folder
///     Made if it is not there.
/// figures, column, csv_locale
///     As for `Analysis.report`.
/// seeds
///     Laboratories that repeat the tests with each ball, one seed each; 32 if left out. Not with a record.
/// sample_rate_hz
///     Their sampling rate, Hz; 50 if left out. Not with a record.
/// repeatability_n
///     Error of a single reading of their force where 0.2 N is that of the zero, N; 0.02 if left out. Not with a record.
/// record, name, test, part, columns
///     A record of one's own, as ``path`` and the others of `read`; it is shown in the layout of the paper, with its conclusions.
///
/// Returns
/// -------
/// dict
///     What summary.json holds: ``claims`` with their verdicts, and more; ``palpate schema reproduction`` and ``reproduced-record`` print
///     the schemas.
///
/// Raises
/// ------
/// RecordError, OptionError, OSError
///     As for `read`; seeds or a sampling rate out of range; a folder that cannot be written to.
///
/// Examples
/// --------
/// >>> import palpate, tempfile
/// >>> with tempfile.TemporaryDirectory() as folder:
/// ...     study = palpate.reproduce(folder, seeds=4, sample_rate_hz=10.0)
/// >>> first = study["claims"][0]
/// >>> first["place"], first["verdict"], first["comparisons"][0]["paper"]
/// ('Abstract', 'not_reproduced', -0.1661)
#[pyfunction]
#[pyo3(signature = (
    folder, *, figures=None, column=None, csv_locale=None, seeds=None, sample_rate_hz=None, repeatability_n=None, record=None, name=None, test=None, part=None, columns=None,
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn reproduce<'py>(
    py: Python<'py>,
    folder: PathBuf,
    figures: Option<Listed<String>>,
    column: Option<&str>,
    csv_locale: Option<&str>,
    seeds: Option<usize>,
    #[pyo3(from_py_with = quantity::hertz)] sample_rate_hz: Option<f64>,
    #[pyo3(from_py_with = quantity::newtons)] repeatability_n: Option<f64>,
    record: Given<'py, '_>,
    name: Option<&str>,
    test: Given<'py, '_>,
    part: Given<'py, '_>,
    columns: Given<'py, '_>,
) -> PyResult<Bound<'py, PyAny>> {
    let options = file_options(figures, column, csv_locale)?;
    let Some(record) = record else {
        if name.is_some() || test.is_some() || part.is_some() || columns.is_some() {
            return Err(OptionError::new_err("name, test, part and columns describe a record: give the record too"));
        }
        let usual = Reproduce::default();
        let question = Reproduce {
            seeds: seeds.unwrap_or(usual.seeds),
            sample_rate_hz: sample_rate_hz.unwrap_or(usual.sample_rate_hz),
            repeatability_n: repeatability_n.unwrap_or(usual.repeatability_n),
        };
        let document = writing_job(py, move |watch| {
            let study = question.run(watch)?.result;
            write_bundle(&folder, &reproduction_bundle(&study, &options, watch)?)?;
            Ok(study.document())
        })?;
        return plain(py, &document);
    };
    if seeds.is_some() || sample_rate_hz.is_some() || repeatability_n.is_some() {
        return Err(OptionError::new_err(
            "seeds, sample_rate_hz and repeatability_n belong to the paper's study: leave them out with a record",
        ));
    }
    let (file, described) = (record_file(record, name)?, described_with(test, part, columns)?);
    let document = writing_job(py, move |watch| {
        let opened = OpenedFile::named(&file, &described)?;
        let measured = opened.measurement(opened.only()?, watch)?;
        let found = Reproduce::of_record(measured, watch)?.result;
        write_bundle(&folder, &found.bundle(&options, watch)?)?;
        Ok(found.document())
    })?;
    plain(py, &document)
}

/// Watch a recorded log as if it came in live: the lines of ``palpate watch --format jsonl``.
///
/// Parameters
/// ----------
/// path, name, test, part, columns
///     As for `read`.
/// material
///     Path of a material file; the excess strain is then known from first touch on.
/// exponent
///     Exponent of the law where no material says it; 5 if left out.
/// slip_force_n
///     Normal force at which what is held slips, N.
/// warn_before_s
///     How long before slip to warn, s; 1 if left out.
/// every_s
///     Time of the log between two ticks that are reported, s; 0.5 if left out.
///
/// Returns
/// -------
/// list of dict
///     Ticks and events in order, the holds last; ``palpate schema watch`` prints the schema of each.
///
/// Raises
/// ------
/// RecordError, OptionError, OSError
///     As for `read` and `Observer`.
#[pyfunction]
#[pyo3(signature = (
    path, *, name=None, test=None, part=None, columns=None, material=None, exponent=None, slip_force_n=None, warn_before_s=None, every_s=None,
))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn watch<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    name: Option<&str>,
    test: Given<'py, '_>,
    part: Given<'py, '_>,
    columns: Given<'py, '_>,
    material: Option<PathBuf>,
    exponent: Option<f64>,
    #[pyo3(from_py_with = quantity::newtons)] slip_force_n: Option<f64>,
    #[pyo3(from_py_with = quantity::seconds)] warn_before_s: Option<f64>,
    #[pyo3(from_py_with = quantity::seconds)] every_s: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let (file, described) = (record_file(path, name)?, described_with(test, part, columns)?);
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
        let opened = OpenedFile::named(&file, &described)?;
        let measured = opened.measurement(opened.only()?, watch)?;
        let (place, mut lines) = (file.name().display().to_string(), Vec::new());
        let holds = log.run((&measured.record, &place), material, watch, |observed: Observed| {
            lines.extend(observed.document());
            true
        })?;
        let holds = holds.result.iter().map(HoldObserved::document).collect();
        lines.push(WatchDocument::Summary(WatchSummaryDocument::new(holds)));
        Ok(lines)
    })?;
    plain(py, &lines)
}
