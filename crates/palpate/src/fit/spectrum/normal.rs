//! The normal equations of the spectrum: products of exponentials with each other, with one and with the signal.

use crate::latency::decay_many;
use crate::statistics::dot;
use crate::vector::multiply;

/// Samples taken at a time, so that all columns of a block stay in the nearest cache.
const BLOCK: usize = 64;

/// After this many of its times an exponential is less than rounding.
pub(crate) const GONE: f64 = 40.0;

/// Products over all samples, per unit of weight.
pub(crate) struct Normal {
    /// CᵀWC over the columns exp(−t/τ_j), then the constant; row-major.
    pub(crate) gram: Vec<f64>,
    /// CᵀWy.
    pub(crate) right: Vec<f64>,
    /// yᵀWy.
    pub(crate) square: f64,
}

impl Normal {
    /// Forms them from samples with these square roots of their weights.
    pub(crate) fn new(times: &[f64], values: &[f64], roots: &[f64], grid: &[f64]) -> Self {
        // The signal is one more column, which gives its products along with the others.
        let columns = grid.len() + 2;
        let mut block = vec![0.0; columns * BLOCK];
        let mut products = vec![0.0; columns * columns];
        for ((times, values), roots) in times.chunks(BLOCK).zip(values.chunks(BLOCK)).zip(roots.chunks(BLOCK)) {
            let rows = times.len();
            // Times rise, so what is gone at the first of a block is gone for good.
            let gone = grid.partition_point(|time| times[0] > GONE * time);
            for (column, time) in block.chunks_mut(BLOCK).zip(grid).skip(gone) {
                decay_many(times, 1.0 / time, 1.0, &mut column[..rows]);
                multiply(&mut column[..rows], roots);
            }
            let (constant, signal) = block[grid.len() * BLOCK..].split_at_mut(BLOCK);
            constant[..rows].copy_from_slice(roots);
            signal[..rows].copy_from_slice(values);
            multiply(&mut signal[..rows], roots);
            for i in gone..columns {
                let column = &block[i * BLOCK..i * BLOCK + rows];
                for j in gone..=i {
                    products[i * columns + j] += dot(column, &block[j * BLOCK..j * BLOCK + rows]);
                }
            }
        }
        Self::from_products(&products, columns, 1.0 / dot(roots, roots))
    }

    /// From the lower triangle of the products of all columns, the signal last.
    fn from_products(products: &[f64], columns: usize, per_weight: f64) -> Self {
        let size = columns - 1;
        let at = |i: usize, j: usize| products[i.max(j) * columns + i.min(j)] * per_weight;
        Self {
            gram: (0..size * size).map(|k| at(k / size, k % size)).collect(),
            right: (0..size).map(|i| at(size, i)).collect(),
            square: at(size, size),
        }
    }

    /// Mean square that `parameters` leave, down to the rounding of these products.
    pub(crate) fn residual(&self, parameters: &[f64]) -> f64 {
        let size = self.right.len();
        let explained: f64 = (0..size)
            .filter(|i| parameters[*i] != 0.0)
            .map(|i| parameters[i] * (2.0 * self.right[i] - dot(&self.gram[i * size..(i + 1) * size], parameters)))
            .sum();
        (self.square - explained).max(size as f64 * f64::EPSILON * self.square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_residual_are_those_of_the_samples() {
        let times: Vec<f64> = (0..300).map(|i| f64::from(i) / 299.0).collect();
        let values: Vec<f64> = times.iter().map(|t| (3.0 * t).cos()).collect();
        let roots: Vec<f64> = times.iter().map(|t| 1.0 + t).collect();
        let normal = Normal::new(&times, &values, &roots, &[0.1, 2.0]);
        let parameters = [0.4, -0.3, 0.2];
        let columns = |t: f64| [(-t / 0.1).exp(), (-t / 2.0).exp(), 1.0];
        let weight: f64 = roots.iter().map(|r| r * r).sum();
        let mean = |f: &dyn Fn(usize) -> f64| (0..300).map(|k| roots[k] * roots[k] * f(k)).sum::<f64>() / weight;
        for i in 0..3 {
            assert!((normal.right[i] - mean(&|k| columns(times[k])[i] * values[k])).abs() < 1e-14);
            for j in 0..3 {
                let product = mean(&|k| columns(times[k])[i] * columns(times[k])[j]);
                assert!((normal.gram[3 * i + j] - product).abs() < 1e-14);
            }
        }
        let left = mean(&|k| (values[k] - dot(&columns(times[k]), &parameters)).powi(2));
        assert!((normal.residual(&parameters) - left).abs() < 1e-14);
    }
}
