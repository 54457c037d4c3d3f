//! The grips of an answer: the displacement held, squeeze and back off, the force held, squeeze again.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, StringArray};
use palpate::calibrate::Prediction as Predicted;
use palpate::grip::{
    BackOff as Backed, Followed, ForceHold, Holding as Found, Move, PlanKind, Regrip, Schedule as Squeezes,
    Sensitivity, TimeToSlip,
};
use palpate::number::significant;
use pyo3::prelude::*;
use pyo3::types::PyType;
use serde::{Deserialize, Serialize};

use crate::errors::{PalpateError, refused_plainly};
use crate::prediction::Prediction;
use crate::table::Table;
use crate::work::{Made, made_again};

/// A time, s; infinite for always.
pub(crate) fn seconds(lasts: TimeToSlip) -> f64 {
    lasts.seconds().unwrap_or(f64::INFINITY)
}

fn again<T: for<'a> Deserialize<'a>>(json: &str) -> PyResult<T> {
    serde_json::from_str(json).map_err(refused_plainly::<PalpateError>)
}

fn column<T>(rows: &[T], number: fn(&T) -> Option<f64>) -> ArrayRef {
    Arc::new(rows.iter().map(number).collect::<Float64Array>())
}

/// How long squeezes beside the one that is asked about hold.
pub(crate) fn neighbour_table(neighbours: &[(f64, TimeToSlip)]) -> PyResult<Table> {
    Table::of(vec![
        ("displacement_m", column(neighbours, |row| Some(row.0))),
        ("time_to_slip_s", column(neighbours, |row| Some(seconds(row.1)))),
    ])
}

/// A grip with the displacement held; SI units.
#[pyclass(name = "Holding", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Holding {
    /// How the jaws close: "squeeze", "settle" (a force is kept before they are locked) or "back_off".
    #[pyo3(get)]
    kind: String,
    /// Where the jaws turn, m; None but for a retreat.
    #[pyo3(get)]
    over_m: Option<f64>,
    /// Force that is kept before the jaws are locked, N; None but for a grip that settles.
    #[pyo3(get)]
    settling_force_n: Option<f64>,
    /// How long it is kept, s.
    #[pyo3(get)]
    settling_s: Option<f64>,
    /// Speed of the jaws, m/s.
    #[pyo3(get)]
    speed_m_per_s: f64,
    /// How long closing takes, s.
    #[pyo3(get)]
    closing_s: f64,
    /// Displacement in the hold, m.
    #[pyo3(get)]
    displacement_m: f64,
    /// Force that is needed there, N.
    #[pyo3(get)]
    needed_force_n: f64,
    /// Force at the start of the hold, N.
    #[pyo3(get)]
    start_force_n: f64,
    /// The largest force, N.
    #[pyo3(get)]
    peak_force_n: f64,
    /// The force that the hold tends to, N.
    #[pyo3(get)]
    relaxed_force_n: f64,
    /// Work of the jaws while they close, J.
    #[pyo3(get)]
    work_j: f64,
    lasts: TimeToSlip,
    interval: Option<(TimeToSlip, TimeToSlip)>,
    /// How sharply the time depends on the squeeze, d ln(time)/d(displacement), 1/m; None where it slips at once or never.
    #[pyo3(get)]
    sharpness_per_m: Option<f64>,
    course: Option<Predicted>,
}

impl Holding {
    pub(crate) fn place(&self) -> f64 {
        self.displacement_m
    }

    fn of(found: &Found, course: Option<&Predicted>) -> Self {
        let (kind, over, settling, speed) = match found.plan.kind {
            PlanKind::Squeeze { speed, .. } => ("squeeze", None, None, speed),
            PlanKind::Settle { force, speed, settling } => ("settle", None, Some((force, settling)), speed),
            PlanKind::BackOff { over, speed, .. } => ("back_off", Some(over), None, speed),
        };
        Self {
            kind: kind.to_owned(),
            over_m: over,
            settling_force_n: settling.map(|settling| settling.0),
            settling_s: settling.map(|settling| settling.1),
            speed_m_per_s: speed,
            closing_s: found.closing,
            displacement_m: found.displacement,
            needed_force_n: found.needed_force,
            start_force_n: found.start_force,
            peak_force_n: found.peak_force,
            relaxed_force_n: found.relaxed_force,
            work_j: found.work,
            lasts: found.lasts,
            interval: found.interval,
            sharpness_per_m: found.sharpness,
            course: course.cloned(),
        }
    }
}

impl From<&Followed<Found>> for Holding {
    fn from(made: &Followed<Found>) -> Self {
        Self::of(&made.found, Some(&made.course))
    }
}

#[pymethods]
impl Holding {
    /// From the start of the hold until it slips, s; infinite for always (longer than ten years), 0 if it slips at once.
    #[getter]
    pub(crate) fn time_to_slip_s(&self) -> f64 {
        seconds(self.lasts)
    }

    /// Ends of the interval of that time by what the calibration leaves open, s; None where it says nothing.
    #[getter]
    pub(crate) fn time_to_slip_interval_s(&self) -> Option<(f64, f64)> {
        self.interval.map(|(low, high)| (seconds(low), seconds(high)))
    }

    /// Force and displacement over time, with intervals; None for the plain squeeze beside a retreat.
    #[getter]
    fn course(&self) -> Option<Prediction> {
        self.course.clone().map(Prediction::kept)
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        again(json)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        made_again::<Self>(py, self)
    }

    fn __repr__(&self) -> String {
        let time = match self.lasts {
            TimeToSlip::Never => "always".to_owned(),
            TimeToSlip::After(time) => format!("for {} s", significant(time, 3)),
        };
        format!(
            "<palpate.Holding {}: {} mm, {} N, {} N relaxed, {} N needed; holds {time}>",
            self.kind,
            significant(1e3 * self.displacement_m, 4),
            significant(self.start_force_n, 4),
            significant(self.relaxed_force_n, 4),
            significant(self.needed_force_n, 4),
        )
    }
}

/// Squeeze and back off, beside the plain squeeze to the same place; SI units.
#[pyclass(name = "BackOff", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct BackOff {
    /// The retreat: its hold begins relaxed.
    #[pyo3(get)]
    backed: Holding,
    /// The plain squeeze.
    #[pyo3(get)]
    plain: Holding,
    /// Time over which drifts are told, s.
    #[pyo3(get)]
    duration_s: f64,
    /// Change of the force over that time after the retreat, N.
    #[pyo3(get)]
    drift_n: f64,
    /// The same after the plain squeeze, N.
    #[pyo3(get)]
    plain_drift_n: f64,
    sensitivities: Vec<Sensitivity>,
}

impl From<&Followed<Backed>> for BackOff {
    fn from(made: &Followed<Backed>) -> Self {
        let found = &made.found;
        Self {
            backed: Holding::of(&found.backed, Some(&made.course)),
            plain: Holding::of(&found.plain, None),
            duration_s: found.duration,
            drift_n: found.drift,
            plain_drift_n: found.plain_drift,
            sensitivities: found.sensitivities.clone(),
        }
    }
}

#[pymethods]
impl BackOff {
    /// What 1 % more of a number of the material does to it: ``number``, its ``relative_error``, by how much the force at the start of the
    /// hold misses the relaxed one (``missed_n``), by how much farther the jaws would have to go (``over_m``).
    #[getter]
    fn sensitivities(&self) -> PyResult<Table> {
        let rows = &self.sensitivities;
        let names: ArrayRef = Arc::new(StringArray::from_iter_values(rows.iter().map(|row| &row.name)));
        Table::of(vec![
            ("number", names),
            ("relative_error", column(rows, |row| row.error)),
            ("missed_n", column(rows, |row| Some(row.missed))),
            ("over_m", column(rows, |row| Some(row.over))),
        ])
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        again(json)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        made_again::<Self>(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "<palpate.BackOff: to {} mm and back to {} mm, {} N stay>",
            significant(1e3 * self.backed.over_m.unwrap_or(self.backed.displacement_m), 4),
            significant(1e3 * self.backed.displacement_m, 4),
            significant(self.backed.start_force_n, 4),
        )
    }
}

/// The force held: it does not relax, the body creeps; SI units.
#[pyclass(name = "ForceHeld", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ForceHeld {
    /// The force, N.
    #[pyo3(get)]
    force_n: f64,
    /// How long it is held, s.
    #[pyo3(get)]
    duration_s: f64,
    /// Force that is needed, N.
    #[pyo3(get)]
    needed_force_n: f64,
    /// How long closing takes, s.
    #[pyo3(get)]
    closing_s: f64,
    /// Displacement when the hold begins, m.
    #[pyo3(get)]
    displacement_start_m: f64,
    /// Displacement when it ends, m.
    #[pyo3(get)]
    displacement_end_m: f64,
    /// Displacement that it tends to, m; None if none of the body carries the force relaxed.
    #[pyo3(get)]
    displacement_relaxed_m: Option<f64>,
    /// Whether the force is enough.
    #[pyo3(get)]
    holds: bool,
    /// When the jaws come to the end of their stroke, s since the hold began; None if they do not.
    #[pyo3(get)]
    stroke_ends_s: Option<f64>,
    /// Work of the jaws, J.
    #[pyo3(get)]
    work_j: f64,
    course: Predicted,
}

impl From<&Followed<ForceHold>> for ForceHeld {
    fn from(made: &Followed<ForceHold>) -> Self {
        let found = &made.found;
        Self {
            force_n: found.force,
            duration_s: found.duration,
            needed_force_n: found.needed_force,
            closing_s: found.closing,
            displacement_start_m: found.displacement_start,
            displacement_end_m: found.displacement_end,
            displacement_relaxed_m: found.displacement_relaxed,
            holds: found.holds,
            stroke_ends_s: found.stroke_ends,
            work_j: found.work,
            course: made.course.clone(),
        }
    }
}

#[pymethods]
impl ForceHeld {
    /// Force and displacement over time, with intervals.
    #[getter]
    fn course(&self) -> Prediction {
        Prediction::kept(self.course.clone())
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        again(json)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        made_again::<Self>(py, self)
    }

    fn __repr__(&self) -> String {
        let (start, end) = (1e3 * self.displacement_start_m, 1e3 * self.displacement_end_m);
        format!(
            "<palpate.ForceHeld: {} N, {} N needed; {} mm to {} mm in {} s>",
            significant(self.force_n, 4),
            significant(self.needed_force_n, 4),
            significant(start, 4),
            significant(end, 4),
            significant(self.duration_s, 4),
        )
    }
}

/// Squeezes that keep the force in a band; SI units.
#[pyclass(name = "Schedule", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Schedule {
    /// What it has least of: "moves" or "work".
    #[pyo3(get)]
    objective: String,
    /// Edges of the band, N.
    #[pyo3(get)]
    band_n: (f64, f64),
    /// How long it lasts behind the first squeeze, s.
    #[pyo3(get)]
    duration_s: f64,
    moves: Vec<Move>,
    /// Force at its end, N.
    #[pyo3(get)]
    end_force_n: f64,
    /// Displacement at its end, m.
    #[pyo3(get)]
    end_displacement_m: f64,
    /// Work of the jaws, J.
    #[pyo3(get)]
    work_j: f64,
    course: Predicted,
}

impl From<&Followed<Squeezes>> for Schedule {
    fn from(made: &Followed<Squeezes>) -> Self {
        let found = &made.found;
        let objective = match found.objective {
            Regrip::FewestMoves => "moves",
            Regrip::LeastWork { .. } => "work",
        };
        Self {
            objective: objective.to_owned(),
            band_n: (found.band.low, found.band.high),
            duration_s: found.duration,
            moves: found.moves.clone(),
            end_force_n: found.end_force,
            end_displacement_m: found.end_displacement,
            work_j: found.work,
            course: made.course.clone(),
        }
    }
}

#[pymethods]
impl Schedule {
    /// The squeezes, the first among them: ``time_s`` since first touch, ``from_m``, ``to_m``, ``force_from_n``, ``force_to_n``.
    #[getter]
    fn moves(&self) -> PyResult<Table> {
        let rows = &self.moves;
        Table::of(vec![
            ("time_s", column(rows, |row| Some(row.time))),
            ("from_m", column(rows, |row| Some(row.from))),
            ("to_m", column(rows, |row| Some(row.to))),
            ("force_from_n", column(rows, |row| Some(row.force_from))),
            ("force_to_n", column(rows, |row| Some(row.force_to))),
        ])
    }

    /// Force and displacement over time, with intervals.
    #[getter]
    fn course(&self) -> Prediction {
        Prediction::kept(self.course.clone())
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        again(json)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        made_again::<Self>(py, self)
    }

    fn __repr__(&self) -> String {
        let (low, high) = (significant(self.band_n.0, 4), significant(self.band_n.1, 4));
        let (count, time) = (self.moves.len(), significant(self.duration_s, 4));
        format!("<palpate.Schedule: {count} squeezes keep {low} N to {high} N for {time} s>")
    }
}
