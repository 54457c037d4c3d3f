//! The search for hard cases: where the quick one ends at a bound, at merged terms or where numbers cannot be told apart.
//!
//! A finer grid, more valleys, and local searches that make columns orthogonal instead of forming normal equations, which lose
//! half the digits just where shapes imitate each other. The result may still be one that no data determine; but no other is
//! better.

use super::condensed::Condensed;
use super::model::{Model, Sampled};
use super::orthogonal::Orthogonal;
use super::samples::Scaled;
use super::separable::{
    Ending, Shapes, Solution, Target, Termination, Work, distance, polished, refine, standing, stepped,
};
use super::starts::{Grid, fine_starts};

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
    let merged: Vec<Vec<f64>> = ends.iter().filter_map(|theta| together(model, theta)).collect();
    let lowest = ends.iter().chain(&merged).map(|theta| local(&all, scaled.target(), theta, work));
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
        starts.extend(base.iter().take(BASES).flat_map(|valley| grown(&fewer, nodes, &valley.theta)));
    }
    let mut aside = Work::default();
    let mut found: Vec<Valley> = starts.iter().map(|start| local(&shapes, nodes.target(), start, &mut aside)).collect();
    work.condensed += aside.evaluations;
    found.sort_by(|a, b| a.square.total_cmp(&b.square));
    found
}

/// Fits of fewer terms that are grown.
const BASES: usize = 3;

/// The rates of a series with one more, wherever that takes off more than a little faster or slower one would.
fn grown(model: &Model, nodes: &Condensed, theta: &[f64]) -> Vec<Vec<f64>> {
    let shapes = model.at(&nodes.times);
    let here = Orthogonal::new(&shapes, theta, nodes.target());
    let (low, high) = shapes.bounds(0);
    let steps = ((high - low) / 0.25).ceil() as usize;
    let rate = |i: usize| low + (high - low) * i as f64 / steps as f64;
    let gain = |i: usize| {
        let mut column = vec![0.0; nodes.times.len()];
        model.shape_value(0, &nodes.times, &[rate(i)], &mut column);
        column.iter_mut().zip(&nodes.roots).for_each(|(entry, root)| *entry *= root);
        here.gain(column)
    };
    let gains: Vec<f64> = (0..=steps).map(gain).collect();
    let highest = |i: &usize| {
        let beside = [i.checked_sub(1), Some(i + 1)].map(|j| j.and_then(|j| gains.get(j)).copied().unwrap_or(0.0));
        gains[*i] > beside[0] && gains[*i] >= beside[1]
    };
    (0..=steps).filter(highest).map(|i| [theta, &[rate(i)]].concat()).collect()
}

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

/// Steps of a local search.
const STEPS: usize = 60;

/// Where a local search ended.
struct Valley {
    theta: Vec<f64>,
    linear: Vec<f64>,
    square: f64,
}

/// Levenberg's method with the linear numbers projected out by orthogonal columns; by normal equations where these are bounded.
fn local(shapes: &Sampled<'_>, target: Target<'_>, start: &[f64], work: &mut Work) -> Valley {
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
        idle = if before - here.square <= 1e-8 * before { idle + 1 } else { 0 };
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
