//! What a test has shown: how far, how fast, how long, how often; and the course of the jaw that this is read from.

use std::borrow::Cow;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::simulate::{Contact, Drive, Motion, ProgramStep, Sampling, SimulateError, simulate, step_ends};
use crate::statistics::{mean, range, slope};

/// Range of the test; predictions beyond it are extrapolations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CalibrationRange {
    /// The longest hold of the displacement, s; 0 of a test that held none.
    pub longest_hold: f64,
    /// The longest hold of the force, s; 0 of a test that held none.
    #[serde(default)]
    pub longest_force_hold: f64,
    /// The deepest squeeze (travel of the jaw since first touch), m.
    pub deepest: f64,
    /// The fastest ramp, m/s.
    pub fastest: f64,
    /// The slowest ramp, m/s.
    pub slowest: f64,
    /// The largest force, N.
    pub largest_force: f64,
    /// The farthest retreat from the deepest place before it, m; 0 of a test in loading alone.
    #[serde(default)]
    pub farthest_retreat: f64,
    /// How often the body was loaded, from the virgin state on: 1 and every loading after a retreat.
    #[serde(default = "once")]
    pub loadings: u32,
}

fn once() -> u32 {
    1
}

/// What is held in a stretch of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Held {
    /// The displacement changes as it is prescribed.
    Nothing,
    /// The force changes as it is prescribed.
    Pressed,
    Displacement,
    Force,
}

/// End of a stretch of a drive.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Corner {
    time: f64,
    displacement: f64,
    /// In the stretch that ends here.
    held: Held,
}

/// The jaw's way through a drive: straight stretches.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Way {
    corners: Vec<Corner>,
    /// A change of the displacement that counts as a retreat or as another loading, m.
    least: f64,
}

/// What the jaw has done up to a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Done {
    /// The deepest displacement, m.
    pub(super) deepest: f64,
    /// The farthest retreat, m.
    pub(super) retreat: f64,
    /// Number of loadings.
    pub(super) loadings: u32,
    /// Slowest and fastest ramp, m/s; 0 without one.
    pub(super) slowest: f64,
    pub(super) fastest: f64,
    /// What is held now, and since when (s).
    pub(super) held: Held,
    pub(super) since: f64,
    /// The longest time that the displacement was held, s.
    pub(super) longest_hold: f64,
    /// The longest time that the force was held, s.
    pub(super) longest_force_hold: f64,
}

/// Share of the deepest displacement below which the jaw stands.
const STILL: f64 = 0.01;

/// Share of it that is a retreat.
const RETREAT: f64 = 0.05;

/// Times (s) from which and until which something is held.
pub(super) type Span = (f64, f64);

/// What was held in a motion that was measured: spans that follow each other.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct HeldSpans {
    /// Of the force.
    pub(super) force: Vec<Span>,
    /// Of the displacement.
    pub(super) displacement: Vec<Span>,
}

impl HeldSpans {
    /// The motion with the jaw on a straight line, that of least squares, in those spans of the displacement in which it moves by more than
    /// `tolerance` (m).
    fn standing<'a>(&self, motion: &'a Motion, tolerance: f64) -> Cow<'a, Motion> {
        let (times, places) = (motion.times(), motion.displacements());
        let (mut still, mut from): (Vec<(f64, f64)>, usize) = (Vec::new(), 0);
        let knots = |range: Range<usize>| times[range.clone()].iter().copied().zip(places[range].iter().copied());
        for &(start, end) in &self.displacement {
            let (first, behind) =
                (times.partition_point(|time| *time < start), times.partition_point(|time| *time <= end));
            if first < from || behind < first + FEWEST || range(&places[first..behind]) <= tolerance {
                continue;
            }
            let (times, places) = (&times[first..behind], &places[first..behind]);
            let (slope, middle, level) = (slope(times, places), mean(times), mean(places));
            still.extend(knots(from..first));
            still.extend([start, end].map(|time| (time, level + slope * (time - middle))));
            from = behind;
        }
        if from == 0 {
            return Cow::Borrowed(motion);
        }
        still.extend(knots(from..times.len()));
        let (times, places) = still.into_iter().unzip();
        Motion::new(times, places).map_or(Cow::Borrowed(motion), Cow::Owned)
    }
}

/// Knots of a motion in a hold that a line is drawn through, at least.
const FEWEST: usize = 4;

impl Way {
    /// Of a drive, with what the body carries where forces are prescribed. In a motion that was measured displacement and force were held in these spans.
    pub(super) fn of(drive: Drive<'_>, contact: &Contact, held: &HeldSpans) -> Result<Self, SimulateError> {
        match drive {
            Drive::Motion(motion) => Ok(Self::of_motion(motion, held)),
            Drive::Force(history) => {
                let times = history.times().to_vec();
                let course = simulate(drive, contact, &Sampling::Times(times))?;
                let mut before = f64::NAN;
                let corner = |index: usize| {
                    let force = history.forces()[index];
                    let held = if force == before { Held::Force } else { Held::Pressed };
                    before = force;
                    Corner {
                        time: course.time[index],
                        displacement: course.displacement[index],
                        held,
                    }
                };
                Ok(Self::new((0..course.len()).map(corner).collect()))
            }
            Drive::Program(steps) => {
                let ends = step_ends(steps, contact)?;
                let start = Corner {
                    time: 0.0,
                    displacement: 0.0,
                    held: Held::Nothing,
                };
                let corners = steps.iter().zip(&ends).map(|(step, end)| Corner {
                    time: end.time,
                    displacement: end.displacement,
                    held: match step {
                        ProgramStep::Move { .. } | ProgramStep::MoveToForce { .. } => Held::Nothing,
                        ProgramStep::HoldPosition { .. } => Held::Displacement,
                        ProgramStep::Press { .. } => Held::Pressed,
                        ProgramStep::HoldForce { .. } => Held::Force,
                    },
                });
                Ok(Self::new(std::iter::once(start).chain(corners).collect()))
            }
        }
    }

    /// Of a motion, less what is noise in it, and less what a hand that trembles does where the jaw was held. In spans of a force that is held the
    /// jaw creeps.
    pub(super) fn of_motion(motion: &Motion, held: &HeldSpans) -> Self {
        let force_held = &held.force;
        let deepest = motion.displacements().iter().copied().fold(0.0, f64::max);
        let simple = held.standing(motion, STILL * deepest).simplified(STILL * deepest);
        let (times, displacements) = (simple.times(), simple.displacements());
        let is_near_zero = |displacement: &f64| displacement.abs() <= 2.0 * STILL * deepest;
        // A jaw that rests before first touch holds nothing.
        let at_rest = displacements[1..displacements.len() - 1].iter().take_while(|end| is_near_zero(end)).count();
        let first = if is_near_zero(&displacements[0]) { at_rest } else { 0 };
        let mut corners = vec![Corner {
            time: times[first],
            displacement: displacements[first],
            held: Held::Nothing,
        }];
        for (times, displacements) in times.windows(2).zip(displacements.windows(2)).skip(first) {
            let is_still = is_near_zero(&(displacements[1] - displacements[0]));
            let pressed = force_held.iter().map(|(from, until)| (until.min(times[1]) - from.max(times[0])).max(0.0));
            let is_creep = pressed.sum::<f64>() > 0.5 * (times[1] - times[0]);
            let bounds = force_held.iter().flat_map(|(from, until)| [*from, *until]);
            let mut start = times[0];
            for time in bounds.filter(|time| times[0] < *time && *time < times[1]).chain([times[1]]) {
                let middle = 0.5 * (start + time);
                corners.push(Corner {
                    time,
                    displacement: simple.displacement_at(time),
                    held: if force_held.iter().any(|(from, until)| *from < middle && middle < *until) {
                        Held::Force
                    } else if is_creep {
                        Held::Pressed
                    } else if is_still {
                        Held::Displacement
                    } else {
                        Held::Nothing
                    },
                });
                start = time;
            }
        }
        Self::new(corners)
    }

    fn new(corners: Vec<Corner>) -> Self {
        let deepest = corners.iter().map(|corner| corner.displacement).fold(0.0, f64::max);
        Self {
            corners,
            least: RETREAT * deepest,
        }
    }

    /// Whether a force is prescribed.
    pub(super) fn holds_force(&self) -> bool {
        self.corners.iter().any(|corner| matches!(corner.held, Held::Force | Held::Pressed))
    }

    /// Follows the jaw from its start.
    pub(super) fn follow(&self) -> Follower<'_> {
        let first = self.corners[0];
        let done = Done {
            deepest: first.displacement,
            retreat: 0.0,
            loadings: 0,
            slowest: f64::INFINITY,
            fastest: 0.0,
            held: Held::Nothing,
            since: first.time,
            longest_hold: 0.0,
            longest_force_hold: 0.0,
        };
        Follower {
            way: self,
            next: 1,
            state: State {
                done,
                is_loading: false,
                turn: first.displacement,
            },
        }
    }
}

/// Follows the jaw through a drive, stretch by stretch.
pub(super) struct Follower<'a> {
    way: &'a Way,
    /// The corner at the end of the stretch that has not ended.
    next: usize,
    /// At its start.
    state: State,
}

/// What the jaw has done, and where it turned last: the lowest place before a loading, the deepest before a retreat.
#[derive(Debug, Clone, Copy)]
struct State {
    done: Done,
    is_loading: bool,
    turn: f64,
}

impl Follower<'_> {
    /// What the jaw has done up to a time (s), not before the one of the last call.
    pub(super) fn until(&mut self, time: f64) -> Done {
        let (corners, least) = (&self.way.corners, self.way.least);
        while let Some(end) = corners.get(self.next).filter(|end| end.time <= time) {
            self.state.go(corners[self.next - 1], *end, end.time, least);
            self.next += 1;
        }
        let mut now = self.state;
        if let Some(end) = corners.get(self.next).filter(|_| corners[self.next - 1].time <= time) {
            now.go(corners[self.next - 1], *end, time, least);
        }
        let Done { slowest, retreat, .. } = now.done;
        Done {
            slowest: if slowest.is_finite() { slowest } else { 0.0 },
            retreat: if retreat < least { 0.0 } else { retreat },
            ..now.done
        }
    }
}

impl State {
    /// Goes on through a stretch up to a time (s) in it; `least` is what counts as a turn, m.
    fn go(&mut self, start: Corner, end: Corner, time: f64, least: f64) {
        let Self { done, is_loading, turn } = self;
        let whole = end.time - start.time;
        let share = if time < end.time { (time - start.time) / whole } else { 1.0 };
        let place = start.displacement + share * (end.displacement - start.displacement);
        if end.held != done.held || matches!(end.held, Held::Nothing | Held::Pressed) {
            (done.held, done.since) = (end.held, start.time);
        }
        match end.held {
            Held::Displacement => done.longest_hold = done.longest_hold.max(time - done.since),
            Held::Nothing if whole > 0.0 => {
                let speed = (end.displacement - start.displacement).abs() / whole;
                done.slowest = done.slowest.min(speed);
                done.fastest = done.fastest.max(speed);
            }
            Held::Force => done.longest_force_hold = done.longest_force_hold.max(time - done.since),
            Held::Nothing | Held::Pressed => {}
        }
        done.deepest = done.deepest.max(place);
        done.retreat = done.retreat.max(done.deepest - place);
        *turn = if *is_loading { turn.max(place) } else { turn.min(place) };
        let has_turned = if *is_loading { place < *turn - least } else { place > *turn + least };
        if has_turned {
            (*is_loading, *turn) = (!*is_loading, place);
            done.loadings += u32::from(*is_loading);
        }
    }
}

impl CalibrationRange {
    /// Of a motion of the jaw up to a time (s), with the spans of it in which it was held or its force was, and the largest force until then (N).
    pub(super) fn of(motion: &Motion, held: &HeldSpans, until: f64, largest_force: f64) -> Self {
        let done = Way::of_motion(motion, held).follow().until(until);
        Self {
            longest_hold: done.longest_hold,
            longest_force_hold: done.longest_force_hold,
            deepest: done.deepest,
            fastest: done.fastest,
            slowest: done.slowest,
            largest_force,
            farthest_retreat: done.retreat,
            loadings: done.loadings.max(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{ProtocolStep, protocol};

    #[test]
    fn the_jaw_is_followed_alike_at_once_and_step_by_step() {
        let step = |to: f64, hold: f64| ProtocolStep { to, rate: 5e-3, hold };
        let motion =
            protocol(&[step(0.01, 5.0), step(0.004, 3.0), step(0.012, 8.0), step(0.0, 1.0), step(0.01, 2.0)]).unwrap();
        let way = Way::of_motion(&motion, &HeldSpans::default());
        let mut jaw = way.follow();
        for time in (0..=(20.0 * motion.end()) as u32).map(|i| 0.05 * f64::from(i)) {
            assert_eq!(jaw.until(time), way.follow().until(time), "{time}");
        }
        let done = jaw.until(f64::INFINITY);
        assert_eq!((done.loadings, done.deepest), (3, 0.012));
        assert!((done.retreat - 0.012).abs() < 1e-12 && (done.longest_hold - 8.0).abs() < 1e-9, "{done:?}");
    }

    /// Tremor of a hand by a fortieth of the depth made "100 loadings" and "holds of up to 0.15 s" of two holds of 15 s, and predictions of them
    /// were "beyond the test".
    #[test]
    fn a_hand_that_trembles_holds() {
        let tremor = |t: f64| 1e-4 * (50.0 * t).sin() - 5e-5 * (t - 2.0).max(0.0) / 30.0;
        let times: Vec<f64> = (0..=1600).map(|i| 0.02 * f64::from(i)).collect();
        let place = |t: &f64| 4e-3 * (t / 2.0).min(1.0) + tremor(*t);
        let motion = Motion::new(times.clone(), times.iter().map(place).collect()).unwrap();
        let held = HeldSpans {
            displacement: vec![(2.0, 32.0)],
            ..HeldSpans::default()
        };
        let range = CalibrationRange::of(&motion, &held, 32.0, 1.0);
        assert!((range.longest_hold - 30.0).abs() < 1e-9 && range.loadings == 1, "{range:?}");
        assert!((range.deepest - 4e-3).abs() < 2e-5, "{range:?}");
    }
}
