//! Products of the columns of a Jacobian with the correlations of a noise between them.

use std::cell::OnceCell;

use super::autoregression::quadratic;
use super::markov::Markov;
use super::model::NoiseModel;
use super::rows::Rows;
use crate::vector::cross_products;

/// The columns of a Jacobian J, ready for products with correlations between them.
pub(crate) struct Columns<'a> {
    columns: &'a [&'a [f64]],
    /// JᵀJ.
    product: Vec<f64>,
    rows: Rows,
    /// Times of the samples in s, where they are spaced unevenly.
    times: Option<&'a [f64]>,
    /// JᵀRJ of a walk of steps of 1.
    of_walk: OnceCell<Vec<f64>>,
}

impl<'a> Columns<'a> {
    pub(crate) fn new(columns: &'a [&'a [f64]], times: Option<&'a [f64]>) -> Self {
        let mut product = vec![0.0; columns.len() * columns.len()];
        cross_products(columns, columns, &mut product);
        Self {
            columns,
            product,
            rows: Rows::new(columns),
            times,
            of_walk: OnceCell::new(),
        }
    }

    /// JᵀRJ, row-major, with R the correlations of this noise.
    ///
    /// With F_i = ρ (F_{i−1} + J_{i−1}), the sums of all that came before, it is JᵀJ + Σ s (JᵀF + FᵀJ) over the parts of the noise.
    pub(crate) fn quadratic(&self, model: NoiseModel) -> Vec<f64> {
        if let NoiseModel::AutoregressiveOfOrder { order, partial } = model {
            return quadratic(self.columns, &partial[..order]);
        }
        let (mut product, size) = (self.product.clone(), self.columns.len());
        let of = |model| Some(Markov::of(model, self.rows.samples, self.times)?.quadratic(&self.rows, size));
        match model {
            NoiseModel::WhiteAndWalk { step } => {
                let walk = NoiseModel::WhiteAndWalk { step: 1.0 };
                let of_walk = self.of_walk.get_or_init(|| of(walk).unwrap_or_default());
                product.iter_mut().zip(of_walk).for_each(|(sum, walked)| *sum += step * step * walked);
                return product;
            }
            NoiseModel::InTime { share, .. } => {
                let process = of(model).unwrap_or_default();
                product.iter_mut().zip(process).for_each(|(sum, faded)| *sum = (1.0 - share) * *sum + faded);
                return product;
            }
            _ => {}
        }
        for (share, correlation) in model.parts() {
            let across = self.rows.with_sums_before(correlation);
            for i in 0..size {
                for j in 0..size {
                    product[i * size + j] += share * (across[i * size + j] + across[j * size + i]);
                }
            }
        }
        product
    }
}
