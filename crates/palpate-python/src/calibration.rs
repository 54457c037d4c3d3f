//! One set of numbers for a whole record.

use std::sync::Arc;

use arrow_array::{ArrayRef, BooleanArray, Float64Array};
use numpy::PyArray1;
use palpate::analysis::AnalysisOptions;
use palpate::calibrate::{CalibrateError, CalibrationData, Candidate, EquilibriumLaw, RateLaw, calibrate, profile};
use palpate::fit::Termination;
use palpate::laws::Law;
use palpate::record::Record as Measured;
use palpate::watch::Unwatched;
use palpate_report::document::CalibrationDocument;
use palpate_report::result::{CalibratedRecord, Input};
use palpate_report::study::{calibration_page, calibration_text};
use pyo3::prelude::*;
use pyo3::types::PyType;
use serde::{Deserialize, Serialize};

use crate::analysis::framed;
use crate::document::{Document, Fields};
use crate::errors::{FitError, ModelError, OptionError, PalpateError, RecordError, refused, refused_plainly};
use crate::fit::ending;
use crate::material::Material;
use crate::table::Table;
use crate::work::{Made, at_length};

/// Laws to hold against the one that is asked for, where nothing is said: those of the command line.
const RIVALS: [&str; 4] = ["standard-linear-solid", "prony:2", "prony:3", "fung:2"];

/// What the keywords of `Record.calibrate` say.
pub(crate) struct Wanted {
    pub(crate) laws: Vec<Law>,
    pub(crate) equilibrium: EquilibriumLaw,
    pub(crate) rate: RateLaw,
    pub(crate) fit_until: Option<f64>,
    pub(crate) confidence: f64,
    pub(crate) profile: bool,
}

/// The law that is asked for, and its rivals.
pub(crate) fn laws(law: &str, rivals: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Law>> {
    let mut names = vec![law.to_owned()];
    match rivals {
        Some(rivals) => names.extend(rivals.extract::<Vec<String>>().map_err(|_| {
            refused_plainly::<OptionError>(format!("rivals: expected a list of laws, found {rivals:?}"))
        })?),
        None => names.extend(RIVALS.map(str::to_owned)),
    }
    let parsed: Result<Vec<Law>, _> = names.iter().map(|name| name.parse()).collect();
    let mut laws = parsed.map_err(refused_plainly::<OptionError>)?;
    let law = laws[0];
    laws.retain(|rival| *rival != law);
    laws.insert(0, law);
    Ok(laws)
}

/// The law of the relaxed force.
pub(crate) fn equilibrium_law(name: &str, poisson_ratio: Option<f64>) -> PyResult<EquilibriumLaw> {
    match (name, poisson_ratio) {
        ("hertz", ratio) => Ok(EquilibriumLaw::Hertz {
            poisson_ratio: ratio.unwrap_or(0.5),
        }),
        ("even-strain" | "table", Some(_)) => Err(refused::<OptionError>(
            "poisson_ratio is for Hertz's law, which is not asked for",
            Some("add equilibrium=\"hertz\", or leave poisson_ratio out"),
        )),
        ("even-strain", None) => Ok(EquilibriumLaw::EvenStrain),
        ("table", None) => Ok(EquilibriumLaw::Table),
        (other, _) => {
            let message = format!("equilibrium is one of \"even-strain\", \"hertz\", \"table\", found {other:?}");
            Err(refused_plainly::<OptionError>(message))
        }
    }
}

/// What the rate coefficient depends on.
pub(crate) fn rate_law(name: &str) -> PyResult<RateLaw> {
    match name {
        "constant" => Ok(RateLaw::Constant),
        "by-strain" => Ok(RateLaw::ByStrain),
        "by-direction" => Ok(RateLaw::ByDirection),
        other => {
            let message = format!("rate is one of \"constant\", \"by-strain\", \"by-direction\", found {other:?}");
            Err(refused_plainly::<OptionError>(message))
        }
    }
}

/// Why there is no calibration: because of what was asked, of the record, of the body or of the samples.
fn uncalibrated(error: &CalibrateError) -> PyErr {
    let hint = Some(error.hint()).filter(|hint| !hint.is_empty());
    match error {
        CalibrateError::NoGeometry
        | CalibrateError::NotALaw { .. }
        | CalibrateError::RateOf { .. }
        | CalibrateError::Exponent { .. }
        | CalibrateError::Split { .. } => refused::<OptionError>(error, hint),
        CalibrateError::TooFewSamples { .. } | CalibrateError::NoStiffness => refused::<FitError>(error, hint),
        CalibrateError::Specimen(_)
        | CalibrateError::Equilibrium(_)
        | CalibrateError::Motion(_)
        | CalibrateError::Simulate(_) => refused::<ModelError>(error, hint),
        _ => refused::<RecordError>(error, hint),
    }
}

fn calibrated(
    record: &Measured,
    options: &AnalysisOptions,
    input: Input,
    wanted: &Wanted,
) -> Result<CalibratedRecord, CalibrateError> {
    let mut data = CalibrationData::of_record(record, options)?;
    if let Some(until) = wanted.fit_until {
        data = data.fitted_until(until)?;
    }
    let mut rows = Vec::new();
    let chosen = Candidate {
        rate: wanted.rate,
        ..Candidate::new(wanted.laws[0], wanted.equilibrium)
    };
    let rivals = &wanted.laws[1..];
    let candidates = if rivals.is_empty() { vec![chosen] } else { chosen.with_rivals(rivals) };
    for candidate in candidates {
        let made = calibrate(&data, candidate, wanted.confidence, &mut Unwatched);
        if rows.is_empty()
            && let Err(error) = made
        {
            // Without the law that was asked for its rivals are of no use.
            return Err(error);
        }
        rows.push((candidate, made));
    }
    let profiles = match rows.first() {
        Some((_, Ok(made))) if wanted.profile => profile(&data, made, &mut Unwatched)?,
        _ => Vec::new(),
    };
    Ok(CalibratedRecord {
        input,
        data,
        rows,
        profiles,
    })
}

/// One set of numbers for a whole record, ramps and holds alike: a material, what its law leaves over, and its rivals.
///
/// Made by `Record.calibrate`. ``print(calibration)`` shows what ``palpate calibrate`` does; series are tables for polars, pandas and
/// pyarrow, and a notebook shows tables and figure.
#[pyclass(name = "Calibration", module = "palpate", frozen, eq)]
#[derive(PartialEq)]
pub(crate) struct Calibration {
    kept: Kept,
    material: Material,
}

/// What a calibration is made of again.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
struct Kept {
    json: String,
    text: String,
    page: String,
    title: String,
    sentence: Option<String>,
    termination: Termination,
    rmse: f64,
    series: Series,
}

/// Measured and simulated force; the first `fitted` samples were fitted, the rest was foretold.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
struct Series {
    time: Vec<f64>,
    displacement: Vec<f64>,
    force: Vec<f64>,
    simulated: Vec<f64>,
    fitted: usize,
}

impl Series {
    fn residuals(&self) -> Vec<f64> {
        self.force.iter().zip(&self.simulated).map(|(measured, simulated)| measured - simulated).collect()
    }
}

impl Kept {
    fn of(record: &CalibratedRecord, confidence: f64) -> PyResult<Option<Self>> {
        let Some(chosen) = record.chosen() else {
            return Ok(None);
        };
        let document = CalibrationDocument::new(record, confidence);
        let data = &record.data;
        Ok(Some(Self {
            json: serde_json::to_string(&document).map_err(refused_plainly::<PalpateError>)?,
            text: calibration_text(record),
            page: calibration_page(record).map_err(refused_plainly::<PalpateError>)?.to_html(),
            title: record.input.title.clone(),
            sentence: record.sentence(),
            termination: chosen.termination,
            rmse: chosen.rmse,
            series: Series {
                time: data.times().to_vec(),
                displacement: data.times().iter().map(|time| data.motion().displacement_at(*time)).collect(),
                force: data.forces().to_vec(),
                simulated: chosen.simulated.clone(),
                fitted: data.fitted(),
            },
        }))
    }

    fn document(&self) -> PyResult<Document> {
        serde_json::from_str(&self.json).map_err(refused_plainly::<PalpateError>)
    }
}

impl Calibration {
    /// Calibrates laws on a record, and warns where the one that is asked for leaves a number open.
    pub(crate) fn of(
        py: Python<'_>,
        record: Measured,
        options: AnalysisOptions,
        input: Input,
        wanted: Wanted,
    ) -> PyResult<Self> {
        let confidence = wanted.confidence;
        let made = at_length(py, move || calibrated(&record, &options, input, &wanted))?;
        let record = made.map_err(|error| uncalibrated(&error))?;
        let made = palpate_jobs::Calibrated { record, confidence };
        let whole = Kept::of(&made.record, confidence)?.zip(made.material());
        let (kept, file) = whole.ok_or_else(|| refused_plainly::<PalpateError>("no law was calibrated"))?;
        Ok(Self {
            kept,
            material: Material::of(py, file)?,
        })
    }
}

#[pymethods]
impl Calibration {
    /// The body with the numbers of the law that was asked for.
    #[getter]
    fn material(&self) -> Material {
        self.material.clone()
    }

    /// The laws, a row each, the one that was asked for first: ``parameters`` searched, root mean square residual ``rmse_n``, the same as a
    /// share of the largest force (``relative``), BIC less the lowest (``delta_bic``), with ``fit_until_s`` the errors of what was
    /// foretold, ``termination``, and why there is no calibration (``error``).
    #[getter]
    fn laws(&self) -> PyResult<Table> {
        let document = self.kept.document()?;
        let row = |law: &Document| {
            let plain = |names: &[&str]| -> Vec<(String, Document)> {
                let cell = |name: &&str| Some(((*name).to_owned(), law.get(name)?.clone()));
                names.iter().filter_map(cell).collect()
            };
            let mut row: Fields =
                plain(&["law", "parameters", "rmse_n", "relative", "delta_bic"]).into_iter().collect();
            if let Some(Document::Fields(foretold)) = law.get("foretold") {
                row.extend(foretold.iter().map(|(name, value)| (format!("foretold_{name}"), value.clone())));
            }
            row.extend(plain(&["termination", "error"]));
            row
        };
        let laws = document.get("laws").map_or(&[][..], Document::entries);
        Table::of_documents(&laws.iter().map(row).collect::<Vec<_>>())
    }

    /// Which law foretells best, or has the lowest BIC, in a sentence; None without rivals.
    #[getter]
    fn sentence(&self) -> Option<&str> {
        self.kept.sentence.as_deref()
    }

    /// The numbers of the law that was asked for, by name and unit as in `to_dict`: ``value``, ``standard_error``, ``low`` and ``high`` of
    /// the interval and, where profiles were asked for, ``profile_low`` and ``profile_high``, NaN where the record leaves them open.
    #[getter]
    fn numbers(&self) -> PyResult<Table> {
        let document = self.kept.document()?;
        let laws = document.get("laws").map_or(&[][..], Document::entries);
        let numbers = laws.first().and_then(|law| law.get("numbers")).map_or(&[][..], Document::entries);
        let row = |number: &Document| {
            let mut row = Fields::new();
            for name in ["name", "value", "standard_error"] {
                row.extend(number.get(name).map(|value| (name.to_owned(), value.clone())));
            }
            let ends = number.get("interval").map_or(&[][..], Document::entries);
            for (name, end) in ["low", "high"].into_iter().zip(ends) {
                row.insert(name.to_owned(), end.clone());
            }
            if let Some(profile) = number.get("profile") {
                for name in ["low", "high"] {
                    row.extend(profile.get(name).map(|end| (format!("profile_{name}"), end.clone())));
                }
            }
            row
        };
        Table::of_documents(&numbers.iter().map(row).collect::<Vec<_>>())
    }

    /// What the numbers alone do not tell, in sentences.
    #[getter]
    fn remarks(&self) -> PyResult<Vec<String>> {
        let document = self.kept.document()?;
        let remarks = document.get("remarks").map_or(&[][..], Document::entries);
        let text = |remark: &Document| match remark {
            Document::Text(text) => Some(text.clone()),
            _ => None,
        };
        Ok(remarks.iter().filter_map(text).collect())
    }

    /// Why the search ended: "converged", or what kept it from that.
    #[getter]
    fn termination(&self) -> String {
        ending(self.kept.termination)
    }

    /// Whether it ended at an optimum inside the range that was searched.
    #[getter]
    fn is_good(&self) -> bool {
        self.kept.termination.is_good()
    }

    /// Root mean square residual over the fitted samples, N.
    #[getter]
    fn rmse_n(&self) -> f64 {
        self.kept.rmse
    }

    /// How many samples, from the first on, were fitted; the rest was foretold.
    #[getter]
    fn fitted(&self) -> usize {
        self.kept.series.fitted
    }

    /// Time of every sample, s, on the clock of the record.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.kept.series.time)
    }

    /// Displacement of the jaw since first touch, m, as it was simulated.
    #[getter]
    fn displacement_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.kept.series.displacement)
    }

    /// Measured force, N.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.kept.series.force)
    }

    /// Force by the law, N.
    #[getter]
    fn simulated_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.kept.series.simulated)
    }

    /// Measured less simulated force, N.
    #[getter]
    fn residual_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.kept.series.residuals())
    }

    fn __len__(&self) -> usize {
        self.kept.series.time.len()
    }

    /// Columns ``time_s``, ``displacement_m``, ``force_n``, ``simulated_n``, ``residual_n`` and ``is_fitted`` as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        let series = &self.kept.series;
        let column = |values: &[f64]| -> ArrayRef { Arc::new(Float64Array::from(values.to_vec())) };
        let fitted: Vec<bool> = (0..series.time.len()).map(|index| index < series.fitted).collect();
        Table::of(vec![
            ("time_s", column(&series.time)),
            ("displacement_m", column(&series.displacement)),
            ("force_n", column(&series.force)),
            ("simulated_n", column(&series.simulated)),
            ("residual_n", column(&series.residuals())),
            ("is_fitted", Arc::new(BooleanArray::from(fitted))),
        ])
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.to_arrow()?.__arrow_c_stream__(py, requested_schema)
    }

    /// The document that ``palpate calibrate --format json`` prints, as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (&self.kept.json,))
    }

    /// The same as text.
    fn to_json(&self) -> &str {
        &self.kept.json
    }

    /// Tables of the laws and of the numbers, and remarks, as text.
    fn report(&self) -> &str {
        &self.kept.text
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str, material: &str) -> PyResult<Self> {
        Ok(Self {
            kept: serde_json::from_str(json).map_err(refused_plainly::<PalpateError>)?,
            material: Material::parsed(material)?,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String, String)>> {
        let json = serde_json::to_string(&self.kept).map_err(refused_plainly::<PalpateError>)?;
        Ok((py.get_type::<Self>().getattr("_from_json")?, (json, self.material.to_toml())))
    }

    fn __str__(&self) -> &str {
        &self.kept.text
    }

    fn __repr__(&self) -> String {
        format!("<palpate.Calibration of {:?}: {}; {}>", self.kept.title, self.material.law(), self.termination())
    }

    /// Tables and figure, for notebooks.
    fn _repr_html_(&self) -> String {
        framed(&self.kept.page)
    }
}
