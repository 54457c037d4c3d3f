//! What a report of a stress-relaxation test states of a hold: how the displacement was applied and held, and R(t) at stated times.

use super::{Analysis, Conditions, HoldAnalysis};
use crate::fit::Estimate;
use crate::segment::{After, HoldMode, Phase, Segment};
use crate::statistics::{coverage_factor, effective_count, lag_one_correlation, noise, range};

/// What a report states of one hold of the displacement; nothing is extrapolated.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldReport {
    /// Time in which the displacement was applied, s: from the last sample before the jaw moves to the first of the hold.
    pub applied_in: Option<f64>,
    /// Largest less smallest displacement over the hold, m: the variation of the constraint, with the noise of its measurement.
    pub constraint_variation: Option<f64>,
    /// The same over the displacement of the hold.
    pub relative_constraint_variation: Option<f64>,
    /// Initial force F₀, N.
    pub initial_force: Option<Estimate>,
    /// Force and R(t) at the stated times that were measured.
    pub relaxation: Vec<StatedRelaxation>,
    /// Times that were chosen, not the usual ones, without a force, s: they lie beyond the hold, or have fewer than five samples about them.
    pub not_measured: Vec<f64>,
}

/// The force that a hold has lost at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatedRelaxation {
    /// Time since that of F₀, s.
    pub time: f64,
    /// F(t), N.
    pub force: Estimate,
    /// R(t) = (F₀ − F(t))/F₀.
    pub relaxation: Estimate,
}

/// The force of a hold at one time, by the samples about it.
#[derive(Debug, Clone, Copy)]
struct Level {
    value: f64,
    standard_error: f64,
    freedom: f64,
}

impl Level {
    fn estimate(self, confidence: f64) -> Estimate {
        let half = coverage_factor(confidence, self.freedom) * self.standard_error;
        Estimate {
            standard_error: Some(self.standard_error),
            interval: Some((self.value - half, self.value + half)),
            ..Estimate::fixed(self.value)
        }
    }
}

/// Windows about a time, as multiples of it, and how far their samples must reach; the first that has enough counts. In a wide one a line that is read
/// at its end is off.
const WINDOWS: [(f64, f64, f64); 3] = [(0.95, 1.05, 1.0), (0.8, 1.2, 1.0), (0.5, 2.0, 1.5)];
/// Fewest samples of a straight line that leave an estimate of their scatter.
const FEWEST: usize = 5;

impl Analysis {
    /// What a report states of a hold: of one that holds the displacement after loading also F₀ and R(t).
    ///
    /// F(t) is a straight line over ln t through the samples from 0.95 t to 1.05 t, or from 0.8 t to 1.2 t where those are few, or from t/2 to 2t,
    /// at t; its standard error is that of the line, for residuals that correlate as they do. F₀ at the start of the fit is the force there, with the noise of one
    /// sample. That of R follows by propagation, (σ_F/F₀)² + (F σ_F₀/F₀²)² (JCGM 100, 5.1.2); errors that all forces share, such as one of
    /// the load cell's zero, are not in it.
    #[must_use]
    pub fn hold_report(&self, hold: &HoldAnalysis) -> HoldReport {
        let (record, segment) = (&self.record, &hold.segment);
        let time = record.time();
        let held = record.displacement().map(|displacement| &displacement[segment.start..segment.end]);
        let constraint_variation = held.map(range);
        let relative = |variation: f64| Some(variation / hold.displacement?.abs()).filter(|share| share.is_finite());
        let segments = &self.segmentation.segments;
        let ramp = segments.iter().rfind(|other| other.end <= segment.start);
        let ramp = ramp.filter(|ramp| ramp.phase == Phase::Loading && Some(After::Loading) == hold.after);
        let of_displacement = segment.mode.is_none_or(|mode| mode == HoldMode::DisplacementHeld);
        let of_loading = of_displacement && hold.after != Some(After::Unloading);
        let (initial_force, relaxation) = of_loading.then(|| self.stated_relaxation(segment)).flatten().unzip();
        let measured = |time: &f64| relaxation.iter().flatten().any(|stated: &StatedRelaxation| stated.time == *time);
        // Of the usual times those count that were measured; of chosen ones all.
        let chosen = self.options.conditions.relaxation_at.as_deref().filter(|_| of_loading);
        HoldReport {
            applied_in: ramp.map(|ramp| time[segment.start] - time[self.last_at_rest(ramp, segment.start)]),
            constraint_variation,
            relative_constraint_variation: constraint_variation.and_then(relative),
            initial_force,
            not_measured: chosen.unwrap_or_default().iter().copied().filter(|time| !measured(time)).collect(),
            relaxation: relaxation.unwrap_or_default(),
        }
    }

    /// The last sample before the jaw goes from where it was before a ramp; a rest too short for a phase of its own is part of its ramp.
    fn last_at_rest(&self, ramp: &Segment, end: usize) -> usize {
        let before = ramp.start.saturating_sub(1);
        let Some(displacement) = self.record.displacement().filter(|_| self.segmentation.settings.from_displacement)
        else {
            return before;
        };
        let is_there =
            |i: &usize| (displacement[*i] - displacement[before]).abs() <= self.segmentation.settings.tolerance;
        (before..end).take_while(is_there).last().unwrap_or(before)
    }

    /// F₀ and R(t) of a hold; `None` where F₀ was not measured or does not exceed its noise.
    fn stated_relaxation(&self, segment: &Segment) -> Option<(Estimate, Vec<StatedRelaxation>)> {
        let (record, conditions) = (&self.record, &self.options.conditions);
        let samples = segment.fit_start..segment.end;
        let (time, force) = (&record.time()[samples.clone()], &record.force()[samples]);
        let start = *time.first()?;
        let times: Vec<f64> = time.iter().map(|time| time - start).collect();
        let initial = match conditions.initial_force_after {
            after if after > 0.0 => level(&times, force, after)?,
            _ => Level {
                value: force[0],
                standard_error: noise(force),
                freedom: force.len() as f64,
            },
        };
        if initial.value <= 3.0 * initial.standard_error {
            return None;
        }
        let confidence = self.options.fit.confidence;
        let stated = |time: &f64| {
            let found = level(&times, force, conditions.initial_force_after.max(0.0) + time)?;
            let (share, f0) = (found.value / initial.value, initial.value);
            let relaxation = Level {
                value: 1.0 - share,
                standard_error: (found.standard_error / f0).hypot(share * initial.standard_error / f0),
                freedom: found.freedom.min(initial.freedom),
            };
            Some(StatedRelaxation {
                time: *time,
                force: found.estimate(confidence),
                relaxation: relaxation.estimate(confidence),
            })
        };
        let times = conditions.relaxation_at.as_deref().unwrap_or(&Conditions::USUAL_TIMES);
        Some((initial.estimate(confidence), times.iter().filter_map(stated).collect()))
    }
}

/// The force at a time above 0 within the samples; `None` outside of them, and where too few lie about it.
fn level(times: &[f64], force: &[f64], at: f64) -> Option<Level> {
    if at > *times.last()? {
        return None;
    }
    let within = |(from, to, reach): (f64, f64, f64)| {
        let (from, to) = (at * from, at * to);
        let window = times.partition_point(|time| *time < from)..times.partition_point(|time| *time <= to);
        (window.len() >= FEWEST && times[window.end - 1] >= reach * at).then_some(window)
    };
    let window = WINDOWS.into_iter().find_map(within)?;
    let (x, y): (Vec<f64>, &[f64]) =
        (times[window.clone()].iter().map(|time| (time / at).ln()).collect(), &force[window]);
    let count = x.len() as f64;
    let (mean_x, mean_y) = (x.iter().sum::<f64>() / count, y.iter().sum::<f64>() / count);
    let spread: f64 = x.iter().map(|x| (x - mean_x).powi(2)).sum();
    let slope = x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum::<f64>() / spread;
    let residuals: Vec<f64> = x.iter().zip(y).map(|(x, y)| y - mean_y - slope * (x - mean_x)).collect();
    let variance = residuals.iter().map(|r| r * r).sum::<f64>() / (count - 2.0);
    // As many independent samples as the correlation of neighbours leaves.
    let share = effective_count(x.len(), lag_one_correlation(&residuals)) / count;
    let leverage = 1.0 / count + mean_x * mean_x / spread;
    Some(Level {
        value: mean_y - slope * mean_x,
        standard_error: (variance * leverage / share).sqrt(),
        freedom: (count * share - 2.0).max(1.0),
    })
    .filter(|level| level.value.is_finite() && level.standard_error.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{AnalysisOptions, analyze};
    use crate::random::Rng;
    use crate::record::Record;

    /// R(24 h) of a hold that is read every 10 min, with F₀ at 30 min, was missing without a word.
    #[test]
    fn a_hold_read_every_ten_minutes_states_its_relaxation_or_that_it_was_not_measured() {
        let time: Vec<f64> = (0..=1008).map(|i| 600.0 * f64::from(i)).collect();
        let mut rng = Rng::new(3);
        let truth = |t: f64| 300.0 - 6.0 * (1.0 + t).ln();
        let force = time.iter().map(|t| truth(*t) + 0.1 * rng.normal()).collect();
        let record = Record::new(time.clone(), Some(vec![1.6e-3; time.len()]), force).expect("a record");
        let mut options = AnalysisOptions::default();
        options.conditions.relaxation_at = Some(vec![24.0 * 3600.0, 71.0 * 3600.0]);
        for (after, measured) in [(1800.0, 2), (400.0, 0)] {
            options.conditions.initial_force_after = after;
            let analysis = analyze(&record, &options).expect("an analysis");
            let report = analysis.hold_report(&analysis.holds[0]);
            assert_eq!((report.relaxation.len(), report.not_measured.len()), (measured, 2 - measured), "{after}");
            for stated in report.relaxation {
                let expected = 1.0 - truth(after + stated.time) / truth(after);
                let error = stated.relaxation.standard_error.expect("an error");
                assert!((stated.relaxation.value - expected).abs() < 4.0 * error && error < 0.002, "{stated:?}");
            }
        }
    }

    /// A straight line over ln t is met exactly, at the last sample too, and nothing beyond or where samples are few.
    #[test]
    fn a_level_is_that_of_the_line_and_never_beyond_the_samples() {
        let times: Vec<f64> = (0..=1000).map(|i| 0.1 * f64::from(i)).collect();
        let force: Vec<f64> = times.iter().map(|time| 5.0 - 0.2 * (time + 1e-300).ln()).collect();
        for at in [1.5, 30.0, 100.0] {
            let found = level(&times, &force, at).expect("a level");
            assert!((found.value - (5.0 - 0.2 * at.ln())).abs() < 1e-12, "{at}: {found:?}");
        }
        assert!(level(&times, &force, 100.1).is_none());
        // From half of it to twice 0.1 s lie two samples; about 0.4 s, seven.
        assert!(level(&times, &force, 0.1).is_none() && level(&times, &force, 0.4).is_some());
    }

    /// Over many records with white noise the error of a level has the size that is stated.
    #[test]
    fn the_stated_error_of_a_level_is_its_scatter() {
        let times: Vec<f64> = (0..600).map(|i| 0.1 * f64::from(i)).collect();
        let mut rng = Rng::new(7);
        let (mut squares, mut stated) = (0.0, 0.0);
        let runs = 400;
        for _ in 0..runs {
            let force: Vec<f64> =
                times.iter().map(|time| 2.0 + (1.0 + time).powf(-0.5) + 0.01 * rng.normal()).collect();
            let found = level(&times, &force, 30.0).expect("a level");
            squares += (found.value - (2.0 + 31.0_f64.powf(-0.5))).powi(2) / f64::from(runs);
            stated += found.standard_error / f64::from(runs);
        }
        let ratio = squares.sqrt() / stated;
        assert!((0.85..1.15).contains(&ratio), "{ratio}");
    }
}
