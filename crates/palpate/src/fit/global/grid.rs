//! The grids of a coarse search: rates evenly spaced in ln λ, a few values of a dimensionless parameter, and the ends of laws that have one.

use std::iter;

use crate::fit::{Condensed, Model};
use crate::laws::{BasisFunction, ShapeParameterKind};

/// How fine a grid is.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Grid {
    /// Enough for smooth valleys.
    Coarse,
    /// For hard cases, where valleys are narrow.
    Fine,
    /// For two rates beside others.
    Dense,
    /// For one parameter alone on all samples.
    Finest,
}

/// All choices of `terms` of the first `count` places, each in rising order.
pub(crate) fn combinations(count: usize, terms: usize) -> impl Iterator<Item = Vec<usize>> {
    let first: Option<Vec<usize>> = (terms <= count).then(|| (0..terms).collect());
    iter::successors(first, move |chosen| {
        // The last place that can go on does, and those after it follow.
        let moving = (0..terms).rev().find(|place| chosen[*place] + (terms - place) < count)?;
        let mut next = chosen.clone();
        next.splice(moving.., (chosen[moving] + 1..).take(terms - moving));
        Some(next)
    })
}

/// The first `most` of those that are like none kept before.
pub(crate) fn distinct<T>(all: impl IntoIterator<Item = T>, most: usize, alike: impl Fn(&T, &T) -> bool) -> Vec<T> {
    let mut kept: Vec<T> = Vec::new();
    for one in all {
        if kept.len() < most && !kept.iter().any(|other| alike(other, &one)) {
            kept.push(one);
        }
    }
    kept
}

/// Step of a coarse search in ln λ.
const STEP: f64 = 1.0;

impl Grid {
    /// Step in ln λ.
    fn step(self) -> f64 {
        match self {
            Self::Coarse => STEP,
            Self::Fine => 0.4 * STEP,
            Self::Dense => 0.25 * STEP,
            Self::Finest => 0.1 * STEP,
        }
    }
}

/// Rates of a coarse search, equally spaced in ln λ.
pub(crate) fn rates((low, high): (f64, f64), fixed: Option<f64>, fineness: Grid) -> Vec<f64> {
    if let Some(rate) = fixed {
        return vec![rate];
    }
    let steps = ((high - low) / fineness.step()).ceil().max(2.0) as usize;
    (0..=steps).map(|i| low + (high - low) * i as f64 / steps as f64).collect()
}

/// The same for a shape that ends when λt = `end`: densely where the end lies between samples, since the residual has a kink wherever it
/// passes one, and not at all where it ends before the second.
pub(crate) fn rates_with_end((low, high): (f64, f64), end: f64, nodes: &Condensed, fineness: Grid) -> Vec<f64> {
    let dense = if fineness != Grid::Coarse { 0.05 } else { 0.2 };
    let first = nodes.times.iter().copied().find(|t| *t > 0.0).unwrap_or(1.0);
    let (from, until) = (end.ln().clamp(low, high), (end / first).ln().clamp(low, high) + STEP);
    let slow = (0..).map(|i| low + STEP * f64::from(i)).take_while(|rate| *rate < from);
    let dense = (0..).map(|i| from + dense * f64::from(i)).take_while(|rate| *rate < until.min(high));
    let mut all: Vec<f64> = slow.chain(dense).chain([until.min(high)]).collect();
    if fineness != Grid::Coarse {
        // Where the end has only just passed one of the first samples, the valley is narrower than any grid.
        let early = nodes.times.iter().filter(|t| **t > 0.0).take(12).map(|t| (end / t).ln());
        all.extend(early.flat_map(|rate| [3e-2, 1e-2, 1e-3].map(|before| (rate - before).clamp(low, high))));
        all.sort_by(f64::total_cmp);
    }
    all
}

/// Values of a dimensionless parameter that a coarse search tries.
pub(crate) fn coarse(kind: ShapeParameterKind, (low, high): (f64, f64), fixed: Option<f64>) -> Vec<f64> {
    match (fixed, kind) {
        (Some(value), _) => vec![value],
        (None, ShapeParameterKind::Pure { coarse, .. }) => {
            let inside = coarse.iter().copied().filter(|value| low < *value && *value < high);
            [low].into_iter().chain(inside).chain((high > low).then_some(high)).collect()
        }
        (None, _) => vec![low],
    }
}

/// Whether the law ends in finite time at these free parameters, which makes its residual one with kinks.
pub(crate) fn ends(model: &Model, theta: &[f64]) -> bool {
    let parameters = model.complete(theta);
    (0..model.form.shapes.len()).any(|shape| {
        let own = &parameters[model.parameters_of(shape)];
        finite_end(model.form.shapes[shape], own.last().copied().unwrap_or(1.0)).is_some()
    })
}

/// Of a law of one shape that may end in finite time: λt at its end, and its other free parameter, for those that a coarse search tries
/// and those halfway between.
pub(crate) fn ends_of(model: &Model) -> Vec<(f64, Vec<f64>)> {
    let [shape] = *model.moving().0.as_slice() else {
        return Vec::new();
    };
    let parameters = &model.parameters[model.parameters_of(shape)];
    if parameters[0].fixed.is_some() {
        return Vec::new();
    }
    let others = parameters
        .get(1)
        .map_or_else(|| vec![1.0], |parameter| coarse(parameter.kind, parameter.bounds, parameter.fixed));
    // Valleys between samples are narrow in the other parameter too.
    let between = others.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let others: Vec<f64> = others.iter().copied().chain(between).collect();
    let free = parameters.get(1).is_some_and(|parameter| parameter.fixed.is_none());
    let end = |other: f64| {
        finite_end(model.form.shapes[shape], other).map(|end| (end, if free { vec![other] } else { vec![] }))
    };
    others.into_iter().filter_map(end).collect()
}

/// λt at which the shape ends, if it does.
pub(crate) fn finite_end(shape: BasisFunction, other: f64) -> Option<f64> {
    let exponent = match shape {
        BasisFunction::Latency => other,
        BasisFunction::LatencyWith(exponent) => exponent,
        _ => return None,
    };
    (exponent < 1.0).then(|| 1.0 / (1.0 - exponent))
}
