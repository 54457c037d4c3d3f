//! A noisy column as a polygon: straight pieces, joined from the bottom up.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::segment::hear;
use crate::watch::{Cancelled, Watch};

/// Moments of some samples about their mean, from which the straight line through them follows.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Line {
    pub(super) count: f64,
    /// Mean time of the samples.
    pub(super) time: f64,
    value: f64,
    tt: f64,
    tv: f64,
    vv: f64,
}

impl Line {
    pub(super) fn of_sample(time: f64, value: f64) -> Self {
        Self {
            count: 1.0,
            time,
            value,
            ..Self::default()
        }
    }

    /// The line through the samples of a range.
    pub(super) fn through(time: &[f64], values: &[f64], range: std::ops::Range<usize>) -> Self {
        range.fold(Self::default(), |line, i| line.joined(&Self::of_sample(time[i], values[i])))
    }

    /// The line through the samples of both.
    pub(super) fn joined(&self, other: &Self) -> Self {
        let count = self.count + other.count;
        let (share, apart) = (other.count / count, (other.time - self.time, other.value - self.value));
        let weight = self.count * share;
        Self {
            count,
            time: self.time + share * apart.0,
            value: self.value + share * apart.1,
            tt: self.tt + other.tt + weight * apart.0 * apart.0,
            tv: self.tv + other.tv + weight * apart.0 * apart.1,
            vv: self.vv + other.vv + weight * apart.1 * apart.1,
        }
    }

    /// Slope; 0 for a single sample.
    pub(super) fn slope(&self) -> f64 {
        if self.tt > 0.0 { self.tv / self.tt } else { 0.0 }
    }

    /// Value of the line at a time.
    pub(super) fn at(&self, time: f64) -> f64 {
        self.value + self.slope() * (time - self.time)
    }

    /// Sum of the squares that the line leaves.
    pub(super) fn left(&self) -> f64 {
        if self.tt > 0.0 { (self.vv - self.tv * self.tv / self.tt).max(0.0) } else { self.vv }
    }
}

/// Samples `start..end` and the line through them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) line: Line,
}

impl Piece {
    fn new(start: usize, end: usize, line: Line) -> Self {
        Self { start, end, line }
    }
}

/// What a polygon may leave of a column.
#[derive(Debug, Clone, Copy)]
pub(super) struct Roughness {
    /// Standard deviation of the noise.
    pub(super) noise: f64,
    /// Root mean square by which samples may leave a line for other reasons than noise.
    pub(super) stray: f64,
    /// Whether what strays does so slowly, for many samples together.
    pub(super) hunts: bool,
}

/// Price of a piece, in units of the noise's square, in a column of one sample; a column of e times as many samples has as many
/// more places where noise looks like a corner, and asks for one unit more.
const PRICE: f64 = 8.0;
/// By how much less than a piece costs two pieces of the finer polygon must explain better than one.
const FINER: f64 = 7.0;
/// The least of that.
const LEAST_KEPT_APART: f64 = 10.0;

/// A proposal to join two pieces: the rank of its cost, where they begin, and where the second ends. A heap gives the cheapest
/// first; of equals the earliest.
type Proposal = Reverse<(i64, usize, usize, usize)>;

/// An integer that stands to others as `cost` to theirs by `total_cmp`.
fn rank(cost: f64) -> i64 {
    let bits = cost.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// Cuts a column into straight pieces.
///
/// 1. At first every sample is a piece, or in a long column every run that a line explains. The two neighbours whose union a
///    straight line explains best are joined, again and again, until every union would leave more than noise (and the stray
///    allowed) explains. Cost: N log N for short columns, N for long ones.
/// 2. Among all polygons that have corners of this one, the one of least cost is taken.
/// 3. Every corner moves to where its two lines leave least.
pub(super) fn pieces(
    time: &[f64],
    values: &[f64],
    roughness: Roughness,
    watch: &mut dyn Watch,
) -> Result<Vec<Piece>, Cancelled> {
    let price = PRICE + (values.len() as f64).ln();
    let mut fine = joined(time, values, roughness, price, watch)?;
    polish(time, values, &mut fine, watch)?;
    let mut pieces = fewest(&fine, roughness, price, watch)?;
    polish(time, values, &mut pieces, watch)?;
    Ok(pieces)
}

/// Neighbours joined to pieces until no union is explained by a line.
fn joined(
    time: &[f64],
    values: &[f64],
    roughness: Roughness,
    price: f64,
    watch: &mut dyn Watch,
) -> Result<Vec<Piece>, Cancelled> {
    let kept_apart = (price - FINER).max(LEAST_KEPT_APART);
    let cost = |a: &Line, b: &Line| {
        let more = a.joined(b).left() - a.left() - b.left();
        let allowed =
            kept_apart * roughness.noise * roughness.noise + a.count.min(b.count) * roughness.stray * roughness.stray;
        more / allowed
    };
    let first = first_pieces(time, values, &cost);
    hear(watch)?;
    let count = first.len();
    // Index of the piece after; 0 stands for a piece that was joined to another.
    let mut lines: Vec<Line> = first.iter().map(|piece| piece.line).collect();
    let mut ends: Vec<usize> = (1..=count).collect();
    let mut before: Vec<usize> = (0..count).map(|i| i.saturating_sub(1)).collect();
    let mut proposals: BinaryHeap<Proposal> = BinaryHeap::new();
    let propose = |proposals: &mut BinaryHeap<Proposal>, cost: f64, left: usize, right: usize, end: usize| {
        if cost <= 1.0 {
            proposals.push(Reverse((rank(cost), left, right, end)));
        }
    };
    for right in 1..count {
        // Single samples join at no cost.
        let samples = first[right - 1].end - first[right - 1].start + first[right].end - first[right].start;
        let cost = if samples == 2 { 0.0 } else { cost(&lines[right - 1], &lines[right]) };
        propose(&mut proposals, cost, right - 1, right, right + 1);
    }
    let mut done = 0usize;
    while let Some(Reverse((_, left, right, end))) = proposals.pop() {
        done += 1;
        if done.is_multiple_of(JOINED) {
            hear(watch)?;
        }
        // Out of date: one of the two has grown or gone since.
        if ends[left] != right || ends[right] != end {
            continue;
        }
        lines[left] = lines[left].joined(&lines[right]);
        (ends[left], ends[right]) = (end, 0);
        if end < count {
            before[end] = left;
            propose(&mut proposals, cost(&lines[left], &lines[end]), left, end, ends[end]);
        }
        if left > 0 {
            let first = before[left];
            propose(&mut proposals, cost(&lines[first], &lines[left]), first, left, end);
        }
    }
    let mut pieces = Vec::new();
    let mut start = 0;
    while start < count {
        pieces.push(Piece::new(first[start].start, first[ends[start] - 1].end, lines[start]));
        start = ends[start];
    }
    Ok(pieces)
}

/// Proposals from one report to the next.
const JOINED: usize = 10_000;

/// What the joining begins with: single samples; of a long column runs of two, four and more that a line explains so well that
/// no other joining would part them.
fn first_pieces(time: &[f64], values: &[f64], cost: &impl Fn(&Line, &Line) -> f64) -> Vec<Piece> {
    let run = (values.len() / MANY + 1).next_power_of_two();
    let mut pieces: Vec<Piece> = Vec::with_capacity(values.len() / run + 1);
    for begin in (0..values.len()).step_by(run) {
        let first = pieces.len();
        for i in begin..(begin + run).min(values.len()) {
            pieces.push(Piece::new(i, i + 1, Line::of_sample(time[i], values[i])));
            // As in a binary count: a carry joins two runs of one length.
            let mut length = 1;
            while (i + 1 - begin) % (2 * length) == 0 {
                let [.., left, right] = &pieces[first..] else { break };
                let alike = left.end - left.start == length && right.end - right.start == length;
                if !alike || (length > 1 && cost(&left.line, &right.line) > SURELY) {
                    break;
                }
                let (end, line) = (right.end, left.line.joined(&right.line));
                pieces.pop();
                if let Some(last) = pieces.last_mut() {
                    (last.end, last.line) = (end, line);
                }
                length *= 2;
            }
        }
    }
    pieces
}

/// Columns of more samples begin with runs of samples.
const MANY: usize = 20_000;
/// Share of what two pieces may cost to be joined up to which they are one without asking their other neighbours.
const SURELY: f64 = 0.3;

/// The polygon of least cost among those whose corners are corners of a finer one: its residual, in units of the noise's
/// square, and a price for every piece.
///
/// What the finer pieces leave, all of them leave; it does not count. What strays slowly strays for a finer piece together, so
/// that its mean square grows with their length.
fn fewest(fine: &[Piece], roughness: Roughness, price: f64, watch: &mut dyn Watch) -> Result<Vec<Piece>, Cancelled> {
    let noise = roughness.noise.powi(2);
    let stray = roughness.stray.powi(2) / if roughness.hunts { 1.0 } else { price };
    // Cost of the best polygon through the first pieces, where its last piece begins, and the line through that.
    let mut best: Vec<(f64, usize, Line)> = vec![(0.0, 0, Line::default())];
    for end in 1..=fine.len() {
        hear(watch)?;
        let (mut line, mut own) = (Line::default(), 0.0);
        let mut chosen = (f64::MAX, 0, Line::default());
        for start in (end.saturating_sub(MOST_JOINED)..end).rev() {
            line = fine[start].line.joined(&line);
            own += fine[start].line.left();
            let allowed = noise + line.count / (end - start) as f64 * stray;
            let more = (line.left() - own).max(0.0) / allowed.max(f64::MIN_POSITIVE);
            let cost = best[start].0 + price + more;
            if cost < chosen.0 {
                chosen = (cost, start, line);
            }
        }
        best.push(chosen);
    }
    let mut pieces = Vec::new();
    let mut end = fine.len();
    while end > 0 {
        let (_, start, line) = best[end];
        pieces.push(Piece::new(fine[start].start, fine[end - 1].end, line));
        end = start;
    }
    pieces.reverse();
    Ok(pieces)
}

/// Most pieces that are joined to one.
const MOST_JOINED: usize = 2000;

/// Moves all corners to where they are best.
fn polish(time: &[f64], values: &[f64], pieces: &mut [Piece], watch: &mut dyn Watch) -> Result<(), Cancelled> {
    for _ in 0..POLISHED {
        for right in 1..pieces.len() {
            hear(watch)?;
            let (left, rest) = pieces.split_at_mut(right);
            split(time, values, &mut left[right - 1], &mut rest[0]);
        }
    }
    Ok(())
}

/// How far a cut is moved at most, in samples.
const FAR: usize = 100_000;
/// How often all cuts are moved to where they are best.
const POLISHED: usize = 2;

/// Moves the cut between two pieces to where their lines leave least.
fn split(time: &[f64], values: &[f64], left: &mut Piece, right: &mut Piece) {
    // Of long pieces the cut is sought in the samples next to it.
    let range = left.start.max(left.end.saturating_sub(FAR))..right.end.min(right.start + FAR);
    let beyond = Line::through(time, values, range.end..right.end);
    let backwards = range.clone().rev().scan(beyond, |line, i| {
        *line = Line::of_sample(time[i], values[i]).joined(line);
        Some(*line)
    });
    let mut after: Vec<Line> = backwards.collect();
    after.reverse();
    let mut before = Line::through(time, values, left.start..range.start);
    let mut best = (left.line.left() + right.line.left(), left.end, left.line, right.line);
    for cut in range.start + 1..range.end {
        before = before.joined(&Line::of_sample(time[cut - 1], values[cut - 1]));
        let rest = &after[cut - range.start];
        let sum = before.left() + rest.left();
        if sum < best.0 {
            best = (sum, cut, before, *rest);
        }
    }
    (left.end, right.start) = (best.1, best.1);
    (left.line, right.line) = (best.2, best.3);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;
    use crate::watch::Unwatched;

    fn cut(values: &[f64], roughness: Roughness) -> Vec<usize> {
        let time: Vec<f64> = (0..values.len()).map(|i| i as f64).collect();
        pieces(&time, values, roughness, &mut Unwatched).unwrap().iter().map(|piece| piece.end).collect()
    }

    #[test]
    fn lines_without_noise_are_cut_at_their_kinks() {
        let value = |i: i32| f64::from(i.min(100)) - 2.0 * f64::from((i - 250).max(0));
        let values: Vec<f64> = (0..400).map(value).collect();
        let ends = cut(
            &values,
            Roughness {
                noise: 0.0,
                stray: 1e-3,
                hunts: false,
            },
        );
        assert_eq!(ends.len(), 3, "{ends:?}");
        assert!(ends[0].abs_diff(100) <= 1 && ends[1].abs_diff(250) <= 1, "{ends:?}");
    }

    /// What a long column is joined from in runs has its corners where a short one has them.
    #[test]
    fn long_columns_are_cut_at_their_corners() {
        let mut random = Rng::new(4);
        let (count, every) = (12 * MANY, 3 * MANY + 17);
        let shape = |i: usize| {
            let (step, rest) = (i / every, i % every);
            step as f64 + (rest as f64 / 10.0).min(1.0)
        };
        let values: Vec<f64> = (0..count).map(|i| shape(i) + 1e-3 * random.normal()).collect();
        let ends = cut(
            &values,
            Roughness {
                noise: 1e-3,
                stray: 0.0,
                hunts: false,
            },
        );
        let expected: Vec<usize> =
            (0..=count / every).flat_map(|step| [step * every, step * every + 10]).skip(1).collect();
        assert_eq!(ends.len(), expected.len() + 1, "{ends:?}");
        for (found, expected) in ends.iter().zip(&expected) {
            assert!(found.abs_diff(*expected) <= 1, "{ends:?} {expected:?}");
        }
    }

    /// A kink of slope change s with n samples on either side is observed where s² n³/24 exceeds 25 σ².
    #[test]
    fn noise_alone_is_hardly_ever_cut() {
        let mut random = Rng::new(3);
        let values: Vec<f64> = (0..20_000).map(|_| random.normal()).collect();
        let ends = cut(
            &values,
            Roughness {
                noise: 1.0,
                stray: 0.0,
                hunts: false,
            },
        );
        assert!(ends.len() <= 3, "{ends:?}");
        let bent: Vec<f64> = values.iter().zip(0..).map(|(v, i)| v + 1e-3 * f64::from((i - 10_000).max(0))).collect();
        let ends = cut(
            &bent,
            Roughness {
                noise: 1.0,
                stray: 0.0,
                hunts: false,
            },
        );
        assert!((2..=4).contains(&ends.len()) && ends.iter().any(|end| end.abs_diff(10_000) < 800), "{ends:?}");
    }
}
