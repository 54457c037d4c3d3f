//! White noise and AR(1).

use super::found::Noise;
use super::likelihood::{Likelihood, correlation_of, noise_at};
use super::model::NoiseModel;
use super::rows::{Filter, Rows, whitened_squares};
use crate::optimise::minimise;

/// Fall of the deviance that a first look has to show: from there to the bottom it falls by some units more. Of white residuals that
/// look slow, two of three are done with here.
const PROMISE: f64 = 2.0;

/// White noise and AR(1): Kalman's filter whitens all columns alike, sample by sample.
pub(crate) struct Mixture<'a> {
    rows: Rows,
    residuals: &'a [f64],
}

impl<'a> Mixture<'a> {
    pub(crate) fn new(jacobian: &[&'a [f64]], residuals: &'a [f64]) -> Self {
        let columns: Vec<&[f64]> = jacobian.iter().copied().chain([residuals]).collect();
        Self {
            rows: Rows::new(&columns),
            residuals,
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
        let (rho, share) = Self::model(x).numbers();
        Filter::new(rho, share, self.rows.samples)
    }

    /// The likelihood, between white noise and noise that is one sample in all.
    pub(crate) fn likelihood(&self, x: &[f64]) -> Option<Likelihood> {
        if x[0] < 0.05 || x[0] > self.longest() || x[1].abs() > 8.0 {
            return None;
        }
        let filter = self.filter(x);
        Likelihood::of(&self.rows.whitened(&filter), filter.log_determinant, self.rows.samples)
    }

    /// κ of noise that is one sample in all.
    fn longest(&self) -> f64 {
        (self.rows.samples as f64).ln()
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
        let squares = whitened_squares(self.residuals, &filters);
        let samples = self.rows.samples as f64;
        let deviances = squares
            .iter()
            .zip(&filters)
            .map(|(square, filter)| samples * (square / samples).ln() + filter.log_determinant);
        let told = deviances.zip(places).filter(|(deviance, _)| deviance.is_finite());
        told.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, place)| place)
    }
}
