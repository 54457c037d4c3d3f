//! Squeeze over and go back: a hold that begins relaxed.

use serde::{Deserialize, Serialize};

use super::margin::Margin;
use super::{ALWAYS, Grip, GripError, Plan, PositionHold, bisected, check_duration};
use crate::number::significant;
use crate::simulate::step_ends;
use crate::statistics::one_sided_factor;

/// What a parameter of the material does to a squeeze that is to begin relaxed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Sensitivity {
    /// Name of the parameter.
    pub name: String,
    /// Its relative standard deviation, for residuals that correlate as they do; `None` where it has none.
    pub error: Option<f64>,
    /// By how much the force at the start of the hold misses the relaxed one (N) if the parameter is 1 % larger and the jaw moves as planned.
    pub missed: f64,
    /// By how much farther (m) the jaw would have to go if the parameter were 1 % larger.
    pub over: f64,
}

/// A squeeze with a retreat beside the plain one to the same place.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BackOff {
    /// The retreat.
    pub backed: PositionHold,
    /// The plain squeeze.
    pub plain: PositionHold,
    /// How far the jaw goes before it turns, m.
    pub over: f64,
    /// Time over which drifts are given, s.
    pub duration: f64,
    /// Change of the force over that time after the retreat, N.
    pub drift: f64,
    /// The same after the plain squeeze, N.
    pub plain_drift: f64,
    /// What the parameters of the material do to it.
    pub sensitivities: Vec<Sensitivity>,
}

impl Grip<'_> {
    /// Squeezes over and goes back to `displacement` (m) at the speed of the gripper, so that the hold begins with no excess strain: the force at its
    /// start is the relaxed one and stays. Without a displacement it is the least whose equilibrium force is enough; with a `confidence` the
    /// least at which the lower end of the interval of the force of that level is, at the start of the hold and after `duration`.
    ///
    /// The turning point is found to the last bits as the one from which the force at the end of the retreat is F_e: farther, and it rises
    /// during the hold; nearer, and it falls. `duration` (s) is the time over which drifts are given. A linear law of several terms has
    /// one excess a term; their sum is zero then, and a small drift is left.
    ///
    /// # Errors
    /// [`GripError::NoSqueeze`] if no equilibrium force within the limits is enough; [`GripError::NoBackOff`] if they end before the turning point;
    /// [`GripError::BeyondLimit`] for a displacement beyond them.
    pub fn back_off(
        &self,
        displacement: Option<f64>,
        duration: f64,
        confidence: Option<f64>,
    ) -> Result<BackOff, GripError> {
        check_duration(duration)?;
        self.at(confidence)?.back_off_by(displacement, duration)
    }

    /// The same by the level of the grip, or by the best estimate where it has none.
    fn back_off_by(&self, displacement: Option<f64>, duration: f64) -> Result<BackOff, GripError> {
        let (deepest, by) = self.limits.deepest(self.contact.specimen());
        let displacement = match (displacement, self.level) {
            (Some(displacement), _) => displacement,
            (None, Some(level)) => self.assured_squeeze(self.relaxed_squeeze(deepest, by)?, duration, level)?,
            (None, None) => self.relaxed_squeeze(deepest, by)?,
        };
        let speed = self.limits.speed;
        let plain = self.position_hold(&Plan::squeeze(displacement, speed))?;
        let over = self.turning_point(displacement)?;
        let plan = Plan::back_off(over, displacement, speed);
        let drift = |plan: &Plan| -> Result<f64, GripError> {
            let ends = self.ends(&plan.held(duration))?;
            Ok(ends[ends.len() - 1].force - ends[ends.len() - 2].force)
        };
        Ok(BackOff {
            drift: drift(&plan)?,
            plain_drift: drift(&plain.plan)?,
            sensitivities: self.sensitivities(displacement, over),
            backed: self.position_hold(&plan)?,
            plain,
            over,
            duration,
        })
    }

    /// The least displacement whose equilibrium force is enough, m.
    fn relaxed_squeeze(&self, deepest: f64, by: String) -> Result<f64, GripError> {
        let is_enough = |d: f64| self.equilibrium_force(d) >= self.needed_force(d);
        if !is_enough(deepest) {
            return Err(self.no_squeeze(self.equilibrium_force(deepest), f64::INFINITY, by));
        }
        // A hair more, for rounding in the force at the end of the retreat.
        Ok((bisected(0.0, deepest, |d| Ok(is_enough(d)))?.1 * (1.0 + 1e-9)).min(deepest))
    }

    /// The least displacement from `least` (m) on at which the force is enough with a probability of `level` all through the hold.
    fn assured_squeeze(&self, least: f64, duration: f64, level: f64) -> Result<f64, GripError> {
        /// By how much a squeeze is larger than the one tried before.
        const MORE: f64 = 1.02;
        /// To which the least is found, as a share.
        const CLOSE: f64 = 1e-6;
        // What the parameters leave of an excess fades, and the band with it: between its ends it is no lower than there.
        let factor = one_sided_factor(level, self.freedom());
        let is_enough = |displacement: f64| -> Result<bool, GripError> {
            let plan = Plan::back_off(self.turning_point(displacement)?, displacement, self.limits.speed);
            let start = self.ends(&plan.steps)?.last().map_or(0.0, |end| end.time);
            let at = vec![start, start + duration.min(ALWAYS)];
            let predicted = self.predict(&plan.held(duration.min(ALWAYS)), at)?;
            let needed = self.needed_force(displacement);
            let is_enough = |i: usize| Margin::of(&predicted, i).is_some_and(|margin| margin.least(factor) >= needed);
            Ok((0..predicted.trajectory.force.len()).all(is_enough))
        };
        let (mut short, mut enough) = (least, least);
        // The limits end it: there is no turning point beyond them.
        while !is_enough(enough)? {
            short = enough;
            enough *= MORE;
        }
        while enough - short > CLOSE * enough {
            let middle = 0.5 * (short + enough);
            if is_enough(middle)? { enough = middle } else { short = middle }
        }
        Ok(enough)
    }

    /// Where the jaw turns so that the hold begins relaxed, m.
    fn turning_point(&self, displacement: f64) -> Result<f64, GripError> {
        let (mut farthest, mut by) = self.limits.deepest(self.contact.specimen());
        if let Some(closing) = self.limits.closing {
            // There and back.
            let in_time = 0.5 * (self.limits.speed * closing + displacement);
            if in_time < farthest {
                farthest = in_time;
                by = format!("closed within {} s", significant(closing, 3));
            }
        }
        if let Some(limit) = self.limits.force {
            let is_over = |d: f64| Ok(self.force_of(d, d, None) > limit);
            if is_over(farthest)? {
                farthest = bisected(displacement, farthest, is_over)?.0;
                by = format!("largest force of {} N", significant(limit, 4));
            }
        }
        self.turned(displacement, farthest, None).ok_or(GripError::NoBackOff {
            displacement,
            limit: farthest,
            by,
        })
    }

    /// The same with other factors of the parameters.
    fn turned(&self, displacement: f64, farthest: f64, factors: Option<&[f64]>) -> Option<f64> {
        let relaxed = self.relaxed_with(displacement, factors)?;
        let is_low = |over: f64| Ok(self.force_of(over, displacement, factors) <= relaxed);
        if farthest < displacement || !is_low(farthest).ok()? {
            return None;
        }
        bisected(displacement, farthest, is_low).ok().map(|(_, over)| over)
    }

    /// Force at the end of a retreat, N; infinite where it cannot be simulated, so that it counts as too high.
    fn force_of(&self, over: f64, displacement: f64, factors: Option<&[f64]>) -> f64 {
        let steps = Plan::back_off(over, displacement, self.limits.speed).steps;
        let ends = match factors.map(|factors| self.material.contact_off(factors)) {
            None => self.ends(&steps),
            Some(Some(contact)) => step_ends(&steps, &contact),
            Some(None) => return f64::INFINITY,
        };
        ends.ok().and_then(|ends| ends.last().map(|end| end.force)).unwrap_or(f64::INFINITY)
    }

    fn relaxed_with(&self, displacement: f64, factors: Option<&[f64]>) -> Option<f64> {
        let Some(factors) = factors else {
            return Some(self.equilibrium_force(displacement));
        };
        let contact = self.material.contact_off(factors)?;
        let body = contact.specimen();
        Some(body.equilibrium_force(body.contact_displacement(displacement)))
    }

    /// Central differences, a thousandth to either side, reported per hundredth.
    fn sensitivities(&self, displacement: f64, over: f64) -> Vec<Sensitivity> {
        const STEP: f64 = 1e-3;
        let (deepest, _) = self.limits.deepest(self.contact.specimen());
        let parameters = self.material.parameters();
        let of = |index: usize| -> Option<Sensitivity> {
            let factors = |by: f64| -> Vec<f64> {
                (0..parameters.len()).map(|i| if i == index { 1.0 + by } else { 1.0 }).collect()
            };
            let missed = |by: f64| -> Option<f64> {
                let factors = factors(by);
                Some(
                    self.force_of(over, displacement, Some(&factors))
                        - self.relaxed_with(displacement, Some(&factors))?,
                )
            };
            let turned = |by: f64| self.turned(displacement, deepest, Some(&factors(by)));
            let per_cent = |high: f64, low: f64| (high - low) / (2.0 * STEP) / 100.0;
            let parameter = &parameters[index];
            let variance = self.material.uncertainty().map(|uncertainty| uncertainty.covariance[index][index]);
            let error = variance.map(f64::sqrt).filter(|_| parameter.estimate.standard_error.is_some());
            Some(Sensitivity {
                name: parameter.name.clone(),
                error,
                missed: per_cent(missed(STEP)?, missed(-STEP)?),
                over: per_cent(turned(STEP)?, turned(-STEP)?),
            })
        };
        (0..parameters.len())
            .filter_map(of)
            .filter(|found| found.missed.is_finite() && found.over.is_finite())
            .collect()
    }
}
