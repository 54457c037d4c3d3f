//! Force and displacement with time stamps of their own.

use super::dropouts::repair;
use crate::record::checks::{self, RecordError};
use crate::record::{Column, Correction, Record};
use crate::statistics::interpolated;

impl Record {
    /// A record whose displacement has time stamps of its own, brought onto the times of the force.
    ///
    /// The displacement is interpolated linearly at every force time that lies inside its own stamps; force samples
    /// outside them are left out, and counted in [`Record::corrections`]. Single-row dropouts of the displacement are repaired first, so that none is smeared.
    ///
    /// # Errors
    /// [`RecordError`] as for [`Record::new`], for either clock, or [`RecordError::ClocksApart`].
    pub fn from_two_clocks(
        displacement_time: &[f64],
        displacement: &[f64],
        force_time: &[f64],
        force: &[f64],
    ) -> Result<Self, RecordError> {
        for (column, time, values) in [("displacement", displacement_time, displacement), ("force", force_time, force)]
        {
            checks::lengths(time, None, values)?;
            checks::finite("time", time)?;
            checks::finite(column, values)?;
            checks::rising(time)?;
        }
        let mut repaired = displacement.to_vec();
        let count = repair(&mut repaired, |_| true);
        let (from, until) = (displacement_time[0], displacement_time[displacement_time.len() - 1]);
        let inside = |time: &f64| (from..=until).contains(time);
        let (first, last) = (force_time.partition_point(|t| *t < from), force_time.partition_point(|t| *t <= until));
        if last < first + 2 {
            return Err(RecordError::ClocksApart {
                displacement_from: from,
                displacement_until: until,
                force_from: force_time[0],
                force_until: force_time[force_time.len() - 1],
            });
        }
        let time: Vec<f64> = force_time[first..last].iter().copied().filter(inside).collect();
        let displacement = interpolated(displacement_time, &repaired, &time);
        let record = Self::new(time, Some(displacement), force[first..last].to_vec())?;
        let column = Column::Displacement;
        let replaced = (count > 0).then_some(Correction::DropoutsReplaced { column, count });
        let left_out = force_time.len() - (last - first);
        Ok(record.corrected_before(replaced).followed_by(Correction::ClocksJoined { left_out }))
    }

    /// The record with a force that was stamped `skew` seconds too late moved to where it belongs.
    ///
    /// F(t + skew), interpolated linearly at the times of the displacement; rows for which no force is left go.
    ///
    /// # Errors
    /// [`RecordError::NotFinite`] for a skew that is no number, [`RecordError::TooShort`] for one as long as the record.
    ///
    /// ```
    /// use palpate::record::Record;
    /// let record = Record::new(vec![0.0, 1.0, 2.0], Some(vec![0.0, 5.0, 5.0]), vec![0.0, 1.0, 3.0])?;
    /// let moved = record.without_skew(0.5, None)?;
    /// assert_eq!((moved.time(), moved.force()), ([0.0, 1.0].as_slice(), [0.5, 2.0].as_slice()));
    /// # Ok::<(), palpate::record::RecordError>(())
    /// ```
    pub fn without_skew(&self, skew: f64, standard_error: Option<f64>) -> Result<Self, RecordError> {
        checks::finite("skew", &[skew])?;
        let (from, until) = (self.time[0], self.time[self.len() - 1]);
        let first = self.time.partition_point(|t| t + skew < from);
        let last = self.time.partition_point(|t| t + skew <= until);
        checks::long_enough(last.saturating_sub(first))?;
        let time = self.time[first..last].to_vec();
        let shifted: Vec<f64> = time.iter().map(|t| t + skew).collect();
        let force = interpolated(&self.time, &self.force, &shifted);
        let done = Correction::SkewRemoved {
            skew,
            standard_error,
            left_out: self.len() - (last - first),
        };
        self.with(time, self.displacement().map(|d| d[first..last].to_vec()), force, done)
    }
}
