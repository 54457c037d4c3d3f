//! A search by brute force, written apart from the library's: a dense grid of the nonlinear parameters with the linear ones solved,
//! Levenberg's method from its ten best points and from the truth, and Nelder and Mead's from the best of those.

use super::double_double::exact_square;
use palpate::laws::{BasisFunction, LawCurve, Response, Term};

/// A law as the search sees it.
#[derive(Clone)]
pub(crate) struct Subject {
    pub(crate) response: Response,
    pub(crate) shapes: Vec<BasisFunction>,
    pub(crate) constant: bool,
    /// Bounds of each free parameter, shape by shape, ln of rates per duration.
    pub(crate) bounds: Vec<(f64, f64)>,
}

/// Whether the first parameter of a shape is a rate that only sets a unit.
pub(crate) fn has_reference(shape: BasisFunction) -> bool {
    matches!(shape, BasisFunction::Straight | BasisFunction::PowerGrowth)
}

/// Parameters of a shape that are searched.
pub(crate) fn free_parameters(shape: BasisFunction) -> usize {
    match shape {
        BasisFunction::Straight => 0,
        BasisFunction::Latency
        | BasisFunction::Stretched
        | BasisFunction::PowerDecay
        | BasisFunction::MittagLeffler
        | BasisFunction::FungContinuous => 2,
        _ => 1,
    }
}

impl Subject {
    /// Columns of the law at times over the duration.
    fn columns(&self, times: &[f64], theta: &[f64]) -> Vec<Vec<f64>> {
        let mut columns = Vec::new();
        if self.constant {
            columns.push(vec![1.0; times.len()]);
        }
        let mut rest = theta;
        for &shape in &self.shapes {
            let (own, others) = rest.split_at(free_parameters(shape));
            rest = others;
            let parameters = if has_reference(shape) { [&[0.0], own].concat() } else { own.to_vec() };
            let term = Term {
                amplitude: 1.0,
                shape,
                parameters,
            };
            let curve = LawCurve {
                response: self.response,
                constant: 0.0,
                terms: vec![term],
            };
            columns.push(curve.values(times));
        }
        columns
    }

    /// What the best linear parameters leave over at `theta`: columns made orthogonal one after the other, twice.
    fn residual(&self, times: &[f64], values: &[f64], theta: &[f64]) -> Vec<f64> {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for mut column in self.columns(times, theta) {
            let before = dot(&column, &column);
            for _ in 0..2 {
                for axis in &basis {
                    remove(&mut column, axis);
                }
            }
            let after = dot(&column, &column);
            // What the columns before imitate to within their rounding is no direction of its own.
            if after > 1e-15 * before && after > 0.0 {
                let size = after.sqrt();
                basis.push(column.iter().map(|entry| entry / size).collect());
            }
        }
        let mut rest = values.to_vec();
        for _ in 0..2 {
            for axis in &basis {
                remove(&mut rest, axis);
            }
        }
        rest
    }

    fn square(&self, times: &[f64], values: &[f64], theta: &[f64]) -> f64 {
        let rest = self.residual(times, values, theta);
        let square = dot(&rest, &rest);
        if square.is_finite() { square } else { f64::INFINITY }
    }

    fn clip(&self, theta: &mut [f64]) {
        for (value, (low, high)) in theta.iter_mut().zip(&self.bounds) {
            *value = value.clamp(*low, *high);
        }
    }

    /// The dense grid: every parameter at many places, several rates in falling order.
    fn grid(&self) -> Vec<Vec<f64>> {
        let rates = self.shapes.iter().filter(|shape| **shape == BasisFunction::Exponential).count();
        let several = rates > 1;
        let count = |i: usize| match (several, self.bounds.len()) {
            (_, 1) => 300,
            (true, 2) => 50,
            (true, _) => 24,
            (false, _) => {
                if i == 0 {
                    60
                } else {
                    24
                }
            }
        };
        let mut points = vec![Vec::new()];
        for (i, &(low, high)) in self.bounds.iter().enumerate() {
            let steps = count(i);
            let place = |k: usize| {
                let share = k as f64 / (steps - 1) as f64;
                // A dimensionless parameter above zero is spread in its logarithm.
                if low > 0.0 { low * (high / low).powf(share) } else { low + (high - low) * share }
            };
            let extended = points.iter().flat_map(|point: &Vec<f64>| {
                let falling = move |value: &f64| !several || point.last().is_none_or(|last| value < last);
                (0..steps).map(place).filter(falling).map(move |value| [point.as_slice(), &[value]].concat())
            });
            points = extended.collect();
        }
        points
    }

    /// The residual squares at which searches ended, and where, lowest first.
    pub(crate) fn search(&self, times: &[f64], values: &[f64], truth: &[f64]) -> Vec<(f64, Vec<f64>)> {
        let stride = times.len().div_ceil(MOST);
        let thin = |column: &[f64]| -> Vec<f64> { column.iter().copied().step_by(stride).collect() };
        let (few_times, few_values) = (thin(times), thin(values));
        let mut found: Vec<(f64, Vec<f64>)> =
            self.grid().into_iter().map(|theta| (self.square(&few_times, &few_values, &theta), theta)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut starts: Vec<Vec<f64>> = vec![truth.to_vec()];
        for (_, theta) in found {
            let near = |other: &Vec<f64>| other.iter().zip(&theta).all(|(a, b)| (a - b).abs() < 0.5);
            if !starts[1..].iter().any(near) {
                starts.push(theta);
            }
            if starts.len() > 10 {
                break;
            }
        }
        let mut ends: Vec<(f64, Vec<f64>)> =
            starts.into_iter().map(|start| self.levenberg(times, values, start)).collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        let polished: Vec<(f64, Vec<f64>)> =
            ends.iter().take(2).map(|(_, theta)| self.simplex(times, values, theta.clone())).collect();
        ends.extend(polished);
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        ends
    }

    /// The lowest of the ends of a search with squares to 30 digits, where the law is a series of exponentials: in doubles merged rates
    /// seem to fit better than they do.
    pub(crate) fn checked(&self, times: &[f64], values: &[f64], ends: Vec<(f64, Vec<f64>)>) -> (f64, Vec<f64>) {
        let is_series = self.shapes.len() > 1 && self.shapes.iter().all(|shape| *shape == BasisFunction::Exponential);
        let exact = |(square, theta): (f64, Vec<f64>)| {
            let square = if is_series { exact_square(times, values, self.constant, &theta) } else { square };
            (square, theta)
        };
        ends.into_iter().map(exact).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
    }

    /// Levenberg's method with differences for derivatives.
    fn levenberg(&self, times: &[f64], values: &[f64], mut theta: Vec<f64>) -> (f64, Vec<f64>) {
        const STEP: f64 = 1e-5;
        self.clip(&mut theta);
        let mut rest = self.residual(times, values, &theta);
        let mut square = dot(&rest, &rest);
        let count = theta.len();
        let mut damping = 1e-3;
        for _ in 0..30 {
            let slopes: Vec<Vec<f64>> = (0..count)
                .map(|j| {
                    let mut beside = theta.clone();
                    let side = if theta[j] + STEP > self.bounds[j].1 { -STEP } else { STEP };
                    beside[j] += side;
                    let other = self.residual(times, values, &beside);
                    other.iter().zip(&rest).map(|(a, b)| (a - b) / side).collect()
                })
                .collect();
            let before = square;
            for _ in 0..8 {
                let mut matrix: Vec<Vec<f64>> =
                    slopes.iter().map(|a| slopes.iter().map(|b| dot(a, b)).collect()).collect();
                for (i, row) in matrix.iter_mut().enumerate() {
                    row[i] = row[i] * (1.0 + damping) + 1e-300;
                }
                let step = eliminate(matrix, slopes.iter().map(|slope| -dot(slope, &rest)).collect());
                let mut next: Vec<f64> =
                    theta.iter().zip(&step).map(|(value, by)| value + by.clamp(-2.0, 2.0)).collect();
                self.clip(&mut next);
                let trial = self.residual(times, values, &next);
                let lower = dot(&trial, &trial);
                if lower < square {
                    (theta, rest, square) = (next, trial, lower);
                    damping = (damping * 0.2).max(1e-9);
                    break;
                }
                damping *= 6.0;
            }
            if before - square <= 1e-9 * square {
                break;
            }
        }
        (square, theta)
    }

    /// Nelder and Mead's method from simplices of three sizes.
    fn simplex(&self, times: &[f64], values: &[f64], start: Vec<f64>) -> (f64, Vec<f64>) {
        let count = start.len();
        let mut best = (self.square(times, values, &start), start);
        if count == 0 {
            return best;
        }
        for size in [0.1, 0.01] {
            let mut corners = vec![best.clone()];
            for j in 0..count {
                let mut corner = best.1.clone();
                corner[j] += if corner[j] + size > self.bounds[j].1 { -size } else { size };
                self.clip(&mut corner);
                corners.push((self.square(times, values, &corner), corner));
            }
            for _ in 0..30 * count {
                corners.sort_by(|a, b| a.0.total_cmp(&b.0));
                if corners[count].0 - corners[0].0 <= 1e-10 * corners[0].0 {
                    break;
                }
                let middle: Vec<f64> =
                    (0..count).map(|j| corners[..count].iter().map(|c| c.1[j]).sum::<f64>() / count as f64).collect();
                let along = |factor: f64| {
                    let worst = &corners[count].1;
                    let mut point: Vec<f64> = middle.iter().zip(worst).map(|(m, w)| m + factor * (w - m)).collect();
                    self.clip(&mut point);
                    (self.square(times, values, &point), point)
                };
                let tried = [-1.0, -2.0, 0.5].map(along);
                let next = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
                if next.0 < corners[count].0 {
                    corners[count] = next;
                } else {
                    let lowest = corners[0].1.clone();
                    for corner in &mut corners[1..] {
                        corner.1 = corner.1.iter().zip(&lowest).map(|(a, b)| 0.5 * (a + b)).collect();
                        corner.0 = self.square(times, values, &corner.1);
                    }
                }
            }
            let lowest = corners.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            if lowest.0 < best.0 {
                best = lowest;
            }
        }
        best
    }
}

/// Samples that the grid looks at.
const MOST: usize = 100;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn remove(column: &mut [f64], axis: &[f64]) {
    let part = dot(column, axis);
    for (entry, along) in column.iter_mut().zip(axis) {
        *entry -= part * along;
    }
}

/// Gauss's elimination with pivots.
fn eliminate(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let count = right.len();
    for i in 0..count {
        let pivot = (i..count).max_by(|a, b| matrix[*a][i].abs().total_cmp(&matrix[*b][i].abs())).unwrap();
        matrix.swap(i, pivot);
        right.swap(i, pivot);
        for k in i + 1..count {
            let factor = matrix[k][i] / matrix[i][i];
            let (above, below) = matrix.split_at_mut(k);
            for (entry, pivot) in below[0][i..].iter_mut().zip(&above[i][i..]) {
                *entry -= factor * pivot;
            }
            right[k] -= factor * right[i];
        }
    }
    for i in (0..count).rev() {
        let known: f64 = (i + 1..count).map(|j| matrix[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right.into_iter().map(|value| if value.is_finite() { value } else { 0.0 }).collect()
}
