//! Where exactly a hold begins and ends: where the line through the ramp meets the line through the hold.

use super::line::Line;
use super::pieces::Piece;
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
                found[index].start = column.start_of(before, cut[index].start, found[index]);
            }
            if found[index].end < count {
                found[index].end = column.end_of(after, cut[index].end, found[index]);
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

    /// How far an edge may lie from where the polygon was cut beside a piece of ramp.
    fn reach(&self, sample: usize) -> usize {
        let ramp = self.piece_of(sample);
        ramp.end - ramp.start + 2 * FEWEST
    }

    fn line(&self, range: std::ops::Range<usize>) -> Line {
        Line::through(self.time, self.values, range)
    }

    /// First sample of a hold that was cut off its ramp at `cut`; the ramp begins at `before` or later.
    fn start_of(&self, before: usize, cut: usize, hold: Standstill) -> usize {
        // The pieces at the cut may be scraps.
        let mut until = self.piece_of(cut).end;
        while until < hold.end && until < hold.start + 2 * FEWEST {
            until = self.piece_of(until).end;
        }
        let until = until.clamp(hold.start + 1, hold.end);
        let level = self.line(hold.start..until);
        let mut from = self.piece_of(cut - 1).start.max(before);
        while from > before && hold.start < from + FEWEST {
            from = self.piece_of(from - 1).start.max(before);
        }
        if hold.start >= from + FEWEST
            && let Some(meeting) = meeting(&self.line(from..hold.start), &level)
        {
            let slack = SLACK * (self.time[hold.start] - self.time[hold.start - 1]);
            let at = self.time.partition_point(|t| *t < meeting - slack);
            if at > from && at < until && at.abs_diff(cut) <= self.reach(cut - 1) {
                return at;
            }
        }
        let keeps = |i: usize| (self.values[i] - level.at(self.time[i])).abs() <= self.near;
        let mut start = hold.start;
        while start < hold.end - 1 && !keeps(start) {
            start += 1;
        }
        while start > before && keeps(start - 1) {
            start -= 1;
        }
        start
    }

    /// Sample after the last of a hold that was cut off its ramp at `cut`; the ramp ends at `after` or before.
    fn end_of(&self, after: usize, cut: usize, hold: Standstill) -> usize {
        let mut from = self.piece_of(cut - 1).start;
        while from > hold.start && from + 2 * FEWEST > hold.end {
            from = self.piece_of(from - 1).start;
        }
        let from = from.clamp(hold.start, hold.end - 1);
        let level = self.line(from..hold.end);
        let mut until = self.piece_of(cut).end.min(after);
        while until < after && until < hold.end + FEWEST {
            until = self.piece_of(until).end.min(after);
        }
        if until >= hold.end + FEWEST
            && let Some(meeting) = meeting(&self.line(hold.end..until), &level)
        {
            let slack = SLACK * (self.time[hold.end] - self.time[hold.end - 1]);
            let at = self.time.partition_point(|t| *t <= meeting + slack);
            if at > from && at < until && at.abs_diff(cut) <= self.reach(cut) {
                return at;
            }
        }
        let keeps = |i: usize| (self.values[i] - level.at(self.time[i])).abs() <= self.near;
        let mut end = hold.end;
        while end > hold.start + 1 && !keeps(end - 1) {
            end -= 1;
        }
        while end < after && keeps(end) {
            end += 1;
        }
        end
    }
}

/// When two lines meet; `None` if they are as good as parallel.
fn meeting(ramp: &Line, level: &Line) -> Option<f64> {
    let slopes = ramp.slope() - level.slope();
    let origin = level.middle();
    let meeting = origin + (level.at(origin) - ramp.at(origin)) / slopes;
    (slopes.abs() > 1e-3 * level.slope().abs() && meeting.is_finite()).then_some(meeting)
}
