//! Laws that end in finite time: wherever the end passes a sample the residual has a kink, and a valley of its own between two.

use super::grid::ends_of;
use crate::fit::{Model, Scaled};
use crate::optimise::{Orthogonal, Shapes, Solution};

/// Intervals between samples that are looked at.
const INTERVALS: usize = 60;

/// Valleys that are kept.
const KEPT: usize = 6;

/// Places in an interval, in parts of the way from one sample to the next.
const PARTS: [f64; 4] = [1e-3, 0.03, 0.3, 0.7];

/// The same after the second sample: it alone feels where the law ends there, the less the nearer, and how near is up to its noise.
const NEAREST: [f64; 9] = [1e-6, 4e-6, 1.6e-5, 6e-5, 2.5e-4, 1e-3, 0.03, 0.3, 0.7];

/// Standard errors that the end may lie off.
const ERRORS: f64 = 6.0;

/// Starts with the end among the first samples.
pub(crate) fn first_kinks(model: &Model, scaled: &Scaled) -> Vec<Vec<f64>> {
    kinks(model, scaled, &|_| true)
}

/// Starts with the end between other samples than in `solution`, as near to it as its errors leave open.
pub(crate) fn near_kinks(model: &Model, scaled: &Scaled, solution: &Solution) -> Vec<Vec<f64>> {
    let (linear, size) = (solution.linear.len(), solution.linear.len() + solution.nonlinear.len());
    let (Some(inverse), [rate]) = (&solution.inverse_normal, solution.nonlinear.as_slice()) else {
        return Vec::new();
    };
    let error = (inverse[linear * (size + 1)] * solution.variance).sqrt();
    kinks(model, scaled, &|other| (other - rate).abs() <= ERRORS * error)
}

/// The deepest valleys over the free parameters with the end at each of some places between samples.
fn kinks(model: &Model, scaled: &Scaled, open: &dyn Fn(f64) -> bool) -> Vec<Vec<f64>> {
    let shapes = model.at(&scaled.times);
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    for (end, rest) in ends_of(model) {
        let (low, high) = shapes.bounds(0);
        let places = |(index, pair): (usize, &[f64])| {
            let (from, width) = (pair[0], pair[1] - pair[0]);
            let parts = if index == 1 { NEAREST.as_slice() } else { &PARTS };
            parts.iter().map(|part| (end / (from + part * width)).ln().clamp(low, high)).collect::<Vec<_>>()
        };
        let is_open = |rates: &Vec<f64>| [rates.first(), rates.last()].into_iter().flatten().any(|rate| open(*rate));
        let rates = scaled.times.windows(2).enumerate().map(places).filter(is_open).take(INTERVALS).flatten();
        let along: Vec<Orthogonal> = rates
            .map(|rate| Orthogonal::new(&shapes, &[&[rate], rest.as_slice()].concat(), scaled.target()))
            .collect();
        // One place of a plateau, where the law ends before the second sample, is enough.
        let lowest = |i: &usize| {
            let square = |j: Option<usize>| j.and_then(|j| along.get(j)).map_or(f64::INFINITY, |other| other.square);
            square(i.checked_sub(1)) >= along[*i].square && along[*i].square < square(Some(i + 1))
        };
        found.extend((0..along.len()).filter(lowest).map(|i| (along[i].square, along[i].theta.clone())));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().take(KEPT).map(|(_, theta)| theta).collect()
}
