//! A record that goes on in a second one: the ramp of a test in one file, its hold in another.

use crate::record::{Correction, LabelledSegment, Record, RecordError};

impl Record {
    /// This record followed by `next`, of the same test on the same machine: places and forces of both count from the same zero.
    ///
    /// `start` (s) is when the clock of `next` was at zero by the clock of this record, where that is known. Else, a `next` that begins
    /// after the end of this record has the same clock, and its times stay; one that begins earlier has a clock of its own, and its first
    /// sample is taken to come one sample interval after the last of this record.
    ///
    /// ```
    /// use palpate::record::Record;
    /// let ramp = Record::new(vec![0.0, 0.5, 1.0], Some(vec![0.0, 1e-3, 2e-3]), vec![0.0, 1.0, 2.0])?;
    /// let hold = Record::new(vec![0.0, 0.5, 1.0], Some(vec![2e-3; 3]), vec![1.9, 1.8, 1.7])?;
    /// let test = ramp.then(&hold, None)?;
    /// assert_eq!(test.time(), [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]);
    /// // On the clock of the ramp nothing is moved.
    /// let hold = Record::new(vec![1.25, 1.75, 2.25], Some(vec![2e-3; 3]), vec![1.9, 1.8, 1.7])?;
    /// assert_eq!(ramp.then(&hold, None)?.time()[3], 1.25);
    /// # Ok::<(), palpate::record::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// [`RecordError::ContinuedWithout`] where one of the two has a displacement and the other none, [`RecordError::TimeNotRising`] where
    /// `start` lets the second begin before the end of the first.
    pub fn then(&self, next: &Self, start: Option<f64>) -> Result<Self, RecordError> {
        let last = self.time[self.len() - 1];
        let shift = match start {
            Some(start) => start,
            None if next.time[0] > last => 0.0,
            None => last + self.sample_interval() - next.time[0],
        };
        let joined = |first: &[f64], second: &[f64]| [first, second].concat();
        let displacement = match (self.displacement(), next.displacement()) {
            (Some(first), Some(second)) => Some(joined(first, second)),
            (None, None) => None,
            (first, _) => {
                return Err(RecordError::ContinuedWithout {
                    without: if first.is_some() { "second" } else { "first" },
                });
            }
        };
        let moved: Vec<f64> = next.time.iter().map(|time| time + shift).collect();
        let from = moved[0];
        let done = next.corrections.iter().cloned().chain([Correction::Continued {
            from,
            gap: from - last,
            shift,
        }]);
        let labels = next.labels.iter().map(|label| LabelledSegment {
            from: label.from + shift,
            to: label.to + shift,
            ..label.clone()
        });
        let record = Self::new(joined(&self.time, &moved), displacement, joined(&self.force, &next.force))?;
        Ok(record
            .labelled(self.labels.iter().cloned().chain(labels).collect())
            .corrected_before(self.corrections.iter().cloned().chain(done)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_follow_is_refused() {
        let with = Record::new(vec![0.0, 1.0], Some(vec![0.0, 1.0]), vec![0.0, 1.0]).unwrap();
        let without = Record::new(vec![0.0, 1.0], None, vec![0.0, 1.0]).unwrap();
        let refused = with.then(&without, None);
        assert!(matches!(refused, Err(RecordError::ContinuedWithout { without: "second" })), "{refused:?}");
        assert!(matches!(with.then(&with, Some(0.5)), Err(RecordError::TimeNotRising { row: 2, .. })));
    }
}
