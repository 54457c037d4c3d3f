//! What was imposed on a body before a hold, as linear laws answer it.

use crate::laws::Loading;
use crate::record::Record;
use crate::segment::{HoldMode, Phase, Segment, ramps_before};
use crate::simulate::Separation;
use crate::statistics::mean;

/// Share of the way of the jaw below which a hold lies too near to where the body was untouched to be what its history is measured by.
const NEAR: f64 = 0.1;

/// The displacement of a body, from where it was last untouched to where the fit of segment `index` starts: all ramps and holds since.
///
/// It begins with the last sample at rest, and air counts as none where the body does not hold on to the jaw. A hold near the untouched body has
/// the ramp before it alone, as has one in a record that begins in its hold. `None` without a ramp.
pub(in crate::analysis) fn imposed(
    record: &Record,
    segments: &[Segment],
    index: usize,
    separation: Separation,
) -> Option<Loading> {
    let held = |hold: &Segment| hold.mode != Some(HoldMode::ForceHeld);
    before((record.time(), record.displacement()?), segments, index, (&held, separation))
}

/// The same of the force, which creeps answer; where it is held it is the mean of the hold.
pub(in crate::analysis) fn imposed_force(
    record: &Record,
    segments: &[Segment],
    index: usize,
    separation: Separation,
) -> Option<Loading> {
    let hold = &segments[index];
    let mut force = record.force().to_vec();
    force[hold.fit_start] = mean(&force[hold.fit_start..hold.end]);
    before((record.time(), &force), segments, index, (&|_| false, separation))
}

/// What a column shows of it; a hold of which `held` is true counts by its ends.
fn before(
    (time, column): (&[f64], &[f64]),
    segments: &[Segment],
    index: usize,
    (held, separation): (&dyn Fn(&Segment) -> bool, Separation),
) -> Option<Loading> {
    let end = segments[index].fit_start;
    let ramp = ramps_before(segments, index).last()?.start.saturating_sub(1)..end + 1;
    let begun = segments[..index]
        .iter()
        .rposition(|segment| segment.phase == Phase::Rest)
        .map_or(0, |rest| rest + 1);
    let rows = if segments[begun].is_ramp() { rows(&segments[begun..index], end, held) } else { Vec::new() };
    let of = |rows: &[usize], inside: &dyn Fn(f64) -> f64| {
        let times: Vec<f64> = rows.iter().map(|row| time[*row]).collect();
        let values: Vec<f64> = rows.iter().map(|row| inside(column[*row])).collect();
        let way = values.iter().fold(0.0, |most: f64, value| most.max((value - values[0]).abs()));
        let change = (values.last()? - values.first()?).abs();
        Loading::new(&times, &values).ok().filter(|_| change > NEAR * way)
    };
    let last: Vec<usize> = ramp.collect();
    let pressed = |value: f64| if separation == Separation::Unilateral { value.max(0.0) } else { value };
    // Displacements of a record whose touch is not known may lie below 0.
    of(&rows, &pressed).or_else(|| of(&last, &pressed)).or_else(|| of(&last, &|value| value))
}

/// Samples of some phases up to `end`: all, but for holds that count by the first and the last.
fn rows(phases: &[Segment], end: usize, held: &dyn Fn(&Segment) -> bool) -> Vec<usize> {
    let mut rows: Vec<usize> = phases.first().map(|first| first.start.saturating_sub(1)).into_iter().collect();
    for phase in phases {
        match phase.phase == Phase::Hold && held(phase) {
            true => rows.extend([phase.start, phase.end - 1]),
            false => rows.extend(phase.start..phase.end),
        }
    }
    rows.extend(phases.last().map_or(end, |last| last.end)..=end);
    rows.dedup();
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{AnalysisOptions, analyze};
    use crate::forecast::{CompareOptions, RampChoice};
    use crate::laws::Law;

    /// γ of ramps from 0 in air of `air` ramps, each of `ramp` s by 3 mm, with holds of `hold` s; and the force of amplitudes 1.5 and 0.8 with times of 1
    /// and 12 s beside 1, in N for 3 mm.
    fn record(signs: &[f64], (rest, air, ramp, hold): (f64, f64, f64, f64), dt: f64) -> Record {
        let of_step = |since: f64| {
            let (s, p) = (since.max(0.0), since.clamp(0.0, ramp));
            let decay = |tau: f64| tau / ramp * ((-(s - p) / tau).exp() - (-s / tau).exp());
            (p / ramp, p / ramp + 1.5 * decay(1.0) + 0.8 * decay(12.0))
        };
        let starts: Vec<f64> = (0..signs.len()).map(|step| rest + air * ramp + step as f64 * (ramp + hold)).collect();
        let end = starts[starts.len() - 1] + ramp + hold;
        let time: Vec<f64> = (0..=(end / dt) as usize).map(|i| i as f64 * dt).collect();
        let sum = |t: f64| {
            let steps = starts.iter().zip(signs).map(|(start, sign)| (of_step(t - start), sign));
            steps.fold((0.0, 0.0), |(d, f), ((way, force), sign)| (d + sign * way, f + sign * force))
        };
        let approach = |t: f64| (t - rest - air * ramp).clamp(-air * ramp, 0.0) / ramp;
        let jaw = time.iter().map(|t| 3e-3 * (sum(*t).0 + approach(*t))).collect();
        let force = time.iter().map(|t| sum(*t).1).collect();
        Record::new(time, Some(jaw), force).unwrap()
    }

    /// Amplitudes of two exponentials in each hold, over the displacement of the hold in steps of 3 mm.
    fn amplitudes(record: &Record) -> Vec<[f64; 2]> {
        let options = AnalysisOptions {
            compare: Some(CompareOptions {
                laws: vec![Law::Prony { terms: 2 }],
                ramps: RampChoice::Measured,
                forecast: false,
                ..CompareOptions::default()
            }),
            ..AnalysisOptions::default()
        };
        let found = analyze(record, &options).unwrap();
        let of_hold = |hold: &crate::analysis::HoldAnalysis| {
            let fit = hold.comparison.as_ref().unwrap().rows[0].fit.as_ref().unwrap();
            ["amplitude_1", "amplitude_2"].map(|name| fit.value(name).unwrap())
        };
        found.holds.iter().map(of_hold).collect()
    }

    /// Amplitudes lacked the share of the first step of the ramp, had that of air, and those of a second hold what was left of the first.
    #[test]
    fn linear_laws_know_all_that_was_imposed() {
        let near = |found: [f64; 2], steps: f64, within: f64| {
            let off = [found[0] / (1.5 * steps) - 1.0, found[1] / (0.8 * steps) - 1.0];
            assert!(off.iter().all(|off| off.abs() < within), "{found:?} {off:?}");
        };
        for dt in [0.2, 0.02] {
            near(amplitudes(&record(&[1.0], (2.0, 0.0, 4.0, 60.0), dt))[0], 1.0, 1e-6);
        }
        near(amplitudes(&record(&[1.0], (2.0, 1.0, 1.0, 60.0), 0.02))[0], 1.0, 2e-2);
        let stairs = amplitudes(&record(&[1.0, 1.0], (2.0, 0.0, 2.0, 20.0), 0.02));
        near(stairs[0], 1.0, 1e-4);
        near(stairs[1], 2.0, 1e-3);
        let back = amplitudes(&record(&[2.0, -1.0], (2.0, 0.0, 2.0, 20.0), 0.02));
        near(back[1], 1.0, 1e-3);
    }
}
