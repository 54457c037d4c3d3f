//! Where a stretch may end: the force as pieces of parabolas, joined from the bottom up.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::optimise::fit_linear;

/// Squares that a join may cost, in squares of the noise.
const JOINED: f64 = 9.0;
/// Most pieces.
const MOST: usize = 220;
/// How far an end may be moved once the pieces are known, samples, and as a share of the two pieces beside it.
const MOVED: (usize, usize) = (12, 8);

/// The first samples of the pieces, and the end of the last.
pub(super) fn breaks(time: &[f64], force: &[f64], noise: f64) -> Vec<usize> {
    let mut ends = joined(time, force, noise);
    for _ in 0..2 {
        sharpen(time, force, &mut ends);
    }
    ends
}

/// Moves every end to where the parabolas on its sides leave least.
pub(super) fn sharpen(time: &[f64], force: &[f64], ends: &mut [usize]) {
    for index in 1..ends.len().saturating_sub(1) {
        let [before, here, after] = [ends[index - 1], ends[index], ends[index + 1]];
        let reach = ((after - before) / MOVED.1).clamp(2, MOVED.0);
        let (from, until) = (before.max(here.saturating_sub(8 * reach)), after.min(here + 8 * reach));
        let cost = |end: usize| left(time, force, (from, end)) + left(time, force, (end, until));
        let places = here.saturating_sub(reach).max(before + 1)..=(here + reach).min(after - 1);
        let costs = places.map(|place| (place, cost(place)));
        if let Some((place, _)) = costs.min_by(|a, b| a.1.total_cmp(&b.1)) {
            ends[index] = place;
        }
    }
}

/// Two neighbours that may be joined; those that cost least come first.
#[derive(Debug, PartialEq)]
struct Join {
    cost: f64,
    left: usize,
    right: usize,
    /// How often each has been joined before: a join of what has changed since is none.
    joined: (u32, u32),
}

impl Eq for Join {}

impl PartialOrd for Join {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Join {
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then_with(|| other.left.cmp(&self.left))
    }
}

/// A piece of the approximation, in a list of its neighbours.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: usize,
    end: usize,
    /// Squares that its parabola leaves.
    left: f64,
    joined: u32,
    /// Neighbours; a piece that another has taken in has none and counts no more.
    before: Option<usize>,
    after: Option<usize>,
    gone: bool,
}

fn joined(time: &[f64], force: &[f64], noise: f64) -> Vec<usize> {
    let count = force.len().div_ceil(2);
    let mut pieces: Vec<Piece> = (0..count)
        .map(|i| Piece {
            start: 2 * i,
            end: (2 * i + 2).min(force.len()),
            left: 0.0,
            joined: 0,
            before: i.checked_sub(1),
            after: (i + 1 < count).then_some(i + 1),
            gone: false,
        })
        .collect();
    let join = |pieces: &[Piece], a: usize, b: usize| {
        let (first, second) = (pieces[a], pieces[b]);
        Join {
            cost: left(time, force, (first.start, second.end)) - first.left - second.left,
            left: a,
            right: b,
            joined: (first.joined, second.joined),
        }
    };
    let mut heap: BinaryHeap<Join> = (1..count).map(|i| join(&pieces, i - 1, i)).collect();
    let (mut remain, most) = (count, JOINED * noise * noise);
    while let Some(next) = heap.pop() {
        let (a, b) = (next.left, next.right);
        if pieces[a].gone || pieces[b].gone || (pieces[a].joined, pieces[b].joined) != next.joined {
            continue;
        }
        if next.cost > most && remain <= MOST {
            break;
        }
        let taken = pieces[b];
        pieces[b].gone = true;
        let first = &mut pieces[a];
        first.left += taken.left + next.cost;
        first.end = taken.end;
        first.joined += 1;
        first.after = taken.after;
        remain -= 1;
        let before = first.before;
        if let Some(after) = taken.after {
            pieces[after].before = Some(a);
            heap.push(join(&pieces, a, after));
        }
        if let Some(before) = before {
            heap.push(join(&pieces, before, a));
        }
    }
    let mut ends: Vec<usize> = pieces.iter().filter(|piece| !piece.gone).map(|piece| piece.start).collect();
    ends.push(force.len());
    ends
}

/// Squares that the parabola of least squares leaves of samples from..until.
fn left(time: &[f64], force: &[f64], (from, until): (usize, usize)) -> f64 {
    if until - from <= 3 {
        return 0.0;
    }
    let (centre, value) = (time[usize::midpoint(from, until)], force[usize::midpoint(from, until)]);
    let span = time[until - 1] - time[from];
    let row = |(t, f): (&f64, &f64)| {
        let u = (t - centre) / span;
        ([1.0, u, u * u], f - value, 1.0)
    };
    fit_linear(time[from..until].iter().zip(&force[from..until]).map(row), 0.0).map_or(0.0, |fit| fit.left)
}
