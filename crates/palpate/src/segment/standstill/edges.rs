//! Where exactly a hold begins and ends: where the line through the ramp meets the line through the hold.

use std::ops::Range;

use super::pieces::{Line, Piece};
use super::standstills::Standstill;

/// Share of a sample interval by which an edge may be off: the rounding of a time column, far below a sample.
const SLACK: f64 = 0.05;
/// Ramps of fewer samples have no line of their own.
const FEWEST: usize = 4;
/// How often samples are dealt out anew.
const ROUNDS: usize = 3;

/// Moves the edges of standstills to where ramps and levels meet.
///
/// Where a ramp has no line, samples no farther than `near` from the level belong to the hold. Elsewhere all samples of the
/// straight piece of either side count, so that the error of an edge comes near the limit that noise sets. What is a sample of
/// the ramp and what of the hold follows from the edge, so it is done three times.
pub(super) fn sharpened(time: &[f64], values: &[f64], pieces: &[Piece], near: f64, found: &mut [Standstill]) {
    let count = values.len();
    let cut = found.to_vec();
    for _ in 0..ROUNDS {
        for index in 0..found.len() {
            let before = index.checked_sub(1).map_or(0, |i| found[i].end);
            let after = found.get(index + 1).map_or(count, |next| next.start);
            let column = Column {
                time,
                values,
                pieces,
                near,
            };
            if found[index].start > 0 {
                found[index].start = column.edge(cut[index].start, found[index], before, true);
            }
            if found[index].end < count {
                found[index].end = column.edge(cut[index].end, found[index], after, false);
            }
        }
    }
}

/// A column with its polygon.
struct Column<'a> {
    time: &'a [f64],
    values: &'a [f64],
    pieces: &'a [Piece],
    near: f64,
}

impl Column<'_> {
    /// The piece that holds a sample.
    fn piece_of(&self, sample: usize) -> &Piece {
        &self.pieces[self.pieces.partition_point(|piece| piece.end <= sample).min(self.pieces.len() - 1)]
    }

    /// The start of the piece that ends at `cut`, or of an earlier one until it is at `near` or before; not before `least`.
    fn back(&self, cut: usize, least: usize, near: usize) -> usize {
        let mut from = self.piece_of(cut - 1).start.max(least);
        while from > least.max(near) {
            from = self.piece_of(from - 1).start.max(least);
        }
        from
    }

    /// The end of the piece that begins at `cut`, or of a later one until it is at `near` or behind; not behind `most`.
    fn forth(&self, cut: usize, most: usize, near: usize) -> usize {
        let mut until = self.piece_of(cut).end.min(most);
        while until < most.min(near) {
            until = self.piece_of(until).end.min(most);
        }
        until
    }

    fn line(&self, range: Range<usize>) -> Line {
        Line::through(self.time, self.values, range)
    }

    /// Whether most samples of a ramp, with the pieces before it, are those of the rest that it comes from or goes to.
    fn mostly_stands(&self, ramp: &Range<usize>, is_start: bool) -> bool {
        let rest = self.values[if is_start { ramp.start } else { ramp.end - 1 }];
        let stands = ramp.clone().filter(|i| (self.values[*i] - rest).abs() <= self.near).count();
        2 * stands > ramp.len()
    }

    /// Whether samples are farther from their line than from a level that they keep to.
    fn bends(&self, line: &Line) -> bool {
        line.left() > line.count * self.near * self.near
    }

    /// First sample of a hold, or the sample after its last, where it was cut off its ramp at `cut`; the ramp goes no farther than to `limit`.
    fn edge(&self, cut: usize, hold: Standstill, limit: usize, is_start: bool) -> usize {
        let edge = if is_start { hold.start } else { hold.end };
        // The pieces at the cut may be scraps.
        let (from, until) = if is_start {
            let until = self.forth(cut, hold.end, edge + 2 * FEWEST).max(edge + 1);
            (self.back(cut, limit, edge.saturating_sub(FEWEST)), until)
        } else {
            let from = self.back(cut, hold.start, edge.saturating_sub(2 * FEWEST)).min(edge - 1);
            (from, self.forth(cut, limit, edge + FEWEST))
        };
        let (before, after) = (from..edge, edge..until);
        let (ramp, level) = if is_start { (before, after) } else { (after, before) };
        let (through, level) = (self.line(ramp.clone()), self.line(level));
        if ramp.len() >= FEWEST
            && !(self.mostly_stands(&ramp, is_start) && self.bends(&through))
            && let Some(meeting) = meeting(&through, &level)
        {
            let slack = SLACK * (self.time[edge] - self.time[edge - 1]);
            let is_before = |t: &f64| if is_start { *t < meeting - slack } else { *t <= meeting + slack };
            let at = self.time.partition_point(is_before);
            // How far an edge may lie from where the polygon was cut beside a piece of ramp.
            let piece = self.piece_of(if is_start { cut - 1 } else { cut });
            if at > from && at < until && at.abs_diff(cut) <= piece.end - piece.start + 2 * FEWEST {
                return at;
            }
        }
        let keeps = |i: &usize| (self.values[*i] - level.at(self.time[*i])).abs() <= self.near;
        if is_start {
            let start = (edge..hold.end - 1).find(keeps).unwrap_or(hold.end - 1);
            (limit..start).rev().take_while(keeps).last().unwrap_or(start)
        } else {
            let end = (hold.start + 1..edge).rev().find(keeps).unwrap_or(hold.start) + 1;
            (end..limit).take_while(keeps).last().map_or(end, |last| last + 1)
        }
    }
}

/// When two lines meet; `None` if they are as good as parallel.
fn meeting(ramp: &Line, level: &Line) -> Option<f64> {
    let slopes = ramp.slope() - level.slope();
    let origin = level.time;
    let meeting = origin + (level.at(origin) - ramp.at(origin)) / slopes;
    (slopes.abs() > 1e-3 * level.slope().abs() && meeting.is_finite()).then_some(meeting)
}
