//! A polygon as what the column does: pieces, jumps between them, and the ramps they make.

use super::pieces::Piece;

/// Part of the polygon, or a jump from one piece to the next, which has no samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Move {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) times: [f64; 2],
    pub(super) ends: [f64; 2],
}

impl Move {
    pub(super) fn duration(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    pub(super) fn travel(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    pub(super) fn speed(&self) -> f64 {
        let duration = self.duration();
        if duration > 0.0 { self.travel() / duration } else { 0.0 }
    }

    /// Value at a time inside.
    pub(super) fn at(&self, time: f64) -> f64 {
        self.ends[0] + self.speed() * (time - self.times[0])
    }

    /// Least and greatest value.
    pub(super) fn bounds(&self) -> (f64, f64) {
        (self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1]))
    }
}

/// The polygon as moves: its pieces, and the jumps between them where they lie more than `band` apart.
pub(super) fn moves(time: &[f64], pieces: &[Piece], band: f64) -> Vec<Move> {
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

/// Share of its greatest speed under which a ramp has ended.
const ENDED: f64 = 0.25;

/// First sample of the ramp that ends at a move.
pub(super) fn ramp_before(moves: &[Move], first: usize) -> usize {
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
pub(super) fn ramp_after(moves: &[Move], last: usize) -> usize {
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
pub(super) fn goes_on_before(moves: &[Move], first: usize, duration: f64) -> Option<f64> {
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
pub(super) fn goes_on_after(moves: &[Move], last: usize, duration: f64) -> Option<f64> {
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
