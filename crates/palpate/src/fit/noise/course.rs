//! How the size of the noise changes along a hold, and after it.

use serde::{Deserialize, Serialize};

/// Largest ln of a variance over the mean.
pub(super) const FARTHEST: f64 = 14.0;

/// What the size of the noise goes with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseFollows {
    /// The fitted curve.
    Signal,
    /// The time since the first sample.
    Time,
}

/// The course of the size of the noise: ln σ²/σ̄² = a + b x + c x², where σ̄ is the standard deviation over the whole hold, and x runs from 0 to 1
/// over the values of the curve, or the times, that the hold has; beyond them the size stays as it is at their end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct NoiseCourse {
    /// What it goes with.
    pub follows: NoiseFollows,
    /// That in the hold where x is 0 and 1: the least and the largest value of the curve in the unit of the signal, or the time of the first and
    /// last sample since the first, s.
    pub range: (f64, f64),
    /// a, b and c.
    pub coefficients: [f64; 3],
    /// That the size changes at all.
    pub probability: f64,
}

impl NoiseCourse {
    /// σ/σ̄ at a time since the first sample, s, where the curve has this value: root mean square over a course and none.
    pub(crate) fn size(&self, elapsed: f64, value: f64) -> f64 {
        let at = match self.follows {
            NoiseFollows::Signal => value,
            NoiseFollows::Time => elapsed,
        };
        let (low, high) = self.range;
        let x = ((at - low) / (high - low)).clamp(0.0, 1.0);
        let [a, b, c] = self.coefficients;
        let variance = (a + x * (b + x * c)).clamp(-FARTHEST, FARTHEST).exp();
        (1.0 + self.probability * (variance - 1.0)).sqrt()
    }
}
