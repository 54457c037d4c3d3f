//! Will it hold: a calibrated body in a gripper.

use std::path::PathBuf;

use palpate::calibrate::Material as Body;
use palpate::grip::{
    Band, Control, Grasp, Grip as Gripper, GripError, Limits, Objective, Question, Regrip, TimeToSlip,
};
use palpate_files::description::MaterialFile;
use palpate_report::document::GripDocument;
use palpate_report::result::GrippedBody;
use palpate_report::study::{Bundle, Pictures, StudyError, grip_bundle, grip_figure, grip_text};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use serde::{Deserialize, Serialize};

use crate::analysis::framed;
use crate::errors::{ModelError, OptionError, PalpateError, refused, refused_plainly, unwritten, warn};
use crate::grip_parts::{BackOff, ForceHeld, Holding, Schedule, neighbour_table};
use crate::table::Table;
use crate::work::{Made, at_length, made_again};

/// What the keywords of `Material.grip` say.
pub(crate) struct Asked {
    pub(crate) grasp: Grasp,
    pub(crate) limits: Limits,
    pub(crate) question: Question,
    pub(crate) confidence: f64,
}

/// What is held, and whether the question suits it.
pub(crate) fn control(name: &str, squeeze: Option<f64>, force: Option<f64>) -> PyResult<Control> {
    match name {
        "position" if force.is_some() => Err(refused::<OptionError>(
            "force_n is for a force that is held, and the displacement is",
            Some("add control=\"force\", or ask with squeeze_m or most_force_n"),
        )),
        "force" if squeeze.is_some() => Err(refused::<OptionError>(
            "squeeze_m is for a displacement that is held, and the force is",
            Some("leave control=\"force\" out, or ask with force_n"),
        )),
        "position" => Ok(Control::Position),
        "force" => Ok(Control::Force),
        other => Err(not_one_of("control", "\"position\", \"force\"", other)),
    }
}

/// What a squeeze should have least of; one that is given has least of nothing.
pub(crate) fn objective(name: Option<&str>, squeeze: Option<f64>) -> PyResult<Objective> {
    if name.is_some() && squeeze.is_some() {
        let message = "objective: expected either this or squeeze_m, found both";
        return Err(refused::<OptionError>(message, Some("leave squeeze_m out, and the squeeze is sought")));
    }
    match name {
        None | Some("squeeze") => Ok(Objective::Squeeze),
        Some("peak-force") => Ok(Objective::PeakForce),
        Some("work") => Ok(Objective::Work),
        Some(other) => Err(not_one_of("objective", "\"squeeze\", \"peak-force\", \"work\"", other)),
    }
}

/// What a schedule should have least of.
pub(crate) fn regrip(name: Option<&str>, shortest_pause: Option<f64>, band: Option<(f64, f64)>) -> PyResult<Regrip> {
    for (option, given) in [("regrip", name.is_some()), ("shortest_pause_s", shortest_pause.is_some())] {
        if given && band.is_none() {
            let message = format!("{option} is for squeezes that keep the force in a band, and there is none");
            return Err(refused::<OptionError>(message, Some("add band_n, such as band_n=(2.1, 3.0)")));
        }
    }
    match name {
        None | Some("moves") => Ok(Regrip::FewestMoves),
        Some("work") => Ok(Regrip::LeastWork {
            shortest_pause: shortest_pause.unwrap_or(1.0),
        }),
        Some(other) => Err(not_one_of("regrip", "\"moves\", \"work\"", other)),
    }
}

pub(crate) fn band(edges: Option<(f64, f64)>) -> Option<Band> {
    edges.map(|(low, high)| Band { low, high })
}

fn not_one_of(option: &str, expected: &str, found: &str) -> PyErr {
    refused_plainly::<OptionError>(format!("{option} is one of {expected}, found {found:?}"))
}

/// Why the question could not be asked: because of its numbers, or of the body.
pub(crate) fn ungripped(error: &GripError) -> PyErr {
    let hint = Some(error.hint()).filter(|hint| !hint.is_empty());
    match error {
        GripError::Number { .. } => refused::<OptionError>(error, hint),
        GripError::Bonded => refused::<ModelError>(error, Some("calibrate on a test of jaws that can leave the body")),
        _ => refused::<ModelError>(error, hint),
    }
}

/// How a calibrated body is to be gripped, and how long that holds: what ``palpate grip`` says.
///
/// Made by `Material.grip`. ``print(grip)`` shows the text of ``palpate grip``; a notebook shows its report.
#[pyclass(name = "Grip", module = "palpate", frozen, eq)]
#[derive(PartialEq)]
pub(crate) struct Grip {
    kept: Kept,
}

/// A grip that there is not: which, why, and what would help.
type Refused = (String, String, String);

/// What a grip is made of again.
#[derive(PartialEq, Serialize, Deserialize)]
struct Kept {
    json: String,
    text: String,
    svg: String,
    files: Vec<(String, String)>,
    question: String,
    verdict: String,
    remarks: Vec<String>,
    extrapolations: Vec<String>,
    confidence: f64,
    holds: bool,
    squeeze: Option<Holding>,
    neighbours: Vec<(f64, TimeToSlip)>,
    back_off: Option<BackOff>,
    force_held: Option<ForceHeld>,
    schedule: Option<Schedule>,
    refused: Vec<Refused>,
}

/// Why there is no answer.
enum Unanswered {
    Question(GripError),
    Study(StudyError),
}

impl From<StudyError> for Unanswered {
    fn from(error: StudyError) -> Self {
        Self::Study(error)
    }
}

impl Kept {
    fn of(body: &Body, text: &str, asked: &Asked) -> Result<Self, Unanswered> {
        let grip = Gripper::new(body, asked.grasp, asked.limits, asked.confidence).map_err(Unanswered::Question)?;
        let answer = grip.answer(&asked.question).map_err(Unanswered::Question)?;
        let holds = match answer.holds() {
            Err(error) if !error.is_answer() => return Err(Unanswered::Question(error)),
            holds => holds == Ok(true),
        };
        let body = GrippedBody {
            path: "material".to_owned(),
            sha256: palpate_jobs::output::sha256(text.as_bytes()),
            grip,
            answer,
        };
        let answer = &body.answer;
        let refused = |(grip, error): (&str, &GripError)| (grip.to_owned(), error.to_string(), error.hint().to_owned());
        // All of them are text but for pictures, which are not asked for.
        let files = grip_bundle(&body, Pictures::default())?.files;
        let files = files.into_iter().map(|(path, content)| (path, String::from_utf8_lossy(&content).into_owned()));
        Ok(Self {
            json: serde_json::to_string(&GripDocument::new(&body)).map_err(StudyError::from)?,
            text: grip_text(&body),
            svg: grip_figure(&body, "grip").to_svg().map_err(StudyError::from)?,
            files: files.collect(),
            question: body.question(),
            verdict: body.verdict(),
            remarks: body.remarks(),
            extrapolations: body.extrapolations().iter().map(ToString::to_string).collect(),
            confidence: body.grip.confidence(),
            holds,
            squeeze: answer.squeeze.as_ref().ok().map(Into::into),
            neighbours: answer.neighbours.clone(),
            back_off: answer.back_off.as_ref().ok().map(Into::into),
            force_held: answer.force_hold.as_ref().ok().map(Into::into),
            schedule: answer.schedule.as_ref().and_then(|made| made.as_ref().ok()).map(Into::into),
            refused: body.refused().into_iter().map(refused).collect(),
        })
    }
}

impl Grip {
    /// Answers, and warns of every question beyond the test.
    pub(crate) fn of(py: Python<'_>, file: &MaterialFile, asked: Asked) -> PyResult<Self> {
        let (body, text) = (file.material.clone(), file.to_toml());
        let kept = at_length(py, move || Kept::of(&body, &text, &asked))?.map_err(|error| match error {
            Unanswered::Question(error) => ungripped(&error),
            Unanswered::Study(error) => refused_plainly::<PalpateError>(error),
        })?;
        for beyond in &kept.extrapolations {
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
        self.kept.holds
    }

    /// The answer in a sentence.
    #[getter]
    fn verdict(&self) -> &str {
        &self.kept.verdict
    }

    /// The question in a sentence.
    #[getter]
    fn question(&self) -> &str {
        &self.kept.question
    }

    /// What the numbers mean, a sentence each.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.kept.remarks.clone()
    }

    /// How the question goes beyond what the test has shown, a sentence each.
    #[getter]
    fn extrapolations(&self) -> Vec<String> {
        self.kept.extrapolations.clone()
    }

    /// Coverage of the intervals.
    #[getter]
    fn confidence(&self) -> f64 {
        self.kept.confidence
    }

    /// The squeeze with the displacement held: the one that was asked about, or the least; None if there is none.
    #[getter]
    fn squeeze(&self) -> Option<Holding> {
        self.kept.squeeze.clone()
    }

    /// Displacement of that squeeze, m.
    #[getter]
    fn squeeze_m(&self) -> Option<f64> {
        self.kept.squeeze.as_ref().map(Holding::place)
    }

    /// From the start of its hold until it slips, s; infinite for always (longer than ten years), 0 if it slips at once.
    #[getter]
    fn time_to_slip_s(&self) -> Option<f64> {
        self.kept.squeeze.as_ref().map(Holding::time_to_slip_s)
    }

    /// Ends of the interval of that time by what the calibration leaves open, s; None where it says nothing.
    #[getter]
    fn time_to_slip_interval_s(&self) -> Option<(f64, f64)> {
        self.kept.squeeze.as_ref().and_then(Holding::time_to_slip_interval_s)
    }

    /// How long squeezes a little less and more deep hold: ``displacement_m`` and ``time_to_slip_s``.
    #[getter]
    fn neighbours(&self) -> PyResult<Table> {
        neighbour_table(&self.kept.neighbours)
    }

    /// Squeeze and back off, so that the hold begins relaxed; None if there is none.
    #[getter]
    fn back_off(&self) -> Option<BackOff> {
        self.kept.back_off.clone()
    }

    /// The force held; None if there is none.
    #[getter]
    fn force_held(&self) -> Option<ForceHeld> {
        self.kept.force_held.clone()
    }

    /// Squeezes that keep the force in a band; None if none was asked for, or none does.
    #[getter]
    fn schedule(&self) -> Option<Schedule> {
        self.kept.schedule.clone()
    }

    /// Grips that there are not, by name, each with the reason and what would help.
    #[getter]
    fn refused<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (grip, reason, hint) in &self.kept.refused {
            dict.set_item(grip, format!("{reason}\nhint: {hint}"))?;
        }
        Ok(dict)
    }

    /// The document that ``palpate grip --format json`` prints, as plain objects; its material is called "material".
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("json")?.call_method1("loads", (&self.kept.json,))
    }

    /// The same as text.
    fn to_json(&self) -> &str {
        &self.kept.json
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
        palpate_jobs::output::write_bundle(&folder, &bundle).map_err(|error| unwritten(&error))?;
        Ok(folder.join("report.html"))
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        let kept = serde_json::from_str(json).map_err(refused_plainly::<PalpateError>)?;
        Ok(Self { kept })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        made_again::<Self>(py, &self.kept)
    }

    fn __str__(&self) -> &str {
        &self.kept.text
    }

    fn __repr__(&self) -> String {
        format!("<palpate.Grip: {}>", self.kept.verdict)
    }

    /// The report, for notebooks.
    fn _repr_html_(&self) -> Option<String> {
        self.kept.files.iter().find(|(path, _)| path == "report.html").map(|(_, page)| framed(page))
    }
}
