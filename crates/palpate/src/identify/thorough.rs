//! The search for hard cases: where the quick one ends at a bound, at merged terms or where numbers cannot be told apart.
//!
//! A finer grid, more valleys, and local searches that make columns orthogonal instead of forming normal equations, which lose
//! half the digits just where shapes imitate each other. The result may still be one that no data determine; but no other is
//! better.

use super::condensed::Condensed;
use super::exact::{Valley, local};
use super::growth::{Grown, grown};
use super::kinks::first_kinks;
use super::model::Model;
use super::samples::Scaled;
use super::search::condense_to;
use super::separable::{Ending, Solution, Termination, Work, distance, polished, refine, standing};
use super::starts::{Grid, fine_starts};
use crate::laws::NumberKind;

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
    // One number is cheap to search on all samples, and nodes miss what the noise of a single one does.
    let whole = if model.free().len() == 1 || model.is_series() { condense_to(scaled, 0.0) } else { nodes.clone() };
    let found = valleys(model, if model.is_series() { nodes } else { &whole }, work);
    let mut ends: Vec<Vec<f64>> = vec![quick.nonlinear.clone()];
    for valley in found {
        if ends.len() <= FINALISTS && ends.iter().all(|other| distance(other, &valley.theta) > 1e-3) {
            ends.push(valley.theta);
        }
    }
    if model.is_series() {
        ends.extend(longer(model, nodes, &whole, work));
    }
    ends.extend(first_kinks(model, scaled));
    ends.extend(ends.iter().flat_map(|theta| first_felt(model, &scaled.times, theta)).collect::<Vec<_>>());
    let merged: Vec<Vec<f64>> = ends.iter().flat_map(|theta| together(model, theta)).collect();
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
    let grid = if model.free().len() == 1 { Grid::Finest } else { Grid::Fine };
    let mut starts = fine_starts(model, nodes, grid, VALLEYS, work);
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

/// Starts of a series on all samples: the best one of a term less, and one more for the noise of any sample.
fn longer(model: &Model, nodes: &Condensed, whole: &Condensed, work: &mut Work) -> Vec<Vec<f64>> {
    let fewer = model.first_shapes(model.form.shapes.len() - 1);
    let bases = valleys(&fewer, nodes, work).into_iter().take(BASES);
    let mut all: Vec<Grown> = bases
        .flat_map(|base| {
            let here = local(&fewer.at(&whole.times), whole.target(), &base.theta, ENOUGH, work);
            grown(&fewer, whole, &here.theta)
        })
        .collect();
    all.sort_by(|a, b| a.square.total_cmp(&b.square));
    all.into_iter().take(FINALISTS).map(|start| start.theta).collect()
}

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
    let is_rate: Vec<bool> = model.free().map(|number| !matches!(number.kind, NumberKind::Pure { .. })).collect();
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

/// The numbers with rates that are near each other brought together, each pair of neighbours and all of them: searches creep
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
            // As near as none, and far enough apart for divided differences of so many.
            let apart = if count == 2 { 1e-4 } else { 1e-3 };
            let mut merged = rates.clone();
            for (i, rate) in merged[run].iter_mut().enumerate() {
                *rate = middle + apart * (0.5 * (count - 1) as f64 - i as f64);
            }
            merged
        })
    };
    runs.filter_map(merged).collect()
}

/// Relative fall of the residual square that counts as none where valleys are compared.
const ENOUGH: f64 = 1e-8;
