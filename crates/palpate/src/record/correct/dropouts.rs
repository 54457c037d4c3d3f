//! Single rows that strayed, replaced by the mean of their neighbours.

use std::borrow::Cow;

use crate::record::signals::{lost_rows, stray_rows, stray_runs};
use crate::record::{Column, Correction, Record};

impl Record {
    /// The record with single-row dropouts replaced by the mean of their neighbours.
    ///
    /// In the displacement these are rows that stray alone. In the force they must be zero exactly as well, or many times farther off
    /// than all other rows reach: a force may jump by itself, and a peak of one row is no dropout.
    #[must_use]
    pub fn repaired(&self) -> Self {
        let mut record = self.clone();
        let strays = record.displacement.as_mut().map_or(0, |displacement| replace(displacement, stray_rows));
        let lost = replace(&mut record.force, lost_rows);
        let done = [(Column::Displacement, strays), (Column::Force, lost)].into_iter().filter(|(_, count)| *count > 0);
        record
            .corrections
            .extend(done.map(|(column, count)| Correction::DropoutsReplaced { column, count }));
        record
    }
}

impl Record {
    /// The record in which phases are searched: a few rows of the force that stray by themselves say nothing of what is held, and they are not in it.
    /// Nothing else has them replaced.
    pub(crate) fn without_strays(&self) -> Cow<'_, Self> {
        let runs = if self.displacement.is_some() { stray_runs(&self.force) } else { Vec::new() };
        if runs.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut record = self.clone();
        for run in runs {
            let (before, after) = (record.force[run.start - 1], record.force[run.end]);
            record.force[run].fill(0.5 * (before + after));
        }
        Cow::Owned(record)
    }
}

/// Replaces `rows` of values (rising, none at an end) by the mean of their neighbours; how many there were.
pub(super) fn replace(values: &mut [f64], rows: impl Fn(&[f64]) -> Vec<usize>) -> usize {
    let rows = rows(values);
    for &row in &rows {
        values[row] = 0.5 * (values[row - 1] + values[row + 1]);
    }
    rows.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::RecordError;

    #[test]
    fn a_single_row_of_zero_in_a_hold_is_repaired_and_counted() {
        let mut displacement = [0.0, 2.0, 4.0, 4.0, 0.0, 4.0, 4.0, 4.0];
        assert_eq!(replace(&mut displacement, stray_rows), 1);
        assert_eq!(displacement, [0.0, 2.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0]);
        let mut ramp: Vec<f64> = (0..20).map(f64::from).collect();
        assert_eq!(replace(&mut ramp, stray_rows), 0);
    }

    #[test]
    fn a_force_of_one_row_is_a_dropout_only_if_it_is_zero() {
        let time: Vec<f64> = (0..9).map(f64::from).collect();
        let record = |force: [f64; 9]| Record::new(time.clone(), None, force.to_vec()).unwrap();
        let done = |count| Correction::DropoutsReplaced {
            column: Column::Force,
            count,
        };
        let repaired = record([0.0, 2.0, 4.0, 3.9, 0.0, 3.7, 3.6, 3.5, 3.5]).repaired();
        assert_eq!((repaired.force()[4], repaired.corrections()), (3.8, [done(1)].as_slice()));
        let peak = record([0.0, 1.0, 1.0, 3.0, 1.05, 1.0, 1.0, 1.0, 1.0]);
        assert_eq!(peak.repaired(), peak);
        // The largest whole number of 32 bits beside a dropout: fits had an equilibrium of 3 ± 3 MN.
        let repaired = record([0.0, 2.0, 4.0, 2_147_483_647.0, 3.9, 0.0, 3.7, 3.6, 3.5]).repaired();
        assert_eq!(
            (repaired.force()[3], repaired.force()[5], repaired.corrections()),
            (3.95, 3.8, [done(2)].as_slice())
        );
        let none = Record::new(vec![0.0, 1.0, 2.0], None, vec![0.0, 9.91e37, 2.0]).unwrap_err();
        assert!(matches!(none, RecordError::NoMeasurement { row: 1, .. }), "{none}");
    }
}
