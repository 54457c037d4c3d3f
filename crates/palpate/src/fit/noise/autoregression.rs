//! Autoregressions: coefficients by partial autocorrelations, predictions, products.

use crate::optimise::Few;
use crate::vector::cross_products;

/// Most samples that an autoregression looks back.
pub(crate) const MOST_ORDER: usize = 6;

/// Coefficients of autoregressions of every order up to p, by Levinson and Durbin.
pub(crate) struct Autoregression {
    /// The coefficients of order k, of the sample before first, with the variance of the error of its predictions, over that of the noise.
    orders: Vec<(Few, f64)>,
}

impl Autoregression {
    pub(crate) fn new(partial: &[f64]) -> Self {
        let mut orders = vec![(Few::new(), 1.0)];
        for by in partial {
            let (before, variance) = &orders[orders.len() - 1];
            let mut kept: Few = before.iter().zip(before.iter().rev()).map(|(ahead, back)| ahead - by * back).collect();
            kept.push(*by);
            let variance = variance * (1.0 - by * by);
            orders.push((kept, variance));
        }
        Self { orders }
    }

    /// Coefficients for sample `index`, which as many lie before.
    pub(crate) fn at(&self, index: usize) -> &[f64] {
        &self.orders[index.min(self.orders.len() - 1)].0
    }

    /// Variance of the error of these predictions, over that of the noise.
    pub(crate) fn variance_at(&self, index: usize) -> f64 {
        self.orders[index.min(self.orders.len() - 1)].1
    }
}

/// JᵀRJ, row-major: with R = L⁻¹ D L⁻ᵀ, where L takes from each sample its prediction by those before, it is the product of D^½ L⁻ᵀ J with itself.
pub(crate) fn quadratic(columns: &[&[f64]], partial: &[f64]) -> Vec<f64> {
    let (found, order) = (Autoregression::new(partial), partial.len());
    let settled = padded(found.at(order));
    let root = found.variance_at(order).sqrt();
    let coloured = |column: &&[f64]| {
        let samples = column.len();
        let mut made = [column, &[0.0; MOST_ORDER][..]].concat();
        for index in (order..samples).rev() {
            let after: &[f64; MOST_ORDER] = made[index + 1..].first_chunk().unwrap_or(&[0.0; MOST_ORDER]);
            let sum: f64 = (0..MOST_ORDER).map(|k| settled[k] * after[k]).sum();
            made[index] += sum;
        }
        for index in (0..order.min(samples)).rev() {
            let after = (1..=order).map(|k| found.at(index + k)[k - 1] * made[index + k]);
            made[index] += after.sum::<f64>();
        }
        made.truncate(samples);
        for (index, entry) in made.iter_mut().enumerate() {
            *entry *= if index < order { found.variance_at(index).sqrt() } else { root };
        }
        made
    };
    let coloured: Vec<Vec<f64>> = columns.iter().map(coloured).collect();
    let size = columns.len();
    let mut product = vec![0.0; size * size];
    cross_products(&coloured, &coloured, &mut product);
    product
}

/// Errors of predictions of residuals by those before, in units of their standard deviation.
pub(crate) fn innovations(residuals: &[f64], partial: &[f64]) -> Vec<f64> {
    let (found, order) = (Autoregression::new(partial), partial.len());
    let (settled, root) = (padded(found.at(order)), found.variance_at(order).sqrt().recip());
    let early = |index: usize| {
        let before = residuals[..index].iter().rev();
        let predicted: f64 = found.at(index).iter().zip(before).map(|(by, before)| by * before).sum();
        (residuals[index] - predicted) / found.variance_at(index).sqrt()
    };
    let late = |some: &[f64]| {
        let predicted: f64 = (0..MOST_ORDER).map(|k| settled[k] * some[MOST_ORDER - 1 - k]).sum();
        root * (some[MOST_ORDER] - predicted)
    };
    let begun = (0..residuals.len().min(MOST_ORDER)).map(early);
    begun.chain(residuals.windows(MOST_ORDER + 1).map(late)).collect()
}

/// Coefficients with zeros behind.
fn padded(kept: &[f64]) -> [f64; MOST_ORDER] {
    std::array::from_fn(|index| kept.get(index).copied().unwrap_or(0.0))
}
