//! Terms of a series that have bounds of their own: each keeps its number, so that all combinations of their rates are tried.

use super::{distinct, mark_merged};
use crate::fit::{Model, Scaled, condense};
use crate::optimise::{Effort, Ending, Refined, Solution, distance, polished, refine};
use crate::watch::Cancelled;

/// Most combinations that are tried.
const MOST: f64 = 4096.0;

/// Of these, those that are refined on condensed samples, and on all.
const REFINED: (usize, usize) = (24, 4);

/// Valleys closer than this in ln λ are one.
const APART: f64 = 1e-3;

/// The best parameters of a model whose terms cannot change places.
pub(super) fn search_each(
    model: &Model,
    scaled: &Scaled,
    most_iterations: usize,
    effort: &mut Effort<'_>,
) -> Result<Option<Solution>, Cancelled> {
    let nodes = condense(scaled);
    let shapes = model.at(&nodes.times);
    let mut aside = effort.aside();
    let mut descend = |starts: Vec<Vec<f64>>, ending: Ending| -> Result<Vec<Vec<f64>>, Cancelled> {
        let mut found = Vec::with_capacity(starts.len());
        for start in starts {
            let refined = refine(&shapes, nodes.target(), &start, ending, &mut aside)?;
            found.push((refined.point.square, refined.into_theta(&shapes)));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(found.into_iter().map(|(_, theta)| theta).collect())
    };
    let mut valleys = descend(combinations(model), Ending::new(0.0, 0))?;
    valleys.truncate(REFINED.0);
    let valleys = descend(valleys, Ending::tight(most_iterations))?;
    let valleys = distinct(valleys, REFINED.1, |one, other| distance(one, other) < APART);
    effort.work.condensed += aside.work.evaluations;
    let (shapes, target) = (model.at(&scaled.times), scaled.target());
    let mut best: Option<Refined> = None;
    for valley in valleys {
        let refined = refine(&shapes, target, &valley, Ending::tight(most_iterations), effort)?;
        if best.as_ref().is_none_or(|best| refined.point.square < best.point.square) {
            best = Some(refined);
        }
    }
    let Some(best) = best else { return Ok(None) };
    let mut solution = polished(&shapes, target, best, effort)?;
    mark_merged(model, &mut solution);
    Ok(Some(solution))
}

/// All combinations of a few rates of each term, evenly spaced in ln λ between its bounds.
fn combinations(model: &Model) -> Vec<Vec<f64>> {
    let each = MOST.powf(1.0 / model.free().len() as f64).floor().max(2.0) as usize;
    let mut all = vec![Vec::new()];
    for (low, high) in model.free().map(|parameter| parameter.bounds) {
        let rate = |i: usize| low + (high - low) * i as f64 / (each - 1) as f64;
        all = all
            .iter()
            .flat_map(|start: &Vec<f64>| (0..each).map(|i| [start.as_slice(), &[rate(i)]].concat()))
            .collect();
    }
    all
}
