//! Displacement of the jaw over time, straight between knots.

use serde::{Deserialize, Serialize};

/// A piecewise-linear motion of the jaw: displacement d (m) since first contact over time (s).
///
/// Both a commanded protocol and a measured displacement series are one. The body is relaxed at the first knot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    times: Vec<f64>,
    displacements: Vec<f64>,
}

/// An invalid motion.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// Fewer than two knots.
    #[error("a motion needs two points or more, found {found}")]
    TooShort {
        /// Number of points.
        found: usize,
    },
    /// As many times as displacements are needed.
    #[error("a motion needs a displacement for every time, found {times} times and {displacements} displacements")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of displacements.
        displacements: usize,
    },
    /// A value that is NaN or infinite.
    #[error("{what} must be finite, found {found} at point {index}")]
    NotFinite {
        /// `time` or `displacement`.
        what: &'static str,
        /// The value.
        found: f64,
        /// Its index.
        index: usize,
    },
    /// Time does not rise.
    #[error("time must rise, found {found} s after {before} s at point {index}")]
    TimeNotRising {
        /// Time before, s.
        before: f64,
        /// Time found, s.
        found: f64,
        /// Its index.
        index: usize,
    },
    /// A speed that is not a finite number above zero.
    #[error("step {step}: rate must be above 0 m/s, found {found} m/s")]
    Rate {
        /// Number of the step, from 1.
        step: usize,
        /// What was given, m/s.
        found: f64,
    },
    /// A hold that is not zero or a finite number above.
    #[error("step {step}: hold must be 0 s or more, found {found} s")]
    Hold {
        /// Number of the step, from 1.
        step: usize,
        /// What was given, s.
        found: f64,
    },
    /// A step that neither moves nor holds.
    #[error("step {step} neither moves nor holds")]
    EmptyStep {
        /// Number of the step, from 1.
        step: usize,
    },
}

/// One step of a protocol: go to a displacement at constant speed, then stay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ProtocolStep {
    /// Displacement of the jaw at the end of the ramp, m.
    pub to: f64,
    /// Speed of the jaw in the ramp, m/s, always positive.
    pub rate: f64,
    /// Time at the new displacement, s.
    pub hold: f64,
}

/// The motion of a protocol that starts at first touch at time 0.
///
/// ```
/// use palpate::simulate::{ProtocolStep, protocol};
/// let step = ProtocolStep { to: 0.005, rate: 0.5 / 60.0, hold: 10.0 };
/// let motion = protocol(&[step])?;
/// assert!((motion.end() - 10.6).abs() < 1e-12);
/// assert_eq!(motion.displacement_at(3.0), 0.005);
/// # Ok::<(), palpate::simulate::MotionError>(())
/// ```
///
/// # Errors
/// [`MotionError`] for a rate that is not above zero, a negative hold, or no movement at all.
pub fn protocol(steps: &[ProtocolStep]) -> Result<Motion, MotionError> {
    let (mut times, mut displacements) = (vec![0.0], vec![0.0]);
    let (mut time, mut at) = (0.0, 0.0);
    for (index, step) in steps.iter().enumerate() {
        let number = index + 1;
        if !(step.rate.is_finite() && step.rate > 0.0) {
            return Err(MotionError::Rate {
                step: number,
                found: step.rate,
            });
        }
        if !(step.hold.is_finite() && step.hold >= 0.0) {
            return Err(MotionError::Hold {
                step: number,
                found: step.hold,
            });
        }
        if step.to == at && step.hold == 0.0 {
            return Err(MotionError::EmptyStep { step: number });
        }
        if step.to != at {
            time += (step.to - at).abs() / step.rate;
            at = step.to;
            times.push(time);
            displacements.push(at);
        }
        if step.hold > 0.0 {
            time += step.hold;
            times.push(time);
            displacements.push(at);
        }
    }
    Motion::new(times, displacements)
}

impl Motion {
    /// A motion through the given points.
    ///
    /// # Errors
    /// [`MotionError`] for fewer than two points, numbers that are not finite, or time that does not rise.
    pub fn new(times: Vec<f64>, displacements: Vec<f64>) -> Result<Self, MotionError> {
        if times.len() != displacements.len() {
            return Err(MotionError::Lengths {
                times: times.len(),
                displacements: displacements.len(),
            });
        }
        if times.len() < 2 {
            return Err(MotionError::TooShort { found: times.len() });
        }
        check_finite(&times, "displacement", &displacements)?;
        if let Some(index) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(MotionError::TimeNotRising {
                before: times[index],
                found: times[index + 1],
                index: index + 1,
            });
        }
        Ok(Self { times, displacements })
    }

    /// Times of the knots, s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Displacements at the knots, m.
    #[must_use]
    pub fn displacements(&self) -> &[f64] {
        &self.displacements
    }

    /// Time of the first knot, s.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.times[0]
    }

    /// Time of the last knot, s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The motion of a jaw that is never below first touch, and that stands there until it leaves it for places farther than `noise` (m).
    #[must_use]
    pub(crate) fn standing_at_touch(&self, noise: f64) -> Self {
        let left = self.displacements.iter().position(|d| *d > noise).unwrap_or(self.displacements.len());
        let stands = self.displacements[..left].iter().rposition(|d| *d <= 0.0).map_or(0, |last| last + 1);
        let at = |(index, d): (usize, &f64)| if index < stands { 0.0 } else { d.max(0.0) };
        Self {
            times: self.times.clone(),
            displacements: self.displacements.iter().enumerate().map(at).collect(),
        }
    }

    /// Displacement of the jaw at `time`, m; constant before the first knot and after the last.
    #[must_use]
    pub fn displacement_at(&self, time: f64) -> f64 {
        value_at(&self.times, &self.displacements, time)
    }
}

/// The value at `time` of a line straight between knots: constant before the first knot and after the last, after the step where two knots
/// stand at one time.
pub(super) fn value_at(times: &[f64], values: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|&knot| knot <= time);
    if after == 0 {
        return values[0];
    }
    if after == times.len() {
        return values[after - 1];
    }
    let (from, to) = (values[after - 1], values[after]);
    if from == to {
        return from;
    }
    from + (to - from) * ((time - times[after - 1]) / (times[after] - times[after - 1]))
}

/// Checks that every number of both columns is finite.
pub(super) fn check_finite(times: &[f64], what: &'static str, values: &[f64]) -> Result<(), MotionError> {
    for (what, values) in [("time", times), (what, values)] {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(MotionError::NotFinite {
                what,
                found: values[index],
                index,
            });
        }
    }
    Ok(())
}

impl Motion {
    /// The motion with fewer knots: straight lines that pass within `tolerance` (m) of every knot left out.
    ///
    /// A single pass ("swinging door"): a line is prolonged from its first knot as long as one slope serves all knots on
    /// the way. Its ends are knots of the motion, so that noise of a held jaw turns into a standstill and corners stay.
    #[must_use]
    pub fn simplified(&self, tolerance: f64) -> Self {
        let (times, displacements) = (&self.times, &self.displacements);
        let mut kept = vec![0];
        let mut from = 0;
        let (mut lowest, mut highest) = (f64::NEG_INFINITY, f64::INFINITY);
        for i in 1..times.len() {
            let run = times[i] - times[from];
            let rise = displacements[i] - displacements[from];
            let (low, high) = ((rise - tolerance) / run, (rise + tolerance) / run);
            let slope = rise / run;
            if slope < lowest || slope > highest {
                from = i - 1;
                kept.push(from);
                let run = times[i] - times[from];
                let rise = displacements[i] - displacements[from];
                (lowest, highest) = ((rise - tolerance) / run, (rise + tolerance) / run);
            } else {
                (lowest, highest) = (lowest.max(low), highest.min(high));
            }
        }
        kept.push(times.len() - 1);
        kept.dedup();
        Self {
            times: kept.iter().map(|i| times[*i]).collect(),
            displacements: kept.iter().map(|i| displacements[*i]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_motions_say_where() {
        let step = |to, rate, hold| ProtocolStep { to, rate, hold };
        assert!(matches!(protocol(&[]), Err(MotionError::TooShort { .. })));
        assert!(matches!(
            protocol(&[step(1.0, 1.0, 0.0), step(2.0, 0.0, 1.0)]),
            Err(MotionError::Rate { step: 2, .. })
        ));
        assert!(matches!(protocol(&[step(1.0, 1.0, -1.0)]), Err(MotionError::Hold { step: 1, .. })));
        assert!(matches!(protocol(&[step(0.0, 1.0, 0.0)]), Err(MotionError::EmptyStep { step: 1 })));
        let rising = Motion::new(vec![0.0, 1.0, 1.0], vec![0.0; 3]);
        assert!(matches!(rising, Err(MotionError::TimeNotRising { index: 2, .. })));
    }

    #[test]
    fn simplifying_keeps_corners_and_drops_noise() {
        let times: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
        let noise = |i: usize| 1e-6 * [1.0, -1.0, 0.5, -0.3][i % 4];
        let displacement: Vec<f64> = times.iter().enumerate().map(|(i, t)| (0.01 * t).min(0.02) + noise(i)).collect();
        let motion = Motion::new(times.clone(), displacement).unwrap();
        let simple = motion.simplified(2e-5);
        assert!(simple.times().len() < 12, "{}", simple.times().len());
        for t in times {
            assert!((simple.displacement_at(t) - motion.displacement_at(t)).abs() < 3e-5);
        }
    }
}
