//! A measured record.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array};
use numpy::PyArray1;
use palpate::analysis::{AnalysisOptions, analyze, corrected};
use palpate::record::Record as Measured;
use palpate::segment::Segment;
use palpate_files::contents::Contents;
use palpate_files::description::{DescriptionError, TestDescription, parse_test, read_test};
use palpate_files::record_file::{ReadError, RecordFile, read_part, tests};
use palpate_report::document::Input;
use pyo3::prelude::*;
use pyo3::types::PyType;
use serde::Serialize;

use crate::analysis::Analysis;
use crate::arrays::doubles;
use crate::document::{Document, Fields};
use crate::errors::{OptionError, RecordError, refused, refused_plainly, unread};
use crate::table::Table;
use crate::work::at_length;

/// A record of time, force and, if there is one, displacement, in SI, checked.
#[pyclass(name = "Record", module = "palpate", frozen, eq)]
#[derive(Clone)]
pub(crate) struct Record {
    record: Measured,
    input: Input,
    test: Option<TestDescription>,
}

impl PartialEq for Record {
    fn eq(&self, other: &Self) -> bool {
        self.record == other.record
    }
}

/// A description in a file, or as text.
fn description(path: Option<PathBuf>, text: Option<&str>) -> PyResult<Option<TestDescription>> {
    let said = |error: DescriptionError| {
        let hint = error.hint();
        refused::<OptionError>(error, hint)
    };
    match (path, text) {
        (Some(path), _) if !path.exists() => {
            let message = format!("{}: no such file", path.display());
            Err(std::io::Error::new(std::io::ErrorKind::NotFound, message).into())
        }
        (Some(path), _) => read_test(&path).map(Some).map_err(said),
        (None, Some(text)) => parse_test(text, Path::new("test")).map(Some).map_err(said),
        (None, None) => Ok(None),
    }
}

fn opened(path: &Path, test: Option<&TestDescription>) -> Result<RecordFile, ReadError> {
    let usual = TestDescription::default();
    let said = test.unwrap_or(&usual);
    let contents = Contents::open(path, &said.reading).map_err(ReadError::File)?;
    let found = tests(&contents, said)?;
    match found.parts[..] {
        [only] => read_part(&contents, only, test, &mut |_, _| {}),
        ref several => Err(ReadError::SeveralParts {
            path: path.to_owned(),
            parts: several.iter().map(|part| contents.parts()[*part].title().to_owned()).collect(),
        }),
    }
}

/// Reads the record in a file; `test_path` or `test_text` describes it.
#[pyfunction]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    test_path: Option<PathBuf>,
    test_text: Option<&str>,
    part: Option<String>,
) -> PyResult<Record> {
    let described_by = test_path.clone();
    let mut test = description(test_path, test_text)?;
    if part.is_some() {
        test.get_or_insert_default().reading.part = part;
    }
    let (read, test, sha256, path) = at_length(py, move || {
        let read = opened(&path, test.as_ref());
        let sha256 = palpate_cli::sha256(&path);
        (read, test, sha256, path)
    })?;
    let file = read.map_err(|error| unread(&error))?;
    let sha256 = sha256.map_err(|(message, hint)| refused::<RecordError>(message, hint))?;
    let stem = || path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let input = Input {
        path: path.display().to_string(),
        part: file.part.name.clone(),
        sha256,
        rows: file.rows,
        rows_averaged: file.averaged,
        test: described_by.map(|path| path.display().to_string()),
        title: test.as_ref().and_then(|test| test.about.title.clone()).unwrap_or_else(stem),
    };
    Ok(Record {
        record: file.record,
        input,
        test,
    })
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
            if !(confidence > 0.0 && confidence < 1.0) {
                let message = format!("confidence is a share between 0 and 1, found {confidence}");
                return Err(refused_plainly::<OptionError>(message));
            }
            options.fit.confidence = confidence;
        }
        options.free_exponent = self.free_exponent.unwrap_or(options.free_exponent);
        options.fit_until = self.fit_until_s.or(options.fit_until);
        if !self.compare {
            options.compare = None;
        }
        Ok(options)
    }
}

impl Record {
    fn options(&self) -> AnalysisOptions {
        self.test.as_ref().map_or_else(AnalysisOptions::default, TestDescription::analysis_options)
    }
}

#[pymethods]
impl Record {
    /// A record of arrays in SI, loading positive.
    #[classmethod]
    #[pyo3(signature = (*, time_s, force_n, displacement_m=None, title="record"))]
    fn from_arrays(
        _class: &Bound<'_, PyType>,
        time_s: &Bound<'_, PyAny>,
        force_n: &Bound<'_, PyAny>,
        displacement_m: Option<&Bound<'_, PyAny>>,
        title: &str,
    ) -> PyResult<Self> {
        let displacement = displacement_m.map(|values| doubles(values, "displacement_m")).transpose()?;
        let record = Measured::new(doubles(time_s, "time_s")?, displacement, doubles(force_n, "force_n")?)
            .map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
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

    /// The phases: loading, hold, unloading, rest.
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

    /// Phases, strains, laws for every hold, findings.
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
        let (mut input, mut options) = (self.input.clone(), self.options());
        if let Some(test) = test {
            let said = py.import("palpate")?.call_method1("_described", (test,))?;
            let (path, text): (Option<PathBuf>, Option<String>) = said.extract()?;
            input.test = path.as_ref().map(|path| path.display().to_string());
            options = description(path, text.as_deref())?.unwrap_or_default().analysis_options();
        }
        let asked = Asked {
            exponents,
            free_exponent,
            confidence,
            fit_until_s,
            compare,
        };
        let (options, record) = (asked.over(options)?, self.record.clone());
        let analysis = at_length(py, move || analyze(&record, &options))?;
        let analysis = analysis.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
        Analysis::new(py, analysis, input)
    }

    /// Columns `time_s`, `displacement_m` and `force_n`.
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
