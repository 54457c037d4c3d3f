//! Resampling.

use std::ops::Range;

use crate::record::signals::gap_rows;
use crate::record::{Correction, Record, RecordError};
use crate::statistics::interpolated;

/// Most rows that a record may be resampled to.
const MOST: f64 = 1e8;

impl Record {
    /// The record at `rate` samples a second (Hz), from its first sample on.
    ///
    /// Where the new samples are closer than those of the record, or about as close, values are interpolated linearly.
    /// Where they are coarser (by half or more) each is the mean of the straight-line record over one new interval about
    /// its time, so that what is faster than the new rate is averaged and not folded back; a straight line stays one.
    /// Gaps of the record that are longer than the new interval stay gaps: nothing was measured there.
    ///
    /// # Errors
    /// [`RecordError::Rate`] for a rate that is not above zero, or that makes fewer than two rows or more than 10⁸;
    /// [`RecordError::ConstantForce`] if averaging leaves no change.
    ///
    /// ```
    /// use palpate::record::Record;
    /// let record = Record::new(vec![0.0, 0.3, 1.0], None, vec![0.0, 3.0, 10.0])?;
    /// assert_eq!(record.resampled(2.0)?.force(), [0.0, 5.0, 10.0]);
    /// # Ok::<(), palpate::record::RecordError>(())
    /// ```
    pub fn resampled(&self, rate: f64) -> Result<Self, RecordError> {
        let (start, end) = (self.time[0], self.time[self.len() - 1]);
        // A last sample that rounding puts just beyond the end still counts.
        let intervals = ((end - start) * rate * (1.0 + 1e-12)).floor();
        if !(rate > 0.0 && (1.0..MOST).contains(&intervals)) {
            return Err(RecordError::Rate {
                rate,
                duration: end - start,
            });
        }
        let before = self.sample_interval();
        let averaged = 1.0 / rate > 1.5 * before;
        let grid: Vec<f64> = (0..=intervals as usize).map(|i| (start + i as f64 / rate).min(end)).collect();
        let (mut times, mut displacement, mut force) = (Vec::new(), Vec::new(), Vec::new());
        for rows in self.stretches(1.0 / rate) {
            let (from, until) = (self.time[rows.start], self.time[rows.end - 1]);
            let inside = grid.partition_point(|t| *t < from)..grid.partition_point(|t| *t <= until);
            let (knots, inside) = (&self.time[rows.clone()], &grid[inside]);
            let column =
                |values: &[f64]| resampled(knots, &values[rows.clone()], inside, averaged.then_some(0.5 / rate));
            times.extend_from_slice(inside);
            displacement.extend(self.displacement().map(column).unwrap_or_default());
            force.extend(column(&self.force));
        }
        let done = Correction::Resampled {
            rate,
            interval: before,
            averaged,
        };
        self.with(times, self.displacement().map(|_| displacement), force, done)
    }

    /// The rows between the gaps that are longer than `interval`.
    fn stretches(&self, interval: f64) -> Vec<Range<usize>> {
        let mut starts = vec![0];
        let gaps = gap_rows(&self.time).into_iter();
        starts.extend(gaps.filter(|row| self.time[row + 1] - self.time[*row] > interval).map(|row| row + 1));
        starts.push(self.len());
        starts.windows(2).map(|pair| pair[0]..pair[1]).collect()
    }
}

/// The straight-line curve through `knots` at `times`, or its means within `half` of them.
fn resampled(knots: &[f64], values: &[f64], times: &[f64], half: Option<f64>) -> Vec<f64> {
    match half {
        // One row between two gaps has no line.
        _ if knots.len() < 2 => vec![values[0]; times.len()],
        Some(half) => block_means(knots, values, times, half),
        None => interpolated(knots, values, times),
    }
}

/// Means of the straight-line curve through `knots` within `half` of each of the `times`; at the ends over what there is,
/// on both sides alike.
fn block_means(knots: &[f64], values: &[f64], times: &[f64], half: f64) -> Vec<f64> {
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let reach = |time: &f64| half.min(time - first).min(last - time);
    let lower = times.iter().map(|time| time - reach(time)).collect::<Vec<_>>();
    let upper = times.iter().map(|time| time + reach(time)).collect::<Vec<_>>();
    let (below, above) = (integrals(knots, values, &lower), integrals(knots, values, &upper));
    let at = interpolated(knots, values, times);
    (0..times.len())
        .map(|i| {
            let width = upper[i] - lower[i];
            // The first and the last sample have no width.
            if width > 1e-9 * half { (above[i] - below[i]) / width } else { at[i] }
        })
        .collect()
}

/// Integrals of the straight-line curve less its first value, from its first knot to rising `times`, trapezoid by trapezoid;
/// the first value times the way is added back.
fn integrals(knots: &[f64], values: &[f64], times: &[f64]) -> Vec<f64> {
    let zero = values[0];
    let (mut knot, mut sum) = (0, 0.0);
    let trapezoid = |knot: usize, until: f64| {
        let (t0, t1) = (knots[knot], knots[knot + 1]);
        let (y0, y1) = (values[knot] - zero, values[knot + 1] - zero);
        let end = y0 + (y1 - y0) * (until - t0) / (t1 - t0);
        0.5 * (y0 + end) * (until - t0)
    };
    let until = |time: &f64| {
        while knot + 2 < knots.len() && knots[knot + 1] < *time {
            sum += trapezoid(knot, knots[knot + 1]);
            knot += 1;
        }
        sum + trapezoid(knot, *time) + zero * (time - knots[0])
    };
    times.iter().map(until).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
        }
    }

    #[test]
    fn a_straight_line_stays_one() {
        let time: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i) + 0.003 * f64::from(i * i % 3)).collect();
        let force: Vec<f64> = time.iter().map(|t| 5.0 - 2.0 * t).collect();
        let record = Record::new(time, Some(force.clone()), force).unwrap();
        for rate in [7.0, 30.0, 100.0, 1000.0] {
            let other = record.resampled(rate).unwrap();
            let expected: Vec<f64> = other.time().iter().map(|t| 5.0 - 2.0 * t).collect();
            close(other.force(), &expected);
            close(other.displacement().unwrap(), &expected);
            let steps = other.time().windows(2).map(|pair| pair[1] - pair[0]);
            assert!(steps.into_iter().all(|step| (step * rate - 1.0).abs() < 1e-9));
        }
    }

    /// A line through 7 s without samples was fitted as if it had been measured.
    #[test]
    fn gaps_stay_gaps() {
        let time: Vec<f64> = (0..400).map(|i| 0.05 * f64::from(i) + if i >= 200 { 7.0 } else { 0.0 }).collect();
        let force: Vec<f64> = time.iter().map(|t| 5.0 + (-t / 3.0).exp()).collect();
        let record = Record::new(time, Some(force.clone()), force).unwrap();
        for (rate, rows) in [(100.0, 996 + 996), (10.0, 100 + 100)] {
            let other = record.resampled(rate).unwrap();
            let steps: Vec<f64> = other.time().windows(2).map(|pair| pair[1] - pair[0]).collect();
            let long: Vec<f64> = steps.into_iter().filter(|step| *step > 1.5 / rate).collect();
            assert!(matches!(long[..], [gap] if (7.0..7.3).contains(&gap)), "{long:?}");
            assert_eq!(other.len(), rows);
            assert!(other.displacement() == Some(other.force()));
            let off = other.time().iter().zip(other.force()).map(|(t, f)| (f - 5.0 - (-t / 3.0).exp()).abs());
            assert!(off.fold(0.0, f64::max) < 3e-4);
        }
        // An interval as long as the gap leaves none.
        let steps = record.resampled(0.1).unwrap().time().windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        assert!(steps < 10.01);
    }

    #[test]
    fn coarser_samples_do_not_fold_back_what_is_faster() {
        let time: Vec<f64> = (0..10_000).map(|i| 1e-3 * f64::from(i)).collect();
        // 49 Hz sampled at 50 Hz would look like 1 Hz.
        let force: Vec<f64> = time.iter().map(|t| t + (std::f64::consts::TAU * 49.0 * t).sin()).collect();
        let record = Record::new(time, None, force).unwrap();
        let other = record.resampled(50.0).unwrap();
        let inner = &other.force()[1..other.len() - 1];
        let off = inner.iter().zip(&other.time()[1..]).map(|(f, t)| (f - t).abs()).fold(0.0, f64::max);
        assert!(off < 0.05, "{off}");
        assert!(matches!(other.corrections(), [Correction::Resampled { averaged: true, .. }]));
        assert!(matches!(
            record.resampled(2000.0).unwrap().corrections(),
            [Correction::Resampled { averaged: false, .. }]
        ));
    }

    #[test]
    fn rates_that_make_no_record_are_refused() {
        let record = Record::new(vec![0.0, 1.0, 2.0], None, vec![0.0, 1.0, 0.5]).unwrap();
        for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 0.4, 1e9] {
            assert!(matches!(record.resampled(rate), Err(RecordError::Rate { .. })), "{rate}");
        }
        let error = record.resampled(0.1).unwrap_err().to_string();
        assert_eq!(error, "0.1 samples per second over 2 s give no valid record: expected 2 to 100000000 rows");
    }
}
