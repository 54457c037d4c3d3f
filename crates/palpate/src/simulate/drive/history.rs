//! Force over time, straight between knots.

use serde::{Deserialize, Serialize};

use super::motion::{MotionError, check_finite, value_at};

/// A piecewise-linear history of the force on one contact: force F (N) over time (s), compression positive.
///
/// Two knots at one time are a step: the force jumps there. Both a commanded protocol and a measured force are one. The body is relaxed,
/// and free of force, before the first knot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForceHistory {
    times: Vec<f64>,
    forces: Vec<f64>,
}

impl ForceHistory {
    /// A history through the given points.
    ///
    /// ```
    /// use palpate::simulate::ForceHistory;
    /// // to 10 N within a second, held for a minute, let go at once, watched for a minute
    /// let history = ForceHistory::new(vec![0.0, 1.0, 61.0, 61.0, 121.0], vec![0.0, 10.0, 10.0, 0.0, 0.0])?;
    /// assert_eq!(history.force_at(0.5), 5.0);
    /// assert_eq!(history.force_at(61.0), 0.0); // after the step
    /// # Ok::<(), palpate::simulate::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// [`MotionError`] for fewer than two points, numbers that are not finite, time that runs backwards or that stands still at three
    /// points.
    pub fn new(times: Vec<f64>, forces: Vec<f64>) -> Result<Self, MotionError> {
        if times.len() != forces.len() {
            return Err(MotionError::Lengths {
                times: times.len(),
                displacements: forces.len(),
            });
        }
        if times.len() < 2 || times[0] == times[times.len() - 1] {
            return Err(MotionError::TooShort { found: times.len() });
        }
        check_finite(&times, "force", &forces)?;
        let stands = |index: usize| index >= 2 && times[index] == times[index - 2];
        if let Some(index) = (1..times.len()).find(|&i| times[i] < times[i - 1] || stands(i)) {
            return Err(MotionError::TimeNotRising {
                before: times[index - 1],
                found: times[index],
                index,
            });
        }
        Ok(Self { times, forces })
    }

    /// Times of the knots, s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Forces at the knots, N.
    #[must_use]
    pub fn forces(&self) -> &[f64] {
        &self.forces
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

    /// Force at `time`, N: after the step where there is one, constant before the first knot and after the last.
    #[must_use]
    pub fn force_at(&self, time: f64) -> f64 {
        value_at(&self.times, &self.forces, time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_histories_say_where() {
        let new = |times: &[f64], forces: &[f64]| ForceHistory::new(times.to_vec(), forces.to_vec());
        assert!(matches!(new(&[0.0, 1.0], &[1.0]), Err(MotionError::Lengths { .. })));
        assert!(matches!(new(&[0.0, 0.0], &[0.0, 1.0]), Err(MotionError::TooShort { .. })));
        assert!(matches!(new(&[0.0, 1.0], &[0.0, f64::NAN]), Err(MotionError::NotFinite { what: "force", .. })));
        assert!(matches!(new(&[0.0, 2.0, 1.0], &[0.0; 3]), Err(MotionError::TimeNotRising { index: 2, .. })));
        assert!(matches!(new(&[0.0, 1.0, 1.0, 1.0], &[0.0; 4]), Err(MotionError::TimeNotRising { index: 3, .. })));
        assert!(new(&[0.0, 0.0, 1.0], &[0.0, 1.0, 1.0]).is_ok());
    }
}
