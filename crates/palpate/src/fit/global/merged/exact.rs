//! Local searches by orthogonal columns: they keep the digits that normal equations lose.

use super::apart::{Valley, apart, rounding, valley};
use super::confluent::confluent;
use crate::fit::problem::model::Sampled;
use crate::optimise::{
    Cholesky, Effort, Ending, Orthogonal, Shapes, Solution, Target, Termination, distance, refine, standing, stepped,
};
use crate::vector::dot;
use crate::watch::Cancelled;

/// The solution carried on to what doubles allow, where normal equations do not reach it: where parameters nearly imitate each other, and
/// where the residual is next to nothing. `inflation` as of the function of that name.
pub(crate) fn exact(
    shapes: &Sampled<'_>,
    target: Target<'_>,
    solution: Solution,
    inflation: f64,
    effort: &mut Effort<'_>,
) -> Result<Solution, Cancelled> {
    let signal = target.square;
    let clean = solution.residual_square < CLEAN * signal && solution.residual_square > ROUNDING * signal;
    if solution.nonlinear.is_empty() || !shapes.linear_bounds().is_empty() || !(clean || inflation > IMITATED) {
        return Ok(solution);
    }
    // Straight to the last digit, with no regard for valleys elsewhere.
    let at = |theta: &[f64]| Place::plain(shapes, theta, target);
    let theta = descended(&solution.nonlinear, at, shapes, f64::EPSILON, effort)?;
    let valley = valley(flat(Orthogonal::new(shapes, &theta, target), shapes, target, effort)?);
    // To within rounding of the values the gradient decides.
    Ok(if valley.square.sqrt() <= solution.residual_square.sqrt() + f64::EPSILON * signal.sqrt() {
        standing(shapes, target, &valley.theta, &valley.linear, Termination::Converged)
    } else {
        solution
    })
}

/// Undamped steps for as long as what the next one promises falls: the residual square is flat to rounding before its gradient is.
fn flat(
    mut here: Orthogonal,
    shapes: &Sampled<'_>,
    target: Target<'_>,
    effort: &mut Effort<'_>,
) -> Result<Orthogonal, Cancelled> {
    let outlook = |here: &Orthogonal| {
        let (hessian, gradient) = here.projected(&here.factors(shapes));
        let next = stepped(&here.theta, &hessian, &gradient, 0.0, shapes);
        let gain: f64 = next.iter().zip(&here.theta).zip(&gradient).map(|((a, b), g)| (a - b) * g).sum();
        (next, gain)
    };
    let slack = f64::EPSILON * dot(target.values, target.values).sqrt();
    let (mut next, mut gain) = outlook(&here);
    for _ in 0..STEPS {
        let trial = Orthogonal::new(shapes, &next, target);
        effort.evaluated()?;
        let (after, less) = outlook(&trial);
        if !(less < gain && trial.square.sqrt() <= here.square.sqrt() + slack) {
            break;
        }
        (here, next, gain) = (trial, after, less);
    }
    Ok(here)
}

/// Of the square of the signal: residuals whose square is below have lost digits in normal equations, and those of rounding.
const CLEAN: f64 = 1e-20;

const ROUNDING: f64 = 1e-30;

/// Variance inflation from which the gradient of normal equations is no guide to the last step.
const IMITATED: f64 = 1e7;

/// The largest factor by which the other parameters widen the variance of one.
pub(crate) fn inflation(solution: &Solution) -> f64 {
    let Some(inverse) = &solution.inverse_normal else {
        return f64::INFINITY;
    };
    let size = solution.linear.len() + solution.nonlinear.len();
    let own = |i: usize| solution.column_squares[i] * inverse[i * (size + 1)];
    (0..solution.linear.len()).map(own).fold(1.0, f64::max)
}

/// Steps of a local search.
const STEPS: usize = 60;

/// Levenberg's method, until the residual square falls by no more than `enough` of itself, with the linear parameters projected out by
/// orthogonal columns; by normal equations where these are bounded.
pub(crate) fn local(
    shapes: &Sampled<'_>,
    target: Target<'_>,
    start: &[f64],
    enough: f64,
    effort: &mut Effort<'_>,
) -> Result<Valley, Cancelled> {
    if !shapes.linear_bounds().is_empty() {
        let refined = refine(shapes, target, start, Ending::tight(STEPS), effort)?;
        return Ok(Valley {
            theta: refined.point.theta.to_vec(),
            linear: refined.point.linear.to_vec(),
            square: refined.point.square,
        });
    }
    effort.work.starts += 1;
    if let Some((times, constant)) = shapes.exponentials() {
        let at = |theta: &[f64]| {
            let (point, factors) = confluent(times, constant, theta, target);
            Place {
                square: point.square,
                point,
                factors,
            }
        };
        let theta = descended(start, at, shapes, enough, effort)?;
        let least = at(&theta).square;
        let there = apart(shapes, target, &theta, effort)?;
        if there.square <= least * (1.0 + APART) {
            return Ok(there);
        }
        // No amplitudes in doubles reach what merged terms do: the best of those that are apart, not above the start.
        let at = |theta: &[f64]| {
            let mut place = Place::plain(shapes, theta, target);
            place.square += rounding(target, place.square, &place.point.linear());
            place
        };
        let from = if at(start).square < there.square { start } else { &there.theta };
        let theta = descended(from, at, shapes, enough, effort)?;
        let after = apart(shapes, target, &theta, effort)?;
        return Ok(if after.square < there.square { after } else { there });
    }
    let at = |theta: &[f64]| Place::plain(shapes, theta, target);
    let theta = descended(start, at, shapes, enough, effort)?;
    Ok(valley(Orthogonal::new(shapes, &theta, target)))
}

/// Relative rise of the residual square that taking merged terms apart may cost.
const APART: f64 = 1e-8;

/// A place of a local search.
struct Place {
    point: Orthogonal,
    /// What counts as the residual square.
    square: f64,
    /// What the derivatives of the columns count by.
    factors: Vec<f64>,
}

impl Place {
    /// With the columns as they are.
    fn plain(shapes: &Sampled<'_>, theta: &[f64], target: Target<'_>) -> Self {
        let point = Orthogonal::new(shapes, theta, target);
        Self {
            square: point.square,
            factors: point.factors(shapes),
            point,
        }
    }
}

/// θ where Levenberg's method ends.
fn descended(
    start: &[f64],
    at: impl Fn(&[f64]) -> Place,
    shapes: &Sampled<'_>,
    enough: f64,
    effort: &mut Effort<'_>,
) -> Result<Vec<f64>, Cancelled> {
    effort.evaluated()?;
    let mut here = lowered(at(start), &at, None, shapes, enough, effort)?;
    // Steps that would cross a cliff are refused, however much the other parameters would gain: one after the other is held.
    for parameter in 0..start.len() {
        if here.point.beside_cliff {
            here = lowered(here, &at, Some(parameter), shapes, enough, effort)?;
        }
    }
    Ok(here.point.theta)
}

/// The place where Levenberg's method ends, with one parameter held where it is if requested.
fn lowered(
    mut here: Place,
    at: &impl Fn(&[f64]) -> Place,
    held: Option<usize>,
    shapes: &Sampled<'_>,
    enough: f64,
    effort: &mut Effort<'_>,
) -> Result<Place, Cancelled> {
    let mut damping = FIRST;
    let mut idle = 0;
    for _ in 0..STEPS {
        let (hessian, gradient) = here.point.projected(&here.factors);
        let before = here.square;
        // Along a flat valley damping is what holds a step back: a small fall says nothing until there is next to none.
        let is_free = damping <= FREE;
        for _ in 0..TRIALS {
            let theta = inside(&here.point.theta, (&hessian, &gradient), held, UNFELT * before, damping, shapes);
            let trial = at(&theta);
            effort.evaluated()?;
            if trial.square < before {
                here = trial;
                damping = (damping * 0.1).max(LEAST);
                effort.work.iterations += 1;
                break;
            }
            if distance(&here.point.theta, &theta) < NOWHERE {
                break;
            }
            damping *= 8.0;
        }
        let idles = before - here.square <= enough * before;
        idle = if idles && is_free { idle + 1 } else { 0 };
        if idle == 2 || before == here.square {
            break;
        }
        if idles && !is_free {
            damping = (damping * 1e-2).max(LEAST);
        }
    }
    Ok(here)
}

/// θ after a damped step inside the bounds: parameters that would leave them stay at the bound, and the others take the best step beside
/// those, as beside one that is `held`. Curvatures below `unfelt` are damped as if they were that: rounding alone makes up the steps of
/// such parameters.
fn inside(
    theta: &[f64],
    (hessian, gradient): (&[f64], &[f64]),
    held: Option<usize>,
    unfelt: f64,
    damping: f64,
    shapes: &Sampled<'_>,
) -> Vec<f64> {
    let count = theta.len();
    let mut step: Vec<Option<f64>> = (0..count).map(|i| (Some(i) == held).then_some(0.0)).collect();
    loop {
        let free: Vec<usize> = (0..count).filter(|i| step[*i].is_none()).collect();
        let entry = |i: usize, j: usize| {
            let plain = hessian[i * count + j];
            if i == j { plain.max(f64::MIN_POSITIVE) + damping * plain.max(unfelt) } else { plain }
        };
        let matrix: Vec<f64> = free.iter().flat_map(|&i| free.iter().map(move |&j| entry(i, j))).collect();
        let known = |i: usize| -> f64 { (0..count).filter_map(|j| Some(hessian[i * count + j] * step[j]?)).sum() };
        let mut change: Vec<f64> = free.iter().map(|&i| gradient[i] - known(i)).collect();
        match Cholesky::new(&matrix, free.len()) {
            Some(factor) => factor.solve(&mut change),
            None => change.iter_mut().zip(&free).for_each(|(value, &i)| *value /= entry(i, i)),
        }
        let mut leaving = false;
        for (&i, &by) in free.iter().zip(&change) {
            let (low, high) = shapes.bounds(i);
            // Of numbers that ran out no bound is one.
            let allowed = by.clamp(-LONGEST, LONGEST).max(low - theta[i]).min(high - theta[i]);
            if allowed != by {
                step[i] = Some(allowed);
                leaving = true;
            }
        }
        if !leaving {
            free.iter().zip(change).for_each(|(&i, by)| step[i] = Some(by));
            let ended = theta.iter().zip(step).enumerate().map(|(i, (value, by))| {
                let (low, high) = shapes.bounds(i);
                (value + by.unwrap_or(0.0)).clamp(low, high)
            });
            return ended.collect();
        }
    }
}

/// Of the residual square: a curvature that hardly shows.
const UNFELT: f64 = 1e-4;

/// Largest change of ln λ that is none.
const NOWHERE: f64 = 1e-15;

/// Dampings tried for a step.
const TRIALS: usize = 16;

/// Damping of the first step, strong: valleys may be narrow, and a long step leaves them for others.
const FIRST: f64 = 1.0;

/// Longest step of a parameter: the model is trusted only so far.
const LONGEST: f64 = 2.0;

/// Damping below which a step is all but free, and the least.
const FREE: f64 = 1e-8;

const LEAST: f64 = 1e-12;
