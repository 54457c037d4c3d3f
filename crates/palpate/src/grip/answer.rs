//! A question to a gripper, and all that answers it.

use std::cell::RefCell;

use serde::{Deserialize, Serialize};

use super::check_confidence;
use super::least::check_duration;
use super::{BackOff, Band, ForceHold, Grip, GripError, Objective, Plan, PositionHold, Regrip, Schedule, TimeToSlip};
use crate::calibrate::Prediction;
use crate::watch::{Cancelled, Stages, Unwatched, Watch};

/// What the gripper holds once it has closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Control {
    /// Its jaws stand: the force relaxes.
    #[default]
    Position,
    /// Its force: the body creeps.
    Force,
}

/// What is required of a grip; by default, of the least squeeze that holds for a minute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// What is held, and which of the grips the verdict is on.
    pub control: Control,
    /// Squeeze that is in question, m; the least by `objective` if not given.
    pub squeeze: Option<f64>,
    /// Force that is in question where the force is held, N; the least that is enough if not given.
    pub force: Option<f64>,
    /// How long it is to hold, s, infinite for always. If not given, the answer for a squeeze or force is how long it does, and the least is sought for a
    /// minute.
    pub duration: Option<f64>,
    /// What the squeeze should have least of.
    pub objective: Objective,
    /// Probability with which the verdict has to hold, on one side; 0.95 by default. Nothing holds with more than a half where the calibration has no
    /// intervals. If not given, the best estimate decides.
    pub confidence: Option<f64>,
    /// Band for a schedule of squeezes.
    pub band: Option<Band>,
    /// What the schedule has least of.
    pub regrip: Regrip,
}

impl Default for Question {
    fn default() -> Self {
        Self {
            control: Control::default(),
            squeeze: None,
            force: None,
            duration: None,
            objective: Objective::default(),
            confidence: Some(Self::CONFIDENCE),
            band: None,
            regrip: Regrip::default(),
        }
    }
}

impl Question {
    /// Probability with which a verdict has to hold by default.
    pub const CONFIDENCE: f64 = 0.95;

    /// How long a position is to be held where neither a time nor a squeeze is requested, s.
    pub const USUAL_DURATION: f64 = 60.0;

    /// How long the position is to be held, s; `None` where the question is how long it does.
    #[must_use]
    pub fn wanted(&self) -> Option<f64> {
        self.duration.or(self.squeeze.is_none().then_some(Self::USUAL_DURATION))
    }
}

/// A grip with its course over time.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct WithPrediction<T> {
    /// The grip.
    pub found: T,
    /// Its course, with bands.
    pub course: Prediction,
}

/// All that answers a question: the grips beside one another, each or why there is none.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Answer {
    /// The question.
    pub question: Question,
    /// How long the courses go on behind the squeeze, s.
    pub shown: f64,
    /// The squeeze with the displacement held.
    pub squeeze: Result<WithPrediction<PositionHold>, GripError>,
    /// The probability that the grip in question holds as long as was requested, or at all; `None` where the calibration says nothing.
    pub probability: Option<f64>,
    /// The least squeeze at the speed of the gripper (m) that holds with the probability requested, if the one in question does not.
    pub assured_squeeze: Option<f64>,
    /// How long squeezes a little less and more deep hold, by displacement in m.
    pub neighbours: Vec<(f64, TimeToSlip)>,
    /// Overshoot and back off (a preconditioning squeeze), to the same position if that holds relaxed.
    pub back_off: Result<WithPrediction<BackOff>, GripError>,
    /// The force held.
    pub force_hold: Result<WithPrediction<ForceHold>, GripError>,
    /// Squeezes that keep the force in the band, if one was requested.
    pub schedule: Option<Result<WithPrediction<Schedule>, GripError>>,
}

/// Samples of a course, a step.
const SAMPLES: usize = 200;

impl Grip<'_> {
    /// Answers a question: the squeeze with its neighbours, overshoot and back off, the force held, and the schedule, beside one another.
    ///
    /// # Errors
    /// Of numbers that make no question ([`GripError::Number`]); what cannot be had is given in its place in the answer.
    pub fn answer(&self, question: &Question) -> Result<Answer, GripError> {
        self.answer_watched(question, &mut Unwatched)
    }

    /// As [`answer`](Self::answer), heard by `watch` at every simulation.
    ///
    /// # Errors
    /// As for [`answer`](Self::answer), and [`GripError::Cancelled`].
    pub fn answer_watched(&self, question: &Question, watch: &mut dyn Watch) -> Result<Answer, GripError> {
        let stages = RefCell::new(Stages::new("searching for grips".to_owned(), watch));
        let heard = Grip {
            heard: Some(&stages),
            ..self.at(self.level_of(question)?)?
        };
        let answer = heard.answered(question);
        stages.borrow_mut().finish()?;
        answer
    }

    /// The level of a question, where it is above that of the best estimate and the calibration can say anything of it.
    fn level_of(&self, question: &Question) -> Result<Option<f64>, GripError> {
        question.confidence.map(check_confidence).transpose()?;
        let is_stated = |level: &f64| *level > 0.5 && self.material.uncertainty().is_some();
        Ok(question.confidence.filter(is_stated))
    }

    /// Goes on to what is `share` of the whole search.
    fn enter(&self, share: f64) -> Result<(), Cancelled> {
        self.heard.map_or(Ok(()), |stages| {
            let mut stages = stages.borrow_mut();
            stages.enter(share);
            stages.reach(0.0)
        })
    }

    fn answered(&self, question: &Question) -> Result<Answer, GripError> {
        self.enter(0.3)?;
        let wanted = question.duration.unwrap_or(Question::USUAL_DURATION);
        check_duration(wanted)?;
        let squeeze = match question.squeeze {
            Some(displacement) => {
                super::error::above_zero("squeeze", displacement, " m")?;
                self.position_hold(&Plan::squeeze(displacement, self.limits.speed))
            }
            None => self.least(question.objective, wanted, self.level),
        };
        let shown = shown(question, squeeze.as_ref().ok());
        let around = |found: &PositionHold| {
            let places = [0.9, 0.95, 1.0, 1.05, 1.1].map(|share| share * found.displacement);
            self.neighbours(&places, found.plan.speed())
        };
        self.enter(0.1)?;
        let neighbours = squeeze.as_ref().map(around).unwrap_or_default();
        let same = question.squeeze.filter(|place| self.equilibrium_force(*place) >= self.needed_force(*place));
        self.enter(0.2)?;
        let back_off = self.back_off(same, shown, self.level);
        self.enter(0.1)?;
        let force_hold = self.force_hold(question.force, shown);
        self.enter(0.1)?;
        let schedule = question.band.map(|band| self.regrip(band, question.regrip, shown));
        if let Some(Err(error)) = &schedule
            && !error.is_answer()
        {
            return Err(error.clone());
        }
        self.enter(0.2)?;
        let probability = match question.control {
            Control::Position => match &squeeze {
                Ok(found) => self.probability(&found.plan, question.wanted().unwrap_or(0.0))?,
                Err(_) => None,
            },
            Control::Force => match &force_hold {
                Ok(found) => self.force_hold_probability(found)?,
                Err(_) => None,
            },
        };
        let is_short = probability.zip(self.level).is_some_and(|(found, level)| found < level);
        let assured_squeeze = match (question.squeeze, question.duration) {
            (Some(from), Some(duration)) if is_short && question.control == Control::Position => {
                self.assured_from(from, duration)?
            }
            _ => None,
        };
        let follow = |steps: &Plan| self.course(steps, shown, SAMPLES);
        Ok(Answer {
            question: *question,
            shown,
            squeeze: squeeze.and_then(|found| followed(found, |found| follow(&found.plan))),
            probability,
            assured_squeeze,
            neighbours,
            back_off: back_off.and_then(|found| followed(found, |found| follow(&found.backed.plan))),
            force_hold: force_hold.and_then(|found| followed(found, |found| self.force_hold_course(found, SAMPLES))),
            schedule: schedule.map(|made| {
                // Its moves are many; each is short.
                made.and_then(|found| followed(found, |found| self.schedule_course(found, SAMPLES / 4)))
            }),
        })
    }
}

impl Answer {
    /// Whether the grip that is in question holds as long as was requested with the probability that was; without a time whether it does at all.
    ///
    /// # Errors
    /// Why there is no such grip.
    pub fn holds(&self) -> Result<bool, GripError> {
        /// Of the time: a least squeeze holds exactly as long as was requested.
        const ROUNDING: f64 = 1.0 - 1e-6;
        match self.question.control {
            Control::Position => {
                let found = &self.squeeze.as_ref().map_err(Clone::clone)?.found;
                let lasts = match (self.question.confidence, found.assured) {
                    (Some(_), Some(assured)) => assured,
                    (Some(level), None) if level > 0.5 => return Ok(false),
                    _ => found.time_to_slip,
                };
                Ok(match self.question.wanted() {
                    None => lasts != TimeToSlip::After(0.0),
                    Some(wanted) if wanted.is_finite() => lasts.covers(wanted * ROUNDING),
                    Some(_) => lasts == TimeToSlip::Never,
                })
            }
            Control::Force => {
                let found = &self.force_hold.as_ref().map_err(Clone::clone)?.found;
                let is_sure = match (self.question.confidence, self.probability) {
                    (Some(level), Some(probability)) => probability >= level,
                    (Some(level), None) => level <= 0.5,
                    (None, _) => true,
                };
                Ok(found.holds && found.stroke_ends.is_none() && is_sure)
            }
        }
    }

    /// The course of the grip that is in question, if there is one.
    #[must_use]
    pub fn course(&self) -> Option<&Prediction> {
        match self.question.control {
            Control::Position => self.squeeze.as_ref().ok().map(|followed| &followed.course),
            Control::Force => self.force_hold.as_ref().ok().map(|followed| &followed.course),
        }
    }
}

fn followed<T>(found: T, course: impl Fn(&T) -> Result<Prediction, GripError>) -> Result<WithPrediction<T>, GripError> {
    let course = course(&found)?;
    Ok(WithPrediction { found, course })
}

/// How long courses are: the time that is requested, beyond the slip if none is, an hour for always.
fn shown(question: &Question, squeeze: Option<&PositionHold>) -> f64 {
    const HOUR: f64 = 3600.0;
    match (question.duration, squeeze.map(|found| found.time_to_slip)) {
        (Some(wanted), _) if wanted.is_finite() => wanted,
        (None, Some(TimeToSlip::After(time))) if question.squeeze.is_some() => (1.5 * time).max(1.0),
        (None, _) if question.squeeze.is_none() => Question::USUAL_DURATION,
        _ => HOUR,
    }
}
