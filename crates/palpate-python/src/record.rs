//! A measured record.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float32Type, Float64Type, Int32Type, Int64Type};
use arrow_array::{Array, ArrayRef, Float64Array};
use arrow_schema::DataType;
use numpy::PyArray1;
use palpate::analysis::{AnalysisOptions, corrected};
use palpate::record::{Correction, Record as Measured};
use palpate::segment::Segment;
use palpate_files::description::{TestDescription, parse_test, read_test};
use palpate_files::open::Contents;
use palpate_files::record::{ReadError, RecordFile, read_part, tests};
use palpate_report::result::Input;
use pyo3::prelude::*;
use pyo3::types::PyType;
use pyo3_arrow::PyTable;
use serde::{Deserialize, Serialize};

use crate::analysis::Analysis;
use crate::arrays::doubles;
use crate::calibration::{Calibration, Wanted, equilibrium_law, laws, rate_law};
use crate::document::{Document, Fields};
use crate::errors::{OptionError, RecordError, refused, refused_plainly, undescribed, unread};
use crate::table::Table;
use crate::work::{Made, at_length, briefly};

/// A record of time, force and, if there is one, displacement, in SI, checked; loading is positive.
///
/// Made by `palpate.read`, `Record.from_arrays` or `Record.from_arrow`. It never changes, can be compared, copied and pickled,
/// and is a table for polars, pandas and pyarrow.
///
/// Examples
/// --------
/// >>> import palpate
/// >>> record = palpate.Record.from_arrays(time_s=[0, 1, 2, 3], force_n=[0.0, 3.0, 2.0, 1.5], displacement_m=[0, 1e-3, 1e-3, 1e-3])
/// >>> len(record), float(record.force_n.max())
/// (4, 3.0)
#[pyclass(name = "Record", module = "palpate", frozen, eq)]
#[derive(Clone)]
pub(crate) struct Record {
    record: Measured,
    input: Input,
    test: Option<Described>,
}

/// A description, and the text that it is made of again elsewhere.
#[derive(Clone)]
struct Described {
    test: TestDescription,
    text: String,
}

/// The columns of a record and what was done to them.
#[derive(Serialize, Deserialize)]
pub(crate) struct Kept {
    time: Vec<f64>,
    displacement: Option<Vec<f64>>,
    force: Vec<f64>,
    corrections: Vec<Correction>,
}

impl Kept {
    pub(crate) fn of(record: &Measured) -> Self {
        Self {
            time: record.time().to_vec(),
            displacement: record.displacement().map(<[f64]>::to_vec),
            force: record.force().to_vec(),
            corrections: record.corrections().to_vec(),
        }
    }

    pub(crate) fn record(self) -> PyResult<Measured> {
        let record = Measured::new(self.time, self.displacement, self.force);
        let record = record.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        Ok(record.corrected_before(self.corrections))
    }
}

/// What a record is made of again.
#[derive(Serialize, Deserialize)]
struct Parts {
    measured: Kept,
    input: Input,
    test: Option<String>,
    part: Option<String>,
}

impl PartialEq for Record {
    fn eq(&self, other: &Self) -> bool {
        self.record == other.record
    }
}

/// A description in a file, or as text.
fn description(path: Option<PathBuf>, text: Option<&str>) -> PyResult<Option<Described>> {
    let (test, text) = match (path, text) {
        (Some(path), _) => (read_test(&path).map_err(undescribed)?, std::fs::read_to_string(&path)?),
        (None, Some(text)) => (parse_test(text, Path::new("test")).map_err(undescribed)?, text.to_owned()),
        (None, None) => return Ok(None),
    };
    Ok(Some(Described { test, text }))
}

/// The name of a test, and what its reading came to.
type ReadTest = (String, Result<RecordFile, ReadError>);

/// Every test that was asked for in a file, each read or refused.
fn opened(path: &Path, test: Option<&TestDescription>) -> Result<Vec<ReadTest>, ReadError> {
    let usual = TestDescription::default();
    let said = test.unwrap_or(&usual);
    let contents = Contents::open(path, &said.reading).map_err(ReadError::File)?;
    let found = tests(&contents, said)?;
    let one = |part: &usize| {
        let title = contents.parts()[*part].title().to_owned();
        (title, read_part(&contents, *part, test, &mut |_, _| {}))
    };
    Ok(found.parts.iter().map(one).collect())
}

/// Reads the records in a file, `only` one of them or all; `test_path` or `test_text` describes them.
#[pyfunction]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    test_path: Option<PathBuf>,
    test_text: Option<&str>,
    part: Option<String>,
    only: bool,
) -> PyResult<Vec<Record>> {
    let described_by = test_path.clone();
    let mut test = description(test_path, test_text)?;
    if part.is_some() {
        let mut said = test.unwrap_or_else(|| Described {
            test: TestDescription::default(),
            text: String::new(),
        });
        said.test.reading.part = part;
        test = Some(said);
    }
    let (read, test, sha256, path) = at_length(py, move || {
        let read = opened(&path, test.as_ref().map(|said| &said.test));
        let sha256 = std::fs::read(&path).map(|bytes| palpate_jobs::output::sha256(&bytes));
        (read, test, sha256, path)
    })?;
    let files = read.map_err(|error| unread(&error))?;
    if only && files.len() > 1 {
        let parts = files.into_iter().map(|(title, _)| title).collect();
        return Err(unread(&ReadError::SeveralParts { path, parts }));
    }
    let sha256 = sha256?;
    let stem = || path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let several = files.len() > 1;
    let record = |(name, file): ReadTest| {
        let file = file.map_err(|error| unread(&error))?;
        let title = test.as_ref().and_then(|said| said.test.about.title.clone()).unwrap_or_else(stem);
        let input = Input {
            path: path.display().to_string(),
            part: file.part.name.clone(),
            sha256: sha256.clone(),
            rows: file.rows,
            rows_averaged: file.averaged,
            test: described_by.as_ref().map(|path| path.display().to_string()),
            title: if several { format!("{title}, {name}") } else { title },
        };
        Ok(Record {
            record: file.record,
            input,
            test: test.clone(),
        })
    };
    files.into_iter().map(record).collect()
}

/// A column of numbers by its name, none missing.
fn column(table: &PyTable, name: &str) -> PyResult<Vec<f64>> {
    let mut values = Vec::new();
    for batch in table.batches() {
        let Some(column) = batch.column_by_name(name) else {
            let schema = batch.schema();
            let names: Vec<&str> = schema.fields().iter().map(|field| field.name().as_str()).collect();
            let message = format!("expected a column called {name:?}, found {}", names.join(", "));
            return Err(refused_plainly::<RecordError>(message));
        };
        if column.null_count() > 0 {
            let row = (0..column.len()).find(|row| column.is_null(*row)).unwrap_or(0);
            let message = format!("{name}: expected a number in every row, found none in row {}", values.len() + row);
            return Err(refused_plainly::<RecordError>(message));
        }
        match column.data_type() {
            DataType::Float64 => values.extend_from_slice(column.as_primitive::<Float64Type>().values()),
            DataType::Float32 => {
                values.extend(column.as_primitive::<Float32Type>().values().iter().map(|v| f64::from(*v)));
            }
            DataType::Int64 => values.extend(column.as_primitive::<Int64Type>().values().iter().map(|v| *v as f64)),
            DataType::Int32 => values.extend(column.as_primitive::<Int32Type>().values().iter().map(|v| f64::from(*v))),
            other => {
                let message = format!("{name}: expected a column of doubles, found one of {other}");
                return Err(refused_plainly::<RecordError>(message));
            }
        }
    }
    Ok(values)
}

/// What the keywords of `Record.analyze` say.
struct Asked {
    exponents: Option<Vec<f64>>,
    free_exponent: Option<bool>,
    confidence: Option<f64>,
    fit_until_s: Option<f64>,
    compare: bool,
}

impl Asked {
    fn over(self, mut options: AnalysisOptions) -> PyResult<AnalysisOptions> {
        if let Some(mut exponents) = self.exponents {
            if exponents.is_empty() || exponents.iter().any(|n| !(n.is_finite() && *n > 0.0)) {
                let message = format!("exponents are numbers above 0, found {exponents:?}");
                return Err(refused_plainly::<OptionError>(message));
            }
            exponents.sort_by(f64::total_cmp);
            exponents.dedup();
            options.exponents = exponents;
        }
        if let Some(confidence) = self.confidence {
            options.fit.confidence = coverage(confidence)?;
        }
        options.free_exponent = self.free_exponent.unwrap_or(options.free_exponent);
        options.fit_until = self.fit_until_s.or(options.fit_until);
        if !self.compare {
            options.compare = None;
        }
        Ok(options)
    }
}

/// Coverage of intervals.
pub(crate) fn coverage(confidence: f64) -> PyResult<f64> {
    if confidence > 0.0 && confidence < 1.0 {
        return Ok(confidence);
    }
    let message = format!("confidence is a share between 0 and 1, found {confidence}");
    Err(refused_plainly::<OptionError>(message))
}

impl Record {
    /// A record of columns of Python: time, displacement, force.
    fn checked(
        py: Python<'_>,
        (time, displacement, force): (Vec<f64>, Option<Vec<f64>>, Vec<f64>),
        title: &str,
    ) -> PyResult<Self> {
        let record = briefly(py, move || Measured::new(time, displacement, force))?;
        let record = record.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        let input = Input {
            path: "arrays".to_owned(),
            part: None,
            sha256: String::new(),
            rows: record.len(),
            rows_averaged: 1,
            test: None,
            title: title.to_owned(),
        };
        Ok(Self {
            record,
            input,
            test: None,
        })
    }

    fn options(&self) -> AnalysisOptions {
        self.test.as_ref().map_or_else(AnalysisOptions::default, |said| said.test.analysis_options())
    }

    /// The options of a description in place of that of the record, and what results say of it.
    fn described_by(&self, test: Option<&Bound<'_, PyAny>>) -> PyResult<(Input, AnalysisOptions)> {
        let mut input = self.input.clone();
        let Some(test) = test else {
            return Ok((input, self.options()));
        };
        let said = test.py().import("palpate")?.call_method1("_described", (test,))?;
        let (path, text): (Option<PathBuf>, Option<String>) = said.extract()?;
        input.test = path.as_ref().map(|path| path.display().to_string());
        let said = description(path, text.as_deref())?;
        Ok((input, said.map_or_else(AnalysisOptions::default, |said| said.test.analysis_options())))
    }
}

#[pymethods]
impl Record {
    /// A record of arrays in SI, loading positive.
    ///
    /// Parameters
    /// ----------
    /// time_s : array_like, shape (N,)
    ///     Times in s, rising; at least two.
    /// force_n : array_like, shape (N,)
    ///     Force in N.
    /// displacement_m : array_like, shape (N,), optional
    ///     Displacement of the jaw in m.
    /// title : str
    ///     For reports.
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     Columns of different lengths, values that are not finite, times that do not rise, a force that never changes.
    /// OptionError
    ///     Columns that are no numbers.
    #[classmethod]
    #[pyo3(signature = (*, time_s, force_n, displacement_m=None, title="record"))]
    fn from_arrays(
        class: &Bound<'_, PyType>,
        time_s: &Bound<'_, PyAny>,
        force_n: &Bound<'_, PyAny>,
        displacement_m: Option<&Bound<'_, PyAny>>,
        title: &str,
    ) -> PyResult<Self> {
        let displacement = displacement_m.map(|values| doubles(values, "displacement_m")).transpose()?;
        Self::checked(class.py(), (doubles(time_s, "time_s")?, displacement, doubles(force_n, "force_n")?), title)
    }

    /// A record of columns of a table in SI, loading positive.
    ///
    /// Parameters
    /// ----------
    /// table
    ///     Of polars, pandas, pyarrow, or anything else with ``__arrow_c_stream__``.
    /// time_s, force_n, displacement_m : str
    ///     Names of the columns. A displacement is looked for under its own name if none is given, and may be missing.
    /// title : str
    ///     For reports.
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     No such column, one that is no numbers or lacks some, or as for `from_arrays`.
    #[classmethod]
    #[pyo3(signature = (table, *, time_s="time_s", force_n="force_n", displacement_m=None, title="record"))]
    fn from_arrow(
        class: &Bound<'_, PyType>,
        table: &Bound<'_, PyAny>,
        time_s: &str,
        force_n: &str,
        displacement_m: Option<&str>,
        title: &str,
    ) -> PyResult<Self> {
        let table: PyTable = table.extract()?;
        let known = |name: &str| table.batches().first().is_none_or(|batch| batch.column_by_name(name).is_some());
        let usual = Some("displacement_m").filter(|name| known(name));
        let displacement = displacement_m.or(usual).map(|name| column(&table, name)).transpose()?;
        Self::checked(class.py(), (column(&table, time_s)?, displacement, column(&table, force_n)?), title)
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        let parts: Parts = serde_json::from_str(json).map_err(refused_plainly::<RecordError>)?;
        let mut test = description(None, parts.test.as_deref())?;
        if let Some(said) = &mut test {
            said.test.reading.part = parts.part;
        }
        Ok(Self {
            record: parts.measured.record()?,
            input: parts.input,
            test,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        let parts = Parts {
            measured: Kept::of(&self.record),
            input: self.input.clone(),
            test: self.test.as_ref().map(|said| said.text.clone()),
            part: self.test.as_ref().and_then(|said| said.test.reading.part.clone()),
        };
        let json = serde_json::to_string(&parts).map_err(refused_plainly::<RecordError>)?;
        Ok((py.get_type::<Self>().getattr("_from_json")?, (json,)))
    }

    /// Title of the record, for reports.
    #[getter]
    fn title(&self) -> &str {
        &self.input.title
    }

    /// Time, s.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.record.time())
    }

    /// Displacement of the jaw, m; None where it was not recorded.
    #[getter]
    fn displacement_m<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.record.displacement().map(|values| PyArray1::from_slice(py, values))
    }

    /// Force, N.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.record.force())
    }

    /// What was done to the record, in words and in order.
    #[getter]
    fn corrections(&self) -> Vec<String> {
        self.record.corrections().iter().map(ToString::to_string).collect()
    }

    fn __len__(&self) -> usize {
        self.record.len()
    }

    /// The phases, found without labels: loading, hold, unloading, rest.
    ///
    /// Returns
    /// -------
    /// Table
    ///     A row a phase: ``phase``, ``start_s``, ``end_s``, ``first_row``, ``last_row`` (both inside), what is held (``mode``),
    ///     what came before (``after``), displacement in m and force in N at both ends.
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     Nothing moves, or nothing stands still.
    fn segments(&self, py: Python<'_>) -> PyResult<Table> {
        let (record, options) = (self.record.clone(), self.options());
        let cut = at_length(py, move || corrected(&record, &options))?;
        let cut = cut.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        let found = cut.segmentation.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        let (time, force) = (cut.record.time(), cut.record.force());
        let number = |value: f64| Document::Number(value);
        let count = |value: usize| Document::Integer(value as i64);
        let row = |segment: &Segment| -> Fields {
            let last = segment.end - 1;
            let at =
                |index: usize| cut.record.displacement().map_or(Document::Null(()), |values| number(values[index]));
            let cells = [
                ("phase", word(segment.phase)),
                ("start_s", number(time[segment.start])),
                ("end_s", number(time[last])),
                ("first_row", count(segment.start)),
                ("last_row", count(last)),
                ("mode", segment.mode.map_or(Document::Null(()), word)),
                ("after", segment.after.map_or(Document::Null(()), word)),
                ("displacement_start_m", at(segment.start)),
                ("displacement_end_m", at(last)),
                ("force_start_n", number(force[segment.start])),
                ("force_end_n", number(force[last])),
            ];
            cells.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
        };
        let rows: Vec<Fields> = found.segments.iter().map(row).collect();
        Table::of_documents(&rows)
    }

    /// Phases, strains, laws for every hold, findings: the study of ``palpate analyze``.
    ///
    /// Parameters
    /// ----------
    /// test : path, mapping or Material, optional
    ///     A test description in place of that of the record, or a material, which knows the body.
    /// exponents : sequence of float, optional
    ///     Exponents n to fit with each; those of the description, or 1, 2, 3, 5 and 7, if left out.
    /// free_exponent : bool, optional
    ///     Whether n is found as well.
    /// confidence : float, optional
    ///     Coverage of the intervals, between 0 and 1.
    /// fit_until_s : float, optional
    ///     Longest stretch of a hold to fit, s.
    /// compare : bool
    ///     Whether laws are compared, which takes most of the time.
    ///
    /// Returns
    /// -------
    /// Analysis
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     No hold, or none that can be fitted.
    /// OptionError
    ///     An exponent, a confidence or a description that is wrong.
    ///
    /// Warns
    /// -----
    /// PalpateWarning
    ///     Findings that forbid the use of a number.
    #[pyo3(signature = (*, test=None, exponents=None, free_exponent=None, confidence=None, fit_until_s=None, compare=true))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn analyze(
        &self,
        py: Python<'_>,
        test: Option<&Bound<'_, PyAny>>,
        exponents: Option<Vec<f64>>,
        free_exponent: Option<bool>,
        confidence: Option<f64>,
        fit_until_s: Option<f64>,
        compare: bool,
    ) -> PyResult<Analysis> {
        let (input, options) = self.described_by(test)?;
        let asked = Asked {
            exponents,
            free_exponent,
            confidence,
            fit_until_s,
            compare,
        };
        Analysis::of(py, self.record.clone(), asked.over(options)?, input)
    }

    /// One set of numbers for the whole record, ramps and holds alike: what ``palpate calibrate`` finds.
    ///
    /// The latency law, strain rate = -v (e - e_e)^n of equation (10) of Tsai, Kao et al., in layers of a thickness that is found as well: holds
    /// carry n and v, ramps the layer thickness, relaxed levels the modulus. No starting values: a grid is searched first.
    ///
    /// Parameters
    /// ----------
    /// law : str
    ///     "latency" (n found), "latency:5" (n given), "standard-linear-solid", "prony:K" or "fung:K".
    /// test : path, mapping or Material, optional
    ///     A test description in place of that of the record; one of them has to know the body: ``{"specimen": {"shape": "ball", "radius":
    ///     "35 mm"}}``.
    /// rivals : sequence of str, optional
    ///     Laws to hold against it on the same record; "standard-linear-solid", "prony:2", "prony:3" and "fung:2" if left out, none for
    ///     an empty list.
    /// equilibrium : str
    ///     Law of the force once relaxation is over: "even-strain" (modulus x displacement/depth x contact area, equation (11)), "hertz", or
    ///     "table", a monotone one with a row where the jaw was held.
    /// poisson_ratio : float, optional
    ///     For Hertz's law, from 0 to 0.5; 0.5 if left out.
    /// rate : str
    ///     What the rate coefficient v of the latency law depends on, by one more number: "constant"; "by-strain", v f^(ε_e/0.1) with
    ///     f = ``strain_factor``; or "by-direction", v after loading and f v after unloading with f = ``unloading_factor``. The other
    ///     two are rivals then.
    /// fit_until_s : float, optional
    ///     Fit only up to this time of the record, s, and foretell the rest.
    /// confidence : float, optional
    ///     Coverage of the intervals, between 0 and 1; that of the description, or 0.95, if left out.
    /// profile : bool
    ///     Add profile intervals, which are asymmetric, and open where the record leaves a number open.
    ///
    /// Returns
    /// -------
    /// Calibration
    ///     The material, what is left over of the record, and the rivals.
    ///
    /// Raises
    /// ------
    /// RecordError
    ///     No displacement, no phases.
    /// OptionError
    ///     No body described, a law of single holds alone, a time outside the record, or any other option that is wrong.
    /// ModelError
    ///     A body that the jaw goes through, a law of the relaxed force that does not go with it.
    /// FitError
    ///     Too few samples, or a force that does not rise with the squeeze.
    ///
    /// Warns
    /// -----
    /// PalpateWarning
    ///     The record leaves a number open.
    ///
    /// Examples
    /// --------
    /// >>> import palpate
    /// >>> ball = {"shape": "ball", "radius": "35 mm"}
    /// >>> squeezed = palpate.simulate({
    /// ...     "specimen": {**ball, "modulus": "28 kPa"},
    /// ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    /// ...     "step": [{"to": to, "rate": "500 mm/min", "hold": "20 s"} for to in ("5 mm", "10 mm")],
    /// ...     "output": {"sample_rate": "10 Hz"},
    /// ... })
    /// >>> record = palpate.Record.from_arrays(
    /// ...     time_s=squeezed.time_s, displacement_m=squeezed.displacement_m, force_n=squeezed.force_n
    /// ... )
    /// >>> calibration = record.calibrate(test={"specimen": ball}, rivals=[])
    /// >>> round(calibration.material.values["exponent"], 2)
    /// 5.0
    /// >>> prediction = calibration.material.predict([{"to": "8 mm", "rate": "500 mm/min", "hold": "20 s"}], at_s=[10.0])
    /// >>> round(float(prediction.force_n[0]), 2)
    /// 3.45
    #[pyo3(signature = (*, law="latency", test=None, rivals=None, equilibrium="even-strain", poisson_ratio=None, rate="constant", fit_until_s=None, confidence=None, profile=false))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn calibrate(
        &self,
        py: Python<'_>,
        law: &str,
        test: Option<&Bound<'_, PyAny>>,
        rivals: Option<&Bound<'_, PyAny>>,
        equilibrium: &str,
        poisson_ratio: Option<f64>,
        rate: &str,
        fit_until_s: Option<f64>,
        confidence: Option<f64>,
        profile: bool,
    ) -> PyResult<Calibration> {
        let (input, options) = self.described_by(test)?;
        let wanted = Wanted {
            laws: laws(law, rivals)?,
            equilibrium: equilibrium_law(equilibrium, poisson_ratio)?,
            rate: rate_law(rate)?,
            profile,
            fit_until: fit_until_s,
            confidence: coverage(confidence.unwrap_or(options.fit.confidence))?,
        };
        Calibration::of(py, self.record.clone(), options, input, wanted)
    }

    /// Columns `time_s`, `displacement_m` and `force_n` as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        let column = |values: &[f64]| -> ArrayRef { Arc::new(Float64Array::from(values.to_vec())) };
        let mut columns = vec![("time_s", column(self.record.time()))];
        columns.extend(self.record.displacement().map(|values| ("displacement_m", column(values))));
        columns.push(("force_n", column(self.record.force())));
        Table::of(columns)
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.to_arrow()?.__arrow_c_stream__(py, requested_schema)
    }

    fn __repr__(&self) -> String {
        let time = self.record.time();
        let duration = palpate::number::significant(time[time.len() - 1] - time[0], 4);
        let displacement = if self.record.displacement().is_some() { "" } else { ", no displacement" };
        format!(
            "<palpate.Record {:?}: {} rows over {duration} s{displacement}>",
            self.input.title,
            self.record.len()
        )
    }
}

/// The word of the library for one of its choices, as its documents write it.
fn word(choice: impl Serialize) -> Document {
    match serde_json::to_value(choice) {
        Ok(serde_json::Value::String(word)) => Document::Text(word),
        _ => Document::Null(()),
    }
}
