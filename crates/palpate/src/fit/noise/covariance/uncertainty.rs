//! Covariances of parameters, and what intervals are made of.

use serde::{Deserialize, Serialize};

use super::sandwich::{ModelCovariance, Sandwich};
use crate::fit::noise::model::Noise;
use crate::optimise::Effort;
use crate::statistics::mean;
use crate::watch::Cancelled;

/// How a parameter is brought to its interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scale {
    /// Symmetric about the value.
    Linear,
    /// Symmetric about ln of the value, for rates and exponents.
    Log,
}

/// The variance of Σ gᵢ pᵢ where p has this covariance: gᵀ C g.
pub(crate) fn variance_of(gradient: &[f64], covariance: &[Vec<f64>]) -> f64 {
    let row = |row: &Vec<f64>| row.iter().zip(gradient).map(|(entry, g)| entry * g).sum::<f64>();
    covariance.iter().zip(gradient).map(|(entries, g)| g * row(entries)).sum()
}

/// Adds rows to rows.
pub(super) fn add(rows: &mut [Vec<f64>], others: &[Vec<f64>]) {
    for (row, by) in rows.iter_mut().zip(others) {
        row.iter_mut().zip(by).for_each(|(entry, by)| *entry += by);
    }
}

/// What intervals are made of: covariances of the searched parameters for noise that correlates.
///
/// The fit is by least squares whatever the noise, so with J the Jacobian and V = σ² R the covariance of the noise that of
/// the parameters is the sandwich (JᵀJ)⁻¹ JᵀVJ (JᵀJ)⁻¹. V is itself an estimate: models m that may have left the residuals have
/// probabilities w_m, and an interval of coverage c is ±h with
///
/// ```text
/// Σ_m w_m T(h/√v_m) = (1 + c)/2
/// ```
///
/// where v_m is the parameter's variance for model m, and T the distribution of Student's t of N − p degrees of freedom.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Uncertainty {
    /// Coverage of the intervals.
    pub confidence: f64,
    /// N − p.
    pub freedom: f64,
    /// Standard deviation of the noise in the unit of the signal, outliers included under a robust loss; of a sample of mean weight if they have
    /// weights.
    pub deviation: f64,
    /// Covariance in the order of `parameters`: squares of standard errors, with the correlations of the mean over the models.
    pub covariance: Vec<Vec<f64>>,
    /// Models of the noise, if there are several.
    pub models: Vec<ModelCovariance>,
}

impl Uncertainty {
    /// That of a fit whose residuals are this noise.
    pub(super) fn of_noise(
        fit: &Sandwich<'_>,
        noise: &Noise,
        (confidence, unit): (f64, f64),
        effort: &Effort<'_>,
    ) -> Result<Self, Cancelled> {
        let mut models: Vec<ModelCovariance> = Vec::with_capacity(noise.likely.len());
        for likely in &noise.likely {
            effort.hear()?;
            models.extend(fit.covariances(likely));
        }
        let size = fit.units.len();
        let mut found = Self {
            confidence,
            freedom: (fit.residuals.len() - size) as f64,
            deviation: noise.variance(fit.residuals.len()).sqrt() * unit,
            covariance: Vec::new(),
            models: Vec::new(),
        };
        if models.len() > 1 {
            found.models = models;
            found.settle();
        } else if let Some(only) = models.pop() {
            found.covariance = only.covariance;
        }
        Ok(found)
    }

    /// Forms the covariance of the models.
    pub(super) fn settle(&mut self) {
        let Some(first) = self.models.first() else { return };
        let size = first.covariance.len();
        let mut mean = vec![vec![0.0; size]; size];
        for model in &self.models {
            for (sums, row) in mean.iter_mut().zip(&model.covariance) {
                sums.iter_mut().zip(row).for_each(|(sum, entry)| *sum += model.probability * entry);
            }
        }
        self.covariance = mean;
        // An improbable model with a large variance rules a mean, and no error that is to be expected.
        let errors = self.standard_errors();
        let by: Vec<f64> = (0..size)
            .map(|i| errors[i] / self.covariance[i][i].sqrt())
            .map(|by| if by.is_finite() { by } else { 1.0 })
            .collect();
        for (row, one) in self.covariance.iter_mut().zip(&by) {
            row.iter_mut().zip(&by).for_each(|(entry, other)| *entry *= one * other);
        }
    }

    /// Adds a covariance of the parameters from another, independent cause.
    pub(super) fn add(&mut self, covariance: &[Vec<f64>]) {
        add(&mut self.covariance, covariance);
        self.models.iter_mut().for_each(|model| add(&mut model.covariance, covariance));
        self.settle();
    }

    /// Multiplies covariances by the mean ratio of these variances to those there are, where it is above 1.
    pub(super) fn widen(&mut self, covariance: &[Vec<f64>]) {
        let variances = |rows: &[Vec<f64>]| -> Vec<f64> { (0..rows.len()).map(|i| rows[i][i]).collect() };
        let pairs = variances(covariance).into_iter().zip(variances(&self.covariance));
        let ratio = mean(&pairs.map(|(other, own)| other / own).collect::<Vec<f64>>());
        if ratio > 1.0 && ratio.is_finite() {
            let models = self.models.iter_mut().map(|model| &mut model.covariance);
            let entries = std::iter::once(&mut self.covariance).chain(models).flatten().flatten();
            entries.for_each(|entry| *entry *= ratio);
        }
    }
}
