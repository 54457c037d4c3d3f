//! Where exactly a hold begins and ends: where the line through the ramp meets the line through the hold.

use super::pieces::{Line, Piece};
use super::standstill::Standstill;

/// Share of a sample interval by which an edge may be off: the rounding of a time column, far below a sample.
const SLACK: f64 = 0.05;
/// Ramps of fewer samples have no line of their own.
const FEWEST: usize = 4;
/// How often samples are dealt out anew.
const ROUNDS: usize = 3;

/// Moves the edges of standstills to where ramps and levels meet.
///
/// Where a ramp has no line, samples no farther than `near` from the level belong to the hold. Elsewhere all samples of the straight piece of either side count, so that the error of an edge comes near the limit that noise
/// sets. What is a sample of the ramp and what of the hold follows from the edge, so it is done three times.
pub(super) fn sharpened(
    time: &[f64],
    values: &[f64],
    pieces: &[Piece],
    near: f64,
    found: &mut [Standstill],
) {
    let count = values.len();
    for _ in 0..ROUNDS {
        for index in 0..found.len() {
            let hold = found[index];
            let before = index.checked_sub(1).map_or(0, |i| found[i].end);
            let after = found.get(index + 1).map_or(count, |next| next.start);
            if hold.start > 0 {
                let ramp = before..hold.start;
                found[index].start = start_of(time, values, pieces, near, ramp, hold);
            }
            let hold = found[index];
            if hold.end < count {
                found[index].end = end_of(time, values, pieces, near, hold.end..after, hold);
            }
        }
    }
}

/// The piece that holds a sample.
fn piece_of(pieces: &[Piece], sample: usize) -> &Piece {
    &pieces[pieces.partition_point(|piece| piece.end <= sample).min(pieces.len() - 1)]
}

/// Samples of the hold, from its start on, that are straight.
fn first_of(pieces: &[Piece], hold: Standstill) -> std::ops::Range<usize> {
    // The piece at the edge itself may be a scrap that the cut left.
    let mut end = piece_of(pieces, hold.start).end;
    while end < hold.end && end - hold.start < 2 * FEWEST {
        end = piece_of(pieces, end).end;
    }
    hold.start..end.clamp(hold.start + 1, hold.end)
}

fn last_of(pieces: &[Piece], hold: Standstill) -> std::ops::Range<usize> {
    let mut start = piece_of(pieces, hold.end - 1).start;
    while start > hold.start && hold.end - start < 2 * FEWEST {
        start = piece_of(pieces, start - 1).start;
    }
    start.clamp(hold.start, hold.end - 1)..hold.end
}

fn start_of(
    time: &[f64],
    values: &[f64],
    pieces: &[Piece],
    near: f64,
    ramp: std::ops::Range<usize>,
    hold: Standstill,
) -> usize {
    let own = first_of(pieces, hold);
    let level = Line::through(time, values, own.clone());
    let keeps = |i: usize| (values[i] - level.at(time[i])).abs() <= near;
    let mut start = hold.start;
    if ramp.len() >= FEWEST {
        let mut from = piece_of(pieces, start - 1).start.max(ramp.start);
        while from > ramp.start && start - from < FEWEST {
            from = piece_of(pieces, from - 1).start.max(ramp.start);
        }
        let line = Line::through(time, values, from..start);
        if let Some(meeting) = meeting(&line, &level) {
            let slack = SLACK * (time[start] - time[start - 1]);
            let at = time.partition_point(|t| *t < meeting - slack);
            if at > from && at < own.end {
                return at;
            }
        }
    }
    while start < hold.end - 1 && !keeps(start) {
        start += 1;
    }
    while start > ramp.start && keeps(start - 1) {
        start -= 1;
    }
    start
}

fn end_of(
    time: &[f64],
    values: &[f64],
    pieces: &[Piece],
    near: f64,
    ramp: std::ops::Range<usize>,
    hold: Standstill,
) -> usize {
    let own = last_of(pieces, hold);
    let level = Line::through(time, values, own.clone());
    let keeps = |i: usize| (values[i] - level.at(time[i])).abs() <= near;
    let mut end = hold.end;
    if ramp.len() >= FEWEST {
        let mut until = piece_of(pieces, end).end.min(ramp.end);
        while until < ramp.end && until - end < FEWEST {
            until = piece_of(pieces, until).end.min(ramp.end);
        }
        let line = Line::through(time, values, end..until);
        if let Some(meeting) = meeting(&line, &level) {
            let slack = SLACK * (time[end] - time[end - 1]);
            let at = time.partition_point(|t| *t <= meeting + slack);
            if at > own.start && at < until {
                return at;
            }
        }
    }
    while end > hold.start + 1 && !keeps(end - 1) {
        end -= 1;
    }
    while end < ramp.end && keeps(end) {
        end += 1;
    }
    end
}

/// When two lines meet; `None` if they are as good as parallel.
fn meeting(ramp: &Line, level: &Line) -> Option<f64> {
    let slopes = ramp.slope() - level.slope();
    let origin = level.middle();
    let meeting = origin + (level.at(origin) - ramp.at(origin)) / slopes;
    (slopes.abs() > 1e-3 * level.slope().abs() && meeting.is_finite()).then_some(meeting)
}
