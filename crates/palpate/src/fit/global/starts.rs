//! The exhaustive coarse search that makes starting values unnecessary.

use super::{Grid, Lattice, Plane, coarse, combinations, finite_end, rates, rates_with_end};
use crate::fit::problem::{Condensed, Model};
use crate::optimise::{Cholesky, Few, Work};
use crate::statistics::dot;
use crate::vector::{LANES, lane_sums, multiply};

/// Points from which to refine the free parameters of a model, best first: the valleys that a coarse grid shows.
///
/// One shape that moves is scanned over its rate, for a list of values of its other parameter; several exponentials are tried in
/// all combinations of a grid of rates.
pub(crate) fn starts(model: &Model, nodes: &Condensed, most: usize, work: &mut Work) -> Vec<Vec<f64>> {
    fine_starts(model, &nodes.coarser(), Grid::Coarse, most, work)
}

/// The same on these very nodes, with a grid as fine as requested.
pub(crate) fn fine_starts(model: &Model, nodes: &Condensed, grid: Grid, most: usize, work: &mut Work) -> Vec<Vec<f64>> {
    let (moving, still) = model.moving();
    let all = model.complete(&vec![0.0; model.free().len()]);
    let column = |shape: &usize| nodes.column(model, *shape, &all[model.parameters_of(*shape)]);
    let plane = Plane::new(model, still.iter().map(column), nodes);
    match *moving.as_slice() {
        [] => vec![Vec::new()],
        [shape] => plane.scan(model, shape, nodes, grid, most, work),
        [shape, ..] if grid != Grid::Coarse && moving.len() <= DEEPEST => {
            let bounds = model.parameters[model.parameters_of(shape).start].bounds;
            let grid = rates(bounds, None, Grid::Fine);
            Lattice {
                model,
                nodes,
                shape,
                plane,
                grid,
                terms: moving.len(),
            }
            .valleys(most, work)
        }
        _ => plane.combine(model, &moving, nodes, most, work),
    }
}

/// Terms up to which a fine grid of all combinations is small.
const DEEPEST: usize = 3;

impl Plane {
    /// One shape over a grid of its rate, for each value of its other parameter.
    fn scan(
        &self,
        model: &Model,
        shape: usize,
        nodes: &Condensed,
        fineness: Grid,
        most: usize,
        work: &mut Work,
    ) -> Vec<Vec<f64>> {
        let range = model.parameters_of(shape);
        let parameters = &model.parameters[range.clone()];
        let mut column = vec![0.0; nodes.times.len()];
        let mut table = Table::new(self, nodes);
        let mut along = |rates: &[f64], other: f64| -> Few {
            if fineness == Grid::Coarse && model.loading.is_none() {
                return table.residuals(model, shape, rates, other);
            }
            let mut residual = |rate: &f64| {
                model.shape_value(shape, &nodes.times, &[*rate, other][..parameters.len()], &mut column);
                multiply(&mut column, &nodes.roots);
                if fineness != Grid::Coarse { self.exact_residual(&mut column) } else { self.residual(&column) }
            };
            rates.iter().map(&mut residual).collect()
        };
        let others = parameters
            .get(1)
            .map_or_else(|| vec![0.0], |parameter| coarse(parameter.kind, parameter.bounds, parameter.fixed));
        let mut found: Vec<Valley> = Vec::new();
        for (place, other) in others.into_iter().enumerate() {
            let end = finite_end(model.form.shapes[shape], other);
            let grid = match end {
                Some(end) if parameters[0].fixed.is_none() => {
                    rates_with_end(parameters[0].bounds, end, nodes, fineness)
                }
                _ => rates(parameters[0].bounds, parameters[0].fixed, fineness),
            };
            let residuals = along(&grid, other);
            work.grid_points += residuals.len() as u64;
            for i in valleys_along(&grid, &residuals) {
                let width =
                    if i + 1 < grid.len() { grid[i + 1] - grid[i] } else { grid[i] - grid[i.saturating_sub(1)] };
                let step = 0.2 * width;
                let (rate, square) = bottom(grid[i], residuals[i], step, |rates| along(rates, other));
                found.push(Valley {
                    square,
                    place,
                    rate,
                    step,
                    other,
                    ends: end.is_some(),
                });
            }
        }
        let mut found = if fineness != Grid::Coarse { found } else { deepest_along(&found) };
        found.sort_by(|a, b| a.square.total_cmp(&b.square));
        found.truncate(most);
        if found.len() > 1 {
            // Nodes cost next to nothing, a long way down from each of several valleys does.
            for valley in &mut found {
                let along = |rates: &[f64]| along(rates, valley.other);
                (valley.rate, valley.square) = bottom(valley.rate, valley.square, 0.2 * valley.step, along);
            }
        }
        let inside = |rate: f64| rate.clamp(parameters[0].bounds.0, parameters[0].bounds.1);
        let mut starts: Vec<[f64; 2]> = found.iter().map(|valley| [inside(valley.rate), valley.other]).collect();
        if starts.is_empty() {
            // Nothing but plateaus: any point will do, and the refinement will say so.
            let rate = parameters[0].fixed.unwrap_or(0.0).clamp(parameters[0].bounds.0, parameters[0].bounds.1);
            let other = parameters
                .get(1)
                .map_or(0.0, |parameter| parameter.fixed.unwrap_or(0.5 * (parameter.bounds.0 + parameter.bounds.1)));
            starts.push([rate, other]);
        }
        let free = |both: [f64; 2]| {
            let kept = parameters.iter().zip(both).filter(|(parameter, _)| parameter.fixed.is_none());
            kept.map(|(_, value)| value).collect()
        };
        starts.into_iter().map(free).collect()
    }

    /// Several exponentials in all combinations of a grid of rates.
    fn combine(
        &self,
        model: &Model,
        moving: &[usize],
        nodes: &Condensed,
        most: usize,
        work: &mut Work,
    ) -> Vec<Vec<f64>> {
        let bounds = model.parameters[model.parameters_of(moving[0]).start].bounds;
        let grid = rates(bounds, None, Grid::Coarse);
        let columns: Vec<Vec<f64>> = grid
            .iter()
            .map(|rate| {
                let mut column = nodes.column(model, moving[0], &[*rate]);
                self.project(&mut column);
                column
            })
            .collect();
        // Rates at which the shape is flat over the hold, or over before it begins, are of no use beside others.
        let useful: Vec<usize> = (0..grid.len())
            .filter(|&i| dot(&columns[i], &columns[i]) > 1e-12 * nodes.times.len() as f64)
            .collect();
        let count = useful.len();
        let gram: Vec<f64> = useful
            .iter()
            .flat_map(|&i| useful.iter().map(|&j| dot(&columns[i], &columns[j])).collect::<Vec<_>>())
            .collect();
        let right: Vec<f64> = useful.iter().map(|&i| dot(&columns[i], &self.values)).collect();
        let terms = moving.len();
        let mut found: Vec<(f64, Vec<usize>)> = Vec::new();
        let (mut block, mut solution) = (vec![0.0; terms * terms], vec![0.0; terms]);
        for chosen in combinations(count, terms) {
            for (a, &i) in chosen.iter().enumerate() {
                solution[a] = right[i];
                for (b, &j) in chosen.iter().enumerate() {
                    block[a * terms + b] = gram[i * count + j];
                }
            }
            if let Some(factor) = Cholesky::new(&block, terms) {
                factor.solve(&mut solution);
                let gain: f64 = chosen.iter().zip(&solution).map(|(&i, amplitude)| right[i] * amplitude).sum();
                found.push((self.square - gain, chosen));
            }
            work.grid_points += 1;
        }
        let kept = lattice_valleys(found, most);
        kept.into_iter().map(|rates| rates.into_iter().rev().map(|i| grid[useful[i]]).collect()).collect()
    }
}

/// Valleys of a lattice of combinations: those beside none that was observed before, that is, is lower.
fn lattice_valleys(mut found: Vec<(f64, Vec<usize>)>, most: usize) -> Vec<Vec<usize>> {
    let order = |a: &(f64, Vec<usize>), b: &(f64, Vec<usize>)| a.0.total_cmp(&b.0);
    if found.len() > LOWEST {
        found.select_nth_unstable_by(LOWEST - 1, order);
        found.truncate(LOWEST);
    }
    found.sort_unstable_by(order);
    let near = |a: &[usize], b: &[usize]| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 1);
    let mut kept: Vec<Vec<usize>> = Vec::new();
    for (index, (_, rates)) in found.iter().enumerate() {
        // What is beside is a little lower more often than much.
        if !found[..index].iter().rev().any(|(_, lower)| near(lower, rates)) {
            kept.push(rates.clone());
        }
        if kept.len() == most {
            break;
        }
    }
    kept
}

/// Combinations of rates that are looked through for valleys, lowest first.
const LOWEST: usize = 400;

/// Residual squares of one more column at many rates at once.
///
/// A shape depends on λt alone, so that its values at many rates are those at one rate and as many sets of times; side by side, node
/// after node, every sum over nodes goes over several rates together.
struct Table<'a> {
    nodes: &'a Condensed,
    /// Squared roots of the weights.
    weights: Vec<f64>,
    /// The values of the plane, then its axes, times the roots.
    factors: Vec<Vec<f64>>,
    square: f64,
    /// Room for times, shapes and sums.
    times: Vec<f64>,
    shapes: Vec<f64>,
    sums: Vec<[f64; LANES]>,
}

impl<'a> Table<'a> {
    fn new(plane: &Plane, nodes: &'a Condensed) -> Self {
        let times_roots = |column: &[f64]| -> Vec<f64> {
            column.iter().zip(&nodes.roots).map(|(entry, root)| entry * root).collect()
        };
        Self {
            nodes,
            weights: times_roots(&nodes.roots),
            factors: std::iter::once(plane.values.as_slice())
                .chain(plane.basis.iter().map(Vec::as_slice))
                .map(times_roots)
                .collect(),
            square: plane.square,
            times: Vec::new(),
            shapes: Vec::new(),
            sums: vec![[0.0; LANES]; 2 + plane.basis.len()],
        }
    }

    fn residuals(&mut self, model: &Model, shape: usize, rates: &[f64], other: f64) -> Few {
        let nodes = self.nodes.times.len();
        let numbers = rates.len().next_multiple_of(LANES) * nodes;
        self.times.resize(numbers, 0.0);
        self.shapes.resize(numbers, 0.0);
        for (rates_together, rows) in rates.chunks(LANES).zip(self.times.as_chunks_mut().0.chunks_mut(nodes)) {
            // The last rate stands in for those that are not there.
            let last = rates_together.len() - 1;
            let scales: [f64; LANES] = std::array::from_fn(|lane| (rates_together[lane.min(last)] - rates[0]).exp());
            rows.iter_mut()
                .zip(&self.nodes.times)
                .for_each(|(row, time)| *row = scales.map(|scale| time * scale));
        }
        let parameters = model.parameters_of(shape).len();
        model.shape_value(shape, &self.times, &[rates[0], other][..parameters], &mut self.shapes);
        let mut residuals = Few::new();
        for (rates, rows) in rates.chunks(LANES).zip(self.shapes.as_chunks::<LANES>().0.chunks(nodes)) {
            lane_sums(rows, &self.weights, &self.factors, &mut self.sums);
            residuals.extend((0..rates.len()).map(|lane| self.residual(lane)));
        }
        residuals
    }

    /// What the column of one lane leaves of the residual square.
    fn residual(&self, lane: usize) -> f64 {
        let [square, shared, axes @ ..] = self.sums.as_slice() else {
            return self.square;
        };
        let imitated: f64 = axes.iter().map(|along| along[lane] * along[lane]).sum();
        let spread = square[lane] - imitated;
        // A shape that is flat over the hold explains nothing.
        let flat = spread <= 1e-14 * square[lane];
        if flat { self.square } else { self.square - shared[lane] * shared[lane] / spread }
    }
}

/// Places on a grid that are no higher than those beside them.
fn valleys_along(grid: &[f64], residuals: &[f64]) -> impl Iterator<Item = usize> {
    (0..grid.len()).filter(|&i| {
        let here = residuals[i];
        let beside = [i.checked_sub(1), Some(i + 1)].map(|j| j.and_then(|j| residuals.get(j)));
        let below = beside.iter().all(|next| next.is_none_or(|next| here <= *next));
        // A plateau, where the shape says nothing, is no valley unless there is nothing else.
        let plain = beside.iter().all(|next| next.is_none_or(|next| here == *next));
        below && !(plain && grid.len() > 1)
    })
}

/// A valley of the residual along ln λ.
#[derive(Clone, Copy)]
struct Valley {
    square: f64,
    /// Place of `other` among the values tried.
    place: usize,
    rate: f64,
    /// Distance of the rates that were tried around it.
    step: f64,
    other: f64,
    /// Whether the shape ends in finite time there.
    ends: bool,
}

/// Valleys that do not go on, deeper, at the next value of the other parameter; kinks break such a chain, so none is left out where the
/// shape ends.
fn deepest_along(valleys: &[Valley]) -> Vec<Valley> {
    /// Change of ln λ from one value of the other parameter to the next within which a valley is the same.
    const SAME: f64 = 3.0;
    let deeper = |valley: &Valley, other: &Valley| {
        other.place.abs_diff(valley.place) == 1
            && !valley.ends
            && (other.rate - valley.rate).abs() < SAME
            && other.square < valley.square
    };
    valleys
        .iter()
        .filter(|valley| !valleys.iter().any(|other| deeper(valley, other)))
        .copied()
        .collect()
}

/// ln λ near the bottom of a valley that was observed, and the residual square there: the vertex of a parabola through the lowest of a few
/// points `step` apart, as many as a table takes together, and those beside it.
fn bottom(at: f64, here: f64, step: f64, mut residuals: impl FnMut(&[f64]) -> Few) -> (f64, f64) {
    let rates: Few = (-3..=3).map(|k| at + step * f64::from(k)).collect();
    let squares = residuals(&rates);
    let best = (0..squares.len()).min_by(|&a, &b| squares[a].total_cmp(&squares[b])).unwrap_or(0);
    if squares[best] > here {
        return (at, here);
    }
    let beside = best.checked_sub(1).zip(squares.get(best + 1)).map(|(before, after)| (squares[before], *after));
    let vertex = beside.map_or(0.0, |(before, after)| match before - 2.0 * squares[best] + after {
        curvature if curvature > 0.0 => (0.5 * (before - after) / curvature).clamp(-0.5, 0.5),
        _ => 0.0,
    });
    (rates[best] + step * vertex, squares[best])
}
