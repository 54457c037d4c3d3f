//! From where in a hold the laws are fitted.

use std::ops::Range;

use super::delayed::force_delay;
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
/// The same over what the signal usually turns back later in a hold, as long as the early part: noise that correlates, or a controller that never
/// comes to rest, goes on.
const BEYOND_LATER: f64 = 1.5;

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
        if options.hold_start == HoldStart::Peak
            && let Some(delay) = force_delay(record, segments, index).filter(|delay| delay.settled > sample)
        {
            (segments[index].fit_start, segments[index].fit_start_rule) =
                (delay.settled, Some(FitStartRule::DelayFaded));
        }
    }
}

/// Samples from its start up to which a run that strays decides a fit.
const DECIDES: usize = 5;

/// Starts the fit of each held displacement behind the runs of the force that stray where it would start: no body relaxes in them.
pub(super) fn start_behind(strays: &[Range<usize>], segments: &mut [Segment]) {
    let answers = |segment: &&mut Segment| segment.phase == Phase::Hold && segment.mode != Some(HoldMode::ForceHeld);
    for hold in segments.iter_mut().filter(answers) {
        for run in strays {
            // The line on which rows that stray were put looks like a delay.
            let is_no_delay = hold.fit_start_rule == Some(FitStartRule::DelayFaded) && run.end > hold.start;
            let decides = run.end > hold.fit_start || is_no_delay;
            if decides && run.start < hold.fit_start + DECIDES && run.end + FEWEST < hold.end {
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
    let turn = (TURNS * noise(measured))
        .max(1.5 * quantum(measured))
        .max(MATTERS * range(signal))
        .max(BEYOND_LATER * turns_back_later(signal, early - settled, sign));
    let turns = extremes(signal, turn);
    let is_high = |pair: &&[usize]| sign * signal[pair[0]] > sign * signal[pair[1]] && settled + pair[0] < early;
    match turns.windows(2).rfind(is_high) {
        Some(&[at, _]) if at > 0 => (settled + at, FitStartRule::Extreme),
        _ if settled > segment.start => (settled, FitStartRule::DriveSettled),
        _ => (settled, FitStartRule::HoldStart),
    }
}

/// How far a signal turns back, against the direction in which it relaxes, in the parts of a hold behind the early one that are as long: the median.
fn turns_back_later(signal: &[f64], early: usize, sign: f64) -> f64 {
    let length = early.max(FEWEST);
    let later = signal.get(length..).unwrap_or_default();
    let mut back: Vec<f64> = later.chunks_exact(length).map(|part| turns_back(part, sign)).collect();
    if back.is_empty() { 0.0 } else { median(&mut back) }
}

/// The largest rise from a value to one after it, of a signal times `sign`.
fn turns_back(values: &[f64], sign: f64) -> f64 {
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for value in values {
        least = least.min(sign * value);
        most = most.max(sign * value - least);
    }
    most
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segment::find_phases;
    use crate::test_problems::Rng;

    /// A ramp of 2 s to 100 N, and a hold in which it relaxes by 30 N with two times; in between it swings by `swing` N. Noise of 0.3 N passes poles.
    fn record(poles: &[f64], swing: f64, hold: f64, seed: u64) -> Record {
        let mut random = Rng::new(seed);
        let (dt, mut made) = (hold / 6000.0, vec![0.0; poles.len()]);
        let mut noise = || {
            let fresh =
                random.normal() + poles.iter().zip(made.iter().rev()).map(|(pole, made)| pole * made).sum::<f64>();
            made.rotate_left(1);
            if let Some(last) = made.last_mut() {
                *last = fresh;
            }
            fresh
        };
        let scale = {
            let some: Vec<f64> = (0..4000).map(|_| noise()).collect();
            (some.iter().map(|value| value * value).sum::<f64>() / 4000.0).sqrt()
        };
        let time: Vec<f64> = (0..=((hold + 2.0) / dt) as usize).map(|i| dt * i as f64).collect();
        let jaw = time.iter().map(|t| 1e-3 * t.min(2.0)).collect();
        let force = |t: &f64| {
            let since = (t - 2.0).max(0.0);
            let relaxed = 70.0 + 10.0 * (-since / (hold / 100.0)).exp() + 20.0 * (-since / (hold / 3.0)).exp();
            let swings = swing * (-since / (hold / 100.0)).exp() * (since / (hold / 300.0)).sin();
            relaxed * t.min(2.0) / 2.0 + swings + 0.3 / scale * noise()
        };
        let force = time.iter().map(force).collect();
        Record::new(time, Some(jaw), force).unwrap()
    }

    /// Of 48 fits to holds read by a load cell with a filter, 47 began 2 to 10 % of the hold late: at the last bump of noise in its first tenth.
    #[test]
    fn noise_of_a_filter_is_no_peak() {
        for poles in [&[0.8][..], &[0.95], &[1.56, -0.64]] {
            for hold in [60.0, 600.0, 18_000.0] {
                for seed in 0..8 {
                    let found = find_phases(&record(poles, 0.0, hold, seed), &SegmentOptions::default()).unwrap();
                    let held = found.segments.iter().find(|segment| segment.phase == Phase::Hold).unwrap();
                    let late = (held.fit_start - held.start) as f64 / 6000.0;
                    assert!(late < 0.01, "{poles:?} {hold} {seed}: {late}");
                }
            }
        }
    }

    /// A machine that swings is still waited for.
    #[test]
    fn swings_of_a_machine_are_left_out() {
        for seed in 0..8 {
            let record = record(&[0.8], 12.0, 600.0, seed);
            let found = find_phases(&record, &SegmentOptions::default()).unwrap();
            let held = found.segments.iter().find(|segment| segment.phase == Phase::Hold).unwrap();
            let late = record.time()[held.fit_start] - record.time()[held.start];
            assert!((2.0..20.0).contains(&late), "{seed}: {late} s, {:?}", held.fit_start_rule);
        }
    }
}
