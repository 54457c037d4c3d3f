//! Where a second record follows in one test: whether its displacement counts from the zero of the first.

use crate::analysis::Finding;
use crate::record::{Correction, Record};
use crate::statistics::{bounds, median, range};

/// Share of the travel by which the displacement changes at the seam, at least.
const JUMP: f64 = 0.1;
/// How many times as fast as anywhere else the jaw would have moved there.
const FASTER: f64 = 5.0;
/// Share of the range of the force above its least that is loaded.
const LOADED: f64 = 0.1;
/// Part of the same share of its range by which the force changes at most.
const GOES_ON: f64 = 0.25;
/// Rows on either side that the force is the median of.
const BESIDE: usize = 3;

/// [`Finding::ContinuedApart`] where the displacement changes at once as a second record begins, and the force of a loaded body goes on.
pub(super) fn continued_apart(record: &Record) -> Vec<Finding> {
    let starts = record.corrections().iter().filter_map(|done| match done {
        Correction::Continued { from, .. } => Some(*from),
        _ => None,
    });
    starts.filter_map(|from| apart_at(record, from)).collect()
}

fn apart_at(record: &Record, from: f64) -> Option<Finding> {
    let (time, force, displacement) = (record.time(), record.force(), record.displacement()?);
    let next = time.partition_point(|time| *time < from);
    let last = next.checked_sub(1)?;
    let (travel, (least, most)) = (range(displacement), bounds(force));
    let pressed = most - least;
    let jump = displacement.get(next)? - displacement[last];
    let speed = |row: usize| (displacement[row + 1] - displacement[row]).abs() / (time[row + 1] - time[row]);
    let elsewhere = (0..time.len() - 1).filter(|row| *row != last).map(speed).fold(0.0, f64::max);
    let beside = |rows: std::ops::Range<usize>| median(&mut force[rows].to_vec());
    let before = beside(next.saturating_sub(BESIDE)..next);
    let after = beside(next..(next + BESIDE).min(force.len()));
    let is_loaded = before.min(after) - least > LOADED * pressed;
    let goes_on = (after - before).abs() < GOES_ON * jump.abs() / travel * pressed;
    let apart = jump.abs() > JUMP * travel && speed(last) > FASTER * elsewhere && is_loaded && goes_on;
    apart.then(|| Finding::ContinuedApart {
        time: time[next],
        before: displacement[last],
        after: displacement[next],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp and its hold, cut in two where `cut` says (s), with displacements of the second shifted.
    fn continued(cut: f64, shift: f64) -> Vec<Finding> {
        let time: Vec<f64> = (0..600).map(|i| 0.02 * f64::from(i)).collect();
        let displacement: Vec<f64> = time.iter().map(|t| 2e-3 * t.min(2.0)).collect();
        let force = time.iter().zip(&displacement).map(|(t, d)| 1e4 * d * (0.7 + 0.3 * (-(t - 2.0).max(0.0)).exp()));
        let force: Vec<f64> = force.collect();
        let row = time.partition_point(|time| *time < cut);
        let part = |rows: std::ops::Range<usize>, shift: f64| {
            let displacement = displacement[rows.clone()].iter().map(|d| d + shift).collect();
            let time = time[rows.clone()].iter().map(|at| at - time[rows.start]).collect();
            Record::new(time, Some(displacement), force[rows].to_vec()).unwrap()
        };
        continued_apart(&part(0..row, 0.0).then(&part(row..time.len(), shift), None).unwrap())
    }

    /// A hold in a second file whose displacement was set to zero anew went without a word: the jaw had let go of a loaded body.
    #[test]
    fn a_second_record_with_a_zero_of_its_own_is_stated() {
        let found = continued(1.98, -3.96e-3);
        let [Finding::ContinuedApart { time, before, after }] = found[..] else {
            panic!("{found:?}");
        };
        assert!((time - 1.98).abs() < 0.03 && (before - 3.96e-3).abs() < 5e-5 && after.abs() < 5e-5, "{found:?}");
        assert_eq!(continued(1.98, 50e-3).len(), 1);
        for (cut, shift) in [(1.98, 0.0), (1.0, 0.0), (6.0, 0.0), (1.98, -1e-4)] {
            assert_eq!(continued(cut, shift), [], "{cut} {shift}");
        }
    }

    #[test]
    fn what_the_body_shows_as_well_or_where_nothing_touches_is_no_other_zero() {
        let joined = |first: (Vec<f64>, Vec<f64>), second: (Vec<f64>, Vec<f64>)| {
            let record = |(displacement, force): (Vec<f64>, Vec<f64>)| {
                let time = (0..displacement.len()).map(|i| 0.1 * i as f64).collect();
                Record::new(time, Some(displacement), force).unwrap()
            };
            continued_apart(&record(first).then(&record(second), None).unwrap())
        };
        let ramp = |from: f64, to: f64| (0..50).map(|i| from + (to - from) * f64::from(i) / 49.0).collect::<Vec<f64>>();
        // The jaw was withdrawn, and the force fell with it.
        let loaded = (ramp(0.0, 4e-3), ramp(0.0, 40.0));
        assert_eq!(joined(loaded.clone(), (ramp(1e-3, 4e-3), ramp(10.0, 40.0))), []);
        // An approach through air, less recorded than it was long.
        assert_eq!(joined((ramp(0.0, 1e-3), ramp(0.0, 0.01)), (ramp(5e-3, 9e-3), ramp(0.0, 40.0))), []);
        assert_eq!(joined(loaded, (ramp(0.0, 1e-3), ramp(40.0, 50.0))).len(), 1);
    }
}
