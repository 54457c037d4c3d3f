//! The least squeeze that holds long enough.

use serde::{Deserialize, Serialize};

use super::{ALWAYS, Grip, GripError, Plan, PositionHold, check, check_confidence, peak};
use crate::number::significant;
use crate::statistics::one_sided_factor;

/// What a plan should have least of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// Displacement of the jaw.
    #[default]
    Squeeze,
    /// The largest force: do not bruise.
    PeakForce,
    /// Work done by the jaws.
    Work,
}

/// Closing times that are tried, over the one that is allowed: from a hundredth of it.
const TRIED: i32 = 12;

impl Grip<'_> {
    /// The plan with the least of something that holds for `duration` (s; infinite for always) within the limits.
    ///
    /// Tried are squeezes at one speed, for which any closing time within the limits may serve, and a force that is kept while the body creeps until
    /// the time to close is over. For each the least displacement or force is found, at which the force at the end of the hold is the one that
    /// is needed; with a `confidence`, at which it is with that probability.
    ///
    /// # Errors
    /// [`GripError::NoSqueeze`] if none holds, [`GripError::NoIntervals`] for a confidence where there are none, [`GripError::Number`] for a duration that is not above zero.
    pub fn least(
        &self,
        objective: Objective,
        duration: f64,
        confidence: Option<f64>,
    ) -> Result<PositionHold, GripError> {
        check_duration(duration)?;
        self.at(confidence)?.least_by(objective, duration)
    }

    /// The same by the level of the grip, or by the best estimate where it has none.
    fn least_by(&self, objective: Objective, duration: f64) -> Result<PositionHold, GripError> {
        let closing = |i: f64| self.limits.slowest_closing() * 10f64.powf(2.0 * (i / f64::from(TRIED - 1) - 1.0));
        let mut best: Option<(f64, f64, Plan)> = None;
        let mut none = None;
        for i in 0..TRIED {
            match self.squeeze_within(closing(f64::from(i)), duration) {
                Ok(plan) => {
                    let cost = self.cost(objective, &plan)?;
                    if best.as_ref().is_none_or(|best| cost < best.0) {
                        best = Some((cost, f64::from(i), plan));
                    }
                }
                Err(error) => none = Some(error),
            }
        }
        if let Some((cost, at, plan)) = &mut best {
            // Golden sections between the neighbours of the best.
            let (mut low, mut high) = ((*at - 1.0).max(0.0), (*at + 1.0).min(f64::from(TRIED - 1)));
            for _ in 0..24 {
                let (left, right) = (high - 0.618_034 * (high - low), low + 0.618_034 * (high - low));
                let mut tried = |i: f64| -> Result<f64, GripError> {
                    let Ok(found) = self.squeeze_within(closing(i), duration) else {
                        return Ok(f64::INFINITY);
                    };
                    let found_cost = self.cost(objective, &found)?;
                    if found_cost < *cost {
                        (*cost, *plan) = (found_cost, found);
                    }
                    Ok(found_cost)
                };
                if tried(left)? <= tried(right)? { high = right } else { low = left }
            }
        }
        if let Some(settled) = self.settled(duration)? {
            let cost = self.cost(objective, &settled)?;
            if best.as_ref().is_none_or(|best| cost < best.0) {
                best = Some((cost, 0.0, settled));
            }
        }
        match (best, none) {
            (Some((_, _, plan)), _) => self.position_hold(&plan),
            (None, Some(error)) => Err(error),
            (None, None) => Err(self.no_squeeze(0.0, duration, "nothing was tried".to_owned())),
        }
    }

    fn cost(&self, objective: Objective, plan: &Plan) -> Result<f64, GripError> {
        let ends = self.ends(&plan.steps)?;
        Ok(match objective {
            Objective::Squeeze => ends.iter().map(|end| end.displacement).fold(0.0, f64::max),
            Objective::PeakForce => peak(&ends),
            Objective::Work => self.work(&plan.steps)?,
        })
    }

    /// The least squeeze that closes within a time (s).
    fn squeeze_within(&self, closing: f64, duration: f64) -> Result<Plan, GripError> {
        let plan = |displacement: f64| Plan::squeeze(displacement, (displacement / closing).min(self.limits.speed));
        let (mut high, mut by) = self.limits.reach(self.contact.specimen());
        if let Some(limit) = self.limits.force {
            let is_allowed = |displacement: f64| -> Result<bool, GripError> {
                Ok(peak(&self.ends(&plan(displacement).steps)?) <= limit)
            };
            if !is_allowed(high)? {
                high = bisected(0.0, high, |d| Ok(!is_allowed(d)?))?.0;
                by = format!("largest force of {} N", significant(limit, 4));
            }
        }
        if high <= 0.0 {
            return Err(self.no_squeeze(0.0, duration, by));
        }
        let surplus = |displacement: f64| self.surplus(&plan(displacement), duration);
        if surplus(high)? < 0.0 {
            let reached = surplus(high)? + self.needed_force(high);
            return Err(self.no_squeeze(reached, duration, by));
        }
        Ok(plan(bisected(0.0, high, |d| Ok(surplus(d)? >= 0.0))?.1))
    }

    /// The least force that, kept until the time to close is over, holds from there; `None` if the limits have none.
    fn settled(&self, duration: f64) -> Result<Option<Plan>, GripError> {
        let (deepest, _) = self.limits.deepest(self.contact.specimen());
        // What cannot be simulated, since no displacement carries it, is beyond the limits as well.
        let plan = |force: f64| -> Option<Plan> {
            let ends = self.ends(&Plan::settle(force, self.limits.speed, 0.0).steps).ok()?;
            let settling = self.limits.slowest_closing() - ends.last()?.time;
            let plan = Plan::settle(force, self.limits.speed, settling.max(0.0));
            let end = *self.ends(&plan.steps).ok()?.last()?;
            (settling >= 0.0 && end.displacement <= deepest && self.limits.force.is_none_or(|limit| force <= limit))
                .then_some(plan)
        };
        let holds = |plan: &Plan| -> Result<bool, GripError> { Ok(self.surplus(plan, duration)? >= 0.0) };
        let mut low = self.needed_force(deepest);
        let mut high = low;
        loop {
            let Some(there) = plan(high) else { return Ok(None) };
            if holds(&there)? {
                break;
            }
            low = high;
            high *= 1.1;
        }
        let found = bisected(low, high, |force| match plan(force) {
            Some(there) => holds(&there),
            None => Ok(true),
        })?;
        Ok(plan(found.1))
    }

    /// Force at the end of a hold less the one that is needed there, N; with a level the least of its bounds over the hold.
    fn surplus(&self, plan: &Plan, duration: f64) -> Result<f64, GripError> {
        if let Some(level) = self.level {
            let factor = one_sided_factor(level, self.freedom());
            let (margins, needed) = self.margins(plan, duration)?;
            let least = margins.iter().map(|margin| margin.least(factor)).reduce(f64::min);
            return Ok(least.unwrap_or(f64::NEG_INFINITY) - needed);
        }
        let ends = self.ends(&plan.held(duration.min(ALWAYS)))?;
        let end = ends.last().copied().unwrap_or_default();
        Ok(end.force - self.needed_force(end.displacement))
    }

    /// The least squeeze (m) from `least` on, at the speed of the gripper, that holds for `duration` (s) with the probability which the verdict has to
    /// have; `None` if none within the limits does.
    pub(super) fn assured_from(&self, least: f64, duration: f64) -> Result<Option<f64>, GripError> {
        let (deepest, _) = self.limits.reach(self.contact.specimen());
        let plan = |displacement: f64| Plan::squeeze(displacement, self.limits.speed);
        let holds =
            |displacement: f64| -> Result<bool, GripError> { Ok(self.surplus(&plan(displacement), duration)? >= 0.0) };
        if least >= deepest || !holds(deepest)? {
            return Ok(None);
        }
        let found = bisected(least, deepest, holds)?.1;
        let is_allowed = match self.limits.force {
            Some(limit) => peak(&self.ends(&plan(found).steps)?) <= limit,
            None => true,
        };
        Ok(is_allowed.then_some(found))
    }

    /// The same with the probability that a verdict has to have, where there is one.
    pub(super) fn at(&self, confidence: Option<f64>) -> Result<Self, GripError> {
        confidence.map(check_confidence).transpose()?;
        if confidence.is_some() && self.material.uncertainty().is_none() {
            return Err(GripError::NoIntervals);
        }
        Ok(Self {
            level: confidence,
            ..self.clone()
        })
    }

    pub(super) fn no_squeeze(&self, reached: f64, duration: f64, by: String) -> GripError {
        let (deepest, _) = self.limits.deepest(self.contact.specimen());
        GripError::NoSqueeze {
            needed: self.needed_force(deepest),
            reached,
            duration,
            by,
        }
    }
}

pub(super) fn check_duration(duration: f64) -> Result<(), GripError> {
    let holds = duration > 0.0 && (duration <= ALWAYS || duration.is_infinite());
    check("time to hold", duration, " s", "above 0 and ten years at most, or always", holds)
}

/// Neighbours between which a question goes over from no to yes, to the last bits: the last no and the first yes.
pub(super) fn bisected(
    mut no: f64,
    mut yes: f64,
    mut is_yes: impl FnMut(f64) -> Result<bool, GripError>,
) -> Result<(f64, f64), GripError> {
    for _ in 0..60 {
        let middle = 0.5 * (no + yes);
        if !(middle > no && middle < yes) {
            break;
        }
        if is_yes(middle)? {
            yes = middle;
        } else {
            no = middle;
        }
    }
    Ok((no, yes))
}
