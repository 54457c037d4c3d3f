//! Nodes with all that needs no search projected out.

use crate::fit::{Condensed, Model};
use crate::statistics::dot;

/// The nodes with all that needs no search, the constant and shapes without free parameters, projected out.
pub(crate) struct Plane {
    /// Orthonormal columns that need no search.
    pub(crate) basis: Vec<Vec<f64>>,
    /// The values less their part along those.
    pub(crate) values: Vec<f64>,
    pub(crate) square: f64,
}

impl Plane {
    /// The nodes with the constant of the model and these columns projected out.
    pub(crate) fn new(model: &Model, columns: impl Iterator<Item = Vec<f64>>, nodes: &Condensed) -> Self {
        let mut plane = Self {
            basis: Vec::new(),
            values: nodes.values.clone(),
            square: 0.0,
        };
        let constant = model.constant.then(|| nodes.roots.clone());
        for mut column in constant.into_iter().chain(columns) {
            let before = dot(&column, &column);
            plane.project(&mut column);
            let after = dot(&column, &column);
            // A column that others imitate adds nothing.
            if after > 1e-20 * before {
                let size = after.sqrt();
                column.iter_mut().for_each(|entry| *entry /= size);
                plane.basis.push(column);
            }
        }
        let mut values = std::mem::take(&mut plane.values);
        plane.project(&mut values);
        plane.square = dot(&values, &values);
        plane.values = values;
        plane
    }

    /// Takes the part along the basis out of a column.
    pub(crate) fn project(&self, column: &mut [f64]) {
        for axis in &self.basis {
            let part = dot(axis, column);
            for (entry, along) in column.iter_mut().zip(axis) {
                *entry -= part * along;
            }
        }
    }

    /// What one more column leaves of the residual square.
    pub(crate) fn residual(&self, column: &[f64]) -> f64 {
        let square = dot(column, column);
        let along: f64 = self.basis.iter().map(|axis| dot(axis, column).powi(2)).sum();
        let spread = square - along;
        let shared = dot(column, &self.values);
        // A shape that is flat over the hold explains nothing.
        if spread <= 1e-14 * square { self.square } else { self.square - shared * shared / spread }
    }

    /// The same without the loss of digits where the column is nearly imitated; takes the basis out of it.
    pub(crate) fn exact_residual(&self, column: &mut [f64]) -> f64 {
        let before = dot(column, column);
        self.project(column);
        self.project(column);
        let size = dot(column, column);
        if size <= 1e-24 * before {
            return self.square;
        }
        let part = dot(column, &self.values) / size;
        self.values.iter().zip(column).map(|(value, entry)| (value - part * *entry).powi(2)).sum()
    }
}
