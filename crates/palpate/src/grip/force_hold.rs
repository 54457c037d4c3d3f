//! The same grasp with the force held.

use super::{Grip, GripError, Plan, beyond, bisected, check, check_duration};
use crate::calibrate::Prediction;
use crate::number::significant;
use crate::simulate::{ProgramStep, SimulateError};

/// A grasp whose force is held: it does not relax, the body creeps.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ForceHold {
    /// The steps, its hold among them.
    pub steps: Vec<ProgramStep>,
    /// Force that is held, N.
    pub force: f64,
    /// How long, s.
    pub duration: f64,
    /// Force that is needed when the hold begins, N; creep makes contacts wider and this no larger.
    pub needed_force: f64,
    /// How long closing takes, s.
    pub closing: f64,
    /// Displacement of the jaw when the hold begins, m.
    pub displacement_start: f64,
    /// Displacement when it ends, or where the stroke does, m.
    pub displacement_end: f64,
    /// Displacement that it tends to, m; `None` if no displacement of the body carries the force relaxed.
    pub displacement_relaxed: Option<f64>,
    /// Whether the force is enough.
    pub holds: bool,
    /// When the jaws come to the end of their stroke, s since the hold began; `None` if they do not.
    pub stroke_ends: Option<f64>,
    /// Work done by the jaws over all of it, J.
    pub work: f64,
}

impl Grip<'_> {
    /// Holds a force (N; the least that is enough if not given) for `duration` (s).
    ///
    /// # Errors
    /// [`GripError::NoSqueeze`] if no force within the limits is enough, [`GripError::BeyondLimit`] for a force beyond them.
    pub fn force_hold(&self, force: Option<f64>, duration: f64) -> Result<ForceHold, GripError> {
        check_duration(duration)?;
        check("time to hold", duration, " s", "finite where the force is held", duration.is_finite())?;
        let force = match force {
            Some(force) => force,
            None => self.least_force()?,
        };
        if let Some(limit) = self.limits.force.filter(|limit| force > *limit) {
            return Err(beyond("force", force, limit, " N"));
        }
        let steps = vec![
            ProgramStep::MoveToForce {
                force,
                rate: self.limits.speed,
            },
            ProgramStep::HoldForce { duration },
        ];
        let ends = self.ends(&steps).map_err(|error| self.not_carried(force, error))?;
        let (start, end) = (ends[0], ends[1]);
        let (deepest, _) = self.limits.deepest(self.contact.specimen());
        self.check_reach(start.displacement)?;
        self.check_closing(start.time)?;
        let needed_force = self.needed_force(start.displacement);
        let until = |time: f64| -> Result<f64, GripError> {
            let held = [steps[0], ProgramStep::HoldForce { duration: time }];
            Ok(self.ends(&held)?[1].displacement)
        };
        let stroke_ends = if end.displacement > deepest {
            Some(bisected(0.0, duration, |time| Ok(until(time)? > deepest))?.0)
        } else {
            None
        };
        Ok(ForceHold {
            force,
            duration,
            needed_force,
            closing: start.time,
            displacement_start: start.displacement,
            displacement_end: end.displacement.min(deepest),
            displacement_relaxed: self.relaxed_under(force),
            // A force that was found to be enough is so to rounding.
            holds: force >= needed_force * (1.0 - 1e-12),
            stroke_ends,
            work: self.work(&steps)?,
            steps,
        })
    }

    /// Its course, with bands.
    ///
    /// # Errors
    /// [`GripError::Simulate`].
    pub fn force_hold_course(&self, pressed: &ForceHold, samples: usize) -> Result<Prediction, GripError> {
        self.course_of(&pressed.steps, samples)
    }

    /// The probability that a held force does not slip, and that its creep stays within the stroke; `None` where the calibration says nothing.
    pub(super) fn force_hold_probability(&self, pressed: &ForceHold) -> Result<Option<f64>, GripError> {
        if self.material.uncertainty().is_none() {
            return Ok(None);
        }
        if !pressed.holds {
            return Ok(Some(0.0));
        }
        let (deepest, _) = self.limits.deepest(self.contact.specimen());
        let ends = self.ends(&pressed.steps)?;
        let end = ends.last().copied().unwrap_or_default();
        let errors = self.predict(&pressed.steps, vec![end.time])?.displacement_standard_error;
        Ok(errors.map(|errors| self.probability_of(deepest - end.displacement, errors[0])))
    }

    /// The least force that carries the load as soon as it is reached.
    fn least_force(&self) -> Result<f64, GripError> {
        let (deepest, mut by) = self.limits.reach(self.contact.specimen());
        let mut most = self.ends(&Plan::squeeze(deepest, self.limits.speed).steps)?.last().map_or(0.0, |end| end.force);
        if let Some(limit) = self.limits.force.filter(|limit| *limit < most) {
            most = limit;
            by = format!("largest force of {} N", significant(limit, 4));
        }
        let least = self.needed_force(deepest);
        // Where the jaw stops when it has met a force; as far as it gets where rounding lets it meet none.
        let is_enough = |force: f64| -> Result<bool, GripError> {
            let step = ProgramStep::MoveToForce {
                force,
                rate: self.limits.speed,
            };
            let met = self.ends(&[step]).ok().and_then(|ends| Some(ends.last()?.displacement));
            Ok(force >= self.needed_force(met.unwrap_or(deepest)))
        };
        if most < least || !is_enough(most)? {
            return Err(GripError::NoSqueeze {
                needed: least,
                reached: most,
                duration: 0.0,
                by,
            });
        }
        if is_enough(least)? { Ok(least) } else { Ok(bisected(least, most, is_enough)?.1) }
    }

    /// Why a force is not met, or not carried by a body that creeps, in words of the grip.
    pub(super) fn not_carried(&self, force: f64, error: SimulateError) -> GripError {
        match error {
            SimulateError::Unreachable { most, .. } => beyond("force", force, most, " N"),
            SimulateError::Force { .. } => {
                let (deepest, _) = self.limits.deepest(self.contact.specimen());
                beyond("force", force, self.equilibrium_force(deepest), " N")
            }
            other => other.into(),
        }
    }

    fn relaxed_under(&self, force: f64) -> Option<f64> {
        let body = self.contact.specimen();
        let end = body.limit();
        let through = if end.included { end.at } else { end.at * (1.0 - 1e-9) } / body.contact_displacement(1.0);
        (self.equilibrium_force(through) >= force)
            .then(|| bisected(0.0, through, |d| Ok(self.equilibrium_force(d) >= force)).ok())
            .flatten()
            .map(|found| found.1)
    }
}
