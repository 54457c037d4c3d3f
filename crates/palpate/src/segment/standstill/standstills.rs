//! Which parts of a polygon are standstills.
//!
//! A standstill is where the column goes by far less than it does beside it. Nothing global is needed for that: a slow ramp
//! between two levels is none, since they are slower, and a level that drifts is one, between ramps that are faster.

use super::evidence::{OBSERVED, Stillness, evidence};
use super::moves::{Move, moves};
use super::pieces::Piece;
use crate::statistics::mean;

/// Overshoot of a servo, or the way it still creeps after a ramp, as a share of the ramp.
const SETTLING: f64 = 0.025;

/// A part of that way that goes by no more than this share of it rests; where most of the time is rest it is a hold of its own.
const RESTS: f64 = 0.2;

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
        let first = settling(&moves, &taken, (core, last), stillness);
        let drift = (moves[last].ends[1] - moves[core].ends[0]).abs();
        let beside = (first > 0 && taken[first - 1]) || taken.get(last + 1) == Some(&true);
        if beside && drift > 2.0 * stillness.band {
            // A slow ramp between two levels.
            refused.note(&moves, first, last);
            continue;
        }
        match evidence(time, values, &moves, (first, last), drift, stillness) {
            Some(gain) => {
                taken[first..=last].fill(true);
                found.push((first, last, gain));
            }
            None => refused.note(&moves, first, last),
        }
    }
    let observed = together(&found);
    found.retain(|(first, last, gain)| {
        let stands = *gain >= OBSERVED
            || ((observed || (stillness.smooth && moves[*last].end - moves[*first].start >= LONG)) && *gain > -LEAST);
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

/// Share of the way that the column would have gone on in a hold by which two neighbours without a ramp between them differ, if
/// they are two levels.
const APART: f64 = 0.65;
/// Most samples that tell how far two neighbours are apart.
const BESIDE: usize = 64;

/// Standstills in order; those that noise alone cut in two are one, and the first begins with the record if nothing but noise is
/// before it.
pub(super) fn joined(values: &[f64], found: &[Standstill], stillness: &Stillness) -> Vec<Standstill> {
    let apart = APART * stillness.goes_on[0];
    let mut joined: Vec<Standstill> = Vec::new();
    for mut next in found.iter().copied() {
        let after = mean(&values[next.start..next.end.min(next.start + BESIDE)]);
        match joined.last_mut() {
            Some(last) if last.end + STRAY >= next.start => {
                let before = mean(&values[last.start.max(last.end.saturating_sub(BESIDE))..last.end]);
                if (after - before).abs() <= apart {
                    last.end = next.end;
                    continue;
                }
            }
            None if next.start <= STRAY && values[..next.start].iter().all(|v| (v - after).abs() <= apart) => {
                next.start = 0;
            }
            _ => {}
        }
        joined.push(next);
    }
    joined
}

/// Samples of a level that a controller reached without a corner; of fewer the corners must tell.
const LONG: usize = 100;

/// A standstill among others may do without, if its corners are not worse by this.
const LEAST: f64 = 6.0;

/// Whether the standstills whose corners are not observed one by one are observed together: a machine that stops at one turn, stops at
/// the others, too.
fn together(found: &[(usize, usize, f64)]) -> bool {
    let gains: Vec<f64> = found.iter().map(|(_, _, gain)| *gain).filter(|gain| gain.is_finite()).collect();
    let sum = gains.iter().map(|gain| gain.min(2.0 * OBSERVED)).sum::<f64>();
    sum >= OBSERVED.max(3.0 * gains.len() as f64)
}

/// Grows a piece to all neighbours that keep to its level.
fn grown(moves: &[Move], taken: &[bool], seed: usize, stillness: &Stillness) -> (usize, usize) {
    let (mut first, mut last) = (seed, seed);
    let most = (2.0 * stillness.band).max(1.5 * moves[seed].travel().abs() + stillness.band);
    let (mut low, mut high) = moves[seed].bounds();
    let mut keeps = |next: &Move, edge: f64| {
        let (a, b) = next.bounds();
        let near = (a - edge).abs().max((b - edge).abs()) <= stillness.band;
        let within = b.max(high) - a.min(low) <= most;
        if near && within {
            (low, high) = (a.min(low), b.max(high));
        }
        near && within
    };
    loop {
        let was = (first, last);
        let later = beyond(moves, last, |from| from.checked_add(1).filter(|next| *next < moves.len()));
        let mut later = later.into_iter().take_while(|next| !taken[*next]);
        last = later.find(|next| keeps(&moves[*next], moves[last].ends[1])).unwrap_or(last);
        let mut earlier = beyond(moves, first, |from| from.checked_sub(1)).into_iter().take_while(|next| !taken[*next]);
        first = earlier.find(|next| keeps(&moves[*next], moves[first].ends[0])).unwrap_or(first);
        if (first, last) == was {
            return was;
        }
    }
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

/// The first move of what a servo does after its ramp: it strays little, for no longer than the standstill, and the ramp before
/// it is twice as fast.
fn settling(moves: &[Move], taken: &[bool], (first, last): (usize, usize), stillness: &Stillness) -> usize {
    let level = moves[first].ends[0];
    let (begin, duration) = (moves[first].times[0], moves[last].times[1] - moves[first].times[0]);
    let (mut settled, mut strays, mut rested) = (first, 0.0f64, 0.0f64);
    for next in (1..first).rev().take(MOST_SETTLING) {
        let (low, high) = moves[next].bounds();
        strays = strays.max((low - level).abs()).max((high - level).abs());
        if strays > stillness.goes_on[0] && moves[next].travel().abs() <= RESTS * strays {
            rested = rested.max(moves[next].duration());
        }
        if taken[next] || begin - moves[next].times[0] > duration {
            break;
        }
        let outer = &moves[next - 1];
        let travel = ramp_travel(moves, taken, next - 1);
        if moves[next].end > moves[next].start
            && strays <= SETTLING * travel + stillness.noise
            && travel > 8.0 * stillness.band
            && outer.speed().abs() > 2.0 * moves[next].speed().abs()
            && rested <= 0.5 * (begin - moves[next].times[0])
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
