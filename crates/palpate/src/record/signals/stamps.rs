//! Time stamps: how often, how evenly, and what is wrong with them.

use serde::{Deserialize, Serialize};

use crate::statistics::quantile;

/// What time stamps are like, in the order in which they were written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Stamps {
    /// Number of stamps.
    pub rows: usize,
    /// Stamps that are not finite; they are skipped.
    pub not_finite: usize,
    /// Time between stamps that rise; `None` where none does.
    pub interval: Option<SampleInterval>,
    /// Stretches without samples.
    pub gaps: Gaps,
    /// Stamps equal to the one before.
    pub repeated: usize,
    /// Stamps before the one before.
    pub reversals: Reversals,
}

/// Time between neighbouring stamps, s, without those that repeat or step back.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SampleInterval {
    /// Median, s.
    pub median: f64,
    /// A share of 5 % is shorter, s.
    pub p5: f64,
    /// A share of 5 % is longer, s.
    pub p95: f64,
    /// Whether `p95` and `p5` differ by more than a tenth of the median.
    pub irregular: bool,
}

/// Stretches without samples: intervals over five times as long as those around them.
///
/// Those around decide, not the median, so that neither sampling ever more slowly nor a change of rate counts as a gap.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Gaps {
    /// How many.
    pub count: usize,
    /// The longest, s; 0 without any.
    pub longest: f64,
    /// Row before the longest, from 0.
    pub row: Option<usize>,
    /// When the longest begins, s.
    pub from: Option<f64>,
}

/// Stamps that lie before the one before them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Reversals {
    /// How many steps back.
    pub count: usize,
    /// The largest, s.
    pub largest: f64,
    /// Row of the first, from 0.
    pub first_row: Option<usize>,
    /// Rows stamped earlier than some row before them.
    pub late_rows: usize,
}

/// An interval this many times longer than those around it is a gap.
const GAP: f64 = 5.0;
/// Spread of the intervals, as a share of their median, from which on they are irregular.
const IRREGULAR: f64 = 0.1;

impl Stamps {
    /// Examines time stamps, s.
    pub(super) fn of(time: &[f64]) -> Self {
        let finite = || time.iter().enumerate().filter(|(_, t)| t.is_finite());
        let mut repeated = 0;
        let mut reversals = Reversals::default();
        // Row before each rising step, and the step.
        let mut rising: Vec<(usize, f64)> = Vec::with_capacity(time.len().saturating_sub(1));
        let mut latest = f64::NEG_INFINITY;
        for ((before, earlier), (row, later)) in finite().zip(finite().skip(1)) {
            let step = later - earlier;
            latest = latest.max(*earlier);
            reversals.late_rows += usize::from(*later < latest);
            if step > 0.0 {
                rising.push((before, step));
            } else if step == 0.0 {
                repeated += 1;
            } else {
                reversals.count += 1;
                reversals.largest = reversals.largest.max(-step);
                reversals.first_row.get_or_insert(row);
            }
        }
        Self {
            rows: time.len(),
            not_finite: time.len() - finite().count(),
            gaps: gaps(time, &rising),
            interval: interval(&rising),
            repeated,
            reversals,
        }
    }
}

fn interval(rising: &[(usize, f64)]) -> Option<SampleInterval> {
    if rising.is_empty() {
        return None;
    }
    let mut steps: Vec<f64> = rising.iter().map(|(_, step)| *step).collect();
    let [p5, median, p95] = [0.05, 0.5, 0.95].map(|share| quantile(&mut steps, share));
    Some(SampleInterval {
        median,
        p5,
        p95,
        irregular: p95 - p5 > IRREGULAR * median,
    })
}

/// Rows behind which a gap begins, of rising times.
pub(in crate::record) fn gap_rows(time: &[f64]) -> Vec<usize> {
    let rising: Vec<(usize, f64)> = time.windows(2).map(|pair| pair[1] - pair[0]).enumerate().collect();
    long_steps(&rising).map(|(row, _)| row).collect()
}

/// The steps that are gaps, each with the row before it.
fn long_steps(rising: &[(usize, f64)]) -> impl Iterator<Item = (usize, f64)> {
    rising.iter().enumerate().filter_map(|(place, &(row, step))| {
        let around = place.saturating_sub(2)..(place + 3).min(rising.len());
        let (mut others, mut count) = ([0.0; 4], 0);
        for other in around.filter(|other| *other != place) {
            others[count] = rising[other].1;
            count += 1;
        }
        let others = &mut others[..count];
        // Most steps are no longer than any around them, and millions of rows are examined.
        if count < 2 || others.iter().all(|other| step <= GAP * other) {
            return None;
        }
        others.sort_by(f64::total_cmp);
        // The upper of the middle ones: at a change of rate two of four neighbours have the new one.
        (step > GAP * others[count / 2]).then_some((row, step))
    })
}

fn gaps(time: &[f64], rising: &[(usize, f64)]) -> Gaps {
    let mut gaps = Gaps::default();
    for (row, step) in long_steps(rising) {
        gaps.count += 1;
        if step > gaps.longest {
            (gaps.longest, gaps.row, gaps.from) = (step, Some(row), Some(time[row]));
        }
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_stamps_have_nothing_to_report() {
        let time: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
        let stamps = Stamps::of(&time);
        let interval = stamps.interval.unwrap();
        assert!((interval.median - 0.01).abs() < 1e-12 && !interval.irregular);
        assert_eq!((stamps.gaps.count, stamps.repeated, stamps.reversals.count), (0, 0, 0));
    }

    #[test]
    fn gaps_are_reported_from_slower_sampling() {
        let logarithmic: Vec<f64> = (0..200).map(|i| 1.05f64.powi(i)).collect();
        assert_eq!(Stamps::of(&logarithmic).gaps.count, 0);
        assert!(Stamps::of(&logarithmic).interval.unwrap().irregular);
        let two_rates: Vec<f64> =
            (0..100).map(f64::from).chain((0..100).map(|i| 100.0 + 50.0 * f64::from(i))).collect();
        assert_eq!(Stamps::of(&two_rates).gaps.count, 0);
        let gap = |i: u32| f64::from(i) + if i > 40 { 7.5 } else { 0.0 } + if i > 41 { 20.0 } else { 0.0 };
        let gaps = Stamps::of(&(0..100).map(gap).collect::<Vec<_>>()).gaps;
        assert_eq!((gaps.count, gaps.longest, gaps.row, gaps.from), (2, 21.0, Some(41), Some(48.5)));
    }

    #[test]
    fn repeated_and_reversed_stamps_are_counted() {
        let stamps = Stamps::of(&[0.0, 1.0, 1.0, 2.0, 5.0, 3.0, 4.0, 6.0, f64::NAN, 7.0]);
        assert_eq!((stamps.rows, stamps.not_finite, stamps.repeated), (10, 1, 1));
        let reversals = stamps.reversals;
        assert_eq!((reversals.count, reversals.largest, reversals.first_row), (1, 2.0, Some(5)));
        assert_eq!(reversals.late_rows, 2);
    }

    #[test]
    fn few_stamps_do_no_harm() {
        for time in [&[][..], &[1.0], &[1.0, 1.0], &[f64::NAN], &[2.0, 1.0]] {
            let stamps = Stamps::of(time);
            assert_eq!((stamps.rows, stamps.gaps.count), (time.len(), 0));
            assert!(stamps.interval.is_none());
        }
    }
}
