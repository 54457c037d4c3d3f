//! A clock that is coarser than the sampling: several rows have the same stamp.

use std::ops::Range;

use crate::statistics::{interpolated, median};

/// Rows by which a row that has a new stamp may lie off the clock of the rows: rounding of stamps moves it by one, jitter of the sampling further.
const OFF: f64 = 1.5;
/// A step between stamps that is longer than so many others is a pause.
const PAUSE: f64 = 1.5;

/// The time between stamps of such a clock, s. `None` where rows rather repeat, or stamps are uneven.
///
/// Stamps are equally far apart, but for a few pauses; a few times only, the number of their rows changes from one to the next by more than a
/// tenth and more than two. As many rows differ where decimals of binary numbers are cut: 100 rows a second and `%.1f` make 9, 10 and 11 a stamp.
pub(super) fn coarse_step(time: &[f64], groups: &[Range<usize>], repeating: usize) -> Option<f64> {
    /// Fewest stamps that say so, and rows of each on average.
    const STAMPS: usize = 5;
    const ROWS: f64 = 1.5;
    const ALIKE: f64 = 1e-6;
    /// Of so many stamps one at least has rows of several values.
    const VARY: usize = 20;
    /// Of so many stamps one at most follows a pause, or a change of the rate.
    const CHANGES: usize = 20;
    let inner = groups.get(1..groups.len() - 1).filter(|inner| inner.len() + 2 >= STAMPS)?;
    let most = inner.iter().map(Range::len).max()?;
    let rows = groups[groups.len() - 1].start - groups[1].start;
    let steps: Vec<f64> = groups.windows(2).map(|pair| time[pair[1].start] - time[pair[0].start]).collect();
    let step = median(&mut steps.clone());
    let is_even = steps.iter().all(|one| (one / step - (one / step).round()).abs() <= ALIKE && *one > 0.5 * step);
    let pauses = steps.iter().filter(|one| **one > PAUSE * step).count();
    let differ = |a: usize, b: usize| a.abs_diff(b) > (a.max(b) / 10).max(2);
    let changes = inner.windows(2).filter(|pair| differ(pair[0].len(), pair[1].len())).count();
    let is_steady = CHANGES * pauses <= steps.len() && CHANGES * changes < inner.len();
    let is_full = rows as f64 >= ROWS * inner.len() as f64
        && [&groups[0], &groups[groups.len() - 1]].iter().all(|edge| edge.len() <= most);
    // In a hold values repeat that were rounded; rows that were written twice repeat all along.
    let is_sampled = (groups.len() - repeating) * VARY >= groups.len();
    (is_even && is_steady && is_full && is_sampled).then_some(step)
}

/// When rows of such a clock were sampled: at a constant rate that changes only where their numbers do, and goes on anew after a pause.
pub(super) fn spread(time: &[f64], groups: &[Range<usize>], step: f64) -> Vec<f64> {
    groups
        .chunk_by(|stamp, next| time[next.start] - time[stamp.start] < PAUSE * step)
        .flat_map(|run| spread_run(time, run, step))
        .collect()
}

/// The same of stamps without a pause between them; the first may have begun before its rows, and the last may not have ended.
fn spread_run(time: &[f64], run: &[Range<usize>], step: f64) -> Vec<f64> {
    let last = run.len() - 1;
    let gate = |index: usize| {
        let beside = run[index].len().max(run[index - 1].len());
        Gate {
            row: run[index].start as f64,
            time: time[run[index].start],
            // The ends are points.
            width: if index == 1 || index == last { 0.0 } else { OFF * step / beside as f64 },
        }
    };
    let single = Gate {
        row: run[0].start as f64,
        time: time[run[0].start],
        width: 0.0,
    };
    let gates: Vec<Gate> = if last == 0 { vec![single] } else { (1..=last).map(gate).collect() };
    let mut knots = straightest(&gates);
    let interval = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
    let full = step / run.iter().map(Range::len).max().unwrap_or(1) as f64;
    let ends = [knots.windows(2).next(), knots.windows(2).last()].map(|pair| pair.map_or(full, interval));
    // Those of the first and the last stamp take no more time than there is.
    let within = |own: f64, stamp: &Range<usize>| own.min(step / (stamp.len() as f64 - 0.5));
    let (first, after) = (within(ends[0], &run[0]), within(ends[1], &run[last]));
    let ([begin, begins], [end, ends]) = (knots[0], knots[knots.len() - 1]);
    let (from, until) = (run[0].start as f64, run[last].end as f64);
    if begin > from {
        knots.insert(0, [from, begins - first * (begin - from)]);
    }
    knots.push([until, ends + after * (until - end)]);
    let [rows, times] = [0, 1].map(|part| knots.iter().map(|knot| knot[part]).collect::<Vec<f64>>());
    let all: Vec<f64> = (run[0].start..run[last].end).map(|row| row as f64).collect();
    interpolated(&rows, &times, &all)
}

/// What a line of time against rows passes at a row: a time, by no more than the width off it.
struct Gate {
    row: f64,
    time: f64,
    width: f64,
}

/// The corners, row and time, of the shortest line through all gates from the first to the last, a taut string: straight as far as it can be.
fn straightest(gates: &[Gate]) -> Vec<[f64; 2]> {
    let mut knots = vec![[gates[0].row, gates[0].time]];
    let mut next = 1;
    while next < gates.len() {
        let [row, time] = knots[knots.len() - 1];
        // The slopes that pass all gates so far, each with the gate that bounds it.
        let (mut least, mut most) = ((f64::NEG_INFINITY, next), (f64::INFINITY, next));
        let mut corner = (gates.len() - 1, 0.0);
        for (index, gate) in gates.iter().enumerate().skip(next) {
            let [low, high] = [-1.0, 1.0].map(|side| (gate.time + side * gate.width - time) / (gate.row - row));
            if low > most.0 || high < least.0 {
                corner = if low > most.0 { (most.1, 1.0) } else { (least.1, -1.0) };
                break;
            }
            if low >= least.0 {
                least = (low, index);
            }
            if high <= most.0 {
                most = (high, index);
            }
        }
        let (at, side) = corner;
        knots.push([gates[at].row, gates[at].time + side * gates[at].width]);
        next = at + 1;
    }
    knots
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    /// The clock of rows sampled at these times, with stamps of this rule; `None` where it is not a coarse one.
    fn found(times: &[f64], stamp: impl Fn(f64) -> f64) -> Option<Vec<f64>> {
        let time: Vec<f64> = times.iter().map(|t| stamp(*t)).collect();
        let starts: Vec<usize> = (0..time.len()).filter(|row| *row == 0 || time[row - 1] < time[*row]).collect();
        let ends = starts.iter().skip(1).copied().chain([time.len()]);
        let groups: Vec<Range<usize>> = starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect();
        coarse_step(&time, &groups, 0).map(|step| spread(&time, &groups, step))
    }

    /// How far times differ at most, in intervals, beyond what all differ by.
    fn farthest(found: &[f64], times: &[f64], interval: f64) -> f64 {
        let off: Vec<f64> = found.iter().zip(times).map(|(found, time)| (found - time) / interval).collect();
        let (low, high) = crate::statistics::bounds(&off);
        0.5 * (high - low)
    }

    fn sampled(rate: f64, rows: usize) -> Vec<f64> {
        (0..rows).map(|row| row as f64 / rate).collect()
    }

    fn printed(time: f64) -> f64 {
        format!("{time:.1}").parse().unwrap()
    }

    fn truncated(time: f64) -> f64 {
        (10.0 * time + 1e-6).floor() / 10.0
    }

    /// 90 % of the rows of such a record were merged.
    #[test]
    fn rows_of_stamps_that_were_printed_are_spread() {
        for rate in [15.0, 20.0, 25.0, 50.0, 64.0, 100.0, 1000.0] {
            let times = sampled(rate, 6000);
            let found = found(&times, printed).unwrap();
            assert!(farthest(&found, &times, 1.0 / rate) < 1.01, "{rate}");
        }
    }

    /// Intervals of 33 and 50 ms alternated in place of 40: rates were 7 % off.
    #[test]
    fn rows_that_are_no_whole_number_a_stamp_are_evenly_spread() {
        for rate in [25.0, 45.0, 64.0] {
            let found = found(&sampled(rate, 3000), truncated).unwrap();
            let worst =
                found[10..2990].windows(2).map(|pair| (rate * (pair[1] - pair[0]) - 1.0).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-3, "{rate}: {worst}");
        }
    }

    #[test]
    fn a_clock_with_jitter_pauses_and_another_rate_is_right_in_each_part() {
        let mut random = Rng::new(5);
        let mut times = sampled(45.0, 2000);
        for (from, rate) in [(2000, 45.0), (3000, 20.0), (4000, 100.0)] {
            let begin = times[from - 1] + if from == 2000 { 13.37 } else { 1.0 / rate };
            times.extend(sampled(rate, 1000).iter().map(|t| begin + t));
        }
        let jitter: Vec<f64> = times.iter().map(|t| t + 0.004 * (random.uniform() - 0.5)).collect();
        let found = found(&jitter, |t| truncated(t.max(0.0))).unwrap();
        assert!(found.windows(2).all(|pair| pair[1] > pair[0]));
        for (part, rate) in [(50..1950, 45.0), (2050..2950, 45.0), (3050..3950, 20.0), (4050..4950, 100.0)] {
            assert!(farthest(&found[part.clone()], &times[part.clone()], 1.0 / rate) < 1.5, "{rate}");
            let took = found[part.end - 1] - found[part.start];
            assert!((took / (times[part.end - 1] - times[part.start]) - 1.0).abs() < 2e-3, "{rate}");
        }
    }
}
