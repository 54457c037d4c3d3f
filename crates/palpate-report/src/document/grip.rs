//! `palpate.grip/1`: a planned grip.

use palpate::grip::{BackOff, ForceHold, Holding, Move, PlanKind, Regrip, Schedule, Sensitivity, TimeToSlip};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::software::Software;
use crate::result::{GrippedBody, word};

/// The load and what holds it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GraspDocument {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Safety factor on friction.
    pub safety: f64,
    /// Gravity, m/s².
    pub gravity_m_per_s2: f64,
    /// Acceleration upwards, m/s².
    pub acceleration_up_m_per_s2: f64,
    /// Acceleration across gravity in the plane of the jaws, m/s².
    pub acceleration_across_m_per_s2: f64,
    /// Acceleration along the closing axis, m/s².
    pub acceleration_closing_m_per_s2: f64,
    /// Torque about the closing axis, N m.
    pub torque_n_m: f64,
    /// Distance of the centre of mass from the closing axis, m.
    pub off_centre_m: f64,
    /// Tangential force at each contact, N.
    pub tangential_force_n: f64,
    /// Torsion at each contact, N m.
    pub torsion_n_m: f64,
}

/// What the gripper can do.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GripLimitsDocument {
    /// The fastest that the jaws go, m/s.
    pub speed_m_per_s: f64,
    /// How far they go, m.
    pub stroke_m: Option<f64>,
    /// The largest force, N.
    pub force_n: Option<f64>,
    /// How long closing may take, s; `null` where any time may.
    pub closing_s: Option<f64>,
}

/// How long something holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LastsDocument {
    /// Longer than ten years.
    pub always: bool,
    /// Until it slips, s; `null` for always.
    pub seconds: Option<f64>,
}

/// A grip with the displacement held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HoldingDocument {
    /// `squeeze`, `settle` or `back_off`.
    pub kind: String,
    /// Where the jaws turn, m; of a retreat.
    pub over_m: Option<f64>,
    /// Force that is kept before the jaws are locked, N; of one that settles.
    pub settling_force_n: Option<f64>,
    /// How long it is kept, s.
    pub settling_s: Option<f64>,
    /// Speed of the jaws, m/s.
    pub speed_m_per_s: f64,
    /// How long closing takes, s.
    pub closing_s: f64,
    /// Displacement in the hold, m.
    pub displacement_m: f64,
    /// Force that is needed there, N.
    pub needed_force_n: f64,
    /// Force at the start of the hold, N.
    pub start_force_n: f64,
    /// The largest force, N.
    pub peak_force_n: f64,
    /// The force that the hold tends to, N.
    pub relaxed_force_n: f64,
    /// Work of the jaws while they close, J.
    pub work_j: f64,
    /// How long it holds.
    pub lasts: LastsDocument,
    /// Ends of the interval of that time.
    pub interval: Option<[LastsDocument; 2]>,
    /// d ln(time)/d(displacement), 1/m.
    pub sharpness_per_m: Option<f64>,
}

/// How long a squeeze to another displacement holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NeighbourDocument {
    /// Displacement, m.
    pub displacement_m: f64,
    /// How long.
    pub lasts: LastsDocument,
}

/// What 1 % more of a number of the material does to squeeze and back off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SensitivityDocument {
    /// Name of the number.
    pub number: String,
    /// Its relative standard error.
    pub relative_error: Option<f64>,
    /// By how much the force at the start of the hold misses the relaxed one, N.
    pub missed_n: f64,
    /// By how much farther the jaws have to go, m.
    pub over_m: f64,
}

/// Squeeze and back off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BackOffDocument {
    /// The retreat.
    pub backed: HoldingDocument,
    /// The plain squeeze to the same place.
    pub plain: HoldingDocument,
    /// Time over which drifts are told, s.
    pub duration_s: f64,
    /// Change of the force after the retreat, N.
    pub drift_n: f64,
    /// The same after the plain squeeze, N.
    pub plain_drift_n: f64,
    /// What the numbers of the material do to it.
    pub sensitivities: Vec<SensitivityDocument>,
}

/// The force held.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PressedDocument {
    /// The force, N.
    pub force_n: f64,
    /// How long, s.
    pub duration_s: f64,
    /// Force that is needed, N.
    pub needed_force_n: f64,
    /// How long closing takes, s.
    pub closing_s: f64,
    /// Displacement when the hold begins, m.
    pub displacement_start_m: f64,
    /// Displacement when it ends, m.
    pub displacement_end_m: f64,
    /// Displacement that it tends to, m; `null` if none of the body carries the force relaxed.
    pub displacement_relaxed_m: Option<f64>,
    /// Whether the force is enough.
    pub holds: bool,
    /// When the jaws come to the end of their stroke, s since the hold began.
    pub stroke_ends_s: Option<f64>,
    /// Work of the jaws, J.
    pub work_j: f64,
}

/// A squeeze of a schedule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MoveDocument {
    /// When it begins, s since first touch.
    pub time_s: f64,
    /// Displacement before it, m.
    pub from_m: f64,
    /// Displacement behind it, m.
    pub to_m: f64,
    /// Force before it, N.
    pub force_from_n: f64,
    /// Force behind it, N.
    pub force_to_n: f64,
}

/// Squeezes that keep the force in a band.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScheduleDocument {
    /// `fewest_moves` or `least_work`.
    pub objective: String,
    /// Edges of the band, N.
    pub band_n: [f64; 2],
    /// How long it lasts behind the first squeeze, s.
    pub duration_s: f64,
    /// The squeezes, the first among them.
    pub moves: Vec<MoveDocument>,
    /// Force at its end, N.
    pub end_force_n: f64,
    /// Displacement at its end, m.
    pub end_displacement_m: f64,
    /// Work of the jaws, J.
    pub work_j: f64,
}

/// A grip that there is not.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RefusedDocument {
    /// Which.
    pub grip: String,
    /// Why.
    pub reason: String,
    /// What would help.
    pub hint: String,
}

/// A planned grip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GripDocument {
    /// Always `palpate.grip/1`.
    pub schema: String,
    /// The software that wrote it.
    pub software: Software,
    /// Path of the material file.
    pub material: String,
    /// SHA-256 of its bytes.
    pub material_sha256: String,
    /// The calibrated law.
    pub law: String,
    /// Coverage of the intervals.
    pub confidence: f64,
    /// The load.
    pub grasp: GraspDocument,
    /// The gripper.
    pub limits: GripLimitsDocument,
    /// What is held: `position` or `force`.
    pub control: String,
    /// How long it is to hold; `null` where that is the question.
    pub duration: Option<LastsDocument>,
    /// What the squeeze has least of: `squeeze`, `peak_force` or `work`; `null` where a squeeze was given.
    pub objective: Option<String>,
    /// Whether the lower edge of the band has to hold.
    pub assured: bool,
    /// Whether the grip that is asked about holds as long as was asked.
    pub holds: bool,
    /// The same in a sentence.
    pub verdict: String,
    /// The displacement held.
    pub squeeze: Option<HoldingDocument>,
    /// Squeezes beside it.
    pub neighbours: Vec<NeighbourDocument>,
    /// Squeeze and back off.
    pub back_off: Option<BackOffDocument>,
    /// The force held.
    pub force_held: Option<PressedDocument>,
    /// Squeeze again.
    pub schedule: Option<ScheduleDocument>,
    /// Grips that there are not, and why.
    pub refused: Vec<RefusedDocument>,
    /// How the question goes beyond what the test has shown.
    pub extrapolations: Vec<String>,
    /// What it means, in sentences.
    pub remarks: Vec<String>,
}

impl From<TimeToSlip> for LastsDocument {
    fn from(lasts: TimeToSlip) -> Self {
        Self {
            always: lasts == TimeToSlip::Never,
            seconds: lasts.seconds(),
        }
    }
}

impl From<&Holding> for HoldingDocument {
    fn from(found: &Holding) -> Self {
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
            lasts: found.lasts.into(),
            interval: found.interval.map(|(low, high)| [low.into(), high.into()]),
            sharpness_per_m: found.sharpness,
        }
    }
}

impl From<&Sensitivity> for SensitivityDocument {
    fn from(found: &Sensitivity) -> Self {
        Self {
            number: found.name.clone(),
            relative_error: found.error,
            missed_n: found.missed,
            over_m: found.over,
        }
    }
}

impl From<&BackOff> for BackOffDocument {
    fn from(found: &BackOff) -> Self {
        Self {
            backed: (&found.backed).into(),
            plain: (&found.plain).into(),
            duration_s: found.duration,
            drift_n: found.drift,
            plain_drift_n: found.plain_drift,
            sensitivities: found.sensitivities.iter().map(Into::into).collect(),
        }
    }
}

impl From<&ForceHold> for PressedDocument {
    fn from(found: &ForceHold) -> Self {
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
        }
    }
}

impl From<&Move> for MoveDocument {
    fn from(step: &Move) -> Self {
        Self {
            time_s: step.time,
            from_m: step.from,
            to_m: step.to,
            force_from_n: step.force_from,
            force_to_n: step.force_to,
        }
    }
}

impl From<&Schedule> for ScheduleDocument {
    fn from(found: &Schedule) -> Self {
        let objective = match found.objective {
            Regrip::FewestMoves => "fewest_moves",
            Regrip::LeastWork { .. } => "least_work",
        };
        Self {
            objective: objective.to_owned(),
            band_n: [found.band.low, found.band.high],
            duration_s: found.duration,
            moves: found.moves.iter().map(Into::into).collect(),
            end_force_n: found.end_force,
            end_displacement_m: found.end_displacement,
            work_j: found.work,
        }
    }
}

impl GripDocument {
    /// The document of a planned grip.
    #[must_use]
    pub fn new(body: &GrippedBody<'_>) -> Self {
        let (answer, grasp, limits) = (&body.answer, body.grip.grasp(), body.grip.limits());
        let question = &answer.question;
        let refused = body.refused().into_iter().map(|(grip, error)| RefusedDocument {
            grip: grip.to_owned(),
            reason: error.to_string(),
            hint: error.hint().to_owned(),
        });
        Self {
            schema: "palpate.grip/1".to_owned(),
            software: Software::this(),
            material: body.path.clone(),
            material_sha256: body.sha256.clone(),
            law: body.grip.material().candidate.to_string(),
            confidence: body.grip.confidence(),
            grasp: GraspDocument {
                mass_kg: grasp.mass,
                friction: grasp.friction,
                safety: grasp.safety,
                gravity_m_per_s2: grasp.gravity,
                acceleration_up_m_per_s2: grasp.acceleration_up,
                acceleration_across_m_per_s2: grasp.acceleration_across,
                acceleration_closing_m_per_s2: grasp.acceleration_closing,
                torque_n_m: grasp.torque,
                off_centre_m: grasp.off_centre,
                tangential_force_n: grasp.tangential_force(),
                torsion_n_m: grasp.torsion(),
            },
            limits: GripLimitsDocument {
                speed_m_per_s: limits.speed,
                stroke_m: limits.stroke,
                force_n: limits.force,
                closing_s: limits.closing,
            },
            control: word(question.control),
            duration: question
                .duration
                .map(|time| if time.is_finite() { TimeToSlip::After(time) } else { TimeToSlip::Never }.into()),
            objective: question.squeeze.is_none().then(|| word(question.objective)),
            assured: question.assured,
            holds: answer.holds() == Ok(true),
            verdict: body.verdict(),
            squeeze: answer.squeeze.as_ref().ok().map(|made| (&made.found).into()),
            neighbours: answer
                .neighbours
                .iter()
                .map(|(place, time)| NeighbourDocument {
                    displacement_m: *place,
                    lasts: (*time).into(),
                })
                .collect(),
            back_off: answer.back_off.as_ref().ok().map(|made| (&made.found).into()),
            force_held: answer.force_hold.as_ref().ok().map(|made| (&made.found).into()),
            schedule: answer.schedule.as_ref().and_then(|made| made.as_ref().ok()).map(|made| (&made.found).into()),
            refused: refused.collect(),
            extrapolations: body.extrapolations().iter().map(ToString::to_string).collect(),
            remarks: body.remarks(),
        }
    }
}
