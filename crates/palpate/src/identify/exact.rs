//! Local searches by orthogonal columns: they keep the digits that normal equations lose.

use super::model::{Model, Sampled};
use super::orthogonal::Orthogonal;
use super::samples::Scaled;
use super::separable::{Ending, Shapes, Solution, Target, Termination, Work, refine, standing, stepped};
use crate::vector::products::dot;

/// The solution carried on to what doubles allow, where normal equations do not reach it: where numbers nearly imitate each other, and
/// where next to nothing is left over.
pub(super) fn exact(model: &Model, scaled: &Scaled, solution: Solution, work: &mut Work) -> Solution {
    let all = model.at(&scaled.times);
    let signal = dot(scaled.target().values(), scaled.target().values());
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
pub(super) fn inflation(solution: &Solution) -> f64 {
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
pub(super) struct Valley {
    pub(super) theta: Vec<f64>,
    pub(super) linear: Vec<f64>,
    pub(super) square: f64,
}

/// Levenberg's method, until the residual square falls by no more than `enough` of itself, with the linear numbers projected out by
/// orthogonal columns; by normal equations where these are bounded.
pub(super) fn local(shapes: &Sampled<'_>, target: Target<'_>, start: &[f64], enough: f64, work: &mut Work) -> Valley {
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
