//! The zero of a record, and the same motion without a body.

use crate::record::{Correction, Record, RecordError, Tare};
use crate::statistics::{interpolated, range};

/// How far the jaw of an air run may stand from that of the record, as a share of the way.
const SAME_PLACE: f64 = 0.02;
/// For what share of the rows it may stand farther: two starts are never at the same instant.
const ELSEWHERE: f64 = 0.05;

impl Record {
    /// The record with force counted from `tare.force`, less `tare.tilt` times the travel, and displacement from `tare.displacement`.
    #[must_use]
    pub fn tared(&self, tare: Tare) -> Self {
        let shifted = |values: &[f64], zero: f64| values.iter().map(|value| value - zero).collect();
        let displacement = self.displacement().map(|values| shifted(values, tare.displacement));
        let mut force: Vec<f64> = shifted(&self.force, tare.force);
        if let Some(travel) = displacement.as_ref().filter(|_| tare.tilt != 0.0) {
            force.iter_mut().zip(travel).for_each(|(force, travel)| *force -= tare.tilt * travel);
        }
        let record = Self {
            time: self.time.clone(),
            displacement,
            force,
            corrections: self.corrections.clone(),
            labels: self.labels.clone(),
        };
        let is_moved = (tare.displacement != 0.0 || tare.tilt != 0.0) && self.displacement.is_some();
        if tare.force == 0.0 && !is_moved {
            return record;
        }
        record.followed_by(Correction::Tared(tare))
    }

    /// The record less an air run: the same motion without a body, which leaves the inertia of the fixture.
    ///
    /// Both are aligned at their first sample and the air run is interpolated linearly. Its last value stands for what
    /// comes after its end, where the jaw of the record moves no more. The paper found at most 0.35 N this way.
    ///
    /// # Errors
    /// [`RecordError::AirRunDiffers`] if its jaw stands elsewhere, by more than 2 % of the way, for more than 5 % of the
    /// time; [`RecordError::AirRunShort`] if it ends before the motion of the record, or before the record where that has no
    /// displacement; [`RecordError::ConstantForce`] if nothing but the air run is left.
    pub fn without_air_run(&self, air: &Self) -> Result<Self, RecordError> {
        let (start, air_start) = (self.time[0], air.time[0]);
        let air_end = air.time[air.len() - 1];
        let times: Vec<f64> = self.time.iter().map(|t| (t - start + air_start).min(air_end)).collect();
        self.same_motion(air, &times)?;
        let inertia = interpolated(&air.time, &air.force, &times);
        let force = self.force.iter().zip(inertia).map(|(force, inertia)| force - inertia).collect();
        self.with_force(force, Correction::AirRunSubtracted)
    }

    /// An error unless an air run, looked at `times` for the rows of this record, is the same motion as far as it goes.
    fn same_motion(&self, air: &Self, times: &[f64]) -> Result<(), RecordError> {
        let duration = |record: &Self| record.time[record.len() - 1] - record.time[0];
        let ends = self.time.partition_point(|t| t - self.time[0] <= duration(air));
        let short = |until: f64| RecordError::AirRunShort {
            found: duration(air),
            needed: until - self.time[0],
        };
        let Some(displacement) = self.displacement() else {
            let beyond = duration(self) - duration(air);
            return if beyond > 0.01 * duration(self) { Err(short(self.time[self.len() - 1])) } else { Ok(()) };
        };
        let allowed = SAME_PLACE * range(displacement);
        if let Some(other) = air.displacement() {
            let other = interpolated(&air.time, other, times);
            // Counted from the first sample: the zero of a run is set by hand.
            let (zero, air_zero) = (displacement[0], other[0]);
            let away = |row: &usize| (displacement[*row] - zero) - (other[*row] - air_zero);
            let elsewhere: Vec<usize> = (0..ends).filter(|row| away(row).abs() > allowed).collect();
            let worst = elsewhere.iter().max_by(|a, b| away(a).abs().total_cmp(&away(b).abs()));
            if let Some(&worst) = worst.filter(|_| elsewhere.len() as f64 > ELSEWHERE * ends as f64) {
                return Err(RecordError::AirRunDiffers {
                    time: self.time[worst],
                    expected: displacement[worst] - zero,
                    found: other[worst] - air_zero,
                });
            }
        }
        let last = displacement[ends.saturating_sub(1)];
        match (ends..self.len()).rev().find(|row| (displacement[*row] - last).abs() > allowed) {
            Some(row) => Err(short(self.time[row])),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_carries_what_was_done_to_it() {
        let record = Record::new(vec![0.0, 1.0, 2.0], Some(vec![1.0, 2.0, 2.0]), vec![0.1, 1.3, 0.9]).unwrap();
        let tare = Tare {
            force: 0.1,
            displacement: 1.0,
            tilt: 0.0,
        };
        let tared = record.tared(tare);
        assert_eq!((record.corrections(), tared.corrections()), ([].as_slice(), [Correction::Tared(tare)].as_slice()));
        let air = Record::new(vec![0.0, 1.0, 2.0], None, vec![0.0, 0.1, 0.0]).unwrap();
        let net = tared.without_air_run(&air).unwrap();
        assert_eq!(net.corrections(), [Correction::Tared(tare), Correction::AirRunSubtracted]);
        let nothing = Tare::default();
        assert!(record.tared(nothing).corrections().is_empty());
    }

    #[test]
    fn an_air_run_takes_the_inertia_away() {
        let time: Vec<f64> = (0..5).map(f64::from).collect();
        let jaw = |travel: &[f64]| Some(travel.to_vec());
        let record = Record::new(time, jaw(&[0.0, 1.0, 2.0, 2.0, 2.0]), vec![0.3, 1.3, 2.3, 2.0, 2.0]).unwrap();
        let air = Record::new(vec![10.0, 12.0, 12.5], jaw(&[7.0, 9.0, 9.0]), vec![0.3, 0.3, 0.0]).unwrap();
        let net = record.without_air_run(&air).unwrap();
        for (found, expected) in net.force().iter().zip([0.0, 1.0, 2.0, 2.0, 2.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }

    /// The run of another speed and one that ended early were subtracted all the same.
    #[test]
    fn an_air_run_of_another_motion_is_refused() {
        let ramp = |speed: f64, until: usize| -> Record {
            let time: Vec<f64> = (0..until).map(|i| 0.1 * i as f64).collect();
            let jaw: Vec<f64> = time.iter().map(|t| (speed * t).min(1.0) + if *t > 5.0 { 0.5 } else { 0.0 }).collect();
            let force = jaw.iter().map(|d| (0.2 - 0.05 * speed) * d).collect();
            Record::new(time, Some(jaw), force).unwrap()
        };
        let record = ramp(1.0, 100);
        let other_force = |air: Record| Record {
            force: air.force.iter().map(|f| 0.5 * f).collect(),
            ..air
        };
        assert!(record.without_air_run(&other_force(ramp(1.0, 60))).is_ok());
        let error = record.without_air_run(&ramp(2.0, 100)).unwrap_err();
        assert_eq!(
            error,
            RecordError::AirRunDiffers {
                time: 0.5,
                expected: 0.5,
                found: 1.0
            }
        );
        let error = record.without_air_run(&ramp(1.0, 30)).unwrap_err();
        assert!(matches!(error, RecordError::AirRunShort { found, .. } if (found - 2.9).abs() < 1e-12), "{error}");
        let force_alone = Record::new(record.time().to_vec(), None, record.force().to_vec()).unwrap();
        assert!(matches!(force_alone.without_air_run(&ramp(1.0, 30)), Err(RecordError::AirRunShort { .. })));
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
