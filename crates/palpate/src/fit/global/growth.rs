//! Starts of a series of exponentials: the best of one term less, and one more wherever that helps.
//!
//! Where noise opens narrow valleys a coarse grid of all rates at once sees none of them, because its slow rates fit too badly.

use crate::fit::problem::condensed::Condensed;
use crate::fit::problem::model::Model;
use crate::optimise::{Orthogonal, Shapes};

/// Step of the rate that is added, in ln λ.
const STEP: f64 = 0.25;

/// Distance in ln λ of a twin, a term beside one that is there.
const BESIDE: f64 = 0.1;

/// The rates `theta` of the series `fewer` with one more: wherever that takes off more than a little faster or slower one would, and
/// beside each of those there; with the residual square over the nodes with the rates that were there before kept.
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
