//! Will it hold: a calibrated body in a gripper.

use std::path::PathBuf;

use palpate::calibrate::Prediction as Predicted;
use palpate_jobs::output::write_bundle;
use palpate_jobs::{JobError, MaterialSource, Outcome, PlanGrip, Results};
use palpate_report::document::GripDocument;
use palpate_report::result::GrippedBody;
use palpate_report::study::{Bundle, Pictures};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use serde::{Deserialize, Serialize};

use crate::errors::{unwritten, warn};
use crate::grip_parts::{BackOff, ForceHeld, Holding, Schedule, seconds};
use crate::html::framed;
use crate::table::{Table, columns};
use crate::work::{Made, job, made_again, plain, printed, unpickled};

/// How a calibrated body is to be gripped, and how long that holds: what ``palpate grip`` says.
///
/// Made by `Material.grip`. ``print(grip)`` shows the text of ``palpate grip``; a notebook shows its report.
#[pyclass(name = "Grip", module = "palpate", frozen, eq)]
#[derive(PartialEq)]
pub(crate) struct Grip {
    kept: Kept,
}

/// What a grip is made of again.
#[derive(PartialEq, Serialize, Deserialize)]
struct Kept {
    document: GripDocument,
    question: String,
    text: String,
    svg: String,
    files: Vec<(String, String)>,
    squeeze: Option<Predicted>,
    back_off: Option<Predicted>,
    force_held: Option<Predicted>,
    schedule: Option<Predicted>,
}

impl Kept {
    fn of(done: &Outcome<GrippedBody<'_>>) -> Result<Self, JobError> {
        let (body, answer) = (&done.result, &done.result.answer);
        // All of them are text but for pictures, which are not asked for.
        let files = done.bundle(Pictures::default())?.files.into_iter();
        let schedule = answer.schedule.as_ref().and_then(|made| made.as_ref().ok());
        Ok(Self {
            document: body.document(),
            question: body.question(),
            text: done.text(),
            svg: done.figure().to_svg()?,
            files: files.map(|(path, content)| (path, String::from_utf8_lossy(&content).into_owned())).collect(),
            squeeze: answer.squeeze.as_ref().ok().map(|made| made.course.clone()),
            back_off: answer.back_off.as_ref().ok().map(|made| made.course.clone()),
            force_held: answer.force_hold.as_ref().ok().map(|made| made.course.clone()),
            schedule: schedule.map(|made| made.course.clone()),
        })
    }
}

impl Grip {
    /// Answers, and warns of every question beyond the test.
    pub(crate) fn of(py: Python<'_>, source: MaterialSource, question: PlanGrip) -> PyResult<Self> {
        let kept = job(py, move |watch| Kept::of(&question.run(&source, watch)?))?;
        for beyond in &kept.document.extrapolations {
            warn(py, &format!("beyond the test: {beyond}"))?;
        }
        Ok(Self { kept })
    }
}

#[pymethods]
impl Grip {
    /// Whether the grip that is asked about holds as long as was asked; without a time whether it does at all.
    #[getter]
    fn holds(&self) -> bool {
        self.kept.document.holds
    }

    /// The answer in a sentence.
    #[getter]
    fn verdict(&self) -> &str {
        &self.kept.document.verdict
    }

    /// The question in a sentence.
    #[getter]
    fn question(&self) -> &str {
        &self.kept.question
    }

    /// What the numbers mean, a sentence each.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.kept.document.remarks.clone()
    }

    /// How the question goes beyond what the test has shown, a sentence each.
    #[getter]
    fn extrapolations(&self) -> Vec<String> {
        self.kept.document.extrapolations.clone()
    }

    /// Coverage of the intervals.
    #[getter]
    fn confidence(&self) -> f64 {
        self.kept.document.confidence
    }

    /// The squeeze with the displacement held: the one that was asked about, or the least; None if there is none.
    #[getter]
    fn squeeze(&self) -> Option<Holding> {
        Some(Holding::new(self.kept.document.squeeze.clone()?, self.kept.squeeze.clone()))
    }

    /// Displacement of that squeeze, m.
    #[getter]
    fn squeeze_m(&self) -> Option<f64> {
        self.kept.document.squeeze.as_ref().map(|found| found.displacement_m)
    }

    /// From the start of its hold until it slips, s; infinite for always (longer than ten years), 0 if it slips at once.
    #[getter]
    fn time_to_slip_s(&self) -> Option<f64> {
        self.squeeze().map(|found| found.time_to_slip_s())
    }

    /// Ends of the interval of that time by what the calibration leaves open, s; None where it says nothing.
    #[getter]
    fn time_to_slip_interval_s(&self) -> Option<(f64, f64)> {
        self.squeeze().and_then(|found| found.time_to_slip_interval_s())
    }

    /// How long squeezes a little less and more deep hold: ``displacement_m`` and ``time_to_slip_s``.
    #[getter]
    fn neighbours(&self) -> PyResult<Table> {
        let rows = &self.kept.document.neighbours;
        Table::of(columns!(rows, row => displacement_m, time_to_slip_s = seconds(row.lasts)))
    }

    /// Squeeze and back off, so that the hold begins relaxed; None if there is none.
    #[getter]
    fn back_off(&self) -> Option<BackOff> {
        Some(BackOff::new(self.kept.document.back_off.clone()?, self.kept.back_off.clone()?))
    }

    /// The force held; None if there is none.
    #[getter]
    fn force_held(&self) -> Option<ForceHeld> {
        Some(ForceHeld::new(self.kept.document.force_held.clone()?, self.kept.force_held.clone()?))
    }

    /// Squeezes that keep the force in a band; None if none was asked for, or none does.
    #[getter]
    fn schedule(&self) -> Option<Schedule> {
        Some(Schedule::new(self.kept.document.schedule.clone()?, self.kept.schedule.clone()?))
    }

    /// Grips that there are not, by name, each with the reason and what would help.
    #[getter]
    fn refused<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for refused in &self.kept.document.refused {
            dict.set_item(&refused.grip, format!("{}\nhint: {}", refused.reason, refused.hint))?;
        }
        Ok(dict)
    }

    /// The document that ``palpate grip --format json`` prints, as plain objects; a material without a file is called "material".
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.kept.document)
    }

    /// The same as text, as the command prints it.
    fn to_json(&self) -> PyResult<String> {
        printed(&self.kept.document)
    }

    /// Force, margin and displacement of the grips over time, as SVG.
    fn to_svg(&self) -> &str {
        &self.kept.svg
    }

    /// Writes what ``palpate grip --out`` writes into a folder, all or none: report.html, grip.json, tables, figure and series.
    ///
    /// Parameters
    /// ----------
    /// folder : path
    ///     Made if it is not there.
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
    #[expect(clippy::needless_pass_by_value, reason = "arguments of Python")]
    fn report(&self, folder: PathBuf) -> PyResult<PathBuf> {
        let bytes = |(path, content): &(String, String)| (path.clone(), content.clone().into_bytes());
        let bundle = Bundle {
            files: self.kept.files.iter().map(bytes).collect(),
        };
        write_bundle(&folder, &bundle).map_err(unwritten)?;
        Ok(folder.join("report.html"))
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        unpickled(json).map(|kept| Self { kept })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        made_again::<Self>(py, &self.kept)
    }

    fn __str__(&self) -> &str {
        &self.kept.text
    }

    fn __repr__(&self) -> String {
        format!("<palpate.Grip: {}>", self.kept.document.verdict)
    }

    /// The report, for notebooks.
    fn _repr_html_(&self) -> Option<String> {
        self.kept.files.iter().find(|(path, _)| path == "report.html").map(|(_, page)| framed(page))
    }
}
