//! From a model and samples to the global optimum.

use super::{ends, exact, grown, inflation, local, mark_merged, near_kinks, search_each, starts, thorough};
use crate::fit::{Condensed, Model, Sampled, Scaled, condense, redundant_terms};
use crate::optimise::{
    Effort, Ending, Near, Refined, Solution, Square, Target, Termination, curvature, descend, distance, polished,
    refine, standing, stepped,
};
use crate::watch::Cancelled;

/// Valleys that are refined on condensed samples.
const VALLEYS: usize = 6;

/// Valleys that are refined on all samples, at most.
const FINALISTS: usize = 3;

/// Finds the best parameters of a model: a coarse grid and local searches on condensed samples, then the best of them on all.
pub(crate) fn search(
    model: &Model,
    scaled: &Scaled,
    most_iterations: usize,
    effort: &mut Effort<'_>,
) -> Result<Option<Solution>, Cancelled> {
    if model.has_own_bounds() {
        return search_each(model, scaled, most_iterations, effort);
    }
    let nodes = condense(scaled);
    let valleys = valleys(model, &nodes, most_iterations, effort)?;
    let (shapes, target) = (model.at(&scaled.times), scaled.target());
    let mut best: Option<Refined> = None;
    for valley in valleys {
        let refined = settle(&shapes, target, &valley, most_iterations, effort)?;
        if best.as_ref().is_none_or(|best| refined.point.square < best.point.square) {
            best = Some(refined);
        }
    }
    let Some(best) = best else {
        return Ok(None);
    };
    let mut solution = polished(&shapes, target, best, effort)?;
    mark_merged(model, &mut solution);
    solution = settled_between_kinks(model, scaled, solution, effort)?;
    let inflation = inflation(&solution);
    let doubtful = solution.termination != Termination::Converged
        || !redundant_terms(model, &solution).is_empty()
        || inflation > BEYOND
        || model.is_series() && widest(&solution) > WIDE
        || is_hasty(model, scaled, &solution);
    if doubtful && model.free().len() > 0 {
        solution = thorough(model, scaled, &nodes, solution, most_iterations, effort)?;
        mark_merged(model, &mut solution);
    } else {
        solution = exact(&shapes, target, solution, inflation, effort)?;
    }
    Ok(Some(solution))
}

/// The largest standard error of a nonlinear parameter.
fn widest(solution: &Solution) -> f64 {
    let Some(inverse) = &solution.inverse_normal else {
        return f64::INFINITY;
    };
    let (linear, size) = (solution.linear.len(), solution.linear.len() + solution.nonlinear.len());
    let error = |i: usize| (inverse[i * (size + 1)] * solution.variance).sqrt();
    (linear..size).map(error).fold(0.0, f64::max)
}

/// Whether the relaxation is nearly over within so few samples that the noise of any of them opens valleys of its own.
fn is_hasty(model: &Model, scaled: &Scaled, solution: &Solution) -> bool {
    let &[shape] = model.moving().0.as_slice() else {
        return false;
    };
    let last = scaled.times.len() - 1;
    let times = [scaled.times[0], scaled.times[HASTY.min(last)], scaled.times[last]];
    let mut values = [0.0; 3];
    let parameters = &model.complete(&solution.nonlinear)[model.parameters_of(shape)];
    model.shape_value(shape, &times, parameters, &mut values);
    let [start, early, end] = values;
    (early - end).abs() < OVER * (start - end).abs()
}

/// Samples that show the course of a relaxation whatever their noise.
const HASTY: usize = 10;

/// Share of a relaxation that is left when it is nearly over.
const OVER: f64 = 0.1;

/// Standard error of ln λ of a term that so few samples feel, or so weakly, that others may need it as much elsewhere.
const WIDE: f64 = 0.15;

/// Variance inflation beyond which doubles do not tell a valley from a plain.
const BEYOND: f64 = 1e12;

/// Where the law ends in finite time, the best of the valleys between samples that the errors of the end leave open.
fn settled_between_kinks(
    model: &Model,
    scaled: &Scaled,
    solution: Solution,
    effort: &mut Effort<'_>,
) -> Result<Solution, Cancelled> {
    if solution.termination != Termination::Converged || !ends(model, &solution.nonlinear) {
        return Ok(solution);
    }
    let shapes = model.at(&scaled.times);
    let beside = near_kinks(model, scaled, &solution);
    let others = beside.iter().map(|theta| local(&shapes, scaled.target(), theta, f64::EPSILON, effort));
    let others = others.collect::<Result<Vec<_>, Cancelled>>()?;
    Ok(match others.into_iter().min_by(|a, b| a.square.total_cmp(&b.square)) {
        Some(best) if best.square < solution.residual_square * (1.0 - ALIKE_AT_ALL) => {
            standing(&shapes, scaled.target(), &best.theta, &best.linear, Termination::Converged)
        }
        _ => solution,
    })
}

/// Relative difference of residual squares that is rounding.
const ALIKE_AT_ALL: f64 = 1e-12;

/// The bottom of a valley of the condensed samples, or a start that only all samples can tell from it.
struct Valley {
    theta: Vec<f64>,
    /// Curvature on the way there, where the valley is smooth.
    curvature: Option<Square>,
}

/// From the bottom of a valley of the condensed samples to that of all samples: Newton's method where the valley is smooth.
fn settle(
    shapes: &Sampled<'_>,
    target: Target<'_>,
    valley: &Valley,
    most_iterations: usize,
    effort: &mut Effort<'_>,
) -> Result<Refined, Cancelled> {
    if let Some(hessian) = &valley.curvature
        && let Some(refined) = descend(shapes, target, &valley.theta, hessian, Near::of(target), effort)?
    {
        return Ok(refined);
    }
    refine(shapes, target, &valley.theta, Ending::tight(most_iterations), effort)
}

/// The nonlinear parameters at the deepest valleys of the condensed problem, deepest first.
pub(crate) fn finalists(
    model: &Model,
    nodes: &Condensed,
    most_iterations: usize,
    effort: &mut Effort<'_>,
) -> Result<Vec<Vec<f64>>, Cancelled> {
    Ok(valleys(model, nodes, most_iterations, effort)?.into_iter().map(|valley| valley.theta).collect())
}

/// The deepest valleys of the condensed problem, deepest first, with every other that is as deep to the accuracy of condensing.
fn valleys(
    model: &Model,
    nodes: &Condensed,
    most_iterations: usize,
    effort: &mut Effort<'_>,
) -> Result<Vec<Valley>, Cancelled> {
    let (shapes, target) = (model.at(&nodes.times), nodes.target());
    let mut aside = effort.aside();
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    let rough = Ending::new(ROUGH, most_iterations);
    let explore = |start: &[f64], aside: &mut Effort<'_>| {
        let refined = refine(&shapes, target, start, rough, aside)?;
        Ok((refined.point.square + nodes.inside, refined.into_theta(&shapes)))
    };
    let (kinked, smooth): (Vec<Vec<f64>>, Vec<Vec<f64>>) =
        starts(model, nodes, VALLEYS, &mut effort.work).into_iter().partition(|start| ends(model, start));
    for start in smooth {
        found.push(explore(&start, &mut aside)?);
    }
    let least = found.iter().map(|(square, _)| *square).fold(f64::INFINITY, f64::min);
    let mut open: Vec<(f64, Vec<f64>)> = Vec::new();
    for start in kinked {
        let square = refine(&shapes, target, &start, AS_IT_IS, &mut aside)?.point.square + nodes.inside;
        if square <= HOPELESS * least {
            found.push(explore(&start, &mut aside)?);
            open.push((square, start));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    if model.is_series()
        && let Some((least, _)) = found.first()
    {
        let limit = least * (1.0 + nodes.noise(FELT));
        for (square, theta) in longer(model, nodes, most_iterations, effort)? {
            if square + nodes.inside <= limit {
                let valley = local(&shapes, target, &theta, ROUGH, &mut aside)?;
                found.push((valley.square + nodes.inside, valley.theta));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    effort.work.starts += aside.work.starts;
    let Some(limit) = found
        .first()
        .map(|(least, _)| least * (1.0 + f64::max(ALIKE, nodes.noise(REPORTED))) + f64::MIN_POSITIVE)
    else {
        return Ok(Vec::new());
    };
    let mut kept: Vec<Valley> = Vec::new();
    for (square, theta) in found {
        if kept.len() == FINALISTS || (!kept.is_empty() && square > limit) {
            break;
        }
        let valley = bottom(&shapes, target, &theta, most_iterations, &mut aside)?;
        if !kept.iter().any(|other| distance(&other.theta, &valley.theta) < 1e-3) {
            kept.push(valley);
        }
    }
    // Where the law ends in finite time nodes only tell roughly: such a start goes to all samples as it is.
    let limit = limit * (1.0 + KINKED);
    for (_, theta) in open.into_iter().filter(|(square, _)| *square <= limit) {
        let curvature = curvature(&shapes, target, &theta, &mut aside)?.map(|(hessian, _)| hessian);
        kept.push(Valley { theta, curvature });
    }
    effort.work.condensed += aside.work.evaluations;
    Ok(kept)
}

/// Starts of a series from the best one of a term less.
fn longer(
    model: &Model,
    nodes: &Condensed,
    most_iterations: usize,
    effort: &mut Effort<'_>,
) -> Result<Vec<(f64, Vec<f64>)>, Cancelled> {
    let fewer = model.first_shapes(model.form.shapes.len() - 1);
    let best = finalists(&fewer, nodes, most_iterations, effort)?.into_iter().next();
    Ok(best.map(|theta| grown(&fewer, nodes, &theta)).unwrap_or_default())
}

/// Variances of the noise of a sample that a refinement may take off the residual square of a grown series.
const FELT: f64 = 20.0;

/// No step at all.
const AS_IT_IS: Ending = Ending::new(0.0, 0);

/// Times the least residual square, above which a law that ends in finite time is not the best with another exponent: those tried are
/// as near to each other as to the laws without an end.
const HOPELESS: f64 = 100.0;

/// Relative difference of residual squares below which a law that ends in finite time may be the best.
const KINKED: f64 = 1e-2;

/// Relative difference of residual squares below which condensed samples cannot say which valley is deeper.
const ALIKE: f64 = 1e-3;

/// Variances of the noise of a sample, the same.
const REPORTED: f64 = 0.2;

/// Relative gain at which a valley has been searched well enough to tell it from others.
const ROUGH: f64 = 1e-5;

/// The very bottom of a valley of the condensed samples, as near as they tell.
fn bottom(
    shapes: &Sampled<'_>,
    target: Target<'_>,
    theta: &[f64],
    most_iterations: usize,
    aside: &mut Effort<'_>,
) -> Result<Valley, Cancelled> {
    let slope = curvature(shapes, target, theta, aside)?;
    let last = slope.as_ref().map(|(hessian, gradient)| stepped(theta, hessian, gradient, 0.0, shapes));
    if let Some(next) = last.filter(|next| Near::TELLING.holds(distance(theta, next), 0.0)) {
        return Ok(Valley {
            theta: next.to_vec(),
            curvature: slope.map(|(hessian, _)| hessian),
        });
    }
    let curvature = slope.map(|(hessian, _)| hessian);
    let refined = match &curvature {
        Some(hessian) => descend(shapes, target, theta, hessian, Near::TELLING, aside)?,
        None => None,
    };
    let refined = match refined {
        Some(refined) => refined,
        None => refine(shapes, target, theta, Ending::tight(most_iterations), aside)?,
    };
    Ok(Valley {
        theta: refined.into_theta(shapes),
        curvature,
    })
}
