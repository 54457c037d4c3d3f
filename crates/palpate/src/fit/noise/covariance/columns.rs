//! Products of the columns of a Jacobian with the correlations of a noise between them.

use std::cell::{OnceCell, RefCell};

use crate::fit::noise::autoregression::quadratic;
use crate::fit::noise::likelihood::{Markov, Rows, steps_since};
use crate::fit::noise::model::NoiseModel;
use crate::vector::cross_products;

/// The columns of a Jacobian J, ready for products with correlations between them.
pub(crate) struct Columns<'a> {
    columns: &'a [&'a [f64]],
    /// Times of the samples, where they are spaced unevenly, in the unit of the models.
    times: Option<&'a [f64]>,
    /// JᵀJ.
    product: Vec<f64>,
    rows: OnceCell<Rows>,
    of_walk: OnceCell<Vec<f64>>,
    /// Products with sums of all before, by the correlation of neighbours: power laws share theirs.
    with_sums: RefCell<Vec<(f64, Vec<f64>)>>,
}

impl<'a> Columns<'a> {
    pub(crate) fn new(columns: &'a [&'a [f64]], times: Option<&'a [f64]>) -> Self {
        let mut product = vec![0.0; columns.len() * columns.len()];
        cross_products(columns, columns, &mut product);
        Self {
            columns,
            times,
            product,
            rows: OnceCell::new(),
            of_walk: OnceCell::new(),
            with_sums: RefCell::default(),
        }
    }

    /// JᵀRJ, row-major, with R the correlations of this noise.
    ///
    /// With F_i = ρ (F_{i−1} + J_{i−1}), the sums of all that came before, it is JᵀJ + Σ s (JᵀF + FᵀJ) over the parts of the noise.
    pub(crate) fn quadratic(&self, model: NoiseModel) -> Vec<f64> {
        match model {
            NoiseModel::AutoregressiveOfOrder { order, partial } => quadratic(self.columns, &partial[..order]),
            NoiseModel::WhiteAndWalk { step } => {
                let of_walk = self.of_walk.get_or_init(|| self.of_walk());
                self.product.iter().zip(of_walk).map(|(white, walk)| white + step * step * walk).collect()
            }
            NoiseModel::InTime {
                correlation_time_s,
                share,
                ..
            } => {
                let times = self.times.unwrap_or_default();
                let mut product: Vec<f64> = self.product.iter().map(|entry| (1.0 - share) * entry).collect();
                self.add_twice(
                    &mut product,
                    1.0,
                    &Markov::in_time(correlation_time_s, share, times).across(self.rows()),
                );
                product
            }
            _ => {
                let mut product = self.product.clone();
                for (share, correlation) in model.parts() {
                    self.add_sums(&mut product, share, correlation);
                }
                product
            }
        }
    }

    fn rows(&self) -> &Rows {
        self.rows.get_or_init(|| Rows::new(self.columns))
    }

    /// Adds s (JᵀF + FᵀJ).
    fn add_sums(&self, product: &mut [f64], share: f64, correlation: f64) {
        let mut known = self.with_sums.borrow_mut();
        let place = known.iter().position(|(of, _)| *of == correlation).unwrap_or_else(|| {
            known.push((correlation, self.rows().with_sums_before(correlation)));
            known.len() - 1
        });
        self.add_twice(product, share, &known[place].1);
    }

    /// Adds s (A + Aᵀ).
    fn add_twice(&self, product: &mut [f64], share: f64, across: &[f64]) {
        let size = self.columns.len();
        for (at, entry) in product.iter_mut().enumerate() {
            *entry += share * (across[at] + across[at % size * size + at / size]);
        }
    }

    /// JᵀMJ of a walk of steps of 1: Σ_k g_k S_k S_kᵀ with S_k the sums of the columns from sample k on, and g_k the time since the sample before
    /// it in mean times between samples.
    fn of_walk(&self) -> Vec<f64> {
        /// Samples whose sums are kept at a time.
        const BLOCK: usize = 4096;
        let size = self.columns.len();
        let samples = self.columns.first().map_or(0, |column| column.len());
        let (mut product, mut of_block) = (vec![0.0; size * size], vec![0.0; size * size]);
        let mut last = vec![0.0; size];
        let mut sums: Vec<Vec<f64>> = (0..size).map(|_| Vec::with_capacity(BLOCK.min(samples))).collect();
        let mut end = samples;
        while end > 1 {
            let start = end.saturating_sub(BLOCK).max(1);
            let gaps = self.times.map(|times| {
                let gap = |k: usize| steps_since(k, Some(times)) - steps_since(k - 1, Some(times));
                (start..end).rev().map(|k| gap(k).sqrt()).collect::<Vec<f64>>()
            });
            for ((sums, column), last) in sums.iter_mut().zip(self.columns).zip(&mut last) {
                sums.clear();
                // From the last sample to the first; four at a time, so that a sum waits for that of the four before alone.
                let (rest, fours) = column[start..end].as_rchunks();
                for [d, c, b, a] in fours.iter().rev() {
                    let (ab, cd) = (a + b, c + d);
                    sums.extend([*last + a, *last + ab, *last + (ab + c), *last + (ab + cd)]);
                    *last += ab + cd;
                }
                sums.extend(rest.iter().rev().map(|entry| {
                    *last += entry;
                    *last
                }));
                let roots = gaps.iter().flatten();
                sums.iter_mut().zip(roots).for_each(|(sum, root)| *sum *= root);
            }
            cross_products(&sums, &sums, &mut of_block);
            product.iter_mut().zip(&of_block).for_each(|(sum, entry)| *sum += entry);
            end = start;
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::noise::likelihood::{dense, in_time};
    use crate::statistics::dot;

    #[test]
    fn products_with_processes_are_those_of_whole_matrices() {
        let times: Vec<f64> = (0..40).map(|i| f64::from(i * i) * 0.01 + 0.2 * f64::from(i)).collect();
        let even: Vec<f64> = (0..40).map(f64::from).collect();
        let columns = [vec![1.0; 40], (0..40).map(|i| (0.3 * f64::from(i)).sin()).collect()];
        let views = [columns[0].as_slice(), columns[1].as_slice()];
        let walk = NoiseModel::WhiteAndWalk { step: 0.3 };
        let cases = [
            (walk, &even, None),
            (walk, &times, Some(times.as_slice())),
            (in_time(0.7, 1.0, &times), &times, Some(times.as_slice())),
            (in_time(2.0, 0.4, &times), &times, Some(times.as_slice())),
        ];
        for (model, times, uneven) in cases {
            let matrix = dense(model, times);
            for (at, found) in Columns::new(&views, uneven).quadratic(model).iter().enumerate() {
                let row = |a: usize| dot(&matrix[a * 40..(a + 1) * 40], views[at % 2]);
                let sum: f64 = (0..40).map(|a| views[at / 2][a] * row(a)).sum();
                assert!((found - sum).abs() < 1e-10 * sum.abs().max(1.0), "{model:?}: {found} {sum}");
            }
        }
    }
}
