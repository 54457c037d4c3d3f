//! What a filter of first order in the channel of the force took away.

use crate::record::{Correction, Record, RecordError, checks};
use crate::statistics::slope;

/// Half the stretch over which the slope of the force is taken, as a share of the time constant.
const STRETCH: f64 = 0.1;
/// Most samples on either side that a slope is taken of; of more, evenly chosen ones.
const MOST: usize = 32;

impl Record {
    /// The record with the force F = y + τ dy/dt before a filter of first order with time constant τ (s), which recorded y.
    ///
    /// dy/dt is the slope of a line by least squares through the samples within τ/10 on either side, the next ones at least. Where the rate of
    /// the force jumps by s, as at first touch, the result is off by up to s/4 times the distance of these samples. White noise grows by the factor
    /// √(1 + τ²/Σ(t − t̄)²), with the sum over the samples of a line.
    ///
    /// ```
    /// use palpate::record::Record;
    /// // A force that rises at 10 N/s lags by 10 N/s · 0.2 s behind the filter.
    /// let time: Vec<f64> = (0..50).map(|i| 0.1 * f64::from(i)).collect();
    /// let recorded = time.iter().map(|t| 10.0 * t - 2.0).collect();
    /// let record = Record::new(time, None, recorded)?.without_filter(0.2)?;
    /// assert!((record.force()[30] - 30.0).abs() < 1e-12);
    /// # Ok::<(), palpate::record::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// [`RecordError::NotFinite`] for a time constant that is no number, [`RecordError::TimeConstant`] for one that is not positive or as long as
    /// the record.
    pub fn without_filter(&self, time_constant_s: f64) -> Result<Self, RecordError> {
        checks::finite("time constant", &[time_constant_s])?;
        let lasts = self.time[self.len() - 1] - self.time[0];
        if time_constant_s <= 0.0 || time_constant_s >= lasts {
            return Err(RecordError::TimeConstant {
                found: time_constant_s,
                lasts,
            });
        }
        let rate = |index: usize| self.force_rate(index, STRETCH * time_constant_s);
        let force = (0..self.len()).map(|index| self.force[index] + time_constant_s * rate(index)).collect();
        let time_constant = time_constant_s;
        self.with_force(force, Correction::FilterRemoved { time_constant })
    }

    /// Slope (N/s) of the force at a sample, from as many samples on either side within `stretch` (s); at the ends of the record to the next one.
    fn force_rate(&self, index: usize, stretch: f64) -> f64 {
        let (time, last) = (&self.time, self.len() - 1);
        let from = time.partition_point(|t| *t < time[index] - stretch).min(index.saturating_sub(1));
        let until = time.partition_point(|t| *t <= time[index] + stretch).max((index + 2).min(last + 1));
        let beside = (index - from).min(until - 1 - index);
        let every = beside.div_ceil(MOST).max(1);
        let beside = beside / every * every;
        let (from, until) =
            if beside > 0 { (index - beside, index + beside) } else { (index.min(last - 1), index.max(1)) };
        let chosen = (from..=until).step_by(every);
        let (times, forces): (Vec<f64>, Vec<f64>) = chosen.map(|i| (time[i], self.force[i])).unzip();
        slope(&times, &forces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rises(rate: f64, count: usize) -> Record {
        let time: Vec<f64> = (0..count).map(|i| i as f64 / rate).collect();
        let force = time.iter().map(|t| 3.0 * t).collect();
        Record::new(time, None, force).unwrap()
    }

    #[test]
    fn ends_and_short_records_have_a_slope() {
        for (rate, count) in [(1.0, 2), (1.0, 3), (10.0, 7), (1e3, 5000)] {
            let record = rises(rate, count);
            let corrected = record.without_filter(0.9 / rate).unwrap();
            for (filtered, force) in record.force().iter().zip(corrected.force()) {
                assert!((force - filtered - 2.7 / rate).abs() < 1e-9, "{rate} {count}: {force} {filtered}");
            }
        }
    }

    #[test]
    fn time_constants_that_are_none_are_refused() {
        for found in [0.0, -1.0, 5.0] {
            let refused = rises(1.0, 5).without_filter(found);
            assert!(matches!(refused, Err(RecordError::TimeConstant { .. })), "{refused:?}");
        }
        assert!(matches!(rises(1.0, 5).without_filter(f64::NAN), Err(RecordError::NotFinite { .. })));
    }
}
