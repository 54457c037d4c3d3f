//! Standstills after the body broke: nothing relaxes in them.

use crate::record::Record;
use crate::segment::hear;
use crate::segment::segmentation::{After, Phase, Rupture, Segment, ramps_before};
use crate::statistics::{median, range};
use crate::watch::{Cancelled, Watch};

/// Share of the way of the jaw over which a body that relaxes cannot have lost half its force.
const FIRST_PART: f64 = 0.75;
/// Share of the way that the jaw still goes when the force has fallen by half.
const STILL_TO_GO: f64 = 0.05;
/// How many times faster than before a jaw that is driven by the force goes when nothing resists it.
const RUNS_AWAY: f64 = 2.0;
/// Share of its range that a force rises before the body breaks.
const LEAST_RISE: f64 = 0.2;
/// Share of the way of the jaw before which the force of its own mass is largest.
const STARTS: f64 = 0.25;
/// Share of its rise by which a force falls below where it began when the mass of a machine is braked.
const BRAKES: f64 = 0.1;
/// Samples at the start of a standstill that tell its force.
const FIRST: usize = 3;
/// Ramps of fewer samples do not tell.
const FEWEST: usize = 10;

/// Turns standstills after a rupture into rest, and says where the body broke.
pub(super) fn ruptures(
    record: &Record,
    segments: &mut [Segment],
    watch: &mut dyn Watch,
) -> Result<Vec<Rupture>, Cancelled> {
    let mut found = Vec::new();
    let Some(mut whole) = Whole::of(record) else {
        return Ok(found);
    };
    for index in 0..segments.len() {
        if segments[index].after != Some(After::Loading) {
            continue;
        }
        hear(watch)?;
        let begin = ramps_before(segments, index).last().map_or(segments[index].start, |ramp| ramp.start);
        if let Some(rupture) = whole.rupture(begin, &segments[index]) {
            (segments[index].phase, segments[index].after, segments[index].mode) = (Phase::Rest, None, None);
            found.push(rupture);
        }
    }
    Ok(found)
}

/// What all ramps of a record have in common.
struct Whole<'a> {
    time: &'a [f64],
    jaw: &'a [f64],
    force: &'a [f64],
    jaw_range: f64,
    force_range: f64,
    /// The sample of the largest force among those looked at, and how many these are.
    most: Option<usize>,
    observed: usize,
}

impl<'a> Whole<'a> {
    fn of(record: &'a Record) -> Option<Self> {
        let (jaw, force) = (record.displacement()?, record.force());
        Some(Self {
            time: record.time(),
            jaw,
            force,
            jaw_range: range(jaw),
            force_range: range(force),
            most: None,
            observed: 0,
        })
    }

    /// The sample of the largest force before sample `until`, which never falls: of equals the last.
    fn largest_before(&mut self, until: usize) -> Option<usize> {
        let rest = self.observed..until.max(self.observed);
        self.observed = rest.end;
        self.most = self.most.into_iter().chain(rest).max_by(|a, b| self.force[*a].total_cmp(&self.force[*b]));
        self.most
    }

    /// Whether the body broke in the ramp from sample `begin` to a standstill.
    ///
    /// The force there is less than half of what it had been when the jaw had gone three quarters of its way. A machine that goes on
    /// at its speed goes on after the force fell; a gripper, which the force drives, runs away just before.
    fn rupture(&mut self, begin: usize, stand: &Segment) -> Option<Rupture> {
        // A body breaks deeper than it was touched; else the jaw counts the other way round, and lets go.
        let most = self.largest_before(stand.start)?;
        let Self { time, jaw, force, .. } = *self;
        if jaw[most] < jaw[0] - 0.1 * self.jaw_range {
            return None;
        }
        let begin = (begin..stand.start).min_by(|a, b| jaw[*a].total_cmp(&jaw[*b]))?;
        if stand.start < begin + FEWEST {
            return None;
        }
        let first = (stand.start + FIRST).min(stand.end);
        let level = median(&mut jaw[stand.start..stand.end].to_vec());
        let place = |share: f64| jaw[begin] + share * (level - jaw[begin]);
        let passes = |share: f64| (begin..stand.start).find(|i| jaw[*i] >= place(share));
        let largest = |range: std::ops::Range<usize>| range.max_by(|a, b| force[*a].total_cmp(&force[*b]));
        let (turn, peak) = (passes(FIRST_PART)?, largest(begin..stand.start)?);
        let open = force[..=peak].iter().copied().fold(f64::MAX, f64::min);
        let before = force[peak];
        // A force that counts the other way round falls as it grows.
        if before - open < LEAST_RISE * self.force_range {
            return None;
        }
        // A machine that moves its own mass pushes first and pulls as it stops; a broken body does not pull.
        let least = force[peak..stand.end].iter().copied().fold(f64::MAX, f64::min);
        if jaw[peak] < place(STARTS) && open - least > BRAKES * (before - open) {
            return None;
        }
        let stood = median(&mut force[stand.start..first].to_vec());
        if stood - open >= 0.5 * (force[largest(begin..turn + 1)?] - open) {
            return None;
        }
        let half = (peak..stand.end).find(|i| force[*i] - open < 0.5 * (before - open))?;
        let goes_on = half < stand.start && {
            let (left, since) = (level - jaw[half], time[stand.start] - time[half]);
            let usual = (jaw[turn] - jaw[begin]) / (time[turn] - time[begin]);
            jaw[half] < place(1.0 - STILL_TO_GO) && left > 0.5 * usual * since
        };
        let runs_away = {
            let way = |from: usize, to: usize| (jaw[to] - jaw[from]) / (time[to] - time[from]);
            way(turn, passes(1.0).unwrap_or(stand.start)) > RUNS_AWAY * way(begin, turn)
        };
        (goes_on || runs_away).then_some(Rupture {
            sample: half,
            time: time[half],
            before,
            after: stood,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segment::{SegmentError, SegmentOptions, find_phases};

    /// A jaw at 1 mm/s for 10 s, then at rest; the force follows a rule of time and displacement in mm.
    fn record(jaw: impl Fn(f64) -> f64, force: impl Fn(f64, f64) -> f64) -> Record {
        let time: Vec<f64> = (0..1500).map(|i| 0.01 * f64::from(i)).collect();
        let jaw: Vec<f64> = time.iter().map(|t| jaw(*t)).collect();
        let force = time.iter().zip(&jaw).map(|(t, d)| force(*t, *d)).collect();
        Record::new(time, Some(jaw.iter().map(|d| 1e-3 * d).collect()), force).unwrap()
    }

    fn found(record: &Record) -> Result<(usize, usize), SegmentError> {
        let found = find_phases(record, &SegmentOptions::default())?;
        Ok((found.holds().count(), found.ruptures.len()))
    }

    /// The torque that a rheometer takes to turn its own rotor was the rupture of a gel, and its relaxation no hold.
    #[test]
    fn the_mass_of_a_machine_breaks_nothing() {
        // A step in 0.2 s, with a force of acceleration that is ten times that of the body.
        let turn = |t: f64| std::f64::consts::TAU * (t - 1.0).clamp(0.0, 0.2) / 0.2;
        let jaw = |t: f64| 8.0 * (turn(t) - turn(t).sin()) / std::f64::consts::TAU;
        let body = |t: f64, d: f64| d * (1.0 + (t - 1.2).max(0.0)).powf(-0.3);
        let rotor = record(jaw, |t, d| body(t, d) + 80.0 * turn(t).sin());
        assert_eq!(found(&rotor).unwrap(), (1, 0));
        // A body that breaks as early, and does not pull.
        let broken = record(jaw, |t, d| if d > 1.6 { 0.2 } else { 40.0 * d.max(0.0) + 0.0 * t });
        assert_eq!(found(&broken).map_or(0, |(holds, _)| holds), 0);
    }

    #[test]
    fn what_stands_after_a_rupture_is_no_hold() {
        let breaks = |_: f64, d: f64| if d < 8.0 { d } else { 1.0 };
        let error = found(&record(|t| t.min(10.0), breaks)).unwrap_err();
        let SegmentError::Ruptured(Rupture {
            time, before, after, ..
        }) = error
        else {
            panic!("{error:?}");
        };
        assert!((time - 8.0).abs() < 0.02 && (before - 8.0).abs() < 0.02 && (after - 1.0).abs() < 1e-9, "{error:?}");
    }

    #[test]
    fn a_gripper_that_runs_away_has_broken_the_body() {
        let runs = |t: f64| if t < 9.7 { 0.7 * t } else { (6.79 + 20.0 * (t - 9.7)).min(10.0) };
        let gives_way = |t: f64, d: f64| if t < 9.86 { d.min(7.0) } else { 1.0 };
        assert!(matches!(found(&record(runs, gives_way)), Err(SegmentError::Ruptured(_))));
    }

    /// A fast body loses more than half its force within three samples of the hold, or while a servo creeps to its place.
    #[test]
    fn fast_relaxation_is_no_rupture() {
        let relaxes = |t: f64, d: f64| if t <= 10.0 { d } else { 2.0 + 8.0 * (-(t - 10.0) / 0.004).exp() };
        assert_eq!(found(&record(|t| t.min(10.0), relaxes)), Ok((1, 0)));
        let creeps = |t: f64| if t < 9.0 { 1.05 * t } else { 10.0 - 0.55 * (-(t - 9.0) / 0.1).exp() };
        let relaxes = |t: f64, d: f64| if t < 9.0 { d } else { 2.0 + 7.45 * (-(t - 9.0) / 0.05).exp() };
        assert_eq!(found(&record(creeps, relaxes)), Ok((1, 0)));
    }

    #[test]
    fn a_step_after_a_rupture_is_a_hold_again() {
        let jaw = |t: f64| if t < 11.0 { t.min(8.0) } else { (8.0 + 2.0 * (t - 11.0)).min(10.0) };
        let breaks = |t: f64, d: f64| {
            if d < 6.0 {
                d
            } else if t < 11.0 {
                1.0
            } else {
                1.0 + d - 8.0
            }
        };
        assert_eq!(found(&record(jaw, breaks)), Ok((1, 1)));
    }
}
