//! A series of exponentials with a term added, or with terms replaced: two of them are taken away and sought again everywhere beside those that stay.
//!
//! Where the signal is far above the noise a grid of all rates at once sees only the valley of the strongest terms. With these kept where
//! they are, a grid of two shows what the others might be instead: one elsewhere, both, or both as one.

use super::{Grid, Lattice, Plane, Valley, distinct, local, rates};
use crate::fit::problem::{Condensed, Model};
use crate::optimise::{Effort, Orthogonal, Shapes, Work, distance};
use crate::watch::Cancelled;

/// Terms that are replaced at once.
const REPLACED: usize = 2;

/// Rounds of replacing.
const ROUNDS: usize = 4;

/// Valleys that terms are replaced in, each round.
const OPEN: usize = 2;

/// Replacements that are followed.
const FOLLOWED: usize = 4;

/// The valleys with those that replacing terms opens, deepest first.
pub(crate) fn exchanged(
    model: &Model,
    nodes: &Condensed,
    valleys: Vec<Valley>,
    effort: &mut Effort<'_>,
) -> Result<Vec<Valley>, Cancelled> {
    let mut all = valleys;
    let mut observed: Vec<Vec<f64>> = Vec::new();
    for _ in 0..ROUNDS {
        all.sort_by(|a, b| a.square.total_cmp(&b.square));
        let fresh = |valley: &&Valley| observed.iter().all(|other| distance(other, &rising(&valley.theta)) > SAME);
        let fresh = all.iter().filter(fresh).map(|valley| rising(&valley.theta));
        let next = distinct(fresh, OPEN, |other, theta| distance(other, theta) <= SAME);
        let lowest = all.first().map_or(f64::INFINITY, |valley| valley.square);
        for theta in next {
            all.extend(replaced(model, nodes, &theta, effort)?);
            observed.push(theta);
        }
        if !all.iter().any(|valley| valley.square < lowest * (1.0 - ENOUGH)) {
            break;
        }
    }
    all.sort_by(|a, b| a.square.total_cmp(&b.square));
    Ok(all)
}

/// Largest difference of ln λ between valleys that are the same.
const SAME: f64 = 1e-2;

/// Relative fall of the residual square that counts as none.
const ENOUGH: f64 = 1e-8;

/// Rates in rising order: the order of terms is of no account.
pub(crate) fn rising(theta: &[f64]) -> Vec<f64> {
    let mut rates = theta.to_vec();
    rates.sort_by(f64::total_cmp);
    rates
}

/// Valleys near `theta` with every two terms replaced.
fn replaced(
    model: &Model,
    nodes: &Condensed,
    theta: &[f64],
    effort: &mut Effort<'_>,
) -> Result<Vec<Valley>, Cancelled> {
    let shapes = model.at(&nodes.times);
    let mut aside = effort.aside();
    let mut found = Vec::new();
    for first in 0..theta.len() {
        for second in first + 1..theta.len() {
            let kept: Vec<f64> = (0..theta.len()).filter(|i| *i != first && *i != second).map(|i| theta[i]).collect();
            for start in paired(model, nodes, &kept, &mut effort.work) {
                found.push(local(&shapes, nodes.target(), &start, ENOUGH, &mut aside)?);
            }
        }
    }
    effort.work.condensed += aside.work.evaluations;
    Ok(found)
}

/// The rates `kept` with two more, wherever a dense grid of these two shows a valley.
pub(crate) fn paired(model: &Model, nodes: &Condensed, kept: &[f64], work: &mut Work) -> Vec<Vec<f64>> {
    let lattice = Lattice {
        model,
        nodes,
        shape: 0,
        plane: Plane::new(model, kept.iter().map(|rate| nodes.column(model, 0, &[*rate])), nodes),
        grid: rates(model.parameters[0].bounds, None, Grid::Dense),
        terms: REPLACED,
    };
    lattice.valleys(FOLLOWED, work).into_iter().map(|others| [kept, &others].concat()).collect()
}

/// Step of the rate that is added, in ln λ.
const STEP: f64 = 0.25;

/// Distance in ln λ of a twin, a term beside one that is there.
const BESIDE: f64 = 0.1;

/// The rates `theta` of the series `fewer` with one more: wherever that takes off more than a little faster or slower one would, and
/// beside each of those there; with the residual square over the nodes with the rates that were there before kept.
///
/// Where noise opens narrow valleys a coarse grid of all rates at once sees none of them, because its slow rates fit too badly.
pub(crate) fn grown(fewer: &Model, nodes: &Condensed, theta: &[f64]) -> Vec<(f64, Vec<f64>)> {
    let shapes = fewer.at(&nodes.times);
    let here = Orthogonal::new(&shapes, theta, nodes.target());
    let (low, high) = shapes.bounds(0);
    let steps = ((high - low) / STEP).ceil() as usize;
    let rates: Vec<f64> = (0..=steps).map(|i| low + (high - low) * i as f64 / steps as f64).collect();
    let gain = |rate: &f64| here.gain(nodes.column(fewer, 0, &[*rate]));
    let gains: Vec<f64> = rates.iter().map(gain).collect();
    let highest = |i: &usize| {
        let beside = [i.checked_sub(1), Some(i + 1)].map(|j| j.and_then(|j| gains.get(j)).copied().unwrap_or(0.0));
        gains[*i] > beside[0] && gains[*i] >= beside[1]
    };
    let start = |(rate, gain): (f64, f64)| (here.square - gain, [theta, &[rate]].concat());
    let peaks = (0..=steps).filter(highest).map(|i| (rates[i], gains[i]));
    let twins = theta.iter().map(|rate| (rate + BESIDE).min(high)).map(|rate| (rate, gain(&rate)));
    peaks.chain(twins).map(start).collect()
}
