//! The study of one record.

use std::path::PathBuf;
use std::sync::Arc;

use palpate::analysis::{Analysis as Studied, Severity};
use palpate_report::document::{AnalysisDocument, FindingDocument, Input};
use palpate_report::study::{Pictures, analysis_bundle, analysis_text};
use pyo3::prelude::*;

use crate::document::{Document, Fields};
use crate::errors::{PalpateError, refused, refused_plainly, warn_of};
use crate::table::Table;
use crate::work::at_length;

/// Something about a record, or a hold, that its numbers alone do not tell.
#[pyclass(name = "Finding", module = "palpate", frozen, get_all, eq)]
#[derive(Clone, PartialEq)]
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
    fn of(finding: &palpate::analysis::Finding, hold: Option<usize>) -> Self {
        let FindingDocument {
            code,
            severity,
            seen,
            meaning,
            remedy,
        } = finding.into();
        Self {
            code,
            severity,
            seen,
            meaning,
            remedy,
            hold,
        }
    }
}

#[pymethods]
impl Finding {
    fn __repr__(&self) -> String {
        let place = self.hold.map_or(String::new(), |hold| format!(", hold {hold}"));
        format!("<palpate.Finding {} ({}{place}): {}>", self.code, self.severity, self.seen)
    }
}

/// Phases, laws of every hold and findings of one record.
#[pyclass(name = "Analysis", module = "palpate", frozen)]
pub(crate) struct Analysis {
    analysis: Arc<Studied>,
    input: Input,
    json: String,
    document: Document,
}

impl Analysis {
    pub(crate) fn new(py: Python<'_>, analysis: Studied, input: Input) -> PyResult<Self> {
        let document = AnalysisDocument::new(&analysis, input.clone());
        let json = serde_json::to_string(&document).map_err(refused_plainly::<PalpateError>)?;
        let document = serde_json::from_str(&json).map_err(refused_plainly::<PalpateError>)?;
        let of_holds = analysis.holds.iter().flat_map(|hold| &hold.findings);
        let all = analysis.findings.iter().chain(of_holds);
        warn_of(py, all.filter(|finding| finding.severity() == Severity::Warning))?;
        Ok(Self {
            analysis: Arc::new(analysis),
            input,
            json,
            document,
        })
    }

    fn rows(&self, name: &str) -> &[Document] {
        self.document.get(name).map_or(&[], Document::entries)
    }
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

    /// The laws fitted to every hold, a row each.
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
        let whole = self.analysis.findings.iter().map(|finding| Finding::of(finding, None));
        let holds =
            self.analysis.holds.iter().enumerate().flat_map(|(index, hold)| {
                hold.findings.iter().map(move |finding| Finding::of(finding, Some(index + 1)))
            });
        whole.chain(holds).collect()
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

    /// Writes report.html, analysis.json, tables and figures into a folder, all or none; returns the path of the report.
    #[pyo3(signature = (folder, *, png=false))]
    fn report(&self, py: Python<'_>, folder: PathBuf, png: bool) -> PyResult<PathBuf> {
        let (analysis, input) = (Arc::clone(&self.analysis), self.input.clone());
        let report = folder.join("report.html");
        let written = at_length(py, move || {
            let bundle =
                analysis_bundle(&analysis, input, Pictures { png }).map_err(|error| (error.to_string(), None))?;
            palpate_cli::write_study(&folder, &bundle)
        })?;
        written.map_err(|(message, hint): (String, Option<String>)| refused::<PalpateError>(message, hint))?;
        Ok(report)
    }

    fn __str__(&self) -> String {
        analysis_text(&self.analysis, &self.input)
    }

    fn __repr__(&self) -> String {
        let holds = self.analysis.holds.len();
        format!("<palpate.Analysis of {:?}: {holds} holds, {} findings>", self.input.title, self.findings().len())
    }

    /// Tables and figures of the report, for notebooks.
    fn _repr_html_(&self) -> PyResult<Option<String>> {
        let bundle = analysis_bundle(&self.analysis, self.input.clone(), Pictures { png: false })
            .map_err(refused_plainly::<PalpateError>)?;
        let report = bundle.files.into_iter().find(|(name, _)| name == "report.html");
        Ok(report.and_then(|(_, page)| String::from_utf8(page).ok()).map(|page| framed(&page)))
    }
}

/// A page inside another one, with its own styles.
fn framed(page: &str) -> String {
    let page = page.replace('&', "&amp;").replace('"', "&quot;");
    format!("<iframe srcdoc=\"{page}\" style=\"width:100%;height:40em;border:0\"></iframe>")
}
