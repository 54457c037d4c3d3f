//! The search for hard cases: where the quick one ends at a bound, at merged terms or where numbers cannot be told apart.
//!
//! A finer grid, more valleys, and local searches that make columns orthogonal instead of forming normal equations, which lose
//! half the digits just where shapes imitate each other. The result may still be one that no data determine; but no other is
//! better.

use super::condensed::Condensed;
use super::growth::grown;
use super::model::{Model, Sampled};
use super::orthogonal::Orthogonal;
use super::samples::Scaled;
use super::separable::{
    Ending, Shapes, Solution, Target, Termination, Work, distance, polished, refine, standing, stepped,
};
use super::starts::{Grid, ends_of, fine_starts};
use crate::vector::products::dot;

/// Valleys that are searched on condensed samples.
const VALLEYS: usize = 16;

/// Valleys that are searched on all samples.
const FINALISTS: usize = 6;

/// The better of `quick` and what a thorough search finds.
pub(super) fn thorough(
    model: &Model,
    scaled: &Scaled,
    nodes: &Condensed,
    quick: Solution,
    most_iterations: usize,
    work: &mut Work,
) -> Solution {
    let all = model.at(&scaled.times);
    let found = valleys(model, nodes, work);
    let mut ends: Vec<Vec<f64>> = vec![quick.nonlinear.clone()];
    for valley in found {
        if ends.len() <= FINALISTS && ends.iter().all(|other| distance(other, &valley.theta) > 1e-3) {
            ends.push(valley.theta);
        }
    }
    ends.extend(kinks(model, scaled));
    let merged: Vec<Vec<f64>> = ends.iter().filter_map(|theta| together(model, theta)).collect();
    let lowest = ends.iter().chain(&merged).map(|theta| local(&all, scaled.target(), theta, ENOUGH, work));
    let Some(best) = lowest.min_by(|a, b| a.square.total_cmp(&b.square)) else {
        return quick;
    };
    let refined = refine(&all, scaled.target(), &best.theta, Ending::tight(most_iterations), work);
    let plain = polished(&all, scaled.target(), refined, work);
    let lowest = quick.residual_square.min(best.square).min(plain.residual_square) * (1.0 + ALIKE);
    if plain.residual_square <= lowest {
        plain
    } else if quick.residual_square <= lowest {
        quick
    } else {
        standing(&all, scaled.target(), &best.theta, &best.linear, Termination::Converged)
    }
}

/// Valleys of the condensed samples, deepest first: those of a fine grid and, for a series, those that one more term opens beside
/// the best fits of one term less.
fn valleys(model: &Model, nodes: &Condensed, work: &mut Work) -> Vec<Valley> {
    let shapes = model.at(&nodes.times);
    let mut starts = fine_starts(model, nodes, Grid::Fine, VALLEYS, work);
    if model.is_series() {
        let fewer = model.first_shapes(model.form.shapes.len() - 1);
        let base = valleys(&fewer, nodes, work);
        starts.extend(
            base.iter()
                .take(BASES)
                .flat_map(|valley| grown(&fewer, nodes, &valley.theta))
                .map(|start| start.theta),
        );
    }
    let mut aside = Work::default();
    let mut found: Vec<Valley> =
        starts.iter().map(|start| local(&shapes, nodes.target(), start, ENOUGH, &mut aside)).collect();
    work.condensed += aside.evaluations;
    found.sort_by(|a, b| a.square.total_cmp(&b.square));
    found
}

/// Fits of fewer terms that are grown.
const BASES: usize = 3;

/// Relative difference of residual squares that is none.
const ALIKE: f64 = 1e-9;

/// The numbers with the two rates that are nearest each other brought together: searches creep towards such an end.
fn together(model: &Model, theta: &[f64]) -> Option<Vec<f64>> {
    /// Difference of ln λ that counts as near, and that is as good as none.
    const NEAR: f64 = 0.5;
    const NONE: f64 = 1e-4;
    if !model.is_series() {
        return None;
    }
    let pairs = (0..theta.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let apart = |(a, b): &(usize, usize)| (theta[*a] - theta[*b]).abs();
    let (a, b) = pairs.min_by(|one, other| apart(one).total_cmp(&apart(other)))?;
    if apart(&(a, b)) > NEAR {
        return None;
    }
    let middle = 0.5 * (theta[a] + theta[b]);
    let mut merged = theta.to_vec();
    (merged[a], merged[b]) = (middle + 0.5 * NONE, middle - 0.5 * NONE);
    Some(merged)
}

/// Starts where a law that ends in finite time ends among the first samples: between two of them the residual has a valley of its
/// own, which no nodes show.
fn kinks(model: &Model, scaled: &Scaled) -> Vec<Vec<f64>> {
    /// Samples looked at, and parts of the way from one to the next.
    const FIRST: usize = 60;
    const PARTS: [f64; 4] = [1e-3, 0.03, 0.3, 0.7];
    let shapes = model.at(&scaled.times);
    let mut found: Vec<Valley> = Vec::new();
    for (end, rest) in ends_of(model) {
        let (low, high) = shapes.bounds(0);
        let pairs = scaled.times.windows(2).take(FIRST);
        let times = pairs.flat_map(|pair| PARTS.map(|part| pair[0] + part * (pair[1] - pair[0]).max(0.0)));
        let along: Vec<Orthogonal> = times
            .map(|time| [&[(end / time).ln().clamp(low, high)], rest.as_slice()].concat())
            .map(|theta| Orthogonal::new(&shapes, &theta, scaled.target()))
            .collect();
        let lowest = |i: &usize| {
            let beside = [i.checked_sub(1), Some(i + 1)].map(|j| j.and_then(|j| along.get(j)));
            beside.into_iter().flatten().all(|other| along[*i].square <= other.square)
        };
        found.extend((0..along.len()).filter(lowest).map(|i| Valley {
            theta: along[i].theta.clone(),
            linear: Vec::new(),
            square: along[i].square,
        }));
    }
    found.sort_by(|a, b| a.square.total_cmp(&b.square));
    found.into_iter().take(FINALISTS).map(|valley| valley.theta).collect()
}

/// Relative fall of the residual square that counts as none where valleys are compared.
const ENOUGH: f64 = 1e-8;

/// The solution carried on to what doubles allow, where normal equations do not reach it: where numbers nearly imitate each other, and
/// where next to nothing is left over.
pub(super) fn exact(model: &Model, scaled: &Scaled, solution: Solution, work: &mut Work) -> Solution {
    let all = model.at(&scaled.times);
    let signal = dot(scaled.target().values, scaled.target().values);
    let clean = solution.residual_square < CLEAN * signal && solution.residual_square > ROUNDING * signal;
    if solution.nonlinear.is_empty() || !all.linear_bounds().is_empty() || !(clean || inflation(&solution) > IMITATED) {
        return solution;
    }
    let valley = local(&all, scaled.target(), &solution.nonlinear, f64::EPSILON, work);
    if valley.square < solution.residual_square {
        standing(&all, scaled.target(), &valley.theta, &valley.linear, Termination::Converged)
    } else {
        solution
    }
}

/// Of the square of the signal: residuals whose square is below have lost digits in normal equations, and those of rounding.
const CLEAN: f64 = 1e-20;
const ROUNDING: f64 = 1e-30;

/// Variance inflation from which the gradient of normal equations is no guide to the last step.
const IMITATED: f64 = 1e7;

/// The largest factor by which the other numbers widen the variance of one.
fn inflation(solution: &Solution) -> f64 {
    let Some(inverse) = &solution.inverse_normal else {
        return f64::INFINITY;
    };
    let size = solution.linear.len() + solution.nonlinear.len();
    let own = |i: usize| dot(&solution.columns[i], &solution.columns[i]) * inverse[i * (size + 1)];
    (0..solution.linear.len()).map(own).fold(1.0, f64::max)
}

/// Steps of a local search.
const STEPS: usize = 60;

/// Where a local search ended.
struct Valley {
    theta: Vec<f64>,
    linear: Vec<f64>,
    square: f64,
}

/// Levenberg's method, until the residual square falls by no more than `enough` of itself, with the linear numbers projected out by orthogonal columns; by normal equations where these are bounded.
fn local(shapes: &Sampled<'_>, target: Target<'_>, start: &[f64], enough: f64, work: &mut Work) -> Valley {
    if !shapes.linear_bounds().is_empty() {
        let refined = refine(shapes, target, start, Ending::tight(STEPS), work);
        return Valley {
            theta: refined.theta().to_vec(),
            linear: refined.linear().to_vec(),
            square: refined.square(),
        };
    }
    let mut here = Orthogonal::new(shapes, start, target);
    work.evaluations += 1;
    work.starts += 1;
    let mut damping = 1e-3;
    let mut idle = 0;
    for _ in 0..STEPS {
        let (hessian, gradient) = here.projected(shapes);
        let before = here.square;
        for _ in 0..TRIALS {
            let theta = stepped(&here.theta, &hessian, &gradient, damping, shapes);
            let trial = Orthogonal::new(shapes, &theta, target);
            work.evaluations += 1;
            if trial.square < here.square {
                here = trial;
                damping = (damping * 0.2).max(1e-12);
                work.iterations += 1;
                break;
            }
            damping *= 6.0;
        }
        idle = if before - here.square <= enough * before { idle + 1 } else { 0 };
        if idle == 2 || before == here.square {
            break;
        }
    }
    Valley {
        linear: here.linear(),
        theta: here.theta,
        square: here.square,
    }
}

/// Dampings tried for a step.
const TRIALS: usize = 9;
