//! Rows that strayed, put on the line between their neighbours.

use std::borrow::Cow;
use std::ops::Range;

use crate::record::signals::{Astray, bridge, runs_of};
use crate::record::{Column, Correction, Record};

impl Record {
    /// The record without dropouts, which are put on the line between their neighbours.
    ///
    /// These are rows that no sensor measured: tens of times larger than the others, such as 9999 or 2³¹ − 1, alone or a few
    /// together. In the displacement rows that stray alone are dropouts too; in the force only if they are zero exactly: a force may jump by itself, and a
    /// peak of one row is no dropout.
    #[must_use]
    pub fn repaired(&self) -> Self {
        let mut record = self.clone();
        let strays = record.displacement.as_mut().map_or(0, |displacement| repair(displacement, |_| true));
        let lost = repair(&mut record.force, |value| value == 0.0);
        let done = [(Column::Displacement, strays), (Column::Force, lost)].into_iter().filter(|(_, count)| *count > 0);
        record
            .corrections
            .extend(done.map(|(column, count)| Correction::DropoutsReplaced { column, count }));
        record
    }

    /// The record in which phases are searched, and the runs that are not in it: a few rows of the force that stray by themselves say nothing of what is
    /// held. Nothing else has them replaced.
    pub(crate) fn without_strays(&self) -> (Cow<'_, Self>, Vec<Range<usize>>) {
        let runs = self.displacement().map_or_else(Vec::new, |jaw| Astray::of_force(&self.force, Some(jaw)).runs);
        if runs.is_empty() {
            return (Cow::Borrowed(self), runs);
        }
        let mut record = self.clone();
        bridge(&mut record.force, &runs);
        (Cow::Owned(record), runs)
    }
}

/// Repairs the rows of values that no sensor measured, and those that stray alone with a value that is a `dropout`; how many there were.
pub(super) fn repair(values: &mut [f64], dropout: impl Fn(f64) -> bool) -> usize {
    let rows = Astray::of(values).those(|run| run.len() == 1 && dropout(values[run.start]));
    bridge(values, &runs_of(&rows));
    rows.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::RecordError;

    #[test]
    fn a_single_row_of_zero_in_a_hold_is_repaired_and_counted() {
        let mut displacement = [0.0, 2.0, 4.0, 4.0, 0.0, 4.0, 4.0, 4.0];
        assert_eq!(repair(&mut displacement, |_| true), 1);
        assert_eq!(displacement, [0.0, 2.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0]);
        let mut ramp: Vec<f64> = (0..20).map(f64::from).collect();
        assert_eq!(repair(&mut ramp, |_| true), 0);
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
