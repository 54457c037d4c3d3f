//! What speaks for a standstill: how far the column would have gone, and how sharp its corners are.

use super::moves::{Move, goes_on, ramp};
use super::smooth::gain_of_corners;

/// What counts as standing still.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stillness {
    /// Standard deviation of the noise.
    pub(super) noise: f64,
    /// How far pieces of one standstill may lie apart.
    pub(super) band: f64,
    /// Drift over the standstill, as a share of how far the column would have gone at the speed beside it.
    pub(super) share: f64,
    /// Farthest drift over a standstill.
    pub(super) drift: f64,
    /// How far the column would have gone on, at least, on its faster and on its slower side.
    pub(super) goes_on: [f64; 2],
    /// Whether a level may be reached without a corner, as a controller reaches it.
    pub(super) smooth: bool,
    /// Fewest samples.
    pub(super) samples: usize,
    /// Shortest duration, where one is requested; then `goes_on` does not count.
    pub(super) duration: Option<f64>,
}

/// What speaks for moves first..=last as a standstill: the gain of its corners, infinite where they are jumps; `None` if it
/// is none.
pub(super) fn evidence(
    time: &[f64],
    values: &[f64],
    moves: &[Move],
    (first, last): (usize, usize),
    drift: f64,
    stillness: &Stillness,
) -> Option<f64> {
    let (start, end) = (moves[first].start, moves[last].end);
    let duration = moves[last].times[1] - moves[first].times[0];
    if end - start < stillness.samples || stillness.duration.is_some_and(|least| duration < least) {
        return None;
    }
    // Noise tilts a short level.
    let tilt = 2.5 * stillness.noise * (12.0 / (end - start) as f64).sqrt();
    if drift > stillness.drift + tilt {
        return None;
    }
    let edges = [(moves[first].times[0], moves[first].ends[0]), (moves[last].times[1], moves[last].ends[1])];
    let sides = [
        goes_on(moves[..first].iter().rev(), edges[0], 0, duration),
        goes_on(moves[last + 1..].iter(), edges[1], 1, duration),
    ];
    let known: Vec<f64> = sides.iter().flatten().copied().collect();
    let (slower, faster) = known.iter().fold((f64::MAX, 0.0f64), |(low, high), far| (low.min(*far), high.max(*far)));
    if known.is_empty() || drift > stillness.share * slower + tilt {
        return None;
    }
    if stillness.duration.is_none() && (faster < stillness.goes_on[0] || slower < stillness.goes_on[1]) {
        return None;
    }
    let Some((before, after)) = surroundings(time, values, moves, (first, last), stillness) else {
        return Some(f64::INFINITY);
    };
    let polygon = |i: usize| {
        let next = moves.partition_point(|part| part.end <= i);
        moves.get(next).map_or(0.0, |part| part.at(time[i]) - values[i])
    };
    let parts = moves.partition_point(|part| part.end < after) - moves.partition_point(|part| part.end <= before);
    let price = PART * parts.saturating_sub(2) as f64 * stillness.noise.powi(2);
    let (gain, samples) = gain_of_corners(time, values, (before, start, end, after), polygon, price);
    let stray = 0.1 * stillness.band;
    let unit = stillness.noise.powi(2) + samples as f64 / OBSERVED * stray * stray;
    Some(gain / unit)
}

/// Square deviation, in units of the noise's, that a part of a polygon must explain.
const PART: f64 = 12.0;
/// Gain in square deviation, in units of the noise's, by which the corners of one standstill are observed.
pub(super) const OBSERVED: f64 = 16.0;
/// How far noise takes a few samples, in its standard deviations.
const SCRAP: f64 = 5.0;
/// Fewest samples of a ramp that could be the side of a smooth turning point.
const RAMP: usize = 3;

/// The ramps beside moves first..=last, as far as the column would have gone in the time of the standstill: samples from where until its
/// start, and from its end until where; none where it jumps. `None` between jumps or ends of the record: nothing is as sharp.
fn surroundings(
    time: &[f64],
    values: &[f64],
    moves: &[Move],
    (first, last): (usize, usize),
    stillness: &Stillness,
) -> Option<(usize, usize)> {
    let (start, end) = (moves[first].start, moves[last].end);
    let (from, until) = (moves[first].times[0], moves[last].times[1]);
    let widest = [
        time.partition_point(|t| *t < from - (until - from)),
        time.partition_point(|t| *t <= until + (until - from)),
    ];
    let ramps = [
        ramp(moves[..first].iter().rev()).map_or(start, |part| part.start).max(widest[0]),
        ramp(moves[last + 1..].iter()).map_or(end, |part| part.end).min(widest[1]),
    ];
    // A ramp of hardly a sample is a corner, if it goes far; else it is a scrap of noise.
    let least = stillness.goes_on[1].max(SCRAP * stillness.noise);
    let goes_far = |range: std::ops::Range<usize>, level: f64| values[range].iter().any(|v| (v - level).abs() > least);
    let short = [start - ramps[0] < RAMP, ramps[1] - end < RAMP];
    let ends = [first == 0, last + 1 == moves.len()];
    let jumps = [
        !ends[0] && short[0] && goes_far(start.saturating_sub(RAMP)..start, moves[first].ends[0]),
        !ends[1] && short[1] && goes_far(end..(end + RAMP).min(values.len()), moves[last].ends[1]),
    ];
    if (jumps[0] || ends[0]) && (jumps[1] || ends[1]) {
        return None;
    }
    // Beside a jump the other corner tells.
    let side = |side: usize, edge: usize| match (jumps[side], short[side]) {
        (true, _) => edge,
        (false, true) => widest[side],
        (false, false) => ramps[side],
    };
    Some((side(0, start), side(1, end)))
}
