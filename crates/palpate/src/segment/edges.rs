//! Where exactly a hold begins and ends.

use crate::statistics::median;

/// A hold with its level.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) value: f64,
}

/// Share of a sample interval by which an edge may be off: the rounding of a time column, far below a sample.
const SLACK: f64 = 0.05;

/// Grows a standstill to all neighbouring samples that keep to its level.
///
/// The level is the median of the standstill, measured in its first and last quarter apart, since a "constant" height
/// may drift.
pub(super) fn grown(values: &[f64], run: (usize, usize), tolerance: f64) -> Level {
    let (first, last) = ends(values, run);
    let mut start = run.0;
    while start < run.1 - 1 && (values[start] - first).abs() > tolerance {
        start += 1;
    }
    while start > 0 && (values[start - 1] - first).abs() <= tolerance {
        start -= 1;
    }
    let mut end = run.1;
    while end > start + 1 && (values[end - 1] - last).abs() > tolerance {
        end -= 1;
    }
    while end < values.len() && (values[end] - last).abs() <= tolerance {
        end += 1;
    }
    let value = median(&mut values[start..end].to_vec());
    Level { start, end, value }
}

/// Median of the first and of the last quarter of a standstill.
fn ends(values: &[f64], run: (usize, usize)) -> (f64, f64) {
    let quarter = ((run.1 - run.0) / 4).max(1);
    let level = |from: usize, until: usize| median(&mut values[from..until].to_vec());
    (level(run.0, run.0 + quarter), level(run.1 - quarter, run.1))
}

/// Where a hold ends and the next begins, of which the ramp between them is part.
pub(super) struct Neighbours {
    /// Sample after the last of the hold before.
    pub(super) before: usize,
    /// First sample of the hold after.
    pub(super) after: usize,
}

/// Cuts off a grown level what belongs to the ramps.
///
/// A ramp that runs straight into the hold passes the tolerance before it reaches the level; the sample at which the
/// straight line through the ramp meets the level is the edge.
pub(super) fn trimmed(
    time: &[f64],
    values: &[f64],
    level: Level,
    run: (usize, usize),
    between: &Neighbours,
    limits: Limits,
) -> Level {
    let (first, last) = ends(values, run);
    let Level {
        mut start,
        mut end,
        value,
    } = level;
    let (grown_start, grown_end) = (start, end);
    if grown_start > 0 {
        let outside = (between.before.min(grown_start)..grown_start).rev();
        let points = on_ramp(values, outside, grown_start, grown_start - 1, first, limits);
        if let Some(meeting) = meeting(time, values, &points, first, limits) {
            let slack = SLACK * (time[grown_start] - time[grown_start - 1]);
            start = time.partition_point(|t| *t < meeting - slack).clamp(grown_start, grown_end - 1);
        }
    }
    if grown_end < values.len() {
        let outside = grown_end..between.after.max(grown_end);
        let points = on_ramp(values, outside, grown_end - 1, grown_end, last, limits);
        if let Some(meeting) = meeting(time, values, &points, last, limits) {
            let slack = SLACK * (time[grown_end] - time[grown_end - 1]);
            end = time.partition_point(|t| *t <= meeting + slack).clamp(start + 1, grown_end);
        }
    }
    Level { start, end, value }
}

/// What tells a ramp from a standstill.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    pub(super) tolerance: f64,
    /// Speed under which the jaw stands still.
    pub(super) still: f64,
}

/// The samples of a ramp next to a level, nearest first: eight of them, more of a slow ramp.
///
/// A ramp of fewer than two samples is known by the edges of the levels on its sides: `own` and, if need be, `other`.
fn on_ramp(
    values: &[f64],
    outside: impl Iterator<Item = usize>,
    own: usize,
    other: usize,
    level: f64,
    limits: Limits,
) -> Vec<usize> {
    const MOST: usize = 8;
    let direction = (values[other] - level).signum();
    let away = |index: usize| direction * (values[index] - level) / limits.tolerance;
    let mut ramp: Vec<usize> = outside
        .enumerate()
        .take_while(|(rank, index)| {
            let away = away(*index);
            away > 1.0 && (*rank < 2 || (away < 50.0 && (*rank < MOST || away < 6.0)))
        })
        .map(|(_, index)| index)
        .collect();
    if ramp.len() < 2 {
        ramp.insert(0, own);
    }
    if ramp.len() < 2 {
        ramp.push(other);
    }
    ramp
}

/// The time at which the line through the end of a ramp meets `level`; `None` if there is no straight ramp to speak of.
///
/// A servo that overshoots comes back in a curve, not along a line: then the tolerance decides alone. So it does where
/// the line is as flat as a standstill, or meets the level farther off than a ramp of its slope could.
fn meeting(time: &[f64], values: &[f64], ramp: &[usize], level: f64, limits: Limits) -> Option<f64> {
    let count = ramp.len() as f64;
    let t0 = time[ramp[0]];
    let (mean_t, mean_v) = (
        ramp.iter().map(|i| time[*i] - t0).sum::<f64>() / count,
        ramp.iter().map(|i| values[*i]).sum::<f64>() / count,
    );
    let (mut tt, mut tv) = (0.0, 0.0);
    for i in ramp {
        let t = time[*i] - t0 - mean_t;
        tt += t * t;
        tv += t * (values[*i] - mean_v);
    }
    let slope = tv / tt;
    let straight = ramp
        .iter()
        .all(|i| (values[*i] - mean_v - slope * (time[*i] - t0 - mean_t)).abs() <= limits.tolerance);
    let span = (time[ramp[ramp.len() - 1]] - t0).abs();
    let interval = span / (count - 1.0);
    let steep = slope.abs() > limits.still && slope.abs() * span > 1.5 * limits.tolerance;
    let meeting = mean_t + (level - mean_v) / slope;
    let near = meeting.abs() <= 2.0 * interval + 1.5 * limits.tolerance / slope.abs();
    (straight && steep && near).then_some(t0 + meeting)
}
