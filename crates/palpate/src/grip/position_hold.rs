//! How long a squeeze holds.

use std::cell::RefCell;

use super::margin::Margin;
use super::{ALWAYS, Grasp, GripError, Limits, Plan, PlanKind, TimeToSlip, check_confidence};
use crate::calibrate::{Material, Prediction};
use crate::simulate::{Contact, ProgramStep, Sampling, Separation, SimulateError, StepEnd, step_ends, work_by_step};
use crate::statistics::{one_sided_factor, student_probability};
use crate::watch::{Cancelled, Progress, Stages};

/// A calibrated body in a gripper.
///
/// ```
/// use palpate::calibrate::{Body, Candidate, EquilibriumLaw, Material, MaterialParameter, MaterialParts, MaterialUnit, CalibrationRange};
/// use palpate::contact::{Shape, Sides};
/// use palpate::grip::{Grasp, Grip, TimeToSlip, Limits, Plan};
/// use palpate::fit::Estimate;
/// use palpate::simulate::Separation;
///
/// // The paper's ball, its parameters without errors.
/// let parameter = |name: &str, unit, value| MaterialParameter { name: name.to_owned(), unit, estimate: Estimate::fixed(value) };
/// let ball = Material::new(MaterialParts {
///     body: Body { shape: Shape::Ball { radius: 0.035 }, sides: Sides::Two, separation: Separation::Unilateral, levels: vec![] },
///     candidate: Candidate::new("latency".parse()?, EquilibriumLaw::UniformStrain),
///     parameters: vec![
///         parameter("modulus_pa", MaterialUnit::Pascal, 28e3),
///         parameter("exponent", MaterialUnit::One, 5.0),
///         parameter("rate_coefficient_per_s", MaterialUnit::PerSecond, 2e4),
///         parameter("layer_thickness_m", MaterialUnit::Metre, 0.035 / 8.0),
///     ],
///     uncertainty: None,
///     noise: 0.0,
///     range: CalibrationRange { longest_hold: 20.0, longest_force_hold: 0.0, deepest: 0.015, fastest: 0.5 / 60.0, slowest: 0.5 / 60.0, largest_force: 14.3, farthest_retreat: 0.01, loadings: 1 },
/// })?;
/// // 0.25 kg with μ = 0.6 need 2.04 N; 5 mm at 500 mm/min start with 3.04 N and relax to 1.06 N.
/// let grip = Grip::new(&ball, Grasp::new(0.25, 0.6)?, Limits::new(0.5 / 60.0)?, 0.95)?;
/// let holding = grip.position_hold(&Plan::squeeze(0.005, 0.5 / 60.0))?;
/// assert!((holding.needed_force - 2.043_052).abs() < 1e-6 && (holding.start_force - 3.035_025).abs() < 1e-6);
/// let TimeToSlip::After(time) = holding.time_to_slip else { panic!() };
/// assert!((time - 0.610_7).abs() < 1e-3, "{time}"); // s until it slips
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Grip<'a> {
    pub(super) material: &'a Material,
    pub(super) contact: Contact,
    pub(super) grasp: Grasp,
    pub(super) limits: Limits,
    pub(super) confidence: f64,
    /// Probability with which a verdict has to hold; the best estimate decides where there is none.
    pub(super) level: Option<f64>,
    /// Who hears of every simulation.
    pub(super) heard: Option<&'a RefCell<Stages<'a>>>,
}

/// What becomes of a plan whose end is held in displacement; SI units.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PositionHold {
    /// The plan.
    pub plan: Plan,
    /// How long it takes to close, s.
    pub closing: f64,
    /// Displacement of the jaw in the hold, m.
    pub displacement: f64,
    /// Force that is needed there, N.
    pub needed_force: f64,
    /// Force at the start of the hold, N.
    pub start_force: f64,
    /// The largest force, N.
    pub peak_force: f64,
    /// The force that the hold tends to, N.
    pub equilibrium_force: f64,
    /// Work that the jaws do while they close, J; what the body gives back is not counted against it.
    pub work: f64,
    /// From the start of the hold until it slips.
    pub time_to_slip: TimeToSlip,
    /// Ends of the interval of that time by what the calibration leaves open; `None` where it says nothing.
    pub interval: Option<(TimeToSlip, TimeToSlip)>,
    /// The time that is reached with the probability which a verdict has to have ([`Question::confidence`](super::Question)); `None` without one, and
    /// where the calibration says nothing.
    pub assured: Option<TimeToSlip>,
    /// How sharply the time depends on the squeeze, d ln(time)/d(displacement), 1/m; `None` where it is no plain squeeze, or slips at once or never.
    pub sharpness: Option<f64>,
}

impl PositionHold {
    /// Whether no time is assured, though the best estimate is above 0; without a level, whether the interval starts at 0.
    #[must_use]
    pub fn may_slip_at_once(&self) -> bool {
        self.time_to_slip != TimeToSlip::After(0.0)
            && self.assured.or(self.interval.map(|(low, _)| low)) == Some(TimeToSlip::After(0.0))
    }
}

impl<'a> Grip<'a> {
    /// A body, its load and the gripper.
    ///
    /// # Errors
    /// [`GripError::Number`] for parameters that describe none, a confidence outside 0…1 among them; [`GripError::Bonded`].
    pub fn new(material: &'a Material, grasp: Grasp, limits: Limits, confidence: f64) -> Result<Self, GripError> {
        grasp.check()?;
        limits.check()?;
        check_confidence(confidence)?;
        if material.body().separation == Separation::Bonded {
            return Err(GripError::Bonded);
        }
        Ok(Self {
            material,
            contact: material.contact().clone(),
            grasp,
            limits,
            confidence,
            level: None,
            heard: None,
        })
    }

    /// The body.
    #[must_use]
    pub fn material(&self) -> &Material {
        self.material
    }

    /// Coverage of the intervals.
    #[must_use]
    pub fn confidence(&self) -> f64 {
        self.confidence
    }

    /// The load.
    #[must_use]
    pub fn grasp(&self) -> &Grasp {
        &self.grasp
    }

    /// The gripper.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Force (N) that is needed while the jaw is at a displacement (m).
    #[must_use]
    pub fn needed_force(&self, displacement: f64) -> f64 {
        let body = self.contact.specimen();
        self.grasp.needed_force(body, body.contact_displacement(displacement))
    }

    /// Force (N) of the relaxed body at a displacement (m) of the jaw.
    #[must_use]
    pub fn equilibrium_force(&self, displacement: f64) -> f64 {
        let body = self.contact.specimen();
        body.equilibrium_force(body.contact_displacement(displacement))
    }

    /// What becomes of a plan once its end is held in displacement.
    ///
    /// The body is simulated along the plan; it slips when the force falls below the one that is needed. The interval of that time is where the edges
    /// of the band of the predicted force do so ([`Material::predict`]).
    ///
    /// # Errors
    /// [`GripError::BeyondLimit`] for a plan that the gripper may not take, [`GripError::Simulate`] for one that cannot be simulated.
    pub fn position_hold(&self, plan: &Plan) -> Result<PositionHold, GripError> {
        self.check_reach(plan.farthest())?;
        let ends = self.ends(&plan.steps)?;
        let (Some(end), peak_force) = (ends.last(), peak(&ends)) else {
            return Err(SimulateError::EmptyProgram.into());
        };
        self.within_limits(&ends)?;
        let needed_force = self.needed_force(end.displacement);
        let time_to_slip = self.time_to_slip(plan)?;
        let (interval, assured) = match self.material.uncertainty() {
            Some(_) => self.slips(plan, end, needed_force)?,
            None => (None, None),
        };
        Ok(PositionHold {
            closing: end.time,
            displacement: end.displacement,
            needed_force,
            start_force: end.force,
            peak_force,
            equilibrium_force: self.equilibrium_force(end.displacement),
            work: self.work(&plan.steps)?,
            time_to_slip,
            interval,
            assured,
            sharpness: self.sharpness(plan, time_to_slip),
            plan: plan.clone(),
        })
    }

    /// The course of the force over a plan and a hold of `duration` (s), with its band: `samples` times over the squeeze and as many over the hold.
    ///
    /// # Errors
    /// [`GripError::Simulate`] for a plan that cannot be simulated.
    pub fn course(&self, plan: &Plan, duration: f64, samples: usize) -> Result<Prediction, GripError> {
        self.course_of(&plan.held(duration), samples)
    }

    /// The course over any program.
    pub(super) fn course_of(&self, steps: &[ProgramStep], samples: usize) -> Result<Prediction, GripError> {
        let ends = self.ends(steps)?;
        let (mut times, mut from) = (vec![0.0], 0.0);
        for end in &ends {
            // Denser where a step begins: that is where the force changes fastest.
            let share = |i: usize| (i as f64 / samples as f64).powi(3);
            times.extend((1..=samples).map(|i| from + (end.time - from) * share(i)).filter(|time| *time > from));
            from = end.time;
        }
        times.dedup();
        Ok(self.predict(steps, times)?)
    }

    /// How long squeezes to other displacements (m) at the same speed (m/s) hold; those that cannot be made are left out.
    #[must_use]
    pub fn neighbours(&self, displacements: &[f64], speed: f64) -> Vec<(f64, TimeToSlip)> {
        let lasts =
            |displacement: &f64| Some((*displacement, self.time_to_slip(&Plan::squeeze(*displacement, speed)).ok()?));
        displacements.iter().filter_map(lasts).collect()
    }

    /// Tells who watches that work goes on.
    pub(super) fn hear(&self) -> Result<(), Cancelled> {
        self.heard.map_or(Ok(()), |stages| stages.borrow_mut().hear())
    }

    /// The course over a program at some times (s), with its band.
    pub(super) fn predict(&self, steps: &[ProgramStep], times: Vec<f64>) -> Result<Prediction, SimulateError> {
        let watch = &mut |_: Progress<'_>| self.hear();
        self.material.predict_watched(steps, &Sampling::Times(times), self.confidence, watch)
    }

    /// Where the steps of a program end.
    pub(super) fn ends(&self, steps: &[ProgramStep]) -> Result<Vec<StepEnd>, SimulateError> {
        self.hear()?;
        step_ends(steps, &self.contact)
    }

    /// Work that the jaws do over a program, J.
    pub(super) fn work(&self, steps: &[ProgramStep]) -> Result<f64, SimulateError> {
        Ok(work_by_step(steps, &self.contact)?.iter().map(|step| step.work + step.given_back).sum())
    }

    /// Refuses a squeeze (m) beyond the stroke or the body.
    pub(super) fn check_reach(&self, displacement: f64) -> Result<(), GripError> {
        let (deepest, _) = self.limits.deepest(self.contact.specimen());
        if displacement > deepest { Err(beyond("squeeze", displacement, deepest, " m")) } else { Ok(()) }
    }

    /// Refuses a time (s) to close beyond the limit.
    pub(super) fn check_closing(&self, time: f64) -> Result<(), GripError> {
        let limit = self.limits.closing.filter(|closing| time > closing * (1.0 + 1e-9));
        limit.map_or(Ok(()), |limit| Err(beyond("time to close", time, limit, " s")))
    }

    fn within_limits(&self, ends: &[StepEnd]) -> Result<(), GripError> {
        self.check_reach(ends.iter().map(|end| end.displacement).fold(0.0, f64::max))?;
        self.check_closing(ends.last().map_or(0.0, |end| end.time))?;
        let peak = peak(ends);
        match self.limits.force {
            Some(force) if peak > force * (1.0 + 1e-9) => Err(beyond("force", peak, force, " N")),
            _ => Ok(()),
        }
    }

    /// From the start of the hold until a plan slips, with the best parameters.
    fn time_to_slip(&self, plan: &Plan) -> Result<TimeToSlip, GripError> {
        let ends = self.ends(&plan.steps)?;
        let end = ends.last().ok_or(SimulateError::EmptyProgram)?;
        let needed = self.needed_force(end.displacement);
        let mut surplus = |times: &[f64]| -> Result<Vec<f64>, GripError> {
            times.iter().map(|time| Ok(self.force_after(plan, *time)? - needed)).collect()
        };
        crossing(&mut surplus)
    }

    fn force_after(&self, plan: &Plan, time: f64) -> Result<f64, SimulateError> {
        Ok(self.ends(&plan.held(time))?.last().map_or(0.0, |end| end.force))
    }

    /// Where the band of the force falls below the needed one: both its edges, and the bound of the level on one side.
    fn slips(&self, plan: &Plan, end: &StepEnd, needed: f64) -> Result<BandSlips, GripError> {
        let program = plan.held(ALWAYS);
        let edge = |bound: &dyn Fn(&Prediction, usize) -> Option<f64>| {
            let mut surplus = |times: &[f64]| -> Result<Vec<f64>, GripError> {
                let at = times.iter().map(|time| end.time + time).collect();
                let predicted = self.predict(&program, at)?;
                let forces = predicted.trajectory.force.iter().enumerate();
                Ok(forces.map(|(i, force)| bound(&predicted, i).unwrap_or(*force) - needed).collect())
            };
            crossing(&mut surplus)
        };
        let [below, above] = [
            edge(&|predicted, i| Some(predicted.force_interval(i)?.0))?,
            edge(&|predicted, i| Some(predicted.force_interval(i)?.1))?,
        ];
        let of_level = |level: f64| {
            let factor = one_sided_factor(level, self.freedom());
            edge(&|predicted, i| Some(Margin::of(predicted, i)?.least(factor)))
        };
        let assured = self.level.map(of_level).transpose()?;
        // Where standard errors reach farther than the band, what is assured with less certainty than the band has may end sooner.
        let is_less_certain = self.level.is_some_and(|level| 1.0 - level >= 0.5 * (1.0 - self.confidence));
        let soonest = assured.filter(|assured| is_less_certain && *assured < below);
        Ok((Some((soonest.unwrap_or(below), above)), assured))
    }

    /// Degrees of freedom of the calibration.
    pub(super) fn freedom(&self) -> f64 {
        self.material.uncertainty().map_or(f64::INFINITY, |uncertainty| uncertainty.freedom)
    }

    /// The probability that a plan still holds after `duration` (s): the least over the hold of that of the needed force or more, for parameters as
    /// uncertain as the calibration left them. `None` where it says nothing.
    ///
    /// # Errors
    /// [`GripError::Simulate`] for a plan that cannot be simulated.
    pub fn probability(&self, plan: &Plan, duration: f64) -> Result<Option<f64>, GripError> {
        if self.material.uncertainty().is_none() {
            return Ok(None);
        }
        let (margins, needed) = self.margins(plan, duration)?;
        let least = margins.iter().map(|margin| margin.deviations_above(needed)).fold(f64::INFINITY, f64::min);
        Ok(Some(student_probability(least, self.freedom())))
    }

    /// The force of a plan while it is held for `duration` (s), and the one that is needed then, N; none where the calibration says nothing.
    pub(super) fn margins(&self, plan: &Plan, duration: f64) -> Result<(Vec<Margin>, f64), GripError> {
        let ends = self.ends(&plan.steps)?;
        let end = ends.last().ok_or(SimulateError::EmptyProgram)?;
        let duration = duration.min(ALWAYS);
        let times = times_of_hold().take_while(|time| *time < duration).chain([duration]);
        let predicted = self.predict(&plan.held(ALWAYS), times.map(|time| end.time + time).collect())?;
        let margins = (0..predicted.trajectory.force.len()).filter_map(|i| Margin::of(&predicted, i)).collect();
        Ok((margins, self.needed_force(end.displacement)))
    }

    /// The probability that something is above 0 which is estimated with this standard error.
    pub(super) fn probability_of(&self, estimate: f64, error: f64) -> f64 {
        if error > 0.0 {
            student_probability(estimate / error, self.freedom())
        } else {
            f64::from(u8::from(estimate >= 0.0))
        }
    }

    fn sharpness(&self, plan: &Plan, lasts: TimeToSlip) -> Option<f64> {
        /// Share of the squeeze to either side.
        const STEP: f64 = 2e-3;
        let PlanKind::Squeeze { displacement, speed } = plan.kind else {
            return None;
        };
        lasts.seconds().filter(|time| *time > 0.0)?;
        let log = |by: f64| {
            let time = self.time_to_slip(&Plan::squeeze(displacement * (1.0 + by), speed)).ok()?.seconds()?;
            (time > 0.0).then(|| time.ln())
        };
        Some((log(STEP)? - log(-STEP)?) / (2.0 * STEP * displacement))
    }
}

/// Ends of the interval of the time to slip, and the time that is assured.
type BandSlips = (Option<(TimeToSlip, TimeToSlip)>, Option<TimeToSlip>);

pub(super) fn beyond(name: &'static str, found: f64, limit: f64, unit: &'static str) -> GripError {
    GripError::BeyondLimit {
        name,
        found,
        limit,
        unit,
    }
}

/// The largest force at the ends of steps, between which it rises or falls only.
pub(super) fn peak(ends: &[StepEnd]) -> f64 {
    ends.iter().map(|end| end.force).fold(0.0, f64::max)
}

/// Times since the start of a hold between which a force may fall below another: 0, the same number of times in each decade, and the longest.
fn times_of_hold() -> impl Iterator<Item = f64> {
    const PER_DECADE: i32 = 8;
    const FIRST: i32 = -4;
    let decades = ALWAYS.log10() - f64::from(FIRST);
    let count = (decades * f64::from(PER_DECADE)).ceil() as i32;
    let rising = (0..count).map(|i| 10f64.powf(f64::from(FIRST) + f64::from(i) / f64::from(PER_DECADE)));
    std::iter::once(0.0).chain(rising).chain([ALWAYS])
}

/// The first time since the start of a hold at which a surplus of force falls below 0.
fn crossing(surplus: &mut impl FnMut(&[f64]) -> Result<Vec<f64>, GripError>) -> Result<TimeToSlip, GripError> {
    let times: Vec<f64> = times_of_hold().collect();
    let values = surplus(&times)?;
    let Some(short) = values.iter().position(|value| *value < 0.0) else {
        return Ok(TimeToSlip::Never);
    };
    if short == 0 {
        return Ok(TimeToSlip::After(0.0));
    }
    let (mut holds, mut slips) = (times[short - 1], times[short]);
    for _ in 0..60 {
        let middle = if holds == 0.0 { 0.5 * slips } else { (holds * slips).sqrt() };
        if !(middle > holds && middle < slips) {
            break;
        }
        if surplus(&[middle])?[0] < 0.0 {
            slips = middle;
        } else {
            holds = middle;
        }
    }
    Ok(TimeToSlip::After(holds))
}
