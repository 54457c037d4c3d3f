//! Single rows that strayed, replaced by the mean of their neighbours.

use crate::record::correction::{Column, Correction};
use crate::record::measured::Record;
use crate::record::signals::{lost_rows, stray_rows};

impl Record {
    /// The record with single-row dropouts replaced by the mean of their neighbours, and how many there were.
    ///
    /// In the displacement these are rows that stray alone. In the force they must be zero exactly as well, or many times farther off
    /// than all other rows reach: a force may jump by itself, and a peak of one row is no dropout.
    #[must_use]
    pub fn repaired(&self) -> (Self, usize) {
        let mut record = self.clone();
        let mut total = 0;
        if let Some(displacement) = self.displacement() {
            let (repaired, count) = without_dropouts(displacement);
            if count > 0 {
                record.displacement = Some(repaired);
                record = record.followed_by(Correction::DropoutsReplaced {
                    column: Column::Displacement,
                    count,
                });
            }
            total += count;
        }
        let lost = lost_rows(&self.force);
        if !lost.is_empty() {
            record.force = replaced(&self.force, &lost);
            record = record.followed_by(Correction::DropoutsReplaced {
                column: Column::Force,
                count: lost.len(),
            });
        }
        (record, total + lost.len())
    }
}

/// The values with rows that stray alone replaced by the mean of their neighbours, and how many there were.
pub(super) fn without_dropouts(values: &[f64]) -> (Vec<f64>, usize) {
    let rows = stray_rows(values);
    (replaced(values, &rows), rows.len())
}

/// Values whose `rows` (rising, none at an end) are the mean of their neighbours.
fn replaced(values: &[f64], rows: &[usize]) -> Vec<f64> {
    let mut repaired = values.to_vec();
    for &row in rows {
        repaired[row] = 0.5 * (repaired[row - 1] + repaired[row + 1]);
    }
    repaired
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::RecordError;

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
    fn a_force_of_one_row_is_a_dropout_only_if_it_is_zero() {
        let time: Vec<f64> = (0..9).map(f64::from).collect();
        let record = |force: [f64; 9]| Record::new(time.clone(), None, force.to_vec()).unwrap();
        let (repaired, count) = record([0.0, 2.0, 4.0, 3.9, 0.0, 3.7, 3.6, 3.5, 3.5]).repaired();
        assert_eq!((count, repaired.force()[4]), (1, 3.8));
        let done = Correction::DropoutsReplaced {
            column: Column::Force,
            count: 1,
        };
        assert_eq!(repaired.corrections(), [done]);
        let peak = record([0.0, 1.0, 1.0, 3.0, 1.05, 1.0, 1.0, 1.0, 1.0]);
        assert_eq!(peak.repaired(), (peak.clone(), 0));
        // The largest whole number of 32 bits beside a dropout: fits had an equilibrium of 3 ± 3 MN.
        let (repaired, count) = record([0.0, 2.0, 4.0, 2_147_483_647.0, 3.9, 0.0, 3.7, 3.6, 3.5]).repaired();
        assert_eq!((count, repaired.force()[3], repaired.force()[5]), (2, 3.95, 3.8));
        let none = Record::new(vec![0.0, 1.0, 2.0], None, vec![0.0, 9.91e37, 2.0]).unwrap_err();
        assert!(matches!(none, RecordError::NoMeasurement { row: 1, .. }), "{none}");
    }
}
