//! Columns as a file holds them, before anything is checked.

use std::convert::Infallible;

use super::checks::{self, RecordError};
use super::repair::{Repaired, repaired};
use super::{Clock, Record, SignalReport};

/// Columns in SI as read, without checks or repairs.
///
/// ```
/// use palpate::record::{Correction, RawColumns};
/// let raw = RawColumns {
///     time: vec![0.0, 0.1, 0.1, 0.2],
///     displacement: None,
///     force: vec![0.0, 2.0, 4.0, 2.5],
///     force_time: None,
/// };
/// assert_eq!(raw.report().stamps.repeated, 1);
/// let record = raw.into_record()?;
/// assert_eq!(record.force(), [0.0, 3.0, 2.5]);
/// assert!(matches!(record.corrections(), [Correction::StampsMerged { merged: 1, .. }]));
/// # Ok::<(), palpate::record::RecordError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RawColumns {
    /// Time, s: of all columns, or of the displacement where the force has its own.
    pub time: Vec<f64>,
    /// Displacement, m.
    pub displacement: Option<Vec<f64>>,
    /// Force, N.
    pub force: Vec<f64>,
    /// Time of the force alone, s. Means nothing without a displacement.
    pub force_time: Option<Vec<f64>>,
}

impl RawColumns {
    /// What the columns are like.
    #[must_use]
    pub fn report(&self) -> SignalReport {
        let Ok(report) = self.report_heard(&mut || Ok::<(), Infallible>(()));
        report
    }

    /// The same, where `hear` says in between whether to go on: columns of millions of rows take a second.
    ///
    /// # Errors
    /// What `hear` says.
    pub fn report_heard<E>(&self, hear: &mut dyn FnMut() -> Result<(), E>) -> Result<SignalReport, E> {
        let force_time = self.force_time.as_deref().filter(|_| self.displacement.is_some());
        SignalReport::heard(&self.time, self.displacement.as_deref(), &self.force, force_time, hear)
    }

    /// The record of these columns, with time stamps repaired where that is safe.
    ///
    /// Rows of equal stamps become one with their mean; where at most one row in fifty is stamped earlier than a row
    /// before it, by less than a twentieth of the whole time, rows are put into order. The record says which of it was
    /// done ([`Record::corrections`]).
    ///
    /// # Errors
    /// [`RecordError`] as for [`Record::new`] and [`Record::from_two_clocks`], and for a clock that goes back further.
    pub fn into_record(self) -> Result<Record, RecordError> {
        match (self.displacement, self.force_time) {
            (Some(displacement), Some(force_time)) => {
                let displacement = checked(Clock::Displacement, self.time, vec![("displacement", displacement)])?;
                let force = checked(Clock::Force, force_time, vec![("force", self.force)])?;
                let joined = Record::from_two_clocks(
                    &displacement.time,
                    &displacement.columns[0],
                    &force.time,
                    &force.columns[0],
                )?;
                Ok(joined.corrected_before(displacement.done.into_iter().chain(force.done)))
            }
            (displacement, _) => {
                let columns = displacement.map(|values| ("displacement", values));
                let repaired =
                    checked(Clock::Common, self.time, columns.into_iter().chain([("force", self.force)]).collect())?;
                let mut columns = repaired.columns;
                let force = columns.pop().unwrap_or_default();
                let record = Record::new(repaired.time, columns.pop(), force)?;
                Ok(record.corrected_before(repaired.done))
            }
        }
    }
}

/// Columns of equal lengths and finite numbers with their stamps repaired.
fn checked(clock: Clock, time: Vec<f64>, columns: Vec<(&'static str, Vec<f64>)>) -> Result<Repaired, RecordError> {
    for (name, values) in &columns {
        checks::same_length(time.len(), name, values.len())?;
    }
    checks::long_enough(time.len())?;
    checks::finite("time", &time)?;
    for (name, values) in &columns {
        checks::finite(name, values)?;
    }
    repaired(clock, time, columns.into_iter().map(|(_, values)| values).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Correction;

    fn raw(time: &[f64], force: &[f64]) -> RawColumns {
        RawColumns {
            time: time.to_vec(),
            displacement: None,
            force: force.to_vec(),
            force_time: None,
        }
    }

    #[test]
    fn good_columns_stay_as_they_are() {
        let record = raw(&[0.0, 1.0, 2.0], &[0.0, 3.0, 2.0]).into_record().unwrap();
        assert_eq!(record, Record::new(vec![0.0, 1.0, 2.0], None, vec![0.0, 3.0, 2.0]).unwrap());
        assert!(record.corrections().is_empty());
    }

    #[test]
    fn rows_of_equal_stamps_become_their_mean() {
        let record = raw(&[0.0, 1.0, 1.0, 1.0, 2.0, 2.0], &[5.0, 1.0, 1.0, 4.0, 7.0, 7.0]).into_record().unwrap();
        assert_eq!((record.time(), record.force()), ([0.0, 1.0, 2.0].as_slice(), [5.0, 2.0, 7.0].as_slice()));
        let [
            Correction::StampsMerged {
                rows: 6,
                merged: 3,
                identical: 2,
                clock: Clock::Common,
            },
        ] = record.corrections()
        else {
            panic!("{:?}", record.corrections())
        };
    }

    #[test]
    fn rows_of_a_clock_of_whole_seconds_are_spread_over_them() {
        // Rates of a log with 20 rows a second and stamps in whole seconds were 25 % too low: each second was its mean at its beginning.
        let time: Vec<f64> = (0..90).map(|i| f64::from((i + 13) / 20)).collect();
        let force: Vec<f64> = (0..90).map(|i| f64::from(i * i)).collect();
        let record = raw(&time, &force).into_record().unwrap();
        assert_eq!(record.force(), force);
        let off = |(i, t): (usize, &f64)| (t - 0.05 * (i as f64 + 13.0)).abs();
        assert!(record.time().iter().enumerate().map(off).fold(0.0, f64::max) < 1e-12);
        let [
            Correction::StampsSpread {
                rows: 90, stamps: 6, ..
            },
        ] = record.corrections()
        else {
            panic!("{:?}", record.corrections())
        };
        // Rows that repeat are one sample each, and a clock that skips a second says nothing of those between.
        let rounded: Vec<f64> = force.iter().map(|force| (force / 2000.0).floor()).collect();
        assert_eq!(raw(&time, &rounded).into_record().unwrap().time(), record.time());
        let repeated: Vec<f64> = time.iter().map(|t| t * t).collect();
        let skips: Vec<f64> = time.iter().map(|t| if *t > 2.0 { t + 1.0 } else { *t }).collect();
        for (time, force) in [(&time, &repeated), (&skips, &force)] {
            let record = raw(time, force).into_record().unwrap();
            assert!(matches!(record.corrections(), [Correction::StampsMerged { merged: 84, .. }]));
        }
    }

    /// A buffer of four rows that was written after the next four.
    #[test]
    fn a_swapped_buffer_is_put_into_order() {
        let mut order: Vec<u32> = (0..400).collect();
        order[200..208].rotate_left(4);
        let time: Vec<f64> = order.iter().map(|i| 0.01 * f64::from(*i)).collect();
        let force: Vec<f64> = order.iter().map(|i| f64::from(*i)).collect();
        let record = raw(&time, &force).into_record().unwrap();
        assert_eq!(record.force(), (0..400).map(f64::from).collect::<Vec<_>>());
        let [Correction::StampsSorted { rows, largest, .. }] = record.corrections() else {
            panic!("{:?}", record.corrections())
        };
        assert!(*rows == 4 && (largest - 0.07).abs() < 1e-12);
    }

    /// Shuffled rows of a test that a column names were called several tests that a column should name.
    #[test]
    fn rows_in_no_order_are_to_be_sorted() {
        let time: Vec<f64> = (0..300).map(|i| f64::from(i * 137 % 300)).collect();
        let error = raw(&time, &time).into_record().unwrap_err();
        assert!(
            matches!(
                error,
                RecordError::NotInOrder {
                    row: 3,
                    steps: 136,
                    rows: 300,
                    ..
                }
            ),
            "{error}"
        );
        assert!(error.hint().starts_with("sort the rows by time"), "{}", error.hint());
    }

    #[test]
    fn a_clock_that_starts_again_is_an_error() {
        let time: Vec<f64> = (0..300).map(|i| 0.1 * f64::from(i % 200)).collect();
        let force: Vec<f64> = (0..300).map(f64::from).collect();
        let error = raw(&time, &force).into_record().unwrap_err();
        assert_eq!(error.row(), Some(200));
        assert!(error.to_string().contains("100 of 300 rows"), "{error}");
        assert!(error.hint().contains("restarts"), "{}", error.hint());
        // One stamp that was lost in the middle: nobody knows where the row belongs.
        let mut time: Vec<f64> = (0..300).map(|i| 5.0 + 0.1 * f64::from(i)).collect();
        time[150] = 0.0;
        assert!(matches!(
            raw(&time, &force).into_record(),
            Err(RecordError::ClockGoesBack { row: 150, late: 1, .. })
        ));
        // Few rows leave no room for a slip.
        assert!(raw(&[0.0, 2.0, 1.0], &[0.0, 2.0, 1.0]).into_record().is_err());
    }

    #[test]
    fn a_clock_that_stands_still_is_an_error() {
        let error = raw(&[3.0; 50], &(0..50).map(f64::from).collect::<Vec<_>>()).into_record().unwrap_err();
        assert_eq!(error, RecordError::ClockStands { found: 3.0, rows: 50 });
    }

    #[test]
    fn two_clocks_are_repaired_each() {
        let raw = RawColumns {
            time: vec![0.0, 1.0, 1.0, 2.0, 3.0],
            displacement: Some(vec![0.0, 1.0, 3.0, 4.0, 4.0]),
            force: vec![0.0, 1.0, 3.0, 2.0],
            force_time: Some(vec![-1.0, 0.5, 1.5, 1.5]),
        };
        let record = raw.into_record().unwrap();
        assert_eq!(record.displacement(), Some([1.0, 3.0].as_slice()));
        assert_eq!(record.force(), [1.0, 2.5]);
        let kinds: Vec<Clock> = record
            .corrections()
            .iter()
            .filter_map(|done| if let Correction::StampsMerged { clock, .. } = done { Some(*clock) } else { None })
            .collect();
        assert_eq!(kinds, [Clock::Displacement, Clock::Force]);
        assert!(matches!(record.corrections()[2], Correction::ClocksJoined { left_out: 1 }));
    }
}
