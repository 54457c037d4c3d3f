//! From the noise of a fit to the covariance of its parameters, their errors and intervals.

use serde::{Deserialize, Serialize};

use super::model::{Lags, Noise};
use super::rows::Columns;
use crate::fit::{Estimate, NoiseChoice, NoiseModel};
use crate::optimise::{Cholesky, Few, Solution, Termination};
use crate::statistics::{coverage_factor, dot};
use crate::vector::cross_products;

/// How a parameter is brought to its interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scale {
    /// Symmetric about the value.
    Linear,
    /// Symmetric about ln of the value, for rates and exponents.
    Log,
}

/// Half an interval in ln beyond which the data leave a parameter open: its curvature then says nothing of where it ends.
const OPEN: f64 = 6.907_755_278_982_137; // ln 1000

/// The variance of Σ gᵢ pᵢ where p has this covariance: gᵀ C g.
pub(crate) fn variance_of(gradient: &[f64], covariance: &[Vec<f64>]) -> f64 {
    let row = |row: &Vec<f64>| row.iter().zip(gradient).map(|(entry, g)| entry * g).sum::<f64>();
    covariance.iter().zip(gradient).map(|(entries, g)| g * row(entries)).sum()
}

/// What intervals are made of: covariances of the searched parameters for noise that correlates.
///
/// The fit is by least squares whatever the noise, so with J the Jacobian and V = σ² R the covariance of the noise that of
/// the parameters is the sandwich (JᵀJ)⁻¹ JᵀVJ (JᵀJ)⁻¹. V is itself an estimate: half the relative variance of a parameter's
/// variance gives the degrees of freedom of its t-quantile (Satterthwaite 1946),
///
/// ```text
/// ν = 2/[2/(N − p) + Σ_d (ln v_d − ln v)²]
/// ```
///
/// where v_d is the parameter's variance for a noise model one standard error off in direction d.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Uncertainty {
    /// Coverage of the intervals.
    pub confidence: f64,
    /// N − p.
    pub freedom: f64,
    /// Standard deviation of the noise in the unit of the signal; of a sample of mean weight if they have weights.
    pub deviation: f64,
    /// Degrees of freedom of its square.
    pub deviation_freedom: f64,
    /// Covariance in the order of `parameters`.
    pub covariance: Vec<Vec<f64>>,
    /// The same for noise models one standard error off.
    pub beside: Vec<Vec<Vec<f64>>>,
}

impl Uncertainty {
    /// An estimate of `value` with this gradient (of ln value on the logarithmic scale), and this variance if noise were white.
    pub(crate) fn estimate(&self, value: f64, gradient: &[f64], white: f64, scale: Scale) -> Estimate {
        if white == 0.0 {
            return Estimate::fixed(value);
        }
        let variance = variance_of(gradient, &self.covariance);
        self.interval(value, white.sqrt(), variance, self.freedom_of(gradient), scale)
    }

    /// The same from the standard error for white noise, a variance and its degrees of freedom.
    pub(crate) fn interval(&self, value: f64, white: f64, variance: f64, freedom: f64, scale: Scale) -> Estimate {
        let error = variance.sqrt();
        let half = error * coverage_factor(self.confidence, freedom);
        if scale == Scale::Log && half > OPEN {
            return Estimate {
                interval: Some((0.0, f64::INFINITY)),
                ..Estimate::fixed(value)
            };
        }
        let (unit, interval) = match scale {
            Scale::Linear => (1.0, (value - half, value + half)),
            Scale::Log => (value.abs(), (value * (-half).exp(), value * half.exp())),
        };
        let (error, white) = (unit * error, unit * white);
        let good = [error, white, interval.0, interval.1].iter().all(|found| found.is_finite());
        Estimate {
            value,
            standard_error: good.then_some(error),
            white_standard_error: good.then_some(white),
            interval: good.then_some(interval),
        }
    }

    /// Degrees of freedom of the variance of a parameter with this gradient.
    pub(crate) fn freedom_of(&self, gradient: &[f64]) -> f64 {
        if self.beside.is_empty() {
            return self.freedom;
        }
        let variance = variance_of(gradient, &self.covariance);
        let changes = self.beside.iter().map(|covariance| (variance_of(gradient, covariance) / variance).ln().powi(2));
        2.0 / (2.0 / self.freedom + changes.sum::<f64>())
    }
}

/// The uncertainty of a fit, with what rests on white noise beside it.
pub(crate) struct Assessed {
    /// s² (JᵀJ)⁻¹ in the caller's units.
    pub(crate) white: Option<Vec<Vec<f64>>>,
    pub(crate) uncertainty: Option<Uncertainty>,
    pub(crate) noise: NoiseModel,
    pub(crate) correlation: f64,
}

impl Assessed {
    /// Assesses a solution. `amplitudes` multiply the derivatives in its Jacobian, `units` bring linear, then nonlinear
    /// parameters to the caller's, `unit` the signal; without `known` its parameters have no errors.
    pub(crate) fn new(
        solution: &Solution,
        amplitudes: &[f64],
        units: &[f64],
        unit: f64,
        (confidence, choice): (f64, NoiseChoice),
        known: bool,
    ) -> Self {
        let (samples, size) = (solution.residuals.len(), units.len());
        let lags = Lags::of(&solution.residuals);
        let freedom = (samples - size) as f64;
        let scaled = |matrix: &[f64], variance: f64| -> Vec<Vec<f64>> {
            let entry = |i: usize, j: usize| matrix[i * size + j] * variance * units[i] * units[j];
            (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()
        };
        let columns: Vec<&[f64]> = solution.columns.iter().chain(&solution.derivatives).map(Vec::as_slice).collect();
        let noise = match choice {
            NoiseChoice::White => Noise::white(&lags, freedom),
            NoiseChoice::FromResiduals => Noise::of(&columns, &solution.residuals, &lags),
        };
        // A robust loss has its own s²; the noise of its residuals stands in the same ratio to it as that of plain ones.
        let ratio = solution.variance * freedom / solution.residual_square;
        let ratio = if ratio.is_finite() { ratio } else { 1.0 };
        let finite = |rows: &Vec<Vec<f64>>| rows.iter().flatten().all(|entry| entry.is_finite());
        let inverse = solution.inverse_normal.as_deref().filter(|_| known);
        let white = inverse.map(|inverse| scaled(inverse, solution.variance)).filter(finite);
        let correlated = (noise.model != NoiseModel::White).then(|| Columns::new(&columns));
        let sandwich = |inverse: &[f64], model: NoiseModel, variance: f64| match &correlated {
            None => scaled(inverse, ratio * variance),
            Some(columns) => scaled(
                &sandwiched(inverse, &with_amplitudes(columns.quadratic(model), amplitudes), size),
                ratio * variance,
            ),
        };
        let off = noise.beside.iter().map(|(_, variance)| (variance / noise.variance).ln().powi(2));
        let uncertainty = inverse.filter(|_| white.is_some()).map(|inverse| Uncertainty {
            confidence,
            freedom,
            deviation: noise.variance.sqrt() * unit,
            deviation_freedom: 2.0 / (2.0 / freedom + off.sum::<f64>()),
            covariance: sandwich(inverse, noise.model, noise.variance),
            beside: noise.beside.iter().map(|(model, variance)| sandwich(inverse, *model, *variance)).collect(),
        });
        Self {
            white,
            uncertainty: uncertainty.filter(|found| finite(&found.covariance)),
            noise: noise.model,
            correlation: lags.first,
        }
    }

    /// Assesses least squares with this Jacobian, column by column, of a model that is linear in nothing.
    pub(crate) fn of_columns(columns: Vec<Vec<f64>>, residuals: Vec<f64>, confidence: f64) -> Self {
        let size = columns.len();
        let views: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let mut normal = vec![0.0; size * size];
        cross_products(&views, &views, &mut normal);
        let residual_square = dot(&residuals, &residuals);
        let solution = Solution {
            linear: vec![0.0; size],
            nonlinear: Vec::new(),
            residual_square,
            variance: residual_square / (residuals.len() as f64 - size as f64),
            residuals,
            column_squares: Few::new(),
            columns,
            derivatives: Vec::new(),
            inverse_normal: Cholesky::new(&normal, size).map(|factor| factor.inverse()),
            termination: Termination::Converged,
        };
        Self::new(&solution, &[], &vec![1.0; size], 1.0, (confidence, NoiseChoice::FromResiduals), true)
    }

    /// From a covariance for white noise of this `deviation`, intervals widened by a factor for samples that count as fewer.
    pub(crate) fn widened(
        white: Option<Vec<Vec<f64>>>,
        deviation: f64,
        (confidence, freedom): (f64, f64),
        widening: f64,
        correlation: f64,
    ) -> Self {
        let wide = |rows: &Vec<Vec<f64>>| {
            rows.iter().map(|row| row.iter().map(|entry| entry * widening * widening).collect()).collect()
        };
        let uncertainty = white.as_ref().map(|white| Uncertainty {
            confidence,
            freedom,
            deviation,
            deviation_freedom: freedom,
            covariance: wide(white),
            beside: Vec::new(),
        });
        let noise = if correlation > 0.0 { NoiseModel::Autoregressive { correlation } } else { NoiseModel::White };
        Self {
            white,
            uncertainty,
            noise,
            correlation,
        }
    }

    /// An estimate of `value` with this gradient (of ln value on the logarithmic scale).
    pub(crate) fn estimate(&self, value: f64, gradient: &[f64], scale: Scale) -> Estimate {
        match (&self.uncertainty, &self.white) {
            (Some(uncertainty), Some(white)) => {
                uncertainty.estimate(value, gradient, variance_of(gradient, white), scale)
            }
            _ => Estimate::fixed(value),
        }
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

/// G M G for symmetric G.
fn sandwiched(bread: &[f64], filling: &[f64], size: usize) -> Vec<f64> {
    let product = |a: &[f64], b: &[f64]| -> Vec<f64> {
        let entry = |i: usize, j: usize| (0..size).map(|k| a[i * size + k] * b[k * size + j]).sum();
        (0..size * size).map(|at| entry(at / size, at % size)).collect()
    };
    product(&product(bread, filling), bread)
}
