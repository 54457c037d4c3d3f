//! What a planned grip is made of: a squeeze, overshoot and back off, the force held, squeeze again.
//!
//! Each is a part of the document of a grip, and its course over time.

use palpate::calibrate::Prediction as Predicted;
use palpate::number::significant;
use palpate_report::document::{
    BackOffDocument, ForceHoldDocument, PositionHoldDocument, ScheduleDocument, TimeToSlipDocument,
};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::materials::prediction::Prediction;
use crate::shown::shown;
use crate::table::{Table, columns};

/// A time, s; infinite for always.
pub(crate) fn seconds(lasts: TimeToSlipDocument) -> f64 {
    lasts.seconds.unwrap_or(f64::INFINITY)
}

/// Ends of the interval of such a time.
pub(crate) fn slip_interval(found: &PositionHoldDocument) -> Option<(f64, f64)> {
    found.interval.map(|[low, high]| (seconds(low), seconds(high)))
}

/// A class of Python that shows a part of the document: with the course, the fields that are passed on or an expression of them, and methods
/// of its own.
macro_rules! part {
    (@ $me:ident, $field:ident) => { $me.found.$field.clone() };
    (@ $me:ident, $field:ident, $value:expr) => { $value };
    (
        $(#[$about:meta])*
        $class:ident($document:ty, $course:ty): $me:ident {
            $($(#[$doc:meta])* $field:ident: $of:ty $(= $value:expr)?,)*
        }
        $($methods:tt)*
    ) => {
        $(#[$about])*
        #[pyclass(module = "palpate", frozen, eq)]
        #[derive(Clone, PartialEq, Serialize, Deserialize)]
        pub(crate) struct $class {
            found: $document,
            course: $course,
        }

        impl $class {
            pub(crate) fn new(found: $document, course: $course) -> Self {
                Self { found, course }
            }
        }

        shown! {
            $class: $me
            values { $($(#[$doc])* $field: $of = part!(@ $me, $field $(, $value)?),)* }
            $($methods)*
        }
    };
}

part! {
    /// A grip with the displacement held; SI units.
    PositionHold(PositionHoldDocument, Option<Predicted>): self {
        /// How the jaws close: "squeeze", "settle" (a force is kept before they are locked) or "back_off".
        kind: String,
        /// Where the jaws turn, m; None but for a retreat.
        over_m: Option<f64>,
        /// Force that is kept before the jaws are locked, N; None but for a grip that settles.
        settling_force_n: Option<f64>,
        /// How long it is kept, s.
        settling_s: Option<f64>,
        /// Speed of the jaws, m/s.
        speed_m_per_s: f64,
        /// How long closing takes, s.
        closing_s: f64,
        /// Displacement in the hold, m.
        displacement_m: f64,
        /// Force that is needed there, N.
        needed_force_n: f64,
        /// Force at the start of the hold, N.
        start_force_n: f64,
        /// The largest force, N.
        peak_force_n: f64,
        /// The force that the hold tends to, N.
        equilibrium_force_n: f64,
        /// Work of the jaws while they close, J.
        work_j: f64,
        /// How sharply the time depends on the squeeze, d ln(time)/d(displacement), 1/m; None where it slips at once or never.
        sharpness_per_m: Option<f64>,
        /// From the start of the hold until it slips, s; infinite for always (longer than ten years), 0 if it slips at once.
        time_to_slip_s: f64 = seconds(self.found.time_to_slip),
        /// Ends of the interval of that time by what the calibration leaves open, s; None where it says nothing.
        time_to_slip_interval_s: Option<(f64, f64)> = slip_interval(&self.found),
        /// Time that it holds with the probability required, s; infinite for always, None if the calibration has no intervals.
        assured_time_s: Option<f64> = self.found.assured.map(seconds),
        /// Force and displacement over time, with intervals; None for the plain squeeze beside a retreat.
        course: Option<Prediction> = self.course.clone().map(Prediction::kept),
    }

    fn __repr__(&self) -> String {
        let found = &self.found;
        let least = found.assured.map(seconds).or(slip_interval(found).map(|(low, _)| low));
        let may_slip_at_once = least == Some(0.0) && seconds(found.time_to_slip) > 0.0;
        let time = match found.time_to_slip.seconds {
            _ if may_slip_at_once => "for a time that is uncertain, from 0 s on".to_owned(),
            None => "always".to_owned(),
            Some(time) => format!("for {} s", significant(time, 3)),
        };
        format!(
            "<palpate.PositionHold {}: {} mm, {} N, {} N relaxed, {} N needed; holds {time}>",
            found.kind,
            significant(1e3 * found.displacement_m, 4),
            significant(found.start_force_n, 4),
            significant(found.equilibrium_force_n, 4),
            significant(found.needed_force_n, 4),
        )
    }
}

part! {
    /// Overshoot and back off (a preconditioning squeeze), beside the plain squeeze to the same position; SI units.
    BackOff(BackOffDocument, Predicted): self {
        /// Time over which drifts are given, s.
        duration_s: f64,
        /// Change of the force over that time after the retreat, N.
        drift_n: f64,
        /// The same after the plain squeeze, N.
        plain_drift_n: f64,
        /// The retreat: its hold begins relaxed.
        backed: PositionHold = PositionHold::new(self.found.backed.clone(), Some(self.course.clone())),
        /// The plain squeeze.
        plain: PositionHold = PositionHold::new(self.found.plain.clone(), None),
        /// What 1 % more of a parameter of the material does to it: ``parameter``, its ``relative_error``, by how much the force at the start of the
        /// hold misses the relaxed one (``missed_n``), by how much farther the jaws would have to go (``over_m``).
        sensitivities: PyResult<Table> =
            Table::of(columns!(self.found.sensitivities, row => parameter, relative_error, missed_n, over_m)),
    }

    fn __repr__(&self) -> String {
        let backed = &self.found.backed;
        format!(
            "<palpate.BackOff: to {} mm and back to {} mm, {} N stay>",
            significant(1e3 * backed.over_m.unwrap_or(backed.displacement_m), 4),
            significant(1e3 * backed.displacement_m, 4),
            significant(backed.start_force_n, 4),
        )
    }
}

part! {
    /// The force held: it does not relax, the body creeps; SI units.
    ForceHold(ForceHoldDocument, Predicted): self {
        /// The force, N.
        force_n: f64,
        /// How long it is held, s.
        duration_s: f64,
        /// Force that is needed, N.
        needed_force_n: f64,
        /// How long closing takes, s.
        closing_s: f64,
        /// Displacement when the hold begins, m.
        displacement_start_m: f64,
        /// Displacement when it ends, m.
        displacement_end_m: f64,
        /// Displacement that it tends to, m; None if none of the body carries the force relaxed.
        displacement_relaxed_m: Option<f64>,
        /// Whether the force is enough.
        holds: bool,
        /// When the jaws come to the end of their stroke, s since the hold began; None if they do not.
        stroke_ends_s: Option<f64>,
        /// Work of the jaws, J.
        work_j: f64,
        /// Force and displacement over time, with intervals.
        course: Prediction = Prediction::kept(self.course.clone()),
    }

    fn __repr__(&self) -> String {
        let found = &self.found;
        format!(
            "<palpate.ForceHold: {} N, {} N needed; {} mm to {} mm in {} s>",
            significant(found.force_n, 4),
            significant(found.needed_force_n, 4),
            significant(1e3 * found.displacement_start_m, 4),
            significant(1e3 * found.displacement_end_m, 4),
            significant(found.duration_s, 4),
        )
    }
}

part! {
    /// Squeezes that keep the force in a band; SI units.
    Schedule(ScheduleDocument, Predicted): self {
        /// How long it lasts behind the first squeeze, s.
        duration_s: f64,
        /// Force at its end, N.
        end_force_n: f64,
        /// Displacement at its end, m.
        end_displacement_m: f64,
        /// Work of the jaws, J.
        work_j: f64,
        /// What it has least of: "moves" or "work".
        objective: &'static str = if self.found.objective == "fewest_moves" { "moves" } else { "work" },
        /// Edges of the band, N.
        band_n: (f64, f64) = self.found.band_n.into(),
        /// The squeezes, the first among them: ``time_s`` since first touch, ``from_m``, ``to_m``, ``force_from_n``, ``force_to_n``.
        moves: PyResult<Table> =
            Table::of(columns!(self.found.moves, row => time_s, from_m, to_m, force_from_n, force_to_n)),
        /// Force and displacement over time, with intervals.
        course: Prediction = Prediction::kept(self.course.clone()),
    }

    fn __repr__(&self) -> String {
        let [low, high] = self.found.band_n.map(|edge| significant(edge, 4));
        let (count, time) = (self.found.moves.len(), significant(self.found.duration_s, 4));
        format!("<palpate.Schedule: {count} squeezes keep {low} N to {high} N for {time} s>")
    }
}
