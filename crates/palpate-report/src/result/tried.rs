//! A squeeze that is tried: whether it holds as long as was requested, and nothing else.

use palpate::calibrate::{Misfit, Prediction};
use palpate::grip::Grip;
use palpate::number::significant;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::misfit::{condition, sentence_of_misfit};
use super::{chance, lasted, percent};

/// `palpate.tried-squeeze/1`: whether a squeeze holds with the displacement held, and the course of its force.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TriedSqueeze {
    /// Always `palpate.tried-squeeze/1`.
    pub schema: String,
    /// Squeeze, m.
    pub squeeze_m: f64,
    /// Speed of the jaws, m/s.
    pub speed_m_per_s: f64,
    /// How long the force holds out is requested, s from the end of the squeeze.
    pub hold_s: f64,
    /// Whether it holds with the probability that is required; `null` where no probability can be stated.
    pub holds: Option<bool>,
    /// Probability that the force after that time is the needed one or more; `null` where the calibration has no intervals.
    pub probability: Option<f64>,
    /// Probability that is required.
    pub verdict_confidence: f64,
    /// What the record of the material shows against its law, and what helps; `null` where nothing.
    pub misfit: Option<String>,
    /// The verdict in a sentence.
    pub verdict: String,
    /// Beyond what the test has shown, in words each.
    pub extrapolations: Vec<String>,
    /// Force that is needed in the hold, N.
    pub needed_force_n: f64,
    /// Force when the jaws stop, N.
    pub start_force_n: f64,
    /// Force at the end of the time requested, N.
    pub end_force_n: f64,
    /// Ends of the interval of that force, N; `null` where it is not known.
    pub end_force_interval_n: Option<[f64; 2]>,
    /// Coverage of the intervals.
    pub confidence: f64,
    /// Times of the course from the start of the squeeze, s.
    pub time_s: Vec<f64>,
    /// Force, N.
    pub force_n: Vec<f64>,
    /// Lower ends of its intervals, N; empty where they are not known.
    pub force_low_n: Vec<f64>,
    /// Upper ends, N.
    pub force_high_n: Vec<f64>,
    /// Time at which the jaws stop, s.
    pub closing_s: f64,
}

impl TriedSqueeze {
    /// Of a grip whose squeeze (m) and its hold (s) were followed: their course, the probability that it holds, and the one required.
    #[must_use]
    pub fn new(
        grip: &Grip<'_>,
        squeeze: f64,
        duration: f64,
        (course, probability, required): (Prediction, Option<f64>, f64),
        misfit: Option<&Misfit>,
    ) -> Self {
        let trajectory = &course.trajectory;
        let (last, closing) = (trajectory.len() - 1, squeeze / grip.limits().speed);
        let ends: Vec<(f64, f64)> = (0..=last).filter_map(|i| course.force_interval(i)).collect();
        let (force_low_n, force_high_n) = ends.iter().copied().unzip();
        let stops = trajectory.time.partition_point(|time| *time < closing * (1.0 - 1e-9)).min(last);
        let holds = probability.map(|found| found >= required);
        let extrapolations: Vec<String> = course.extrapolations.iter().map(ToString::to_string).collect();
        let condition = condition(misfit, !extrapolations.is_empty());
        let what = format!(
            "a squeeze of {} mm at {} mm/s",
            significant(1e3 * squeeze, 4),
            significant(1e3 * grip.limits().speed, 3)
        );
        let (time, level) = (lasted(duration), percent(required));
        let verdict = match (holds, probability) {
            (Some(true), Some(p)) => {
                format!("Yes: {what} holds for {time} with a probability of {}{condition}.", chance(p))
            }
            (Some(false), Some(p)) => format!(
                "No: {what} holds for {time} with a probability of {}{condition}; {level} are required.",
                chance(p)
            ),
            _ => "Not known: the calibration has no intervals, and no probability can be stated.".to_owned(),
        };
        Self {
            schema: "palpate.tried-squeeze/1".to_owned(),
            squeeze_m: squeeze,
            speed_m_per_s: grip.limits().speed,
            hold_s: duration,
            holds,
            probability,
            verdict_confidence: required,
            misfit: misfit.map(|misfit| sentence_of_misfit(misfit, &grip.material().candidate().to_string())),
            verdict,
            extrapolations,
            needed_force_n: grip.needed_force(squeeze),
            start_force_n: trajectory.force[stops],
            end_force_n: trajectory.force[last],
            end_force_interval_n: ends.get(last).map(|(low, high)| [*low, *high]),
            confidence: course.confidence,
            force_low_n,
            force_high_n,
            closing_s: closing,
            time_s: course.trajectory.time,
            force_n: course.trajectory.force,
        }
    }
}
