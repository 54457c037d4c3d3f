//! From the noise of a fit to the covariance of its parameters, their errors and intervals.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::blocks::by_blocks;
use super::columns::Columns;
use super::lagged::partial;
use super::model::{Lags, Likely, Noise};
use super::portmanteau::{UNEXPLAINED, p_value};
use super::spread::{Spread, by_residuals};
use crate::fit::{Estimate, NoiseChoice, NoiseModel};
use crate::optimise::{Cholesky, Effort, Few, Solution, Termination};
use crate::statistics::{dot, mean};
use crate::vector::{add_multiple, cross_products, extremes};
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
    /// Standard deviation of the noise in the unit of the signal; of a sample of mean weight if they have weights.
    pub deviation: f64,
    /// Covariance in the order of `parameters`: the mean over the models.
    pub covariance: Vec<Vec<f64>>,
    /// Models of the noise, if there are several.
    pub models: Vec<ModelCovariance>,
}

/// What follows from one model of the noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelCovariance {
    /// w_m.
    pub probability: f64,
    /// Covariance of the parameters if this is the noise.
    pub covariance: Vec<Vec<f64>>,
}

/// The uncertainty of a fit, with what rests on white noise beside it.
pub(crate) struct Assessed {
    /// s² (JᵀJ)⁻¹ in the caller's units.
    pub(crate) white: Option<Vec<Vec<f64>>>,
    pub(crate) uncertainty: Option<Uncertainty>,
    pub(crate) noise: NoiseModel,
    /// Probability that this noise leaves such residuals.
    pub(crate) noise_p_value: Option<f64>,
    pub(crate) correlation: f64,
    /// The size of the noise changes along the samples.
    pub(crate) uneven: bool,
}

/// What is known of a fit whose errors are wanted.
pub(crate) struct Trust<'a> {
    /// Coverage of intervals.
    pub(crate) confidence: f64,
    pub(crate) noise: NoiseChoice,
    /// Whether its parameters have errors.
    pub(crate) known: bool,
    /// Whether the size of the noise may change along the samples.
    pub(crate) may_vary: bool,
    /// The fitted values, where they are no sum of columns.
    pub(crate) curve: Option<&'a [f64]>,
    /// Times of the samples, and their unit in s.
    pub(crate) times: Option<(&'a [f64], f64)>,
}

impl Uncertainty {
    /// Multiplies covariances by the mean ratio of these variances to those there are, where it is above 1.
    fn widen(&mut self, covariance: &[Vec<f64>]) {
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

impl Assessed {
    /// Assesses a solution. `amplitudes` multiply the derivatives in its Jacobian, `units` bring linear, then nonlinear parameters to the
    /// caller's, `unit` the signal. Of millions of samples it takes as long as the fit: it is heard of in between.
    pub(crate) fn new(
        solution: &Solution,
        amplitudes: &[f64],
        units: &[f64],
        unit: f64,
        trust: &Trust<'_>,
        effort: &Effort<'_>,
    ) -> Result<Self, Cancelled> {
        effort.hear()?;
        let Trust {
            confidence,
            noise: choice,
            known,
            may_vary,
            curve,
            times,
        } = *trust;
        let (samples, size) = (solution.residuals.len(), units.len());
        let lags = Lags::of(&solution.residuals);
        let freedom = (samples - size) as f64;
        let scaled = |matrix: &[f64], variance: f64| -> Vec<Vec<f64>> {
            let entry = |i: usize, j: usize| matrix[i * size + j] * variance * units[i] * units[j];
            (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()
        };
        let columns: Vec<&[f64]> = solution.columns.iter().chain(&solution.derivatives).map(Vec::as_slice).collect();
        let inverse = solution.inverse_normal.as_deref().filter(|_| known);
        // Merged terms have columns that are one another's multiples, beside which no noise has a likelihood.
        let taken_up = if inverse.is_some() { columns.clone() } else { independent(&columns) };
        let times = times.filter(|_| choice == NoiseChoice::FromResiduals);
        let (times, time_unit) =
            times.map_or((None, 1.0), |(times, unit)| (Some(times).filter(|times| are_uneven(times)), unit));
        let spread = (may_vary && times.is_none() && choice == NoiseChoice::FromResiduals)
            .then(|| {
                let (partial, _) = partial(&lags, samples, size);
                let curve = curve.map_or_else(|| Cow::Owned(fitted(solution)), Cow::Borrowed);
                Spread::of(&solution.residuals, &curve, &partial)
            })
            .flatten();
        effort.hear()?;
        let (noise, noise_p_value) = match (choice, &spread) {
            (NoiseChoice::White, _) => (Noise::white(&lags, freedom), None),
            (NoiseChoice::FromResiduals, None) => {
                let noise = Noise::of(&taken_up, &solution.residuals, &lags, times);
                let p_value = times.is_none().then(|| p_value(&solution.residuals, noise.model)).flatten();
                (noise, p_value)
            }
            (NoiseChoice::FromResiduals, Some(spread)) => {
                let even: Vec<Vec<f64>> = taken_up.iter().map(|column| spread.even(column)).collect();
                let views: Vec<&[f64]> = even.iter().map(Vec::as_slice).collect();
                let residuals = spread.even(&solution.residuals);
                let noise = Noise::of(&views, &residuals, &Lags::of(&residuals), times);
                let p_value = p_value(&residuals, noise.model);
                (noise, p_value)
            }
        };
        effort.hear()?;
        // A robust loss has its own s²; the noise of its residuals stands in the same ratio to it as that of plain ones.
        let ratio = solution.variance * freedom / solution.residual_square;
        let ratio = if ratio.is_finite() { ratio } else { 1.0 };
        let finite = |rows: &Vec<Vec<f64>>| rows.iter().flatten().all(|entry| entry.is_finite());
        let white = inverse.map(|inverse| scaled(inverse, solution.variance)).filter(finite);
        let weighed: Option<Vec<Vec<f64>>> =
            spread.as_ref().map(|spread| columns.iter().map(|column| spread.weighed(column)).collect());
        let views: Option<Vec<&[f64]>> = weighed.as_ref().map(|weighed| weighed.iter().map(Vec::as_slice).collect());
        let correlates = noise.likely.iter().any(|likely| likely.model != NoiseModel::White);
        let correlated = correlates.then(|| Columns::new(views.as_ref().unwrap_or(&columns), times));
        let sandwich = |inverse: &[f64], model: NoiseModel, variance: f64| match &correlated {
            _ if model == NoiseModel::White && spread.is_some() => {
                let filling = by_residuals(&columns, amplitudes, inverse, &solution.residuals);
                scaled(&sandwiched(inverse, &filling, size), ratio)
            }
            Some(columns) if model != NoiseModel::White => scaled(
                &sandwiched(inverse, &with_amplitudes(columns.quadratic(model), amplitudes), size),
                ratio * variance,
            ),
            _ => scaled(inverse, ratio * variance),
        };
        let of_inverse = |inverse: &[f64]| {
            let of_model = |likely: &Likely| {
                effort.hear()?;
                Ok(ModelCovariance {
                    probability: likely.probability,
                    covariance: sandwich(inverse, likely.model, likely.variance),
                })
            };
            let mut models: Vec<ModelCovariance> =
                noise.likely.iter().map(of_model).collect::<Result<_, Cancelled>>()?;
            let mut covariance = vec![vec![0.0; size]; size];
            for model in &models {
                for (sums, row) in covariance.iter_mut().zip(&model.covariance) {
                    sums.iter_mut().zip(row).for_each(|(sum, entry)| *sum += model.probability * entry);
                }
            }
            if models.len() == 1 {
                models.clear();
            }
            Ok(Uncertainty {
                confidence,
                freedom,
                deviation: noise.variance(samples).sqrt() * unit,
                covariance,
                models,
            })
        };
        let mut uncertainty = inverse.filter(|_| white.is_some()).map(of_inverse).transpose()?;
        if let (Some(uncertainty), Some(inverse)) = (&mut uncertainty, inverse)
            && noise_p_value.is_some_and(|p_value| p_value < UNEXPLAINED)
            && let Some(filling) = by_blocks(&columns, &solution.residuals)
        {
            let filling = with_amplitudes(filling, amplitudes);
            uncertainty.widen(&scaled(&sandwiched(inverse, &filling, size), ratio));
        }
        Ok(Self {
            white,
            uncertainty: uncertainty.filter(|found| finite(&found.covariance)),
            noise: noise.model.in_unit(time_unit),
            noise_p_value,
            correlation: lags.correlations[0],
            uneven: spread.is_some(),
        })
    }

    /// Assesses least squares with this Jacobian, column by column, of a model that is linear in nothing, to values that differ from
    /// it by the residuals.
    pub(crate) fn of_columns(
        columns: Vec<Vec<f64>>,
        (values, residuals): (&[f64], Vec<f64>),
        confidence: f64,
    ) -> Result<Self, Cancelled> {
        let size = columns.len();
        let curve: Vec<f64> = values.iter().zip(&residuals).map(|(value, left)| value - left).collect();
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
        let trust = Trust {
            confidence,
            noise: NoiseChoice::FromResiduals,
            known: true,
            may_vary: true,
            curve: Some(&curve),
            times: None,
        };
        Self::new(&solution, &[], &vec![1.0; size], 1.0, &trust, &Effort::default())
    }

    /// Adds a covariance of the parameters from another, independent cause.
    pub(crate) fn add(&mut self, covariance: &[Vec<f64>]) {
        let add = |rows: &mut Vec<Vec<f64>>| {
            for (row, by) in rows.iter_mut().zip(covariance) {
                row.iter_mut().zip(by).for_each(|(entry, by)| *entry += by);
            }
        };
        self.white.iter_mut().for_each(add);
        if let Some(uncertainty) = &mut self.uncertainty {
            add(&mut uncertainty.covariance);
            uncertainty.models.iter_mut().for_each(|model| add(&mut model.covariance));
        }
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
            covariance: wide(white),
            models: Vec::new(),
        });
        let noise = if correlation > 0.0 { NoiseModel::Autoregressive { correlation } } else { NoiseModel::White };
        Self {
            white,
            uncertainty,
            noise,
            noise_p_value: None,
            correlation,
            uneven: false,
        }
    }

    /// Estimates of `values`, of which column a of `gradients` has the derivatives by parameter a (of ln value on the logarithmic scale).
    pub(crate) fn estimates(
        &self,
        values: &[f64],
        gradients: &[impl AsRef<[f64]>],
        scale: impl Fn(usize) -> Scale,
    ) -> Vec<Estimate> {
        let (Some(uncertainty), Some(white)) = (&self.uncertainty, &self.white) else {
            return values.iter().map(|value| Estimate::fixed(*value)).collect();
        };
        let mut found = uncertainty.estimates(values, gradients, white, |_| 0.0, scale);
        for estimate in &mut found {
            // What no parameter moves was given.
            if estimate.white_standard_error == Some(0.0) {
                *estimate = Estimate::fixed(estimate.value);
            }
        }
        found
    }

    /// An estimate of one value.
    pub(crate) fn estimate(&self, value: f64, gradient: &[f64], scale: Scale) -> Estimate {
        let columns: Vec<&[f64]> = gradient.iter().map(std::slice::from_ref).collect();
        self.estimates(&[value], &columns, |_| scale).swap_remove(0)
    }
}

/// Whether times between samples differ by more than jitter and some gaps would have it.
fn are_uneven(times: &[f64]) -> bool {
    let mut gaps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (least, most) = extremes(&gaps);
    if gaps.len() < 4 || most <= 2.0 * least {
        return false;
    }
    let (tenth, last) = (gaps.len() / 10, gaps.len() - 1);
    let low = *gaps.select_nth_unstable_by(tenth, f64::total_cmp).1;
    let high = *gaps.select_nth_unstable_by(last - tenth, f64::total_cmp).1;
    low > 0.0 && high > 2.0 * low
}

/// The curve of a solution: its columns times their amplitudes.
fn fitted(solution: &Solution) -> Vec<f64> {
    let mut values = vec![0.0; solution.residuals.len()];
    for (column, amplitude) in solution.columns.iter().zip(&solution.linear) {
        add_multiple(&mut values, *amplitude, column);
    }
    values
}

/// The columns that those before them do not span.
fn independent<'a>(columns: &[&'a [f64]]) -> Vec<&'a [f64]> {
    /// The share of its square that a column has to have beside those before: of less, products with correlated noise keep no digits.
    const LEAST: f64 = 1e-6;
    let size = columns.len();
    let mut rest = vec![0.0; size * size];
    cross_products(columns, columns, &mut rest);
    let squares: Vec<f64> = (0..size).map(|i| rest[i * size + i]).collect();
    let mut kept = Vec::with_capacity(size);
    for k in 0..size {
        let own = rest[k * size + k];
        if own.is_nan() || own <= LEAST * squares[k] {
            continue;
        }
        kept.push(columns[k]);
        for i in k + 1..size {
            let by = rest[i * size + k] / own;
            for j in k + 1..size {
                rest[i * size + j] -= by * rest[k * size + j];
            }
        }
    }
    kept
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
