//! From the covariance of a noise to that of the parameters of a fit.

use serde::{Deserialize, Serialize};

use super::blocks::by_blocks;
use super::columns::Columns;
use super::rounding::Rounding;
use super::uneven::by_residuals;
use crate::fit::NoiseModel;
use crate::fit::noise::model::Likely;
use crate::vector::cross_products;

/// What follows from one model of the noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelCovariance {
    /// w_m.
    pub probability: f64,
    /// Covariance of the parameters if this is the noise.
    pub covariance: Vec<Vec<f64>>,
}

/// A fit by least squares, ready for the covariances (JᵀJ)⁻¹ JᵀVJ (JᵀJ)⁻¹ of its parameters in the caller's units.
pub(super) struct Sandwich<'a> {
    /// J; the last of its columns are bare derivatives, which count times the amplitudes.
    pub(super) columns: &'a [&'a [f64]],
    pub(super) amplitudes: &'a [f64],
    /// (JᵀJ)⁻¹.
    pub(super) inverse: &'a [f64],
    /// What brings each parameter to the caller's unit.
    pub(super) units: &'a [f64],
    pub(super) residuals: &'a [f64],
    /// s² of the loss over that of squares: a robust loss has its own, and the noise of its residuals stands in the same ratio to it.
    pub(super) ratio: f64,
    /// Columns as noise weighs them, with products of them; where the noise is not white.
    pub(super) correlated: Option<&'a Columns<'a>>,
    /// Where the size of the noise may change along the samples: the probability that it does, and columns as it weighs them.
    pub(super) uneven: Option<(f64, &'a [&'a [f64]])>,
}

impl Sandwich<'_> {
    /// For noise of this model and variance, with probabilities.
    ///
    /// Of white noise whose size changes, the squares of the residuals know the size without a course, and the course that fits them knows it with
    /// less noise: half of each.
    pub(super) fn covariances(&self, likely: &Likely) -> Vec<ModelCovariance> {
        let of = |share: f64, covariance: Vec<Vec<f64>>| ModelCovariance {
            probability: share * likely.probability,
            covariance,
        };
        let variance = self.ratio * likely.variance;
        match (likely.model, self.correlated, self.uneven) {
            (NoiseModel::White, _, Some((probability, weighed))) => {
                let squares = by_residuals(self.columns, self.amplitudes, self.inverse, self.residuals);
                let mut course = vec![0.0; weighed.len() * weighed.len()];
                cross_products(weighed, weighed, &mut course);
                let even = (probability < 1.0).then(|| of(1.0 - probability, self.scaled(self.inverse, variance)));
                let changes = [
                    of(0.5 * probability, self.filled(&squares, self.ratio)),
                    of(0.5 * probability, self.filled(&with_amplitudes(course, self.amplitudes), variance)),
                ];
                even.into_iter().chain(changes).collect()
            }
            (model, Some(columns), _) if model != NoiseModel::White => {
                vec![of(1.0, self.filled(&with_amplitudes(columns.quadratic(model), self.amplitudes), variance))]
            }
            _ => vec![of(1.0, self.scaled(self.inverse, variance))],
        }
    }

    /// From sums over blocks of neighbours, whatever the model of the noise.
    pub(super) fn by_blocks(&self) -> Option<Vec<Vec<f64>>> {
        let filling = by_blocks(self.columns, self.residuals)?;
        Some(self.filled(&with_amplitudes(filling, self.amplitudes), self.ratio))
    }

    /// From values that were rounded.
    pub(super) fn by_rounding(&self, rounding: &Rounding) -> Vec<Vec<f64>> {
        self.filled(&with_amplitudes(rounding.quadratic(self.columns), self.amplitudes), 1.0)
    }

    /// (JᵀJ)⁻¹ M (JᵀJ)⁻¹ times a variance.
    fn filled(&self, filling: &[f64], variance: f64) -> Vec<Vec<f64>> {
        let size = self.units.len();
        let product = |a: &[f64], b: &[f64]| -> Vec<f64> {
            let entry = |i: usize, j: usize| (0..size).map(|k| a[i * size + k] * b[k * size + j]).sum();
            (0..size * size).map(|at| entry(at / size, at % size)).collect()
        };
        self.scaled(&product(&product(self.inverse, filling), self.inverse), variance)
    }

    /// A matrix times a variance, in the caller's units.
    pub(super) fn scaled(&self, matrix: &[f64], variance: f64) -> Vec<Vec<f64>> {
        let (units, size) = (self.units, self.units.len());
        let entry = |i: usize, j: usize| matrix[i * size + j] * variance * units[i] * units[j];
        (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()
    }
}

/// JᵀRJ from that of columns and bare derivatives: the latter count times their amplitudes.
fn with_amplitudes(mut product: Vec<f64>, amplitudes: &[f64]) -> Vec<f64> {
    let size = product.len().isqrt();
    let linear = size - amplitudes.len();
    let factor = |i: usize| if i < linear { 1.0 } else { amplitudes[i - linear] };
    for (at, entry) in product.iter_mut().enumerate() {
        *entry *= factor(at / size) * factor(at % size);
    }
    product
}
