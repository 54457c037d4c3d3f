//! A separable model at one place, with orthogonal columns: exact where columns nearly imitate each other.

use super::separable::{Shapes, Target};
use crate::vector::{dot, multiply};

/// The columns of a model, made orthogonal one after the other (Gram and Schmidt, twice), and what they leave of the values.
#[derive(Default)]
pub(crate) struct Orthogonal {
    pub(crate) theta: Vec<f64>,
    pub(crate) square: f64,
    /// Orthonormal axes; `None` for a column that those before it imitate to rounding.
    axes: Vec<Option<Vec<f64>>>,
    /// Parts of each column along the axes before it, and its length along its own.
    parts: Vec<Vec<f64>>,
    /// Whether a column is all but imitated.
    pub(crate) beside_cliff: bool,
    /// Parts of the values along the axes.
    along: Vec<f64>,
    rest: Vec<f64>,
    derivatives: Vec<Vec<f64>>,
}

impl Orthogonal {
    pub(crate) fn new(shapes: &impl Shapes, theta: &[f64], target: Target<'_>) -> Self {
        let samples = target.values.len();
        let mut columns = vec![vec![0.0; samples]; shapes.columns()];
        let mut derivatives = vec![vec![0.0; samples]; theta.len()];
        shapes.fill(theta, &mut columns, &mut derivatives);
        Self::of(theta, columns, derivatives, target)
    }

    /// The same of these columns and derivatives, not yet times the roots of the weights.
    pub(crate) fn of(
        theta: &[f64],
        mut columns: Vec<Vec<f64>>,
        mut derivatives: Vec<Vec<f64>>,
        target: Target<'_>,
    ) -> Self {
        if let Some(roots) = target.roots {
            for column in columns.iter_mut().chain(&mut derivatives) {
                multiply(column, roots);
            }
        }
        let mut here = Self {
            theta: theta.to_vec(),
            rest: target.values.to_vec(),
            derivatives,
            ..Self::default()
        };
        for mut column in columns {
            let before = dot(&column, &column);
            let mut parts = here.project(&mut column);
            let after = dot(&column, &column);
            let own = after > IMITATED * before && after > 0.0;
            here.beside_cliff |= own && after <= CLIFF * IMITATED * before;
            parts.push(after.sqrt());
            here.parts.push(parts);
            here.axes.push(own.then(|| {
                let size = after.sqrt();
                column.iter_mut().for_each(|entry| *entry /= size);
                column
            }));
        }
        let mut rest = std::mem::take(&mut here.rest);
        here.along = here.project(&mut rest);
        here.square = dot(&rest, &rest);
        if !here.square.is_finite() {
            here.square = f64::INFINITY;
        }
        here.rest = rest;
        here
    }

    /// Takes the parts along the axes out of a column, and returns them.
    fn project(&self, column: &mut [f64]) -> Vec<f64> {
        let mut parts = vec![0.0; self.axes.len()];
        for _ in 0..2 {
            for (axis, part) in self.axes.iter().zip(&mut parts) {
                let Some(axis) = axis else { continue };
                let more = dot(axis, column);
                *part += more;
                for (entry, along) in column.iter_mut().zip(axis) {
                    *entry -= more * along;
                }
            }
        }
        parts
    }

    /// The best linear numbers; 0 for a column that others imitate.
    pub(crate) fn linear(&self) -> Vec<f64> {
        let count = self.axes.len();
        let mut linear = vec![0.0; count];
        for i in (0..count).rev() {
            if self.axes[i].is_some() {
                let known: f64 = (i + 1..count).map(|j| self.parts[j][i] * linear[j]).sum();
                linear[i] = (self.along[i] - known) / self.parts[i][i];
            }
        }
        linear
    }

    /// What one more column would take off the square.
    pub(crate) fn gain(&self, mut column: Vec<f64>) -> f64 {
        let before = dot(&column, &column);
        self.project(&mut column);
        let size = dot(&column, &column);
        if size > IMITATED * before && size > 0.0 { dot(&column, &self.rest).powi(2) / size } else { 0.0 }
    }

    /// What the derivatives of plain columns count by: the linear number of each.
    pub(crate) fn factors(&self, shapes: &impl Shapes) -> Vec<f64> {
        let linear = self.linear();
        (0..self.theta.len()).map(|index| linear[shapes.column_of(index)]).collect()
    }

    /// The Gauss–Newton matrix and gradient in θ with the linear numbers projected out (Kaufman), for derivatives that are to be
    /// multiplied by `factors`.
    pub(crate) fn projected(&self, factors: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let slope = |(derivative, factor): (&Vec<f64>, &f64)| {
            let mut slope: Vec<f64> = derivative.iter().map(|entry| factor * entry).collect();
            self.project(&mut slope);
            slope
        };
        let slopes: Vec<Vec<f64>> = self.derivatives.iter().zip(factors).map(slope).collect();
        let mut hessian: Vec<f64> = slopes.iter().flat_map(|a| slopes.iter().map(|b| dot(a, b))).collect();
        // A number that the data do not feel stays where it is: rounding in its gradient moves it nowhere.
        let count = slopes.len();
        (0..count).for_each(|i| hessian[i * count + i] += UNFELT * self.square);
        let gradient = slopes.iter().map(|slope| dot(slope, &self.rest)).collect();
        (hessian, gradient)
    }
}

/// Of the residual square: a curvature below it would not show across the whole range of a number.
const UNFELT: f64 = 1e-14;

/// Share of a column's square below which it lies in the plane of the others.
/// Below it rounding of the shapes makes up its direction.
const IMITATED: f64 = 1e-17;

/// Times that share: a column that is all but imitated.
const CLIFF: f64 = 2.0;
