//! The restricted likelihood of autoregressions.

use super::kind::{Kind, Likelihood, slowest};
use crate::fit::noise::autoregression::MOST_ORDER;
use crate::fit::noise::model::NoiseModel;
use crate::optimise::{Few, Square, minimise};
use crate::vector::cross_products;

/// The model of these partial autocorrelations.
fn model(partial: &[f64]) -> NoiseModel {
    match partial {
        [] => NoiseModel::White,
        [correlation] => NoiseModel::Autoregressive {
            correlation: *correlation,
        },
        several => {
            let mut partial = [0.0; MOST_ORDER];
            partial[..several.len()].copy_from_slice(several);
            NoiseModel::AutoregressiveOfOrder {
                order: several.len(),
                partial,
            }
        }
    }
}

/// Products of columns with those some samples later, formed once, give the likelihood of every AR(p): with a = (1, −φ) and v the variance
/// of the error of its predictions, zᵀR⁻¹z = Σ_ij a_i a_j Σ_t z_{t+i} z_{t+j} / v, t = 0 to N − 1 − i − j (Box and Jenkins 1970, A7.4).
pub(crate) struct Lagged {
    samples: usize,
    /// Samples of each of the series, which are independent of each other.
    length: usize,
    order: usize,
    /// For every i ≤ j ≤ p Σ_t z_{t+i} z_{t+j}ᵀ, those of i < j made symmetric.
    products: Vec<Square>,
}

impl Lagged {
    pub(crate) fn new(jacobian: &[&[f64]], residuals: &[f64], length: usize, order: usize) -> Self {
        let all: Vec<&[f64]> = jacobian.iter().copied().chain([residuals]).collect();
        let (samples, size) = (residuals.len(), all.len());
        let entries = || (0..size).flat_map(|a| (0..size).map(move |b| (a, b)));
        let mut products = Vec::new();
        let mut own = vec![0.0; size * size];
        for i in 0..=order {
            for j in i..=order {
                let mut sum = Square::from_elem(0.0, size * size);
                for start in (0..samples).step_by(length) {
                    if i == 0 {
                        let early: Vec<&[f64]> = all.iter().map(|column| &column[start..start + length - j]).collect();
                        let late: Vec<&[f64]> = all.iter().map(|column| &column[start + j..start + length]).collect();
                        cross_products(&early, &late, &mut own);
                        for (at, (a, b)) in entries().enumerate() {
                            sum[at] += if j == 0 { own[at] } else { own[a * size + b] + own[b * size + a] };
                        }
                    } else {
                        // As one sample less on both sides, without the first and the last of its terms.
                        let (first, last) = (start + i - 1, start + length - j);
                        for (at, (a, b)) in entries().enumerate() {
                            let term = |of: usize| {
                                let one = all[a][of] * all[b][of + j - i];
                                if i == j { one } else { one + all[b][of] * all[a][of + j - i] }
                            };
                            sum[at] -= term(first) + term(last);
                        }
                    }
                }
                if i > 0 {
                    let before: &Square = &products[place(i - 1, j - 1, order)];
                    sum.iter_mut().zip(before).for_each(|(sum, before)| *sum += before);
                }
                products.push(sum);
            }
        }
        Self {
            samples,
            length,
            order,
            products,
        }
    }

    /// The likelihood of partial autocorrelations.
    pub(crate) fn likelihood(&self, partial: &[f64]) -> Option<Likelihood> {
        // By Levinson and Durbin; |R| = Π_t σ_t², the variances of errors of predictions by the samples before.
        let mut signs = [0.0; MOST_ORDER + 1];
        signs[0] = 1.0;
        let (mut variance, mut begun) = (1.0, 1.0);
        for (order, by) in (1..).zip(partial) {
            let before = signs;
            (1..=order).for_each(|k| signs[k] -= by * before[order - k]);
            begun *= variance;
            variance *= 1.0 - by * by;
        }
        let mut product = Square::from_elem(0.0, self.products[0].len());
        for i in 0..=self.order {
            for j in i..=self.order {
                let factor = signs[i] * signs[j] / variance;
                let part = &self.products[place(i, j, self.order)];
                product.iter_mut().zip(part).for_each(|(sum, entry)| *sum += factor * entry);
            }
        }
        let series = (self.samples / self.length) as f64;
        let log_determinant = series * (f64::ln(begun) + (self.length - self.order) as f64 * variance.ln());
        Likelihood::of(&product, log_determinant, self.samples)
    }

    /// The best near these partial autocorrelations.
    pub(crate) fn noise(&self, start: &[f64]) -> Option<Kind> {
        let most = slowest(self.length);
        let partial = |x: &[f64]| -> Few { x.iter().map(|kappa| (0.5 * kappa).tanh()).collect() };
        let at = |x: &Few| {
            if x.iter().any(|kappa| kappa.abs() > most) { None } else { self.likelihood(&partial(x)) }
        };
        let evaluate = |points: &[Few]| points.iter().map(at).collect();
        let begin: Few = start.iter().map(|by| (2.0 * by.atanh()).clamp(0.1 - most, most - 0.1)).collect();
        let found = minimise(&evaluate, &begin, &vec![(-most, most); begin.len()], f64::INFINITY)?;
        Kind::about(&found, &evaluate, |x| Some(model(&partial(x))))
    }
}

/// AR(1) of correlations evenly spaced in κ, with their likelihoods: of few samples any may be.
pub(crate) fn first_order(jacobian: &[&[f64]], residuals: &[f64]) -> Vec<(Likelihood, NoiseModel)> {
    /// From one κ to the next, and the least of them.
    const PACE: f64 = 0.5;
    const LEAST: f64 = -2.5;
    let lagged = Lagged::new(jacobian, residuals, residuals.len(), 1);
    let most = (residuals.len() as f64).ln() + 1.5;
    let kappas = (0..).map(|i| LEAST + PACE * f64::from(i)).take_while(|kappa| *kappa < most);
    let point = |kappa: f64| {
        let correlation = (0.5 * kappa).tanh();
        Some((lagged.likelihood(&[correlation])?, NoiseModel::Autoregressive { correlation }))
    };
    kappas.filter(|kappa| *kappa != 0.0).filter_map(point).collect()
}

/// Where the product of i and j stands.
fn place(i: usize, j: usize, order: usize) -> usize {
    (0..i).map(|row| order + 1 - row).sum::<usize>() + j - i
}
