//! Products of the columns of a Jacobian with the correlations of a noise between them.

use super::model::NoiseModel;
use super::rows::Rows;
use crate::vector::products::cross_products;

/// The columns of a Jacobian J, ready for products with correlations between them.
pub(crate) struct Columns {
    size: usize,
    /// JᵀJ.
    product: Vec<f64>,
    rows: Rows,
}

impl Columns {
    pub(crate) fn new(columns: &[&[f64]]) -> Self {
        let size = columns.len();
        let mut product = vec![0.0; size * size];
        cross_products(columns, columns, &mut product);
        Self {
            size,
            product,
            rows: Rows::new(columns),
        }
    }

    /// JᵀRJ, row-major, with R the correlations of this noise, in one pass over the columns.
    ///
    /// F_i = ρ (F_{i−1} + J_{i−1}) sums all that came before, so that JᵀRJ = JᵀJ + s (JᵀF + FᵀJ).
    pub(crate) fn quadratic(&self, model: NoiseModel) -> Vec<f64> {
        let (correlation, share) = model.numbers();
        let mut product = self.product.clone();
        let across = self.rows.with_sums_before(correlation);
        for i in 0..self.size {
            for j in 0..self.size {
                product[i * self.size + j] += share * (across[i * self.size + j] + across[j * self.size + i]);
            }
        }
        product
    }
}
