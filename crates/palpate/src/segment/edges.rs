//! Where exactly a hold begins and ends.

use crate::statistics::median;

/// A hold with its level.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) value: f64,
}

/// Grows a standstill to all neighbouring samples that keep to its level, then cuts back what belongs to the ramps.
///
/// The level is the median of the standstill, measured in its first and last quarter apart, since a "constant" height
/// may drift. A ramp that runs straight into the hold passes the tolerance before it reaches the level; the sample
/// at which the straight line through the ramp meets the level is the edge.
pub(super) fn edges(time: &[f64], values: &[f64], run: (usize, usize), tolerance: f64) -> Level {
    let quarter = ((run.1 - run.0) / 4).max(1);
    let level = |from: usize, until: usize| median(&mut values[from..until].to_vec());
    let (first, last) = (level(run.0, run.0 + quarter), level(run.1 - quarter, run.1));
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
    if start > 0
        && let Some(meeting) = meeting(time, values, Side::Before(start), first, tolerance)
    {
        let edge = time.partition_point(|t| *t < meeting - 1e-6 * (time[start] - time[start - 1]));
        start = edge.clamp(start, run.1 - 1);
    }
    if end < values.len()
        && let Some(meeting) = meeting(time, values, Side::After(end), last, tolerance)
    {
        let edge = time.partition_point(|t| *t <= meeting + 1e-6 * (time[end] - time[end - 1]));
        end = edge.clamp(start + 1, end);
    }
    Level {
        start,
        end,
        value: level(start, end),
    }
}

/// On which side of a hold a ramp lies, with the index of its edge.
#[derive(Clone, Copy)]
enum Side {
    Before(usize),
    After(usize),
}

/// The time at which the line through the end of a ramp meets `level`; `None` if there is no straight ramp to speak of.
///
/// The line goes through the samples outside the tolerance, up to eight of them or five tolerances away. A servo that
/// overshoots comes back in a curve, not along a line: then the samples inside the tolerance decide alone.
fn meeting(time: &[f64], values: &[f64], side: Side, level: f64, tolerance: f64) -> Option<f64> {
    const MOST: usize = 8;
    let indices: Vec<usize> = match side {
        Side::Before(edge) => (0..edge).rev().take(MOST).collect(),
        Side::After(edge) => (edge..values.len()).take(MOST).collect(),
    };
    let direction = (values[*indices.first()?] - level).signum();
    let ramp: Vec<usize> = indices
        .into_iter()
        .enumerate()
        .take_while(|(rank, index)| {
            let away = direction * (values[*index] - level);
            *rank < 2 || (away > tolerance && away < 50.0 * tolerance)
        })
        .map(|(_, index)| index)
        .collect();
    if ramp.len() < 2 {
        return None;
    }
    let count = ramp.len() as f64;
    let t0 = time[ramp[0]];
    let (mean_t, mean_v) = (
        ramp.iter().map(|i| time[*i] - t0).sum::<f64>() / count,
        ramp.iter().map(|i| values[*i]).sum::<f64>() / count,
    );
    let (mut tt, mut tv) = (0.0, 0.0);
    for i in &ramp {
        let t = time[*i] - t0 - mean_t;
        tt += t * t;
        tv += t * (values[*i] - mean_v);
    }
    let slope = tv / tt;
    let straight = ramp.iter().all(|i| (values[*i] - mean_v - slope * (time[*i] - t0 - mean_t)).abs() <= tolerance);
    (straight && slope != 0.0).then(|| t0 + mean_t + (level - mean_v) / slope)
}
