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

/// The last of the moves of a ramp, which begins with the first of these.
pub(super) fn ramp<'a>(parts: impl Iterator<Item = &'a Move> + Clone) -> Option<&'a Move> {
    let direction = parts.clone().next()?.travel().signum();
    let mut fastest = 0.0f64;
    let goes = |part: &&Move| {
        let speed = part.speed() * direction;
        let goes = speed > ENDED * fastest;
        fastest = fastest.max(speed);
        goes
    };
    parts.take_while(goes).last()
}

/// How far the column would go in `duration` at the speed it has just beside a move that has this edge (time and value); `None` at the ends of
/// the record. Of the `parts` beside it, the next first, end `far` (0 before the move, 1 after it) is the far one.
///
/// The farthest point within half the duration counts: a stretch that reaches the next level may end on the same one.
pub(super) fn goes_on<'a>(
    parts: impl Iterator<Item = &'a Move>,
    (edge, level): (f64, f64),
    far: usize,
    duration: f64,
) -> Option<f64> {
    let sign = [-1.0, 1.0][far];
    let until = edge + sign * 0.5 * duration;
    let (mut way, mut span) = (0.0f64, 0.0);
    for part in parts {
        let beyond = sign * (part.times[far] - until) >= 0.0;
        let end = if beyond { until } else { part.times[far] };
        way = way.max((part.at(end) - level).abs()).max((part.ends[1 - far] - level).abs());
        span = sign * (end - edge);
        if beyond {
            break;
        }
    }
    (span > 0.0).then(|| way / span * duration)
}
