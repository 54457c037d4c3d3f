//! The search for hard cases: where the quick one ends at a bound, at merged terms or where parameters cannot be distinguished.
//!
//! A finer grid, more valleys, and local searches that make columns orthogonal instead of forming normal equations, which lose
//! half the digits just where shapes imitate each other. The result may still be one that no data determine; but no other is
//! better.

use super::{Grid, Valley, distinct, exchanged, fine_starts, first_kinks, grown, local, paired, rising, rounding};
use crate::fit::{Condensed, Model, Scaled, condense_to};
use crate::laws::ShapeParameterKind;
use crate::optimise::{Effort, Ending, Solution, Termination, distance, polished, refine, standing};
use crate::watch::Cancelled;

/// Valleys that are searched on condensed samples.
const VALLEYS: usize = 16;

/// Valleys that are searched on all samples.
const FINALISTS: usize = 6;

/// The better of `quick` and what a thorough search finds.
pub(crate) fn thorough(
    model: &Model,
    scaled: &Scaled,
    nodes: &Condensed,
    quick: Solution,
    most_iterations: usize,
    effort: &mut Effort<'_>,
) -> Result<Solution, Cancelled> {
    let all = model.at(&scaled.times);
    let mut ends = vec![quick.nonlinear.clone()];
    ends.extend(if model.is_series() {
        series(model, scaled, &quick, effort)?
    } else {
        // One parameter is cheap to search on all samples, and nodes miss what the noise of a single one does.
        let whole = if model.free().len() == 1 { condense_to(scaled, 0.0) } else { nodes.clone() };
        deepest(valleys(model, &whole, effort)?, FINALISTS)
    });
    ends.extend(first_kinks(model, scaled));
    if !model.is_series() {
        ends.extend(ends.iter().flat_map(|theta| first_felt(model, &scaled.times, theta)).collect::<Vec<_>>());
    }
    let mut best: Option<Valley> = None;
    for theta in &ends {
        let valley = local(&all, scaled.target(), theta, ENOUGH, effort)?;
        if best.as_ref().is_none_or(|best| valley.square.total_cmp(&best.square).is_lt()) {
            best = Some(valley);
        }
    }
    let Some(best) = best else {
        return Ok(quick);
    };
    let refined = refine(&all, scaled.target(), &best.theta, Ending::tight(most_iterations), effort)?;
    let plain = polished(&all, scaled.target(), refined, effort)?;
    // With rounding, which the best has in its square.
    let whole = |solution: &Solution| {
        solution.residual_square + rounding(scaled.target(), solution.residual_square, &solution.linear)
    };
    let lowest = whole(&quick).min(best.square).min(whole(&plain)) * (1.0 + ALIKE);
    Ok(if whole(&plain) <= lowest {
        plain
    } else if whole(&quick) <= lowest {
        quick
    } else {
        standing(&all, scaled.target(), &best.theta, &best.linear, Termination::Converged)
    })
}

/// Valleys of the condensed samples, deepest first: those of a fine grid and, for a series, those that one more term opens beside
/// the best fits of one term less, or two more beside the best of two less.
fn valleys(model: &Model, nodes: &Condensed, effort: &mut Effort<'_>) -> Result<Vec<Valley>, Cancelled> {
    let fewest = if model.is_series() { 1 } else { model.form.shapes.len() };
    let shorter: Vec<Model> = (fewest..model.form.shapes.len()).map(|count| model.first_shapes(count)).collect();
    let mut bases: Vec<(&Model, Vec<Valley>)> = Vec::new();
    for own in shorter.iter().chain([model]) {
        let grid = if own.free().len() == 1 { Grid::Finest } else { Grid::Fine };
        let mut starts = fine_starts(own, nodes, grid, VALLEYS, &mut effort.work);
        if let [.., (fewer, base)] = bases.as_slice() {
            let longer = distinct_of(base, BASES).into_iter().flat_map(|theta| grown(fewer, nodes, &theta));
            starts.extend(longer.map(|(_, theta)| theta));
        }
        if let [.., (_, base), _] = bases.as_slice()
            && let Some(best) = base.first()
        {
            // Of two terms that come together none may help alone.
            starts.extend(paired(own, nodes, &best.theta, &mut effort.work));
        }
        let (shapes, mut aside) = (own.at(&nodes.times), effort.aside());
        let mut found = starts
            .iter()
            .map(|start| local(&shapes, nodes.target(), start, ENOUGH, &mut aside))
            .collect::<Result<Vec<Valley>, Cancelled>>()?;
        effort.work.condensed += aside.work.evaluations;
        found.sort_by(|a, b| a.square.total_cmp(&b.square));
        bases.push((own, found));
    }
    Ok(bases.pop().map(|(_, found)| found).unwrap_or_default())
}

/// The deepest valleys of a series on nodes that tell them apart: with terms exchanged, brought together, and made as slow as can be felt.
fn series(
    model: &Model,
    scaled: &Scaled,
    quick: &Solution,
    effort: &mut Effort<'_>,
) -> Result<Vec<Vec<f64>>, Cancelled> {
    let nodes = condense_to(scaled, FINER);
    let shapes = model.at(&nodes.times);
    let mut aside = effort.aside();
    let mut found = valleys(model, &nodes, effort)?;
    found.push(local(&shapes, nodes.target(), &quick.nonlinear, ENOUGH, &mut aside)?);
    let mut found = exchanged(model, &nodes, found, effort)?;
    let mut descend = |theta: Vec<f64>| local(&shapes, nodes.target(), &theta, ENOUGH, &mut aside);
    let bases = distinct_of(&found, FINALISTS);
    let beside = bases
        .iter()
        .flat_map(|theta| [first_felt(model, &scaled.times, theta), together(model, theta)].concat());
    found.extend(beside.map(&mut descend).collect::<Result<Vec<_>, Cancelled>>()?);
    found.sort_by(|a, b| a.square.total_cmp(&b.square));
    let hasty = distinct_of(&found, SOUGHT_ANEW)
        .into_iter()
        .flat_map(|theta| among_the_first(&scaled.times, &theta));
    found.extend(hasty.map(&mut descend).collect::<Result<Vec<_>, Cancelled>>()?);
    effort.work.condensed += aside.work.evaluations;
    Ok(deepest(found, FINALISTS))
}

/// The parameters of the deepest valleys that are not the same, deepest first.
fn deepest(mut valleys: Vec<Valley>, most: usize) -> Vec<Vec<f64>> {
    valleys.sort_by(|a, b| a.square.total_cmp(&b.square));
    distinct_of(&valleys, most)
}

/// The same of valleys in their order.
fn distinct_of(valleys: &[Valley], most: usize) -> Vec<Vec<f64>> {
    // Parameters that are not felt differ, and the residual square does not.
    let same = |other: &&Valley, valley: &&Valley| {
        (other.square - valley.square).abs() <= ALIKE * valley.square
            || distance(&rising(&other.theta), &rising(&valley.theta)) <= 1e-3
    };
    distinct(valleys, most, same).iter().map(|valley| valley.theta.clone()).collect()
}

/// Relative width of the bins of nodes on which a series is sought: to 10⁻⁴ of what they leave over.
const FINER: f64 = 0.05;

/// Fits of fewer terms that are grown.
const BASES: usize = 3;

/// Relative difference of residual squares that is none.
const ALIKE: f64 = 1e-9;

/// Where a term is over before the second sample its rate is of no account; it is where that sample only just feels the term.
fn first_felt(model: &Model, times: &[f64], theta: &[f64]) -> Vec<Vec<f64>> {
    /// λt at the second sample beyond which only the first feels the term, and those to try.
    const OVER: f64 = 10.0;
    const FELT: [f64; 3] = [2.0, 4.0, 8.0];
    let Some(second) = times.iter().find(|time| **time > 0.0) else {
        return Vec::new();
    };
    let is_rate: Vec<bool> =
        model.free().map(|parameter| !matches!(parameter.kind, ShapeParameterKind::Pure { .. })).collect();
    let over = (0..theta.len()).filter(|&i| is_rate[i] && theta[i].exp() * second > OVER);
    let felt = |i: usize| {
        FELT.map(|felt| {
            let mut beside = theta.to_vec();
            beside[i] = (felt / second).ln();
            beside
        })
    };
    over.flat_map(felt).collect()
}

/// Valleys whose fast terms are sought anew.
const SOUGHT_ANEW: usize = 2;

/// A series with its terms of the first few samples at all combinations of rates there, equal ones among them: what such terms are is up
/// to the noise of a sample or two, and valleys are many.
fn among_the_first(times: &[f64], theta: &[f64]) -> Vec<Vec<f64>> {
    /// Samples that count as the first few.
    const FEW: usize = 6;
    /// λt at the last of them from which a term is theirs, and at the second sample up to which it is felt.
    const FAST: f64 = 0.2;
    const OVER: f64 = 10.0;
    const TRIED: usize = 9;
    let first: Vec<f64> = times.iter().copied().filter(|time| *time > 0.0).take(FEW - 1).collect();
    let &[second, .., last] = first.as_slice() else {
        return Vec::new();
    };
    let (slowest, fastest) = ((FAST / last).ln(), (OVER / second).ln());
    let (fast, slow): (Vec<f64>, Vec<f64>) = theta.iter().partition(|rate| **rate > slowest);
    let tried: Vec<f64> = (0..TRIED).map(|i| slowest + (fastest - slowest) * i as f64 / (TRIED - 1) as f64).collect();
    let mut all = if fast.is_empty() { Vec::new() } else { vec![Vec::new()] };
    for _ in &fast {
        let longer = all.iter().flat_map(|rates: &Vec<f64>| {
            let from = rates.last().copied().unwrap_or(f64::NEG_INFINITY);
            tried
                .iter()
                .filter(move |rate| **rate >= from)
                .map(move |rate| [rates.as_slice(), &[*rate]].concat())
        });
        all = longer.collect();
    }
    all.into_iter().map(|rates| [rates.as_slice(), &slow].concat()).collect()
}

/// The parameters with rates that are near each other brought together, each pair of neighbours and all of them: searches creep
/// towards such an end.
fn together(model: &Model, theta: &[f64]) -> Vec<Vec<f64>> {
    /// Difference of ln λ that counts as near.
    const NEAR: f64 = 0.5;
    if !model.is_series() {
        return Vec::new();
    }
    let mut rates = theta.to_vec();
    rates.sort_by(|a, b| b.total_cmp(a));
    let runs = (2..=rates.len()).flat_map(|length| (0..=rates.len() - length).map(move |from| from..from + length));
    let merged = |run: std::ops::Range<usize>| {
        let own = &rates[run.clone()];
        let count = own.len();
        (own[0] - own[count - 1] <= NEAR).then(|| {
            let middle = own.iter().sum::<f64>() / count as f64;
            let mut merged = rates.clone();
            merged[run].fill(middle);
            merged
        })
    };
    runs.filter_map(merged).collect()
}

/// Relative fall of the residual square that counts as none where valleys are compared.
const ENOUGH: f64 = 1e-8;
