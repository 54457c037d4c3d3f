//! `palpate.grip/1`: a planned grip.

use palpate::grip::{
    BackOff, ForceHold, Grasp, GripError, Limits, Move, PlanKind, PositionHold, Regrip, Schedule, Sensitivity,
    TimeToSlip,
};

use super::software::Software;
use crate::result::{GrippedBody, word};

documents! {
    /// The load and the friction that carries it.
    GraspDocument(grasp: &Grasp) {
        /// Mass, kg.
        mass_kg: f64 = grasp.mass,
        /// Coefficient of friction.
        friction: f64 = grasp.friction,
        /// Safety factor on friction.
        safety: f64 = grasp.safety,
        /// Gravity, m/s².
        gravity_m_per_s2: f64 = grasp.gravity,
        /// Acceleration upwards, m/s².
        acceleration_up_m_per_s2: f64 = grasp.acceleration_up,
        /// Acceleration across gravity in the plane of the jaws, m/s².
        acceleration_across_m_per_s2: f64 = grasp.acceleration_across,
        /// Acceleration along the closing axis, m/s².
        acceleration_closing_m_per_s2: f64 = grasp.acceleration_closing,
        /// Torque about the closing axis, N m.
        torque_n_m: f64 = grasp.torque,
        /// Distance of the centre of mass from the closing axis, m.
        off_centre_m: f64 = grasp.off_centre,
        /// Tangential force at each contact, N.
        tangential_force_n: f64 = grasp.tangential_force(),
        /// Torsion at each contact, N m.
        torsion_n_m: f64 = grasp.torsion(),
    }

    /// Limits of the gripper.
    GripLimitsDocument(limits: &Limits) {
        /// Largest speed of the jaws, m/s.
        speed_m_per_s: f64 = limits.speed,
        /// Stroke of the jaws, m.
        stroke_m: Option<f64> = limits.stroke,
        /// The largest force, N.
        force_n: Option<f64> = limits.force,
        /// Longest time of closing, s; `null` if unlimited.
        closing_s: Option<f64> = limits.closing,
    }

    /// Time to slip.
    #[derive(Copy)]
    TimeToSlipDocument(lasts: TimeToSlip) {
        /// Longer than ten years.
        always: bool = lasts == TimeToSlip::Never,
        /// Time to slip, s; `null` for always.
        seconds: Option<f64> = lasts.seconds(),
    }

    /// A position hold.
    PositionHoldDocument(found: &PositionHold) with {
        let (kind, over, settling_force, settling) = match found.plan.kind {
            PlanKind::Squeeze { .. } => ("squeeze", None, None, None),
            PlanKind::Settle { force, settling, .. } => ("settle", None, Some(force), Some(settling)),
            PlanKind::BackOff { over, .. } => ("back_off", Some(over), None, None),
        };
    } {
        /// `squeeze`, `settle` or `back_off`.
        kind: String = kind.to_owned(),
        /// Displacement at which the jaws reverse, m; of a back-off.
        over_m: Option<f64> = over,
        /// Force held before the jaws are locked, N; of `settle`.
        settling_force_n: Option<f64> = settling_force,
        /// Duration of that force hold, s.
        settling_s: Option<f64> = settling,
        /// Speed of the jaws, m/s.
        speed_m_per_s: f64 = found.plan.speed(),
        /// Duration of closing, s.
        closing_s: f64 = found.closing,
        /// Displacement in the hold, m.
        displacement_m: f64 = found.displacement,
        /// Required force there, N.
        needed_force_n: f64 = found.needed_force,
        /// Force at the start of the hold, N.
        start_force_n: f64 = found.start_force,
        /// The largest force, N.
        peak_force_n: f64 = found.peak_force,
        /// Equilibrium force of the hold, N.
        equilibrium_force_n: f64 = found.equilibrium_force,
        /// Work of the jaws while they close, J.
        work_j: f64 = found.work,
        /// Time to slip.
        time_to_slip: TimeToSlipDocument = TimeToSlipDocument::new(found.time_to_slip),
        /// Ends of the interval of that time.
        interval: Option<[TimeToSlipDocument; 2]> = found.interval.map(|(low, high)| [low, high].map(TimeToSlipDocument::new)),
        /// Time that is reached with the probability requested.
        assured: Option<TimeToSlipDocument> = found.assured.map(TimeToSlipDocument::new),
        /// d ln(time)/d(displacement), 1/m.
        sharpness_per_m: Option<f64> = found.sharpness,
    }

    /// Time to slip of a squeeze to another displacement.
    NeighbourDocument(displacement: f64, lasts: TimeToSlip) {
        /// Displacement, m.
        displacement_m: f64 = displacement,
        /// Time to slip.
        time_to_slip: TimeToSlipDocument = TimeToSlipDocument::new(lasts),
    }

    /// Sensitivity of overshoot and back off to a parameter of the material that is 1 % larger.
    SensitivityDocument(found: &Sensitivity) {
        /// Name of the parameter.
        parameter: String = found.name.clone(),
        /// Its relative standard error.
        relative_error: Option<f64> = found.error,
        /// Difference of the force at the start of the hold from the equilibrium force, N.
        missed_n: f64 = found.missed,
        /// Additional overshoot of the jaws, m.
        over_m: f64 = found.over,
    }

    /// Overshoot and back off (a preconditioning squeeze).
    BackOffDocument(found: &BackOff) {
        /// The back-off.
        backed: PositionHoldDocument = PositionHoldDocument::new(&found.backed),
        /// The plain squeeze to the same displacement.
        plain: PositionHoldDocument = PositionHoldDocument::new(&found.plain),
        /// Time over which the drifts are evaluated, s.
        duration_s: f64 = found.duration,
        /// Change of the force after the back-off, N.
        drift_n: f64 = found.drift,
        /// The same after the plain squeeze, N.
        plain_drift_n: f64 = found.plain_drift,
        /// Sensitivity to the parameters of the material.
        sensitivities: Vec<SensitivityDocument> = found.sensitivities.iter().map(SensitivityDocument::new).collect(),
    }

    /// The force hold.
    ForceHoldDocument(found: &ForceHold) {
        /// The force, N.
        force_n: f64 = found.force,
        /// How long, s.
        duration_s: f64 = found.duration,
        /// Required force, N.
        needed_force_n: f64 = found.needed_force,
        /// Duration of closing, s.
        closing_s: f64 = found.closing,
        /// Displacement when the hold begins, m.
        displacement_start_m: f64 = found.displacement_start,
        /// Displacement when it ends, m.
        displacement_end_m: f64 = found.displacement_end,
        /// Equilibrium displacement, m; `null` if no equilibrium displacement carries the force.
        displacement_relaxed_m: Option<f64> = found.displacement_relaxed,
        /// Whether the force is sufficient.
        holds: bool = found.holds,
        /// Time at which the jaws reach the end of their stroke, s from the start of the hold.
        stroke_ends_s: Option<f64> = found.stroke_ends,
        /// Work of the jaws, J.
        work_j: f64 = found.work,
    }

    /// A squeeze of a schedule.
    MoveDocument(step: &Move) {
        /// When it begins, s since first touch.
        time_s: f64 = step.time,
        /// Displacement before it, m.
        from_m: f64 = step.from,
        /// Displacement after it, m.
        to_m: f64 = step.to,
        /// Force before it, N.
        force_from_n: f64 = step.force_from,
        /// Force after it, N.
        force_to_n: f64 = step.force_to,
    }

    /// Squeezes that keep the force in a band.
    ScheduleDocument(found: &Schedule) with {
        let objective = match found.objective {
            Regrip::FewestMoves { .. } => "fewest_moves",
            Regrip::LeastWork { .. } => "least_work",
        };
    } {
        /// `fewest_moves` or `least_work`.
        objective: String = objective.to_owned(),
        /// Edges of the band, N.
        band_n: [f64; 2] = [found.band.low, found.band.high],
        /// Its duration after the first squeeze, s.
        duration_s: f64 = found.duration,
        /// The squeezes, the first among them.
        moves: Vec<MoveDocument> = found.moves.iter().map(MoveDocument::new).collect(),
        /// Force at its end, N.
        end_force_n: f64 = found.end_force,
        /// Displacement at its end, m.
        end_displacement_m: f64 = found.end_displacement,
        /// Work of the jaws, J.
        work_j: f64 = found.work,
    }

    /// A grip without a solution.
    #[derive(Eq)]
    RefusedDocument(grip: &str, error: &GripError) {
        /// Which.
        grip: String = grip.to_owned(),
        /// Why.
        reason: String = error.to_string(),
        /// Remedy.
        hint: String = error.hint().to_owned(),
    }

    /// A planned grip.
    GripDocument(body: &GrippedBody<'_>) with {
        let (answer, question) = (&body.answer, &body.answer.question);
        let wanted = |time: f64| if time.is_finite() { TimeToSlip::After(time) } else { TimeToSlip::Never };
        let schedule = answer.schedule.as_ref().and_then(|made| made.as_ref().ok());
        let neighbours = answer.neighbours.iter().map(|(place, time)| NeighbourDocument::new(*place, *time));
        let refused = body.refused().into_iter().map(|(grip, error)| RefusedDocument::new(grip, error));
    } {
        /// Always `palpate.grip/1`.
        schema: String = "palpate.grip/1".to_owned(),
        /// The software that wrote it.
        software: Software = Software::this(),
        /// Path of the material file.
        material: String = body.path.clone(),
        /// SHA-256 of its bytes.
        material_sha256: String = body.sha256.clone(),
        /// SHA-256 over the material, every setting and the build of palpate. Equal digests stand for equal plans.
        depends_on_sha256: String = body.depends_on_sha256.clone(),
        /// The calibrated law.
        law: String = body.grip.material().candidate().to_string(),
        /// What its record shows against that law, and what helps; `null` where nothing.
        misfit: Option<String> = body.misfit_sentence(),
        /// Coverage of the intervals.
        confidence: f64 = body.grip.confidence(),
        /// The load.
        grasp: GraspDocument = GraspDocument::new(body.grip.grasp()),
        /// The gripper.
        limits: GripLimitsDocument = GripLimitsDocument::new(body.grip.limits()),
        /// What is held: `position` or `force`.
        control: String = word(question.control),
        /// Required duration; `null` where the time to slip is computed.
        duration: Option<TimeToSlipDocument> = question.duration.map(|time| TimeToSlipDocument::new(wanted(time))),
        /// The minimised quantity: `squeeze`, `peak_force` or `work`; `null` where a squeeze was given.
        objective: Option<String> = question.squeeze.is_none().then(|| word(question.objective)),
        /// Level at which the verdict has to hold; `null` where the best estimate decides.
        verdict_confidence: Option<f64> = question.confidence,
        /// Probability that the grip in question holds as long as requested; `null` if the calibration has no intervals.
        probability: Option<f64> = body.answer.probability,
        /// The least squeeze that reaches the requested probability, m, if the squeeze in question does not.
        assured_squeeze_m: Option<f64> = body.answer.assured_squeeze,
        /// Whether the requested grip holds for the required duration.
        holds: bool = answer.holds() == Ok(true),
        /// The same in a sentence.
        verdict: String = body.verdict(),
        /// The position hold.
        squeeze: Option<PositionHoldDocument> = answer.squeeze.as_ref().ok().map(|made| PositionHoldDocument::new(&made.found)),
        /// Alternative squeezes.
        neighbours: Vec<NeighbourDocument> = neighbours.collect(),
        /// Overshoot and back off (a preconditioning squeeze).
        back_off: Option<BackOffDocument> = answer.back_off.as_ref().ok().map(|made| BackOffDocument::new(&made.found)),
        /// The force hold.
        force_held: Option<ForceHoldDocument> =
            answer.force_hold.as_ref().ok().map(|made| ForceHoldDocument::new(&made.found)),
        /// Schedules of regrips.
        schedule: Option<ScheduleDocument> = schedule.map(|made| ScheduleDocument::new(&made.found)),
        /// Grips without a solution, with reasons.
        refused: Vec<RefusedDocument> = refused.collect(),
        /// Extrapolations beyond the calibration range.
        extrapolations: Vec<String> = body.extrapolations().iter().map(ToString::to_string).collect(),
        /// Remarks, in sentences.
        remarks: Vec<String> = body.remarks(),
    }
}
