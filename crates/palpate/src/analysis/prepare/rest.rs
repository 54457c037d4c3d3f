//! Whether the force drifts while nothing touches the body.

use std::ops::Range;

use crate::analysis::Finding;
use crate::fit::{Assessed, Scale};
use crate::record::Record;
use crate::segment::{After, HoldMode, Phase, Segment, Segmentation, free_samples};
use crate::statistics::{self, mean, noise};

/// Fewest samples of a rest that tell a drift from noise.
const FEWEST: usize = 30;
/// Samples that a longer rest is averaged to.
const MOST: usize = 1000;
/// Share of the way of the jaw, behind its rest, without a force that is one through air.
const AIR: f64 = 0.02;
/// Confidence with which the force drifts.
const SURE: f64 = 0.999;
/// Share of a hold that a rest lasts at least which says how the force goes on in it.
const SHORTEST: f64 = 0.05;
/// Share of the relaxation of a hold that the drift makes in it, from which on it is stated.
const MATTERS: f64 = 5e-3;

/// [`Finding::BaselineDrifts`] where the force before first touch follows a line by so much that it matters in the hold that it changes most.
///
/// The line is one by least squares, with the error that the noise of its residuals gives it, slow noise too.
pub(super) fn baseline_drifts(record: &Record, segmentation: &Segmentation) -> Option<Finding> {
    // A way through air may have a force of its own, and where columns count the other way round a hold comes before all loading.
    let is_pressed = |segment: &&Segment| matches!(segment.phase, Phase::Loading | Phase::Hold);
    let loads = segmentation.segments.iter().find(is_pressed)?.start;
    let free = free_samples(record, segmentation).into_iter().next()?;
    let rest = free.start..free.end.min(loads);
    if rest.len() < FEWEST {
        return None;
    }
    let (time, force) = (record.time(), record.force());
    let lasts = time[rest.end - 1] - time[rest.start];
    let together = rest.len().div_ceil(MOST);
    let averaged = |values: &[f64]| values[rest.clone()].chunks(together).map(mean).collect::<Vec<f64>>();
    let (rate, half) = slope(&averaged(time), &averaged(force))?;
    // The jaw has come through air where the force stays as it was for a part of the way to its farthest place.
    let came_through_air = record.displacement().is_some_and(|places| {
        let (from, clear) = (places[rest.end - 1], places[free.end.clamp(rest.end, places.len()) - 1]);
        let farthest = places.iter().fold(from, |most, place| most.max(*place));
        clear - from > AIR * (farthest - from)
    });
    if rate.abs() <= half || !came_through_air && !is_near_zero(force, &rest, rate * lasts) {
        return None;
    }
    let in_hold = |(number, hold): (usize, &Segment)| {
        let duration = time[hold.end - 1] - time[hold.fit_start];
        let (change, relaxed) = (rate * duration, relaxation(&force[hold.fit_start..hold.end], rate * duration)?);
        (lasts > SHORTEST * duration).then_some((number, change, (change / relaxed).abs()))
    };
    let counts = |hold: &&Segment| {
        hold.after != Some(After::Unloading) && hold.mode.is_none_or(|mode| mode == HoldMode::DisplacementHeld)
    };
    let holds = (1..).zip(segmentation.holds()).filter(|(_, hold)| counts(hold)).filter_map(in_hold);
    let (hold, change, share) = holds.max_by(|one, other| one.2.total_cmp(&other.2))?;
    (share > MATTERS).then_some(Finding::BaselineDrifts {
        rate,
        half,
        lasts,
        hold,
        change,
        share,
    })
}

/// Whether a force is that of a load cell near its zero, but for its drift (N) over the rest: a body that is pressed before the first ramp relaxes.
fn is_near_zero(force: &[f64], rest: &Range<usize>, drift: f64) -> bool {
    /// Share of the largest force that a load cell shows at most of which nobody set the zero.
    const ZERO: f64 = 0.01;
    let largest = force.iter().fold(0.0f64, |largest, force| largest.max(force.abs()));
    mean(&force[rest.clone()]).abs() <= ZERO * largest + drift.abs()
}

/// What a body relaxes in a hold, N: what the force falls, and a drift hides; `None` where that is no more than noise.
fn relaxation(force: &[f64], drift: f64) -> Option<f64> {
    /// Samples at either end; a hundredth of all at its end.
    const ENDS: usize = 3;
    const OBSERVED: f64 = 6.0;
    let last = (force.len() / 100).max(ENDS);
    let relaxed = mean(force.get(..ENDS)?) - mean(force.get(force.len().checked_sub(last)?..)?) + drift;
    (relaxed.abs() > OBSERVED * noise(force) / (ENDS as f64).sqrt()).then_some(relaxed)
}

/// The slope of a line, and half of its interval.
fn slope(time: &[f64], force: &[f64]) -> Option<(f64, f64)> {
    let (middle, level) = (mean(time), mean(force));
    let from_middle: Vec<f64> = time.iter().map(|t| t - middle).collect();
    let slope = statistics::slope(time, force);
    let left = from_middle.iter().zip(force).map(|(t, force)| force - level - slope * t).collect();
    let columns = vec![vec![1.0; time.len()], from_middle];
    let line = Assessed::of_columns(columns, (force, left), SURE).ok()?;
    let (low, high) = line.estimate(slope, &[0.0, 1.0], Scale::Linear).interval?;
    Some((slope, 0.5 * (high - low)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

    use super::*;
    use crate::analysis::AnalysisOptions;
    use crate::analysis::prepare::corrected;
    use crate::record::Baseline;
    use crate::simulate::{ContactState, Separation};
    use crate::test_problems::{Rng, paper_ball};

    /// 40 s of rest, 5 mm in 0.6 s and a hold of 100 s; the load cell drifts by `rate` (N/s) beside noise of `white` (N) and a walk of
    /// `step` (N) a sample.
    fn record(rate: f64, white: f64, step: f64, seed: u64) -> Record {
        let (model, mut contact, mut random) =
            (paper_ball(Separation::Unilateral), ContactState::default(), Rng::new(seed));
        let way = |t: f64| 5e-3 * (t.clamp(0.0, 0.6) / 0.6);
        let (mut time, mut jaw, mut force, mut walk) = (Vec::new(), Vec::new(), Vec::new(), 0.0);
        for i in 0..2800 {
            let t = 0.05 * f64::from(i);
            walk += step * random.normal();
            time.push(t);
            jaw.push(way(t - 40.0));
            let of_body = contact.step(&model, 0.05, way(t - 40.0)).unwrap();
            force.push(of_body + rate * t + walk + white * random.normal());
        }
        Record::new(time, Some(jaw), force).unwrap()
    }

    fn drift(record: &Record, options: &AnalysisOptions) -> Option<(f64, f64)> {
        let corrected = corrected(record, options).unwrap();
        match baseline_drifts(&corrected.record, &corrected.segmentation.unwrap())? {
            Finding::BaselineDrifts { rate, share, .. } => Some((rate, share)),
            _ => None,
        }
    }

    /// A load cell that drifted by 0.2 N within a hold, as its rest showed, stood without a word; the equilibrium force contains it.
    #[test]
    fn a_load_cell_that_drifts_at_rest_is_stated() {
        for seed in 0..4 {
            let drifting = record(2e-3, 5e-3, 0.0, seed);
            let (rate, share) = drift(&drifting, &AnalysisOptions::default()).unwrap();
            assert!((rate / 2e-3 - 1.0).abs() < 0.1 && (0.05..0.15).contains(&share), "{rate} {share}");
            let mut sloped = AnalysisOptions::default();
            sloped.corrections.baseline = Some(Baseline::Sloped);
            assert_eq!(drift(&drifting, &sloped), None);
        }
    }

    /// A jaw that stands free in the end had a "relaxation" of its noise, and the drift was thousands of per cent of it; so was that of an elastic body.
    #[test]
    fn a_drift_is_no_share_of_what_does_not_relax() {
        let elastic = |t: f64| (2.0 * (t - 40.0)).clamp(0.0, 4.0) - (2.0 * (t - 100.0)).clamp(0.0, 4.0);
        let mut random = Rng::new(5);
        let time: Vec<f64> = (0..2800).map(|i| 0.05 * f64::from(i)).collect();
        let jaw = time.iter().map(|t| 1e-3 * elastic(*t)).collect();
        let force = time.iter().map(|t| 5.0 * elastic(*t) + 1e-4 * t + 5e-3 * random.normal()).collect();
        assert_eq!(drift(&Record::new(time, Some(jaw), force).unwrap(), &AnalysisOptions::default()), None);
    }

    /// Columns of compression that count down: "before first touch" lasted 63 s and contained two holds, and drifted by 180 % of the relaxation.
    #[test]
    fn holds_of_columns_that_count_down_are_no_rest() {
        for seed in 0..3 {
            let up = record(0.0, 5e-3, 0.0, seed);
            let down = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<f64>>();
            let jaw = down(up.displacement().unwrap());
            let turned = Record::new(up.time().to_vec(), Some(jaw), down(up.force())).unwrap();
            assert_eq!(drift(&turned, &AnalysisOptions::default()), None, "{seed}");
        }
    }

    /// A record that begins on a body under load, which relaxes from the test before: "before first touch the force drifts", and the line that the
    /// finding advised to subtract made 22.8 kPa of 60.
    #[test]
    fn a_body_under_load_before_the_first_ramp_is_no_load_cell_that_drifts() {
        let relaxes = |t: f64, tau: f64| if t < 0.0 { 0.0 } else { (-t / tau).exp() };
        for (rate, lasts) in [(20.0, 0.6), (200.0, 6.0)] {
            let mut random = Rng::new(3);
            let ramp = |t: f64| (t - 40.0).clamp(0.0, lasts) / lasts;
            let time: Vec<f64> = (0..(140.0 * rate) as usize).map(|i| i as f64 / rate).collect();
            let jaw = time.iter().map(|t| 0.0125 + 5e-3 * ramp(*t)).collect();
            let of_body = |t: f64| 30.0 + relaxes(t, 100.0) + (20.0 + 4.0 * relaxes(t - 40.0 - lasts, 30.0)) * ramp(t);
            let force = time.iter().map(|t| of_body(*t) + 5e-3 * random.normal()).collect();
            let record = Record::new(time, Some(jaw), force).unwrap();
            assert_eq!(drift(&record, &AnalysisOptions::default()), None, "{rate}");
        }
    }

    #[test]
    fn a_load_cell_that_walks_or_is_noisy_does_not_drift() {
        let stated = |step: f64| {
            (0..20)
                .filter(|seed| drift(&record(0.0, 5e-3, step, *seed), &AnalysisOptions::default()).is_some())
                .count()
        };
        let counts = [0.0, 5e-4, 2e-3].map(stated);
        println!("{counts:?}");
        assert!(counts.iter().all(|count| *count <= 1), "{counts:?}");
    }
}
