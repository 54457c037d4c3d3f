//! Where a joint search starts: at the separate fits, at their mean, and at the valleys of a coarse grid over all holds.

use super::arrow::{Point, refine};
use super::hold::{Hold, View};
use crate::fit::global::grid::{Grid, coarse, combinations, distinct, rates};
use crate::fit::global::starts::starts as valleys;
use crate::fit::{Condensed, Model, condense};
use crate::optimise::{Effort, Ending, refine as refine_one};
use crate::watch::{Cancelled, Progress};

/// A point to start from.
#[derive(Clone)]
pub(crate) struct Start {
    pub(crate) shared: Vec<f64>,
    pub(crate) own: Vec<Vec<f64>>,
}

impl Start {
    pub(crate) fn new(shared: Vec<f64>, own: Vec<Vec<f64>>) -> Self {
        Self { shared, own }
    }
}

/// Points of the grid that are refined.
const KEPT: usize = 6;

/// Combinations of rates that are tried, at most.
const COMBINATIONS: usize = 2000;

/// Points that are refined on all samples, at most.
const FINALISTS: usize = 3;

/// The best points on the nodes that stand for the samples, deepest first.
pub(crate) fn finalists(
    holds: &[Hold],
    bounds: &[(f64, f64)],
    separate: Vec<Start>,
    most_iterations: usize,
    effort: &mut Effort<'_>,
) -> Result<Vec<Start>, Cancelled> {
    let nodes: Vec<Condensed> = holds.iter().map(|hold| condense(&hold.scaled)).collect();
    let views: Vec<View<'_>> = holds.iter().zip(&nodes).map(|(hold, nodes)| view(hold, nodes)).collect();
    let inside: f64 = holds.iter().zip(&nodes).map(|(hold, nodes)| hold.weight.powi(2) * nodes.inside).sum();
    let mut aside = effort.aside();
    let mut starts = with_mean(separate);
    starts.extend(if holds[0].coupling.is_some() {
        by_exponent(holds, &nodes, effort)?
    } else {
        grid(holds, &nodes, bounds, effort)?
    });
    let ending = Ending::new(1e-10, most_iterations);
    let mut found: Vec<(f64, Start)> = Vec::new();
    for start in starts {
        aside.reach(Progress::counted("fitting holds together", holds.len(), holds.len() + 1))?;
        let inner: Vec<f64> =
            start.shared.iter().zip(bounds).map(|(value, (low, high))| value.clamp(*low, *high)).collect();
        let point = Point::new(&views, &inner, &start.own, &mut aside)?;
        let (point, _) = refine(&views, bounds, point, ending, &mut aside)?;
        if point.square.is_finite() {
            let start = Start::new(point.shared.clone(), point.own());
            found.push((point.square + inside, start));
        }
    }
    effort.work.starts += aside.work.starts;
    effort.work.condensed += aside.work.evaluations;
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let limit = found.first().map_or(0.0, |(least, _)| least * 1.001 + f64::MIN_POSITIVE);
    let alike = found.into_iter().take_while(|(square, _)| *square <= limit).map(|(_, start)| start);
    Ok(distinct(alike, FINALISTS, near(1e-3)))
}

fn view<'a>(hold: &'a Hold, nodes: &'a Condensed) -> View<'a> {
    View {
        hold,
        times: &nodes.times,
        target: nodes.target(),
    }
}

/// Whether starts differ by less than `apart` in all shared parameters.
fn near(apart: f64) -> impl Fn(&Start, &Start) -> bool {
    move |a, b| a.shared.iter().zip(&b.shared).all(|(a, b)| (a - b).abs() < apart)
}

/// The separate fits and their mean; fits that agree count once.
fn with_mean(separate: Vec<Start>) -> Vec<Start> {
    let count = separate.len() as f64;
    let mean = |p: usize| separate.iter().map(|start| start.shared[p]).sum::<f64>() / count;
    let middle = separate
        .first()
        .map(|first| Start::new((0..first.shared.len()).map(mean).collect(), first.own.clone()));
    distinct(middle.into_iter().chain(separate), usize::MAX, near(0.3))
}

/// For each exponent of a coarse list: every hold fitted alone at it, and the mean of what they have in common.
fn by_exponent(holds: &[Hold], nodes: &[Condensed], effort: &mut Effort<'_>) -> Result<Vec<Start>, Cancelled> {
    let parameter = holds[0].model.parameters.get(1);
    let exponents =
        parameter.map_or_else(Vec::new, |parameter| coarse(parameter.kind, parameter.bounds, parameter.fixed));
    let alone = |exponent: f64, effort: &mut Effort<'_>| -> Result<Option<Start>, Cancelled> {
        let mut start = Start::new(vec![0.0, exponent], Vec::new());
        for (hold, nodes) in holds.iter().zip(nodes) {
            let mut parameters = hold.model.parameters.clone();
            parameters[1].fixed = Some(exponent);
            let model = Model::new(hold.model.form.clone(), hold.model.constant, parameters, Vec::new());
            let Some(valley) = valleys(&model, nodes, 1, &mut effort.work).into_iter().next() else {
                return Ok(None);
            };
            let ending = Ending::new(1e-5, 50);
            let mut aside = effort.aside();
            let fit = refine_one(&model.at(&nodes.times), nodes.target(), &valley, ending, &mut aside)?;
            effort.work.condensed += aside.work.evaluations;
            let own = fit.point.linear.to_vec();
            start.shared[0] += hold.shared(&[fit.point.theta[0], exponent], &own)[0] / holds.len() as f64;
            start.own.push(own);
        }
        Ok(start.shared[0].is_finite().then_some(start))
    };
    exponents.into_iter().filter_map(|exponent| alone(exponent, effort).transpose()).collect()
}

/// The best points of a grid over the shared parameters, the residuals of all holds summed.
fn grid(
    holds: &[Hold],
    nodes: &[Condensed],
    bounds: &[(f64, f64)],
    effort: &mut Effort<'_>,
) -> Result<Vec<Start>, Cancelled> {
    let nodes: Vec<Condensed> = nodes.iter().map(Condensed::coarser).collect();
    let views: Vec<View<'_>> = holds.iter().zip(&nodes).map(|(hold, nodes)| view(hold, nodes)).collect();
    let own: Vec<Vec<f64>> = holds.iter().map(|hold| vec![0.0; hold.model.linear()]).collect();
    let mut aside = effort.aside();
    let mut found: Vec<(f64, Start)> = Vec::new();
    for shared in places(&holds[0].model, bounds) {
        effort.work.grid_points += 1;
        let point = Point::new(&views, &shared, &own, &mut aside)?;
        if point.square.is_finite() {
            found.push((point.square, Start::new(shared, own.clone())));
        }
    }
    effort.work.condensed += aside.work.evaluations;
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(distinct(found.into_iter().map(|(_, start)| start), KEPT, near(1.6)))
}

/// The points of the grid: a rate and a dimensionless parameter, or rates in all combinations, fastest first.
fn places(model: &Model, bounds: &[(f64, f64)]) -> Vec<Vec<f64>> {
    let (moving, _) = model.moving();
    if moving.len() > 1 {
        let mut grid = rates(bounds[0], None, Grid::Coarse);
        let most = (moving.len()..).take_while(|m| ways(*m, moving.len()) <= COMBINATIONS).last();
        let count = most.unwrap_or(moving.len()).min(grid.len());
        let (low, high) = bounds[0];
        if count < grid.len() {
            grid = (0..count).map(|i| low + (high - low) * i as f64 / (count - 1) as f64).collect();
        }
        let chosen = combinations(grid.len(), moving.len());
        return chosen.map(|chosen| chosen.iter().rev().map(|&i| grid[i]).collect()).collect();
    }
    let axis = |(parameter, bounds): (&crate::fit::problem::model::ModelParameter, &(f64, f64))| match parameter.kind {
        crate::laws::ShapeParameterKind::Pure { .. } => coarse(parameter.kind, *bounds, None),
        _ => rates(*bounds, None, Grid::Coarse),
    };
    let axes: Vec<Vec<f64>> = model.free().zip(bounds).map(axis).collect();
    axes.iter().fold(vec![Vec::new()], |points, axis| {
        points
            .iter()
            .flat_map(|point| axis.iter().map(|value| [point.as_slice(), &[*value]].concat()))
            .collect()
    })
}

/// Ways to choose `terms` of `count`.
fn ways(count: usize, terms: usize) -> usize {
    (0..terms).fold(1, |ways, i| ways * (count - i) / (i + 1))
}
