//! Corrections that make a new record and leave the old one as it was.

use serde::{Deserialize, Serialize};

use super::clocks::interpolated;
use super::{Record, RecordError};

/// What was subtracted from a record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Tare {
    /// Force without contact, N.
    pub force: f64,
    /// Displacement at first touch, m.
    pub displacement: f64,
}

impl Record {
    /// The record with force counted from `tare.force` and displacement from `tare.displacement`.
    #[must_use]
    pub fn tared(&self, tare: Tare) -> Self {
        let shifted = |values: &[f64], zero: f64| values.iter().map(|value| value - zero).collect();
        Self {
            time: self.time.clone(),
            displacement: self.displacement().map(|values| shifted(values, tare.displacement)),
            force: shifted(&self.force, tare.force),
        }
    }

    /// The record less an air run: the same motion without a body, which leaves the inertia of the fixture.
    ///
    /// Both are aligned at their first sample; the air run is interpolated linearly and counts as its last value
    /// after its end. The paper found at most 0.35 N this way.
    ///
    /// # Errors
    /// [`RecordError::ConstantForce`] if nothing but the air run is left.
    pub fn without_air_run(&self, air: &Self) -> Result<Self, RecordError> {
        let (start, air_start) = (self.time[0], air.time[0]);
        let air_end = air.time[air.len() - 1];
        let times: Vec<f64> = self.time.iter().map(|t| (t - start + air_start).min(air_end)).collect();
        let inertia = interpolated(&air.time, &air.force, &times);
        let force = self.force.iter().zip(inertia).map(|(force, inertia)| force - inertia).collect();
        Self::new(self.time.clone(), self.displacement.clone(), force)
    }

    /// The record with single-row dropouts of the displacement replaced by the mean of their neighbours, and how many there were.
    #[must_use]
    pub fn repaired(&self) -> (Self, usize) {
        let Some(displacement) = self.displacement() else {
            return (self.clone(), 0);
        };
        let (repaired, count) = without_dropouts(displacement);
        let record = Self {
            time: self.time.clone(),
            displacement: Some(repaired),
            force: self.force.clone(),
        };
        (record, count)
    }
}

/// A single row that leaves and comes back is a dropout if it strays over 5 % of the range while its neighbours
/// differ from each other by less than a tenth of that stray.
pub(super) fn without_dropouts(values: &[f64]) -> (Vec<f64>, usize) {
    let mut repaired = values.to_vec();
    let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
    let mut count = 0;
    for i in 1..values.len().saturating_sub(1) {
        let (before, here, after) = (repaired[i - 1], values[i], values[i + 1]);
        let stray = (here - before).abs().min((here - after).abs());
        if stray > 0.05 * (high - low) && (after - before).abs() < 0.1 * stray {
            repaired[i] = 0.5 * (before + after);
            count += 1;
        }
    }
    (repaired, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_row_of_zero_in_a_hold_is_repaired_and_counted() {
        let displacement = vec![0.0, 2.0, 4.0, 4.0, 0.0, 4.0, 4.0, 4.0];
        let (repaired, count) = without_dropouts(&displacement);
        assert_eq!(count, 1);
        assert_eq!(repaired, vec![0.0, 2.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0]);
        let ramp: Vec<f64> = (0..20).map(f64::from).collect();
        assert_eq!(without_dropouts(&ramp).1, 0);
    }

    #[test]
    fn an_air_run_takes_the_inertia_away() {
        let time: Vec<f64> = (0..5).map(f64::from).collect();
        let record = Record::new(time.clone(), None, vec![0.3, 1.3, 2.3, 2.0, 2.0]).unwrap();
        let air = Record::new(vec![10.0, 12.0, 12.5], None, vec![0.3, 0.3, 0.0]).unwrap();
        let net = record.without_air_run(&air).unwrap();
        for (found, expected) in net.force().iter().zip([0.0, 1.0, 2.0, 2.0, 2.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn two_clocks_become_one() {
        let record =
            Record::from_two_clocks(&[0.0, 1.0, 2.0], &[0.0, 2.0, 2.0], &[-0.1, 0.5, 1.5, 2.1], &[0.0, 1.0, 2.0, 3.0]);
        let record = record.unwrap();
        assert_eq!(record.time(), [0.5, 1.5]);
        assert_eq!(record.displacement(), Some([1.0, 2.0].as_slice()));
        assert_eq!(record.force(), [1.0, 2.0]);
    }
}
