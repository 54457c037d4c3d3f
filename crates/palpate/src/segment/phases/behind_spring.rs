//! A machine that stands still behind a spring: a cantilever, or a frame that gives way as the force changes.

use super::turning::extremes;
use crate::record::Record;
use crate::statistics::{mean, noise, range};

/// A change of direction of the force, as a share of its range, and in standard deviations of its noise.
const TURNS: f64 = 0.02;
const OBSERVED: f64 = 8.0;
/// Way of the jaw behind a force that falls, as a share of its range; one that goes less far stands by any measure.
const LEAST_WAY: f64 = 0.01;
/// Parts in which displacement and force must be on one line, and fewest samples of each.
const PARTS: usize = 10;
const FEWEST: usize = 4;
/// How far the mean of a part may lie beside the line: a share of the way, or in standard errors.
const BESIDE: f64 = 0.04;
const ERRORS: f64 = 5.0;
/// Share of the way that the first half sees of what relaxes; of a jaw that travels, as through air over a baseline that tilts, it is a half.
const RELAXES: f64 = 0.55;
/// Standard errors of the mean of a part that the way must have, for the line to show.
const SHOWS: f64 = 30.0;

/// Where the machine itself is, up to a constant: displacement plus force times the compliance of a spring between the machine and the body.
///
/// Behind a spring of stiffness k a machine that stands still has u + F/k constant: as the body relaxes, the jaw creeps on by −ΔF/k, and the
/// displacement alone stands still only when the relaxation is over. The compliance is the slope of that line, in all stretches in which the jaw
/// goes on while the force falls back; `None` where there are none, or where one of them is on no such line.
pub(super) fn machine(record: &Record, displacement: &[f64]) -> Option<Vec<f64>> {
    let force = record.force();
    let stretches = stretches(displacement, force);
    let (mut covariance, mut variance) = (0.0, 0.0);
    for &(from, until) in &stretches {
        let about = |column: &[f64]| -> Vec<f64> {
            let centre = mean(&column[from..until]);
            column[from..until].iter().map(|value| value - centre).collect()
        };
        let (way, load) = (about(displacement), about(force));
        covariance += way.iter().zip(&load).map(|(u, f)| u * f).sum::<f64>();
        variance += load.iter().map(|f| f * f).sum::<f64>();
    }
    let compliance = -covariance / variance;
    if !(compliance.is_finite() && compliance > 0.0) {
        return None;
    }
    let machine: Vec<f64> = displacement.iter().zip(force).map(|(u, f)| u + compliance * f).collect();
    stretches
        .iter()
        .all(|&(from, until)| stands(&displacement[from..until], &machine[from..until]))
        .then_some(machine)
}

/// Stretches in which the jaw goes on in the direction of a ramp while the force falls back from where that ramp brought it.
fn stretches(displacement: &[f64], force: &[f64]) -> Vec<(usize, usize)> {
    let turns = extremes(force, (TURNS * range(force)).max(OBSERVED * noise(force)));
    let far = LEAST_WAY * range(displacement);
    let stretch = |ends: &[usize]| {
        let [from, until] = [ends[0], ends[1]];
        let direction = (force[from] - force[until]).signum();
        let forward = |i: &usize| direction * displacement[*i];
        let last = (from..=until).max_by(|a, b| forward(a).total_cmp(&forward(b)))?;
        let way = direction * (displacement[last] - displacement[from]);
        (from > 0 && last - from >= PARTS * FEWEST && way > far).then_some((from, last))
    };
    turns.windows(2).filter_map(stretch).collect()
}

/// Whether the machine stands while the jaw goes on: by parts, and from the first to the last.
fn stands(way: &[f64], machine: &[f64]) -> bool {
    let cut = |part: usize| part * way.len() / PARTS;
    let means =
        |column: &[f64]| -> Vec<f64> { (0..PARTS).map(|part| mean(&column[cut(part)..cut(part + 1)])).collect() };
    let (ways, places) = (means(way), means(machine));
    let error = noise(machine) / (way.len() as f64 / PARTS as f64).sqrt();
    let far = range(&ways);
    let centre = mean(machine);
    let relaxes = (mean(&ways[PARTS / 2 - 1..=PARTS / 2]) - ways[0]) / (ways[PARTS - 1] - ways[0]) > RELAXES;
    relaxes
        && far > SHOWS * error
        && places.iter().all(|place| (place - centre).abs() <= (BESIDE * far).max(ERRORS * error))
}
