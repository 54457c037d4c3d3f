//! Which parts of a polygon are standstills.
//!
//! A standstill is where the column goes by far less than it does beside it. Nothing global is needed for that: a slow ramp
//! between two levels is none, since they are slower, and a level that drifts is one, between ramps that are faster.

use super::pieces::Piece;
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
    /// Fewest samples.
    pub(super) samples: usize,
    /// Shortest duration, where one is asked for; then `goes_on` does not count.
    pub(super) duration: Option<f64>,
}

/// Part of the polygon, or a jump from one piece to the next, which has no samples.
#[derive(Debug, Clone, Copy)]
struct Move {
    start: usize,
    end: usize,
    times: [f64; 2],
    ends: [f64; 2],
}

impl Move {
    fn duration(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    fn travel(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    fn speed(&self) -> f64 {
        let duration = self.duration();
        if duration > 0.0 { self.travel() / duration } else { 0.0 }
    }

    /// Value at a time inside.
    fn at(&self, time: f64) -> f64 {
        self.ends[0] + self.speed() * (time - self.times[0])
    }
}

/// Overshoot of a servo, or the way it still creeps after a ramp, as a share of the ramp.
const SETTLING: f64 = 0.025;

/// Most pieces of that way.
const MOST_SETTLING: usize = 16;

/// A standstill: samples, and which pieces of the polygon it consists of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Standstill {
    pub(super) start: usize,
    pub(super) end: usize,
}

/// The longest standstill that was refused.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Refused {
    pub(super) duration: f64,
    pub(super) samples: usize,
}

impl Refused {
    fn note(&mut self, moves: &[Move], first: usize, last: usize) {
        let duration = moves[last].times[1] - moves[first].times[0];
        if first > 0 && duration > self.duration {
            *self = Self {
                duration,
                samples: moves[last].end - moves[first].start,
            };
        }
    }
}

/// Finds the standstills of a column, in order.
pub(super) fn standstills(
    time: &[f64],
    values: &[f64],
    pieces: &[Piece],
    stillness: &Stillness,
) -> (Vec<Standstill>, Refused) {
    let moves = moves(time, pieces, stillness.band);
    let mut order: Vec<usize> = (0..moves.len()).filter(|index| moves[*index].end > moves[*index].start).collect();
    // The flattest and longest first: they take their neighbours.
    let rank = |index: usize| moves[index].duration() / (moves[index].travel().abs() + stillness.band);
    order.sort_by(|a, b| rank(*b).total_cmp(&rank(*a)).then(a.cmp(b)));
    let mut taken = vec![false; moves.len()];
    let mut found: Vec<(usize, usize, f64)> = Vec::new();
    let mut refused = Refused::default();
    for seed in order {
        if taken[seed] {
            continue;
        }
        let (core, last) = grown(&moves, &taken, seed, stillness);
        let first = settling(&moves, &taken, core, last, stillness.band);
        let drift = (moves[last].ends[1] - moves[core].ends[0]).abs();
        match evidence(time, values, &moves, (first, last), drift, stillness) {
            Some(gain) => {
                taken[first..=last].fill(true);
                found.push((first, last, gain));
            }
            None => refused.note(&moves, first, last),
        }
    }
    let seen = together(&found);
    found.retain(|(first, last, gain)| {
        let stands = *gain >= SEEN || (seen && *gain > -LEAST);
        if !stands {
            refused.note(&moves, *first, *last);
        }
        stands
    });
    found.sort_by_key(|(first, ..)| *first);
    let standstill = |(first, last, _): (usize, usize, f64)| Standstill {
        start: moves[first].start,
        end: moves[last].end,
    };
    (found.into_iter().map(standstill).collect(), refused)
}

/// Gain in square deviation, in units of the noise's, by which the corners of one standstill are seen.
const SEEN: f64 = 16.0;
/// A standstill among others may do without, if its corners are not worse by this.
const LEAST: f64 = 6.0;

/// Whether the standstills whose corners are not seen one by one are seen together: a machine that stops at one turn, stops at
/// the others, too.
fn together(found: &[(usize, usize, f64)]) -> bool {
    let gains: Vec<f64> = found.iter().map(|(_, _, gain)| *gain).filter(|gain| gain.is_finite()).collect();
    let sum = gains.iter().map(|gain| gain.min(2.0 * SEEN)).sum::<f64>();
    sum >= SEEN.max(3.0 * gains.len() as f64)
}

/// The polygon as moves: its pieces, and the jumps between them where they lie more than `band` apart.
fn moves(time: &[f64], pieces: &[Piece], band: f64) -> Vec<Move> {
    let mut moves: Vec<Move> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let times = [time[piece.start], time[piece.end - 1]];
        let next = Move {
            start: piece.start,
            end: piece.end,
            times,
            ends: times.map(|t| piece.line.at(t)),
        };
        if let Some(last) = moves.last()
            && (next.ends[0] - last.ends[1]).abs() > band
        {
            moves.push(Move {
                start: piece.start,
                end: piece.start,
                times: [last.times[1], times[0]],
                ends: [last.ends[1], next.ends[0]],
            });
        }
        moves.push(next);
    }
    moves
}

/// Grows a piece to all neighbours that keep to its level.
fn grown(moves: &[Move], taken: &[bool], seed: usize, stillness: &Stillness) -> (usize, usize) {
    let (mut first, mut last) = (seed, seed);
    let most = (2.0 * stillness.band).max(1.5 * moves[seed].travel().abs() + stillness.band);
    let (mut low, mut high) = bounds(&moves[seed]);
    let keeps = |next: &Move, edge: f64, low: &mut f64, high: &mut f64| {
        let (a, b) = bounds(next);
        let near = (a - edge).abs().max((b - edge).abs()) <= stillness.band;
        let within = b.max(*high) - a.min(*low) <= most;
        if near && within {
            (*low, *high) = (a.min(*low), b.max(*high));
        }
        near && within
    };
    loop {
        let (was_first, was_last) = (first, last);
        let later = beyond(moves, last, |from| from.checked_add(1).filter(|next| *next < moves.len()));
        for next in later.into_iter().take_while(|next| !taken[*next]) {
            if keeps(&moves[next], moves[last].ends[1], &mut low, &mut high) {
                last = next;
                break;
            }
        }
        let earlier = beyond(moves, first, |from| from.checked_sub(1));
        for next in earlier.into_iter().take_while(|next| !taken[*next]) {
            if keeps(&moves[next], moves[first].ends[0], &mut low, &mut high) {
                first = next;
                break;
            }
        }
        if (first, last) == (was_first, was_last) {
            break;
        }
    }
    (first, last)
}

/// Samples that may stray together and yet not end a standstill.
const STRAY: usize = 3;

/// The next move, and those after scraps of a few samples: what strays for so short a time and comes back is noise.
fn beyond(moves: &[Move], from: usize, step: impl Fn(usize) -> Option<usize>) -> Vec<usize> {
    let (mut next, mut samples, mut found) = (step(from), 0, Vec::new());
    while let Some(index) = next {
        if samples == 0 || moves[index].end - moves[index].start > samples {
            found.push(index);
        }
        samples += moves[index].end - moves[index].start;
        if samples > STRAY {
            break;
        }
        next = step(index);
    }
    found
}

fn bounds(part: &Move) -> (f64, f64) {
    (part.ends[0].min(part.ends[1]), part.ends[0].max(part.ends[1]))
}

/// The first move of what a servo does after its ramp: it strays little, for no longer than the standstill, and the ramp before
/// it is twice as fast.
fn settling(moves: &[Move], taken: &[bool], first: usize, last: usize, band: f64) -> usize {
    let level = moves[first].ends[0];
    let (begin, duration) = (moves[first].times[0], moves[last].times[1] - moves[first].times[0]);
    let (mut settled, mut strays) = (first, 0.0f64);
    for next in (1..first).rev().take(MOST_SETTLING) {
        let (low, high) = bounds(&moves[next]);
        strays = strays.max((low - level).abs()).max((high - level).abs());
        if taken[next] || begin - moves[next].times[0] > duration {
            break;
        }
        let outer = &moves[next - 1];
        let travel = ramp_travel(moves, taken, next - 1);
        if moves[next].end > moves[next].start
            && strays <= SETTLING * travel
            && travel > 8.0 * band
            && outer.speed().abs() > 2.0 * moves[next].speed().abs()
        {
            settled = next;
        }
    }
    settled
}

/// How far the ramp goes of which move `index` is the last.
fn ramp_travel(moves: &[Move], taken: &[bool], index: usize) -> f64 {
    let direction = moves[index].travel().signum();
    let begin = (0..=index).rev().take_while(|i| !taken[*i] && moves[*i].travel() * direction > 0.0).last();
    begin.map_or(0.0, |begin| (moves[index].ends[1] - moves[begin].ends[0]).abs())
}

/// What speaks for moves first..=last as a standstill: the gain of its corners, infinite where they are jumps; `None` if it
/// is none.
fn evidence(
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
    let sides = [goes_on_before(moves, first, duration), goes_on_after(moves, last, duration)];
    let known: Vec<f64> = sides.iter().flatten().copied().collect();
    let (slower, faster) = known.iter().fold((f64::MAX, 0.0f64), |(low, high), far| (low.min(*far), high.max(*far)));
    if known.is_empty() || drift > stillness.share * slower + tilt {
        return None;
    }
    if stillness.duration.is_none() && (faster < stillness.goes_on[0] || slower < stillness.goes_on[1]) {
        return None;
    }
    let widest = [
        time.partition_point(|t| *t < moves[first].times[0] - duration),
        time.partition_point(|t| *t <= moves[last].times[1] + duration),
    ];
    let mut before = widest[0].max(ramp_before(moves, first));
    let mut after = widest[1].min(ramp_after(moves, last));
    // A ramp of hardly a sample is a corner, if it goes far; else it is a scrap of noise.
    let least = stillness.goes_on[1].max(SCRAP * stillness.noise);
    let goes_far = |range: std::ops::Range<usize>, level: f64| values[range].iter().any(|v| (v - level).abs() > least);
    if first > 0 && start - before < RAMP {
        if goes_far(start.saturating_sub(RAMP)..start, moves[first].ends[0]) {
            return Some(f64::INFINITY);
        }
        before = widest[0];
    }
    if last + 1 < moves.len() && after - end < RAMP {
        if goes_far(end..(end + RAMP).min(values.len()), moves[last].ends[1]) {
            return Some(f64::INFINITY);
        }
        after = widest[1];
    }
    let (gain, samples) = gain_of_corners(time, values, (before, start, end, after));
    let stray = 0.1 * stillness.band;
    let unit = stillness.noise.powi(2) + samples as f64 / SEEN * stray * stray;
    Some(gain / unit)
}

/// How far noise takes a few samples, in its standard deviations.
const SCRAP: f64 = 4.5;
/// Fewest samples of a ramp that could be the side of a smooth turning point.
const RAMP: usize = 3;
/// Share of its greatest speed under which a ramp has ended.
const ENDED: f64 = 0.25;

/// First sample of the ramp that ends at a move.
fn ramp_before(moves: &[Move], first: usize) -> usize {
    let (mut begin, mut fastest) = (moves[first].start, 0.0f64);
    let direction = first.checked_sub(1).map_or(0.0, |last| moves[last].travel().signum());
    for part in moves[..first].iter().rev() {
        let speed = part.speed() * direction;
        if speed <= ENDED * fastest {
            break;
        }
        (begin, fastest) = (part.start, fastest.max(speed));
    }
    begin
}

/// Sample after the ramp that begins after a move.
fn ramp_after(moves: &[Move], last: usize) -> usize {
    let (mut end, mut fastest) = (moves[last].end, 0.0f64);
    let direction = moves.get(last + 1).map_or(0.0, |next| next.travel().signum());
    for part in &moves[last + 1..] {
        let speed = part.speed() * direction;
        if speed <= ENDED * fastest {
            break;
        }
        (end, fastest) = (part.end, fastest.max(speed));
    }
    end
}

/// How far the column would go in `duration` at the speed it has just before a move; `None` at the start of the record.
///
/// The farthest point within half the duration counts: a stretch that reaches the next level may end on the same one.
fn goes_on_before(moves: &[Move], first: usize, duration: f64) -> Option<f64> {
    let (edge, level) = (moves[first].times[0], moves[first].ends[0]);
    let until = edge - 0.5 * duration;
    let mut farthest: Option<(f64, f64)> = None;
    for part in moves[..first].iter().rev() {
        let begin = part.times[0].max(until);
        let far = (part.at(begin) - level).abs().max((part.ends[1] - level).abs());
        let so_far = farthest.map_or(0.0, |(far, _)| far);
        farthest = Some((so_far.max(far), edge - begin));
        if part.times[0] <= until {
            break;
        }
    }
    farthest.filter(|(_, span)| *span > 0.0).map(|(far, span)| far / span * duration)
}

/// The same just after a move; `None` at the end of the record.
fn goes_on_after(moves: &[Move], last: usize, duration: f64) -> Option<f64> {
    let (edge, level) = (moves[last].times[1], moves[last].ends[1]);
    let until = edge + 0.5 * duration;
    let mut farthest: Option<(f64, f64)> = None;
    for part in &moves[last + 1..] {
        let end = part.times[1].min(until);
        let far = (part.at(end) - level).abs().max((part.ends[0] - level).abs());
        let so_far = farthest.map_or(0.0, |(far, _)| far);
        farthest = Some((so_far.max(far), end - edge));
        if part.times[1] >= until {
            break;
        }
    }
    farthest.filter(|(_, span)| *span > 0.0).map(|(far, span)| far / span * duration)
}
