//! Laws compared on one hold by what they foretell.

use palpate::fit::{LawOptions, Samples};
use palpate::forecast::{CompareOptions, compare_laws};
use palpate::laws::{Law, Response};
use palpate_report::document::HoldComparisonDocument;
use palpate_report::result::Quantity;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::arrays::doubles;
use crate::document::{Document, Fields};
use crate::errors::{FitError, OptionError, refused_plainly};
use crate::fit::deviations_of;
use crate::table::Table;
use crate::work::{Made, at_length};

/// Laws compared on one hold: each was fitted to its first part and held against the rest.
#[pyclass(name = "Comparison", module = "palpate", frozen, eq)]
pub(crate) struct Comparison {
    json: String,
    document: Document,
}

/// Compares laws; none named: all that suit the response.
#[pyfunction]
pub(crate) fn compare(
    py: Python<'_>,
    time_s: &Bound<'_, PyAny>,
    signal: &Bound<'_, PyAny>,
    weights: Option<&Bound<'_, PyAny>>,
    laws: Option<Vec<String>>,
    quantity: &str,
    cuts: Option<Vec<f64>>,
) -> PyResult<Comparison> {
    let (times, values) = (doubles(time_s, "time_s")?, doubles(signal, "signal")?);
    let deviations = deviations_of(weights)?;
    let (quantity, response) = match quantity {
        "force" => (Quantity::Force, Response::Relaxation),
        "strain" => (Quantity::Strain, Response::Relaxation),
        "displacement" => (Quantity::Displacement, Response::Creep),
        other => {
            let message = format!(
                "quantity is \"force\" or \"strain\" of a relaxation, or \"displacement\" of a creep, found {other:?}"
            );
            return Err(refused_plainly::<OptionError>(message));
        }
    };
    let parsed = |name: &String| name.parse::<Law>().map_err(refused_plainly::<OptionError>);
    let usual = CompareOptions::default();
    let options = CompareOptions {
        laws: laws.unwrap_or_default().iter().map(parsed).collect::<PyResult<_>>()?,
        fit: LawOptions {
            response,
            ..LawOptions::default()
        },
        cuts: cuts.unwrap_or(usual.cuts),
        ..CompareOptions::default()
    };
    let compared = at_length(py, move || {
        let samples = Samples::new(&times, &values);
        let samples = deviations.as_deref().map_or(samples, |deviations| samples.with_deviations(deviations));
        compare_laws(&samples, &options)
    })?;
    let compared = compared.map_err(refused_plainly::<FitError>)?;
    let json = serde_json::to_string(&HoldComparisonDocument::new(&compared, quantity))
        .map_err(refused_plainly::<FitError>)?;
    let document = serde_json::from_str(&json).map_err(refused_plainly::<FitError>)?;
    Ok(Comparison { json, document })
}

impl PartialEq for Comparison {
    fn eq(&self, other: &Self) -> bool {
        self.json == other.json
    }
}

impl Comparison {
    fn verdict(&self, field: &str) -> Option<String> {
        match self.document.get("verdict")?.get(field)? {
            Document::Text(text) => Some(text.clone()),
            _ => None,
        }
    }
}

#[pymethods]
impl Comparison {
    /// The law to use: that with the fewest numbers among those that do best; None if none could be fitted.
    #[getter]
    fn law(&self) -> Option<String> {
        self.verdict("law")
    }

    /// How sure that is: "clear", "likely" or "open".
    #[getter]
    fn certainty(&self) -> Option<String> {
        self.verdict("certainty")
    }

    /// All that in one sentence.
    #[getter]
    fn sentence(&self) -> Option<String> {
        self.verdict("sentence")
    }

    /// The laws, best first, a row each.
    #[getter]
    fn laws(&self) -> PyResult<Table> {
        let row = |law: &Document| {
            let mut row = Fields::new();
            law.flat(&mut row);
            row
        };
        let laws = self.document.get("laws").map_or(&[][..], Document::entries);
        Table::of_documents(&laws.iter().map(row).collect::<Vec<_>>())
    }

    /// Everything as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (&self.json,))
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: String) -> PyResult<Self> {
        let document = serde_json::from_str(&json).map_err(refused_plainly::<FitError>)?;
        Ok(Self { json, document })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        Ok((py.get_type::<Self>().getattr("_from_json")?, (self.json.clone(),)))
    }

    fn __repr__(&self) -> String {
        format!("<palpate.Comparison: {}>", self.sentence().unwrap_or_else(|| "no law could be fitted".to_owned()))
    }
}
