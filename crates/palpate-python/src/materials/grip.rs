//! Will it hold: a calibrated body in a gripper.

use std::path::PathBuf;

use palpate::calibrate::Prediction as Predicted;
use palpate_jobs::output::write_bundle;
use palpate_jobs::{JobError, MaterialSource, PlanGrip, Results};
use palpate_report::document::{GripDocument, PositionHoldDocument};
use palpate_report::result::GrippedBody;
use palpate_report::study::{Bundle, FileOptions, StudyError, grip_bundle, grip_figure};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use serde::{Deserialize, Serialize};

use crate::errors::{unwritten, warn};
use crate::html::framed;
use crate::materials::grip_parts::{BackOff, ForceHold, PositionHold, Schedule, seconds, slip_interval};
use crate::materials::prediction::Prediction;
use crate::shown::shown;
use crate::table::{Table, columns};
use crate::work::{job, plain, printed};

/// How a calibrated body is to be gripped, and how long that holds: what ``palpate grip`` says.
///
/// Made by `Material.grip`. ``print(grip)`` shows the text of ``palpate grip``; a notebook shows its report.
#[pyclass(name = "Grip", module = "palpate", frozen, eq)]
#[derive(PartialEq, Serialize, Deserialize)]
pub(crate) struct Grip {
    document: GripDocument,
    question: String,
    text: String,
    svg: String,
    /// The files of its report that are text, and the others.
    texts: Vec<(String, String)>,
    others: Vec<(String, Vec<u8>)>,
    squeeze: Option<Predicted>,
    back_off: Option<Predicted>,
    force_held: Option<Predicted>,
    schedule: Option<Predicted>,
}

impl Grip {
    fn made(body: &GrippedBody<'_>) -> Result<Self, JobError> {
        let (mut texts, mut others) = (Vec::new(), Vec::new());
        for (path, content) in grip_bundle(body, &FileOptions::default())?.files {
            match String::from_utf8(content) {
                Ok(text) => texts.push((path, text)),
                Err(other) => others.push((path, other.into_bytes())),
            }
        }
        let courses = body.grips().map(|made| made?.ok().cloned());
        let [squeeze, back_off, force_held, schedule] = courses;
        Ok(Self {
            document: body.document(),
            question: body.question(),
            text: body.text(),
            svg: grip_figure(body, "grip").to_svg().map_err(StudyError::from)?,
            texts,
            others,
            squeeze,
            back_off,
            force_held,
            schedule,
        })
    }

    /// Answers, and warns of a law that the record contradicts and of every question beyond the test.
    pub(crate) fn of(py: Python<'_>, source: MaterialSource, question: PlanGrip) -> PyResult<Self> {
        let made = job(py, move |watch| Self::made(&question.run(&source, watch)?.result))?;
        if let Some(misfit) = &made.document.misfit {
            warn(py, misfit.trim_end_matches('.'))?;
        }
        for beyond in &made.document.extrapolations {
            warn(py, &format!("beyond the test: {beyond}"))?;
        }
        Ok(made)
    }

    fn of_squeeze<T>(&self, reported: impl Fn(&PositionHoldDocument) -> T) -> Option<T> {
        self.document.squeeze.as_ref().map(reported)
    }
}

shown! {
    Grip: self
    values {
        /// Whether the grip that is in question holds as long as was requested; without a time whether it does at all.
        holds: bool = self.document.holds,
        /// What the record of the material shows against its law, and what helps, in a sentence; None where nothing. It is the first remark too.
        misfit: Option<&str> = self.document.misfit.as_deref(),
        /// The answer in a sentence.
        verdict: &str = &self.document.verdict,
        /// The question in a sentence.
        question: &str = &self.question,
        /// What the parameters mean, a sentence each.
        remarks: Vec<String> = self.document.remarks.clone(),
        /// How the question goes beyond what the test has shown, a sentence each.
        extrapolations: Vec<String> = self.document.extrapolations.clone(),
        /// Coverage of the intervals.
        confidence: f64 = self.document.confidence,
        /// The squeeze with the displacement held: the one that is in question, or the least; None if there is none.
        squeeze: Option<PositionHold> = self.of_squeeze(|found| PositionHold::new(found.clone(), self.squeeze.clone())),
        /// Probability that the grip that is in question holds as long as was requested; None if the calibration has no intervals.
        probability: Option<f64> = self.document.probability,
        /// The least squeeze that reaches the probability required, m, if the one in question does not; None without one.
        assured_squeeze_m: Option<f64> = self.document.assured_squeeze_m,
        /// Time that the squeeze holds with the probability required, s; infinite for always, None if the calibration has no intervals.
        assured_time_s: Option<f64> = self.of_squeeze(|found| found.assured.map(seconds)).flatten(),
        /// Displacement of that squeeze, m.
        squeeze_m: Option<f64> = self.of_squeeze(|found| found.displacement_m),
        /// From the start of its hold until it slips, s; infinite for always (longer than ten years), 0 if it slips at once.
        time_to_slip_s: Option<f64> = self.of_squeeze(|found| seconds(found.time_to_slip)),
        /// Ends of the interval of that time by what the calibration leaves open, s; None where it says nothing.
        time_to_slip_interval_s: Option<(f64, f64)> = self.of_squeeze(slip_interval).flatten(),
        /// Overshoot and back off (a preconditioning squeeze), so that the hold begins relaxed; None if there is none.
        back_off: Option<BackOff> = Some(BackOff::new(self.document.back_off.clone()?, self.back_off.clone()?)),
        /// The force held; None if there is none.
        force_held: Option<ForceHold> = Some(ForceHold::new(self.document.force_held.clone()?, self.force_held.clone()?)),
        /// Squeezes that keep the force in a band; None if none was requested, or none does.
        schedule: Option<Schedule> = Some(Schedule::new(self.document.schedule.clone()?, self.schedule.clone()?)),
        /// How long squeezes a little less and more deep hold: ``displacement_m`` and ``time_to_slip_s``.
        neighbours: PyResult<Table> =
            Table::of(columns!(self.document.neighbours, row => displacement_m, time_to_slip_s = seconds(row.time_to_slip))),
        /// Grips that there are not, by name, each with the reason and what would help.
        refused<'py>(py): PyResult<Bound<'py, PyDict>> = self.document.refused.iter()
            .map(|made| (&made.grip, format!("{}\nhint: {}", made.reason, made.hint)))
            .into_py_dict(py),
    }

    /// The document that ``palpate grip --format json`` prints, as plain objects; a material without a file is called "material".
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.document)
    }

    /// The same as text, as the command prints it.
    fn to_json(&self) -> PyResult<String> {
        printed(&self.document)
    }

    /// The course of every grip over time, one below the other: ``grip`` ("squeeze", "back_off", "force_held" or "schedule"), and the columns
    /// of `Prediction.to_arrow`.
    fn to_arrow(&self) -> PyResult<Table> {
        let courses = [
            ("squeeze", &self.squeeze),
            ("back_off", &self.back_off),
            ("force_held", &self.force_held),
            ("schedule", &self.schedule),
        ];
        let there = courses.iter().filter_map(|(name, course)| Some((*name, course.as_ref()?.clone())));
        let tables = there.map(|(name, course)| Ok((name, Prediction::kept(course).to_arrow()?)));
        Table::stacked("grip", &tables.collect::<PyResult<Vec<_>>>()?)
    }

    /// Force, margin and displacement of the grips over time, as SVG.
    fn to_svg(&self) -> &str {
        &self.svg
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
        let files: Vec<_> = self.texts.iter().map(bytes).chain(self.others.iter().cloned()).collect();
        write_bundle(&folder, &Bundle::from(files)).map_err(unwritten)?;
        Ok(folder.join("report.html"))
    }

    fn __str__(&self) -> &str {
        &self.text
    }

    fn __repr__(&self) -> String {
        format!("<palpate.Grip: {}>", self.document.verdict)
    }

    /// The report, for notebooks.
    fn _repr_html_(&self) -> Option<String> {
        self.texts.iter().find(|(path, _)| path == "report.html").map(|(_, page)| framed(page))
    }
}
