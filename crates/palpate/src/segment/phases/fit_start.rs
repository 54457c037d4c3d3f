//! From where in a hold the laws are fitted.

use std::ops::Range;

use super::turning::extremes;
use crate::record::Record;
use crate::segment::{
    After, CONTROLLER, FitStartRule, HoldMode, HoldStart, Phase, SERVO, Segment, SegmentOptions, ramps_before,
};
use crate::statistics::{mean, median, noise, quantum, range};

/// Share of a hold in which a controller settles, at most; what takes longer is part of what the hold shows.
const EARLY: f64 = 0.1;
/// Samples that are early in the shortest holds.
const FEWEST: usize = 12;
/// Range of a dozen samples of noise, in its standard deviations, which it exceeds once in some ten thousand times.
const SWINGS: f64 = 6.0;
/// How far the signal turns back, in standard deviations of its noise, where it turns.
const TURNS: f64 = 6.0;
/// The same as a share of the change over the hold: less does not matter to a fit.
const MATTERS: f64 = 0.01;

/// Sets from where laws are fitted to each hold.
pub(super) fn place_fits(record: &Record, options: &SegmentOptions, segments: &mut [Segment]) {
    // In a hold of constant force the force is what the machine drives, and the displacement answers.
    let exchanged = record.exchanged().and_then(Result::ok);
    for index in 0..segments.len() {
        if segments[index].phase != Phase::Hold {
            continue;
        }
        let answers = exchanged.as_ref().filter(|_| segments[index].mode == Some(HoldMode::ForceHeld));
        let wander = if answers.is_some() { CONTROLLER } else { SERVO };
        let (sample, rule) = options.hold_start.sample(answers.unwrap_or(record), wander, segments, index);
        (segments[index].fit_start, segments[index].fit_start_rule) = (sample, Some(rule));
    }
}

/// Samples from its start up to which a run that strays decides a fit.
const DECIDES: usize = 5;

/// Starts the fit of each held displacement behind the runs of the force that stray where it would start: no body relaxes in them.
pub(super) fn start_behind(strays: &[Range<usize>], segments: &mut [Segment]) {
    let answers = |segment: &&mut Segment| segment.phase == Phase::Hold && segment.mode != Some(HoldMode::ForceHeld);
    for hold in segments.iter_mut().filter(answers) {
        for run in strays {
            if run.end > hold.fit_start && run.start < hold.fit_start + DECIDES && run.end + FEWEST < hold.end {
                (hold.fit_start, hold.fit_start_rule) = (run.end, Some(FitStartRule::BehindStrays));
            }
        }
    }
}

impl HoldStart {
    /// The sample from which to fit segment `index`, and how it was chosen.
    fn sample(self, record: &Record, wander: f64, segments: &[Segment], index: usize) -> (usize, FitStartRule) {
        let segment = &segments[index];
        match self {
            Self::Settled => (segment.start, FitStartRule::HoldStart),
            Self::Peak => peak(record, wander, segments, index),
            Self::AfterPeak(delay) => {
                let from = record.time()[peak(record, wander, segments, index).0] + delay;
                let sample = record.time().partition_point(|time| *time < from);
                (sample.clamp(segment.start, segment.end - 1), FitStartRule::AfterExtreme)
            }
        }
    }
}

/// Where the signal begins to relax: its last extreme early in the hold, from where the drive has settled on.
///
/// A machine that swings, overshoots or falls short at first moves the signal itself; the laws describe what follows.
fn peak(record: &Record, wander: f64, segments: &[Segment], index: usize) -> (usize, FitStartRule) {
    let segment = &segments[index];
    let early = segment.start + early(&record.time()[segment.start..segment.end]);
    let settled = settled(record, wander, segments, index, early);
    // A row that strays alone is no extreme.
    let signal = running_median(&record.force()[settled..segment.end]);
    let signal = signal.as_slice();
    let (first, last) = (mean(&signal[..signal.len().min(3)]), mean(&signal[signal.len() - signal.len() / 20 - 1..]));
    let sign = match segment.after {
        Some(After::Unloading) => -1.0,
        None if last > first => -1.0,
        _ => 1.0,
    };
    let measured = &record.force()[settled..segment.end];
    let turn = (TURNS * noise(measured)).max(1.5 * quantum(measured)).max(MATTERS * range(signal));
    let turns = extremes(signal, turn);
    let is_high = |pair: &&[usize]| sign * signal[pair[0]] > sign * signal[pair[1]] && settled + pair[0] < early;
    match turns.windows(2).rfind(is_high) {
        Some(&[at, _]) if at > 0 => (settled + at, FitStartRule::Extreme),
        _ if settled > segment.start => (settled, FitStartRule::DriveSettled),
        _ => (settled, FitStartRule::HoldStart),
    }
}

/// Medians of five neighbours; the two values at either end as they are.
fn running_median(values: &[f64]) -> Vec<f64> {
    let mut medians = values.to_vec();
    for (middle, five) in medians.iter_mut().skip(2).zip(values.windows(5)) {
        *middle = median(&mut five.to_vec());
    }
    medians
}

/// How many samples at these times are the early part of a hold.
fn early(time: &[f64]) -> usize {
    let (from, until) = (time[0], time[time.len() - 1]);
    let share = time.partition_point(|t| *t <= from + EARLY * (until - from));
    // Of very few samples most must be left to fit.
    share.max(FEWEST.min(time.len() / 4)).min(time.len())
}

/// The first sample of the hold from which on the drive does not swing.
fn settled(record: &Record, wander: f64, segments: &[Segment], index: usize, early: usize) -> usize {
    let segment = &segments[index];
    let Some(drive) = record.displacement() else {
        return segment.start;
    };
    let hold = &drive[segment.start..segment.end];
    let ramp = ramps_before(segments, index).last().map_or(segment.start, |ramp| ramp.start);
    let level = median(&mut hold.to_vec());
    let way = (level - drive[ramp.saturating_sub(1)]).abs();
    // Of a force the zero is known: what a controller holds it to is a share of the force.
    let way = if segment.mode == Some(HoldMode::ForceHeld) { way.min(level.abs()) } else { way };
    segment.start + calm(hold, 2.0 * wander * way, early - segment.start).unwrap_or(0)
}

/// The first value, of those that are early, from which on a drive does not swing: for a while it keeps within its noise, or within a
/// band about what it holds.
fn calm(drive: &[f64], band: f64, early: usize) -> Option<usize> {
    let band = band.max(SWINGS * noise(drive));
    let window = FEWEST.max(early / 10).min(drive.len());
    let swings = |i: &usize| range(&drive[*i..(*i + window).min(drive.len())]) > band;
    (0..early).find(|i| !swings(i))
}

/// The sample from which on the jaw rests in a step that begins with the record, which has come from its first position and ends
/// before sample `end`; `None` where it does not come to rest early.
pub(super) fn rests_from(record: &Record, end: usize) -> Option<usize> {
    let drive = &record.displacement()?[..end];
    let way = (median(&mut drive.to_vec()) - drive[0]).abs();
    calm(drive, 2.0 * SERVO * way, early(&record.time()[..end]))
}
