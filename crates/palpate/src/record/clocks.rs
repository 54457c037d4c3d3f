//! Force and displacement with time stamps of their own.

use super::{Record, RecordError, checks};

impl Record {
    /// A record whose displacement has time stamps of its own, brought onto the times of the force.
    ///
    /// The displacement is interpolated linearly at every force time that lies inside its own stamps; force samples
    /// outside them are left out. Single-row dropouts of the displacement are repaired first, so that none is smeared.
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
        let (repaired, _) = super::corrections::without_dropouts(displacement);
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
        Self::new(time, Some(displacement), force[first..last].to_vec())
    }
}

/// `values` given at rising `knots`, linearly interpolated at rising `times` that lie inside them.
pub(super) fn interpolated(knots: &[f64], values: &[f64], times: &[f64]) -> Vec<f64> {
    let mut after = 1;
    let at = |time: f64| {
        while after + 1 < knots.len() && knots[after] < time {
            after += 1;
        }
        let (t0, t1) = (knots[after - 1], knots[after]);
        let share = ((time - t0) / (t1 - t0)).clamp(0.0, 1.0);
        values[after - 1] + share * (values[after] - values[after - 1])
    };
    times.iter().copied().map(at).collect()
}
