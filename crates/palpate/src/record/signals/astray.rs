//! Rows of a column that stray from those about them.
//!
//! Rows that no sensor measured are found first, and passed over; then runs of a few rows that leave what is beside them and come back.

use std::ops::Range;

use crate::statistics::{bounds, noise, quantile, range};

/// Rows of a column that stray.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Astray {
    /// Rows that no sensor measured, rising.
    pub(crate) lost: Vec<usize>,
    /// Runs of the others, in order.
    pub(crate) runs: Vec<Range<usize>>,
}

/// Most rows of a run.
const LONGEST: usize = 5;
/// Fewest rows of a column that show noise, runs of several rows, and lines beside them.
const ENOUGH: usize = 50;
/// Share of the range, and standard deviations of the noise, by which a row strays alone; a run of several strays twice as far.
const FAR: (f64, f64) = (0.05, 8.0);
/// Share of how far a run strays by which the rows on either side differ at most.
const ALIKE: f64 = 0.1;
/// The same from one row to the next beside it, and for where lines through those rows lead.
const CALM: f64 = 0.25;

impl Astray {
    /// Those of a column.
    pub(crate) fn of(values: &[f64]) -> Self {
        let lost = lost_rows(values);
        let mut clean = values.to_vec();
        bridge(&mut clean, &runs_of(&lost));
        let longest = if clean.len() < ENOUGH { 1 } else { LONGEST };
        let noise = if clean.len() < ENOUGH { 0.0 } else { noise(&clean) };
        let least = (FAR.0 * range(&clean)).max(FAR.1 * noise);
        let (mut runs, mut row) = (Vec::new(), 1);
        while row + 1 < clean.len() {
            let leaves = (clean[row] - clean[row - 1]).abs() > least;
            let run = (1..=longest).map(|length| row..row + length).find(|run| leaves && strays(&clean, run, least));
            row += run.as_ref().map_or(1, Range::len);
            if let Some(run) = run {
                bridge(&mut clean, std::slice::from_ref(&run));
                runs.push(run);
            }
        }
        Self { lost, runs }
    }

    /// Those of a force, without the runs in which the jaw goes away and comes back, too: the body was let go.
    pub(crate) fn of_force(force: &[f64], jaw: Option<&[f64]>) -> Self {
        let mut found = Self::of(force);
        if let Some(jaw) = jaw.filter(|jaw| jaw.len() == force.len()) {
            let far = (FAR.0 * range(jaw)).max(FAR.1 * noise(jaw));
            let mut stays = jaw.to_vec();
            bridge(&mut stays, &found.runs);
            let goes = |row: usize| (jaw[row] - stays[row]).abs() > far;
            found.runs.retain(|run| run.len() == 1 || !run.clone().all(goes));
        }
        found
    }

    /// All of them, rising.
    pub(crate) fn rows(&self) -> Vec<usize> {
        self.those(|_| true)
    }

    /// The lost rows, and the runs that are `wanted`, rising.
    pub(crate) fn those(&self, wanted: impl Fn(&Range<usize>) -> bool) -> Vec<usize> {
        let runs = self.runs.iter().filter(|run| wanted(run)).cloned().flatten();
        let mut rows: Vec<usize> = self.lost.iter().copied().chain(runs).collect();
        rows.sort_unstable();
        rows
    }
}

/// Rows, rising, as runs.
pub(crate) fn runs_of(rows: &[usize]) -> Vec<Range<usize>> {
    rows.chunk_by(|a, b| a + 1 == *b).map(|run| run[0]..run[run.len() - 1] + 1).collect()
}

/// Puts runs on the straight line between the rows beside them; at an end of the column, on the one row.
pub(crate) fn bridge(values: &mut [f64], runs: &[Range<usize>]) {
    for run in runs {
        let before = run.start.checked_sub(1).map(|row| values[row]);
        let after = values.get(run.end).copied();
        let (Some(from), Some(to)) = (before.or(after), after.or(before)) else {
            continue;
        };
        for row in run.clone() {
            let share = (row + 1 - run.start) as f64 / (run.len() + 1) as f64;
            values[row] = from + share * (to - from);
        }
    }
}

/// Whether a run leaves the rows beside it at once, to one side, and comes back to where they go on.
fn strays(values: &[f64], run: &Range<usize>, least: f64) -> bool {
    let Some(after) = values.get(run.end).copied() else {
        return false;
    };
    let (before, inside) = (values[run.start - 1], &values[run.clone()]);
    // How far the nearest and the farthest of its rows are beyond both levels.
    let off = |levels: [f64; 2]| {
        let side = (inside[0] - before).signum();
        let beyond = |value: &f64| levels.map(|level| side * (value - level)).into_iter().fold(f64::MAX, f64::min);
        bounds(&inside.iter().map(beyond).collect::<Vec<f64>>())
    };
    let (nearest, farthest) = off([before, after]);
    let least = if run.len() == 1 { least } else { 2.0 * least };
    // What grows row by row is a peak.
    if nearest <= least || nearest <= 0.5 * farthest {
        return false;
    }
    let meet = |a: f64, b: f64, share: f64| (a - b).abs() < share * nearest;
    // Three rows, the nearest first, lead along their line, or to where they stay; what comes and goes within more rows is a wave.
    let leads = |rows: [Option<usize>; 3]| match rows.map(|row| Some(*values.get(row?)?)) {
        [Some(a), Some(b), Some(c)] if meet(a + c, 2.0 * b, ALIKE) => Some(2.0 * a - b),
        [Some(a), b, _] if b.is_none_or(|b| meet(a, b, CALM)) => Some(a),
        _ => None,
    };
    let from = leads([1, 2, 3].map(|back| run.start.checked_sub(back)));
    let to = leads([0, 1, 2].map(|ahead| Some(run.end + ahead)));
    // Where a ramp ends its line leads to where the hold goes on, and not to the run.
    let goes_on = values.len() >= ENOUGH
        && from.zip(to).is_some_and(|(from, to)| meet(from, to, CALM) && off([from, to]).0 > least);
    goes_on || run.len() == 1 && meet(before, after, ALIKE) && !is_tip(values, run.start, 0.5 * nearest)
}

/// Whether row `i` is no farther than `least` from the lines through the two rows before and the two after, the corner of a triangle of few samples;
/// or no farther on than the line of the ramp that leads to it, the end of one from which a body relaxes within a sample to where the ramp was a sample
/// before.
fn is_tip(values: &[f64], i: usize, least: f64) -> bool {
    let beyond = |next: usize, far: Option<usize>| {
        let far = far.and_then(|far| values.get(far))?;
        Some(values[i] - (2.0 * values[next] - far))
    };
    let (before, after) = (beyond(i - 1, i.checked_sub(2)), beyond(i + 1, Some(i + 2)));
    let is_corner = before.zip(after).is_some_and(|(before, after)| before.abs().max(after.abs()) < least);
    let rows = i.checked_sub(3).map(|first| [values[first], values[first + 1], values[first + 2]]);
    let side = (values[i] - values[i - 1]).signum();
    let is_end = rows.zip(before).is_some_and(|([a, b, c], before)| {
        let is_ramp = side * (c - b) > least && (a + c - 2.0 * b).abs() < CALM * (c - b).abs();
        is_ramp && side * before < least
    });
    is_corner || is_end
}

/// Rows, few of all, alike where they are successive, and tens of times larger than nearly all others: what a load cell shows beyond its range, or a
/// logger (9999, 2³¹ − 1) for a value that it did not get.
fn lost_rows(values: &[f64]) -> Vec<usize> {
    /// Most of them, as a share of all.
    const MOST: f64 = 0.02;
    /// How many times larger they are.
    const LARGER: f64 = 20.0;
    let most = ((MOST * values.len() as f64) as usize).max(1);
    let mut sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    let usual = quantile(&mut sizes, 1.0 - most as f64 / values.len().saturating_sub(1).max(1) as f64);
    let far: Vec<usize> = (0..values.len()).filter(|row| values[*row].abs() > LARGER * usual).collect();
    // A peak goes its way row by row, and a body that is squeezed at once for more than some rows relaxes in them.
    let stands = |run: &Range<usize>| {
        let most = ALIKE * values[run.start].abs();
        let mut beside = run.start.checked_sub(1).into_iter().chain([run.end]).filter_map(|row| values.get(row));
        let differ = range(&values[run.clone()]);
        let is_one = if run.len() > LONGEST { differ == 0.0 } else { differ < most };
        is_one && beside.all(|value| value.abs() < most)
    };
    let runs = if far.len() > most || usual == 0.0 { Vec::new() } else { runs_of(&far) };
    runs.into_iter().filter(stands).flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The force of a ramp and a relaxing hold.
    fn squeeze() -> Vec<f64> {
        let relaxation = |i: u32| 0.7 + 0.3 * (-0.02 * (f64::from(i) - 100.0).max(0.0)).exp();
        (0..400u32).map(|i| 0.1 * f64::from(i.min(100)) * relaxation(i)).collect()
    }

    /// Five rows of 99,999 N at the beginning of a hold went into its fit without a word.
    #[test]
    fn a_few_rows_beyond_the_range_of_the_load_cell_are_no_measurements() {
        let force = squeeze();
        let with = |rows: std::ops::Range<usize>, value: f64| {
            let mut force = force.clone();
            force[rows].fill(value);
            Astray::of(&force).lost
        };
        assert_eq!(with(100..105, 99_999.0), [100, 101, 102, 103, 104]);
        assert_eq!(with(397..400, -32_768.0), [397, 398, 399]);
        assert!(with(100..105, 30.0).is_empty() && with(100..150, 99_999.0).is_empty());
        // The mass of a rotor as it starts: one row beyond 20 times what follows, between others nearly as large.
        let rotor = |i: usize| [3.0, 15.0, 25.0, 14.0, 2.0].get(i).copied().unwrap_or(1.0);
        assert!(Astray::of(&(0..300).map(rotor).collect::<Vec<f64>>()).lost.is_empty());
        assert_eq!(with(300..308, 9999.0), (300..308).collect::<Vec<usize>>());
        // A squeeze of ten rows in a long log of a gripper that holds nothing.
        let squeezed =
            |i: usize| if (500..510).contains(&i) { 5.0 - 0.02 * i as f64 % 0.2 } else { 1e-3 * (i % 7) as f64 };
        assert!(Astray::of(&(0..1000).map(squeezed).collect::<Vec<f64>>()).lost.is_empty());
        // A force that falls to a hundredth at once, but not in one row.
        let falling: Vec<f64> = (0..400).map(|i| (-0.5 * f64::from(i)).exp() + 1e-5 * f64::from(i % 7)).collect();
        assert!(Astray::of(&falling).lost.is_empty());
    }

    #[test]
    fn corners_of_triangles_of_few_samples_are_no_strays() {
        let corner = |i: usize| [0.0, 1.0, 2.0, 3.0, 2.0, 1.0][i % 6];
        let mut triangle: Vec<f64> = (0..60).map(corner).chain((0..400).map(|i| 0.005 * f64::from(i))).collect();
        assert_eq!(Astray::of(&triangle).rows(), [] as [usize; 0]);
        triangle[300] = 0.0;
        assert_eq!(Astray::of(&triangle).rows(), [300]);
    }

    /// The last row of a ramp strayed, and was left out of fits, where the body relaxed within a sample to the height of the row before it: in 6 of
    /// 60 clean records.
    #[test]
    fn the_end_of_a_ramp_is_no_stray() {
        for (share, relaxed) in [(1.0, 0.1), (1.0, 0.0), (0.6, 0.0), (0.3, 0.02)] {
            let ramp = |i: usize| 1.5 * (i as f64 - 50.0).max(0.0);
            let peak = ramp(57) + 1.5 * share;
            let falls = |i: usize| (peak - ramp(57) - relaxed) * (-0.3 * (i as f64 - 59.0)).exp() + ramp(55);
            let below = ramp(57) + relaxed - falls(59);
            let force: Vec<f64> = (0..400)
                .map(|i| match i {
                    0..58 => ramp(i),
                    58 => peak,
                    _ => falls(i) + below,
                })
                .collect();
            assert_eq!(Astray::of(&force), Astray::default(), "{share} {relaxed}");
        }
    }

    /// One sample of 130 % at the start of a hold was a term of its own in a "clear" law: the ramp beside it hid it.
    #[test]
    fn rows_that_stray_where_a_ramp_ends_are_found() {
        for length in 1..=LONGEST {
            for start in [99, 100, 101, 103] {
                let (mut force, run) = (squeeze(), start..start + length);
                force[run.clone()].iter_mut().for_each(|force| *force *= 1.3);
                assert_eq!(Astray::of(&force).runs, [run], "{length} from {start}");
            }
        }
        assert_eq!(Astray::of(&squeeze()), Astray::default());
    }
}
