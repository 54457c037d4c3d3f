//! The restricted likelihood of a noise: of AR(1) at every ρ, and of white noise with AR(1).

use super::model::{Noise, NoiseModel};
use super::rows::{Filter, Rows, whitened_squares};
use crate::optimise::{Cholesky, Few, Level, Minimum, Square, minimise};
use crate::statistics::dot;
use crate::vector::cross_products;

/// Value of the restricted likelihood: −2 ln L up to a constant, and the variance that belongs to it.
#[derive(Clone, Copy)]
pub(crate) struct Likelihood {
    pub(crate) deviance: f64,
    pub(crate) variance: f64,
}

impl Level for Likelihood {
    fn level(&self) -> f64 {
        self.deviance
    }
}

impl Likelihood {
    /// From ZᵀR⁻¹Z with Z = (J, r), and ln |R|:
    /// −2 ln L = (N − p) ln σ² + ln |R| + ln |JᵀR⁻¹J|, σ² = (rᵀR⁻¹r − what J takes up)/(N − p).
    pub(crate) fn of(product: &[f64], log_determinant: f64, samples: usize) -> Option<Self> {
        let size = product.len().isqrt();
        let parameters = size - 1;
        let block: Square =
            (0..parameters * parameters).map(|i| product[i / parameters * size + i % parameters]).collect();
        let factor = Cholesky::new(&block, parameters)?;
        let right = &product[parameters * size..parameters * size + parameters];
        let mut taken = Few::from_slice(right);
        factor.solve(&mut taken);
        let left = product[size * size - 1] - dot(right, &taken);
        let freedom = (samples - parameters) as f64;
        let variance = left / freedom;
        let deviance = freedom * variance.ln() + log_determinant + factor.log_determinant();
        deviance.is_finite().then_some(Self { deviance, variance })
    }
}

/// The deviance at a minimum and the noise there, with that beside it along the columns of the Cholesky factor of its covariance,
/// 2 (∂²deviance)⁻¹.
pub(crate) fn noise_at(
    minimum: &Minimum<Likelihood>,
    evaluate: &impl Fn(&[f64]) -> Option<Likelihood>,
    model: impl Fn(&[f64]) -> NoiseModel,
) -> (f64, Noise) {
    let mut beside = Vec::new();
    for spread in minimum.directions() {
        // At an edge the other side has to do.
        for side in [1.0, -1.0, 0.5, -0.5] {
            let at: Few = minimum.at.iter().zip(&spread).map(|(x, d)| x + side * d).collect();
            if let Some(found) = evaluate(&at) {
                beside.push((model(&at), found.variance));
                break;
            }
        }
    }
    let noise = Noise {
        model: model(&minimum.at),
        variance: minimum.value.variance,
        beside,
    };
    (minimum.value.deviance, noise)
}

/// ρ from ln of how many samples count as one, κ = ln((1 + ρ)/(1 − ρ)): the scale on which ρ is searched.
pub(crate) fn correlation_of(kappa: f64) -> f64 {
    (0.5 * kappa).tanh()
}

/// AR(1): its R⁻¹ has three diagonals, so products of neighbours, formed once, give the likelihood at every ρ.
pub(crate) struct Neighbours {
    samples: usize,
    /// Samples of each of the series, which are independent of each other.
    length: usize,
    size: usize,
    /// ZᵀZ.
    same: Vec<f64>,
    /// Σ z_i z_{i+1}ᵀ, made symmetric.
    next: Vec<f64>,
    /// Products of the first and of the last row of each series.
    ends: Vec<f64>,
}

impl Neighbours {
    pub(crate) fn new(jacobian: &[&[f64]], residuals: &[f64], length: usize) -> Self {
        let all: Vec<&[f64]> = jacobian.iter().copied().chain([residuals]).collect();
        let (samples, size) = (residuals.len(), all.len());
        let mut same = vec![0.0; size * size];
        cross_products(&all, &all, &mut same);
        let (mut shifted, mut own) = (vec![0.0; size * size], vec![0.0; size * size]);
        let starts = || (0..samples).step_by(length);
        for start in starts() {
            let last = start + length - 1;
            let early: Vec<&[f64]> = all.iter().map(|column| &column[start..last]).collect();
            let late: Vec<&[f64]> = all.iter().map(|column| &column[start + 1..=last]).collect();
            cross_products(&early, &late, &mut own);
            shifted.iter_mut().zip(&own).for_each(|(sum, own)| *sum += own);
        }
        let pairs = || (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
        let at_ends = |i: usize, j: usize| -> f64 {
            starts().flat_map(|start| [start, start + length - 1]).map(|end| all[i][end] * all[j][end]).sum()
        };
        Self {
            samples,
            length,
            size,
            same,
            next: pairs().map(|(i, j)| shifted[i * size + j] + shifted[j * size + i]).collect(),
            ends: pairs().map(|(i, j)| at_ends(i, j)).collect(),
        }
    }

    /// R⁻¹ has 1 + ρ² on its diagonal (1 at the ends) and −ρ beside it, over 1 − ρ²; |R| = (1 − ρ²)^(N−1) for each series.
    pub(crate) fn likelihood(&self, kappa: f64) -> Option<Likelihood> {
        let rho = correlation_of(kappa);
        let square = rho * rho;
        let entry =
            |i: usize| ((1.0 + square) * self.same[i] - square * self.ends[i] - rho * self.next[i]) / (1.0 - square);
        let product: Square = (0..self.size * self.size).map(entry).collect();
        let steps = self.samples - self.samples / self.length;
        Likelihood::of(&product, steps as f64 * (1.0 - square).ln(), self.samples)
    }

    /// The best ρ, between white noise and noise of which a series is one sample in all.
    pub(crate) fn noise(&self) -> Option<(f64, Noise)> {
        let model = |kappa: f64| NoiseModel::Autoregressive {
            correlation: correlation_of(kappa),
        };
        let most = (self.length as f64).ln();
        let evaluate = |x: &[f64]| if x[0] < 0.0 || x[0] > most { None } else { self.likelihood(x[0]) };
        let last = self.same.len() - 1;
        let start = 2.0 * (0.5 * self.next[last] / self.same[last]).clamp(-0.999, 0.999).atanh();
        let found = minimise(&evaluate, &[start.clamp(0.1, most - 0.1)])?;
        Some(noise_at(&found, &evaluate, |x| model(x[0])))
    }
}

/// Fall of the deviance that a first look has to show: from there to the bottom it falls by some units more. Of white residuals that
/// look slow, two of three are done with here.
const PROMISE: f64 = 2.0;

/// White noise and AR(1): Kalman's filter whitens all columns alike, sample by sample.
pub(crate) struct Mixture<'a> {
    rows: Rows,
    residuals: &'a [f64],
    /// Samples of each of the series, which are independent of each other.
    length: usize,
}

impl<'a> Mixture<'a> {
    pub(crate) fn new(jacobian: &[&'a [f64]], residuals: &'a [f64], length: usize) -> Self {
        let columns: Vec<&[f64]> = jacobian.iter().copied().chain([residuals]).collect();
        Self {
            rows: Rows::new(&columns),
            residuals,
            length,
        }
    }

    /// ρ and s from κ and ln(s/(1 − s)).
    pub(crate) fn model(x: &[f64]) -> NoiseModel {
        NoiseModel::WhiteAndAutoregressive {
            correlation: correlation_of(x[0]),
            share: 1.0 / (1.0 + (-x[1]).exp()),
        }
    }

    fn filter(&self, x: &[f64]) -> Filter {
        let (rho, share) = Self::model(x).parameters();
        Filter::new(rho, share, self.length)
    }

    /// The likelihood, between white noise and noise that is one sample in all.
    pub(crate) fn likelihood(&self, x: &[f64]) -> Option<Likelihood> {
        if x[0] < 0.05 || x[0] > self.longest() || x[1].abs() > 8.0 {
            return None;
        }
        let filter = self.filter(x);
        let log_determinant = self.series() * filter.log_determinant;
        Likelihood::of(&self.rows.whitened(&filter, self.length), log_determinant, self.rows.samples)
    }

    /// How many series.
    fn series(&self) -> f64 {
        (self.rows.samples / self.length) as f64
    }

    /// κ of noise of which a series is one sample in all.
    fn longest(&self) -> f64 {
        (self.length as f64).ln()
    }

    /// The best ρ and s, if a first look finds a deviance that promises to fall below this one.
    pub(crate) fn noise(&self, deviance: f64) -> Option<(f64, Noise)> {
        let evaluate = |x: &[f64]| self.likelihood(x);
        let start = self.start()?;
        if evaluate(&start)?.deviance > deviance - PROMISE {
            return None;
        }
        let found = minimise(&evaluate, &start)?;
        Some(noise_at(&found, &evaluate, Self::model))
    }

    /// Where to begin: the residuals alone can tell, as if nothing had been fitted.
    fn start(&self) -> Option<[f64; 2]> {
        let kappas = (1..).map(|i| 1.2 * f64::from(i)).take_while(|kappa| *kappa < self.longest());
        let places: Vec<[f64; 2]> = kappas.flat_map(|kappa| [-2.5, 0.0, 2.5].map(|share| [kappa, share])).collect();
        let filters: Vec<Filter> = places.iter().map(|place| self.filter(place)).collect();
        let mut squares = vec![0.0; filters.len()];
        for series in self.residuals.chunks_exact(self.length) {
            squares.iter_mut().zip(whitened_squares(series, &filters)).for_each(|(sum, square)| *sum += square);
        }
        let samples = self.rows.samples as f64;
        let deviances = squares
            .iter()
            .zip(&filters)
            .map(|(square, filter)| samples * (square / samples).ln() + self.series() * filter.log_determinant);
        let reported = deviances.zip(places).filter(|(deviance, _)| deviance.is_finite());
        reported.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, place)| place)
    }
}
