//! The study of one record.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use palpate::analysis::{Analysis as Studied, AnalysisOptions, Severity, analyze};
use palpate::record::Record as Measured;
use palpate_report::document::AnalysisDocument;
use palpate_report::result::Input;
use palpate_report::study::{Pictures, analysis_bundle, analysis_text};
use pyo3::prelude::*;
use pyo3::types::PyType;
use serde::{Deserialize, Serialize};

use crate::document::{Document, Fields};
use crate::errors::{PalpateError, RecordError, refused, refused_plainly, unwritten, warn_of};
use crate::record::Kept;
use crate::table::Table;
use crate::work::{Made, at_length};

/// Something about a record, or a hold, that its numbers alone do not tell.
#[pyclass(name = "Finding", module = "palpate", frozen, get_all, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Finding {
    /// Stable code, such as "saturated".
    code: String,
    /// "info", "caution" or "warning".
    severity: String,
    /// What was seen.
    seen: String,
    /// What it may mean.
    meaning: String,
    /// What helps.
    remedy: String,
    /// Number of the hold, from 1; None for the record as a whole.
    hold: Option<usize>,
}

impl Finding {
    /// From the fields of a document.
    fn of(fields: &Document, hold: Option<usize>) -> Self {
        let text = |name: &str| match fields.get(name) {
            Some(Document::Text(text)) => text.clone(),
            _ => String::new(),
        };
        Self {
            code: text("code"),
            severity: text("severity"),
            seen: text("seen"),
            meaning: text("meaning"),
            remedy: text("remedy"),
            hold,
        }
    }
}

#[pymethods]
impl Finding {
    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        serde_json::from_str(json).map_err(refused_plainly::<PalpateError>)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        let json = serde_json::to_string(self).map_err(refused_plainly::<PalpateError>)?;
        Ok((py.get_type::<Self>().getattr("_from_json")?, (json,)))
    }

    fn __repr__(&self) -> String {
        let place = self.hold.map_or(String::new(), |hold| format!(", hold {hold}"));
        format!("<palpate.Finding {} ({}{place}): {}>", self.code, self.severity, self.seen)
    }
}

/// Phases, laws of every hold and findings of one record; a page with figures in a notebook.
///
/// ``print(analysis)`` shows what ``palpate analyze`` does.
///
/// What its document says is kept as that; the study behind it is made anew, from the same record and the same options, where a
/// report is asked of an analysis that came from elsewhere.
#[pyclass(name = "Analysis", module = "palpate", frozen, eq)]
pub(crate) struct Analysis {
    measured: Arc<(Measured, AnalysisOptions)>,
    study: OnceLock<Arc<Studied>>,
    input: Input,
    json: String,
    document: Document,
}

impl PartialEq for Analysis {
    fn eq(&self, other: &Self) -> bool {
        self.json == other.json
    }
}

/// What an analysis is made of again.
#[derive(Serialize, Deserialize)]
struct Parts {
    measured: Kept,
    options: AnalysisOptions,
    input: Input,
    json: String,
}

impl Analysis {
    /// Analyses a record, and warns of what its numbers must not be used for.
    pub(crate) fn of(py: Python<'_>, record: Measured, options: AnalysisOptions, input: Input) -> PyResult<Self> {
        let measured = Arc::new((record, options));
        let study = studied(py, &measured)?;
        let document = AnalysisDocument::new(&study, input.clone());
        let json = serde_json::to_string(&document).map_err(refused_plainly::<PalpateError>)?;
        let document = serde_json::from_str(&json).map_err(refused_plainly::<PalpateError>)?;
        let of_holds = study.holds.iter().flat_map(|hold| &hold.findings);
        let all = study.findings.iter().chain(of_holds);
        warn_of(py, all.filter(|finding| finding.severity() == Severity::Warning))?;
        Ok(Self {
            measured,
            study: OnceLock::from(Arc::new(study)),
            input,
            json,
            document,
        })
    }

    fn study(&self, py: Python<'_>) -> PyResult<Arc<Studied>> {
        if let Some(study) = self.study.get() {
            return Ok(Arc::clone(study));
        }
        let study = Arc::new(studied(py, &self.measured)?);
        Ok(Arc::clone(self.study.get_or_init(|| study)))
    }

    fn rows(&self, name: &str) -> &[Document] {
        self.document.get(name).map_or(&[], Document::entries)
    }
}

fn studied(py: Python<'_>, measured: &Arc<(Measured, AnalysisOptions)>) -> PyResult<Studied> {
    let measured = Arc::clone(measured);
    let study = at_length(py, move || analyze(&measured.0, &measured.1))?;
    study.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))
}

fn table_of(documents: &[Document]) -> PyResult<Table> {
    let row = |document: &Document| {
        let mut row = Fields::new();
        document.flat(&mut row);
        row
    };
    Table::of_documents(&documents.iter().map(row).collect::<Vec<_>>())
}

#[pymethods]
impl Analysis {
    /// The phases, a row each.
    #[getter]
    fn segments(&self) -> PyResult<Table> {
        table_of(self.rows("segments"))
    }

    /// The holds, a row each.
    #[getter]
    fn holds(&self) -> PyResult<Table> {
        table_of(self.rows("holds"))
    }

    /// The laws fitted to every hold, a row each: ``hold``, ``domain``, ``exponent``, ``equilibrium_force_n``,
    /// ``rate_coefficient_per_s``, ..., each with its standard error and interval.
    #[getter]
    fn fits(&self) -> PyResult<Table> {
        let mut rows = Vec::new();
        for hold in self.rows("holds") {
            for fit in hold.get("fits").map_or(&[][..], Document::entries) {
                let number = hold.get("index").cloned().unwrap_or(Document::Null(()));
                let mut row = Fields::from_iter([("hold".to_owned(), number)]);
                fit.flat(&mut row);
                rows.push(row);
            }
        }
        Table::of_documents(&rows)
    }

    /// What to know besides the numbers.
    #[getter]
    fn findings(&self) -> Vec<Finding> {
        let mut findings: Vec<Finding> =
            self.rows("findings").iter().map(|finding| Finding::of(finding, None)).collect();
        for (index, hold) in self.rows("holds").iter().enumerate() {
            let of_hold = hold.get("findings").map_or(&[][..], Document::entries);
            findings.extend(of_hold.iter().map(|finding| Finding::of(finding, Some(index + 1))));
        }
        findings
    }

    /// The document that `palpate analyze --format json` prints, as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (&self.json,))
    }

    /// The same as text.
    fn to_json(&self) -> &str {
        &self.json
    }

    /// The table of laws, for polars, pandas and pyarrow.
    fn to_arrow(&self) -> PyResult<Table> {
        self.fits()
    }

    /// Writes report.html, analysis.json, tables and figures into a folder, all or none.
    ///
    /// Parameters
    /// ----------
    /// folder : path
    ///     Made if it is not there.
    /// png : bool
    ///     Whether figures are written as PNG beside SVG.
    ///
    /// Returns
    /// -------
    /// Path
    ///     The report.
    ///
    /// Raises
    /// ------
    /// PalpateError
    ///     The folder cannot be written to.
    #[pyo3(signature = (folder, *, png=false))]
    fn report(&self, py: Python<'_>, folder: PathBuf, png: bool) -> PyResult<PathBuf> {
        let (analysis, input) = (self.study(py)?, self.input.clone());
        let report = folder.join("report.html");
        let written = at_length(py, move || {
            let bundle = analysis_bundle(&analysis, input, Pictures { png })?;
            palpate_jobs::output::write_bundle(&folder, &bundle)
        })?;
        written.map_err(|error| unwritten(&error))?;
        Ok(report)
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        let parts: Parts = serde_json::from_str(json).map_err(refused_plainly::<PalpateError>)?;
        let document = serde_json::from_str(&parts.json).map_err(refused_plainly::<PalpateError>)?;
        Ok(Self {
            measured: Arc::new((parts.measured.record()?, parts.options)),
            study: OnceLock::new(),
            input: parts.input,
            json: parts.json,
            document,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        let parts = Parts {
            measured: Kept::of(&self.measured.0),
            options: self.measured.1.clone(),
            input: self.input.clone(),
            json: self.json.clone(),
        };
        let json = serde_json::to_string(&parts).map_err(refused_plainly::<PalpateError>)?;
        Ok((py.get_type::<Self>().getattr("_from_json")?, (json,)))
    }

    fn __str__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(analysis_text(&*self.study(py)?, &self.input))
    }

    fn __repr__(&self) -> String {
        let holds = self.rows("holds").len();
        format!("<palpate.Analysis of {:?}: {holds} holds, {} findings>", self.input.title, self.findings().len())
    }

    /// Tables and figures of the report, for notebooks.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let bundle = analysis_bundle(&*self.study(py)?, self.input.clone(), Pictures { png: false })
            .map_err(refused_plainly::<PalpateError>)?;
        let report = bundle.files.into_iter().find(|(name, _)| name == "report.html");
        Ok(report.and_then(|(_, page)| String::from_utf8(page).ok()).map(|page| framed(&page)))
    }
}

/// A page inside another one, with its own styles.
pub(crate) fn framed(page: &str) -> String {
    let page = page.replace('&', "&amp;").replace('"', "&quot;");
    format!("<iframe srcdoc=\"{page}\" style=\"width:100%;height:40em;border:0\"></iframe>")
}
