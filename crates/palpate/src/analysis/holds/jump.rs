//! Steps of the force within a hold: the body slips or cracks, or the grip gives way.

use crate::analysis::finding::Finding;
use crate::record::Record;
use crate::segment::Segment;
use crate::statistics::{median, noise, range};

/// Samples on either side that tell a level.
const LEVEL: usize = 5;
/// How many times the noise of a sample, and the change from level to level beside it, a step exceeds.
const CLEAR: f64 = 8.0;
/// How many times as much as at the speed beside it the force changes in a step while samples are missing.
const GOES_ON: f64 = 2.0;
/// Share of the range of the force in the hold that it exceeds.
const LEAST: f64 = 0.1;
/// More steps are the digits of a force that is rounded coarsely.
const MOST: usize = 3;

/// The largest step of the force between two samples of a hold; none where the force goes on as it went before, be it while samples are missing.
///
/// Levels are medians of five samples. A force that relaxes, however fast, changes about as much from level to level before and behind;
/// a step changes it once.
pub(super) fn force_step(record: &Record, segment: &Segment) -> Option<Finding> {
    let force = &record.force()[segment.fit_start..segment.end];
    let time = &record.time()[segment.fit_start..segment.end];
    // Longer than a level lasts before it.
    let missing =
        |i: usize| Some(time[i] - time[i - 1]).filter(|gap| *gap > time[i - 1] - time[i - 1 - LEVEL]).unwrap_or(0.0);
    let level = |from: usize| median(&mut force[from..from + LEVEL].to_vec());
    let least = (LEAST * range(force)).max(CLEAR * noise(force));
    let mut steps: Vec<(usize, f64)> = Vec::new();
    for i in 2 * LEVEL..force.len().saturating_sub(2 * LEVEL) {
        // Between samples i − 1 and i; most of them are none by these two already.
        if (force[i] - force[i - 1]).abs() < 0.5 * least {
            continue;
        }
        let levels = [i - 2 * LEVEL, i - LEVEL, i, i + LEVEL].map(level);
        let step = levels[2] - levels[1];
        let beside = (levels[1] - levels[0]).abs().max((levels[3] - levels[2]).abs());
        let missing = missing(i);
        // While samples are missing the force goes on.
        let goes_on = GOES_ON * beside * missing / (time[i - 1] - time[i - 1 - LEVEL]);
        if step.abs() > least && step.abs() > goes_on.max(CLEAR * beside) {
            steps.push((i, step));
        }
    }
    if steps.len() > MOST {
        return None;
    }
    let (at, step) = steps.into_iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    Some(Finding::ForceStep {
        time: time[at],
        step,
        gap: missing(at),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

    use super::*;
    use crate::analysis::{AnalysisOptions, analyze};
    use crate::test_problems::Rng;

    /// A force that fell by 2 N within a sample at 30 s went into one law, without a word.
    #[test]
    fn a_body_that_slips_in_a_hold_is_reported() {
        let steps = |force: &dyn Fn(f64) -> f64, noise: f64| -> Vec<(f64, f64)> {
            let mut random = Rng::new(6);
            let time: Vec<f64> = (0..600).map(|i| 0.1 * f64::from(i)).collect();
            let travel = time.iter().map(|t| t.min(1.0) * 5e-3).collect();
            let force = time.iter().map(|t| force(*t) + noise * random.normal()).collect();
            let record = Record::new(time, Some(travel), force).unwrap();
            let found = analyze(&record, &AnalysisOptions::default()).unwrap();
            let findings = found.holds.iter().flat_map(|hold| &hold.findings);
            findings
                .filter_map(|finding| match finding {
                    Finding::ForceStep { time, step, .. } => Some((*time, *step)),
                    _ => None,
                })
                .collect()
        };
        let relaxing = |t: f64| if t < 1.0 { 20.0 * t } else { 10.0 + 10.0 * (1.0 + 4.0 * (t - 1.0)).powf(-0.25) };
        let slips = |t: f64| relaxing(t) - if t > 29.95 { 2.0 } else { 0.0 };
        let found = steps(&slips, 0.02);
        assert!(
            matches!(found[..], [(time, step)] if (time - 30.0).abs() < 0.05 && (step + 2.0).abs() < 0.1),
            "{found:?}"
        );
        let fast = |t: f64| if t < 1.0 { 20.0 * t } else { 10.0 + 10.0 * (-(t - 1.0) / 0.2).exp() };
        for smooth in [&relaxing as &dyn Fn(f64) -> f64, &fast, &|t| 0.5 * (relaxing(t) * 2.0).round()] {
            for noise in [0.0, 0.02, 0.3] {
                assert_eq!(steps(smooth, noise), []);
            }
        }
    }

    /// Relaxation that went on while a clock paused was a step "at once", as was a step in the pause.
    #[test]
    fn a_step_while_samples_are_missing_is_none_or_says_so() {
        let steps = |slips: f64, pause: std::ops::Range<f64>| -> Option<(f64, f64)> {
            let mut random = Rng::new(6);
            let time: Vec<f64> = (0..1200).map(|i| 0.05 * f64::from(i)).filter(|t| !pause.contains(t)).collect();
            let travel = time.iter().map(|t| t.min(1.0) * 5e-3).collect();
            let relaxing = |t: f64| t.min(1.0) * (12.0 + 8.0 * (-(t - 1.0).max(0.0) / 8.0).exp());
            let force =
                time.iter().map(|t| relaxing(*t) - if *t > 30.0 { slips } else { 0.0 } + 2e-3 * random.normal());
            let record = Record::new(time.clone(), Some(travel), force.collect()).unwrap();
            let found = analyze(&record, &AnalysisOptions::default()).unwrap();
            found.holds[0].findings.iter().find_map(|finding| match finding {
                Finding::ForceStep { step, gap, .. } => Some((*step, *gap)),
                _ => None,
            })
        };
        assert_eq!(steps(0.0, 5.0..15.0), None);
        let (step, gap) = steps(2.0, 25.0..32.0).unwrap();
        assert!((step + 2.2).abs() < 0.1 && (gap - 7.05).abs() < 0.01, "{step} {gap}");
        assert_eq!(steps(2.0, 5.0..5.0).map(|(_, gap)| gap), Some(0.0));
    }
}
