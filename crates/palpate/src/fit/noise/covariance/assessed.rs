//! A fit whose noise was found: errors and intervals of its parameters.

use std::borrow::Cow;

use super::columns::Columns;
use super::rounding::Rounding;
use super::sandwich::Sandwich;
use super::uncertainty::{Scale, Uncertainty, add};
use super::uneven::leverages;
use crate::fit::levels::step_between_levels;
use crate::fit::noise::course::NoiseCourse;
use crate::fit::noise::model::Noise;
use crate::fit::noise::portmanteau::{UNEXPLAINED, p_value};
use crate::fit::noise::residuals::Residuals;
use crate::fit::noise::spread::Spread;
use crate::fit::{Estimate, NoiseChoice, NoiseModel};
use crate::optimise::{Cholesky, Effort, Few, Solution, Termination};
use crate::statistics::dot;
use crate::vector::{add_multiple, cross_products, extremes};
use crate::watch::Cancelled;

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
    /// How it may change.
    pub(crate) course: Option<NoiseCourse>,
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
    /// Residuals as a robust loss counts them.
    pub(crate) counted: Option<&'a [f64]>,
    /// What multiplies residuals and columns of samples that have weights.
    pub(crate) roots: Option<&'a [f64]>,
    /// The fitted values, where they are no sum of columns.
    pub(crate) curve: Option<&'a [f64]>,
    /// Times of the samples, and their unit in s.
    pub(crate) times: Option<(&'a [f64], f64)>,
    /// The step that the values were rounded to, or 0.
    pub(crate) step: f64,
}

impl Trust<'_> {
    /// Times of samples that are spaced unevenly, and their unit in s.
    fn uneven_times(&self) -> (Option<&[f64]>, f64) {
        let times = self.times.filter(|_| self.noise == NoiseChoice::FromResiduals);
        times.map_or((None, 1.0), |(times, unit)| (Some(times).filter(|times| are_uneven(times)), unit))
    }

    /// How the size of noise with these partial autocorrelations changes along the samples.
    fn spread(
        &self,
        solution: &Solution,
        residuals: &Residuals<'_>,
        partial: &[f64],
        leverages: impl FnOnce() -> Option<Vec<f64>>,
    ) -> Option<Spread> {
        if !self.may_vary || self.noise == NoiseChoice::White {
            return None;
        }
        Spread::of(residuals.values, &self.fitted(solution), partial, leverages)
    }

    /// What rounding adds to the noise.
    fn rounding(&self, solution: &Solution, counted: &[f64]) -> Option<Rounding> {
        Rounding::new(&self.fitted(solution), counted, self.roots, self.step)
    }

    /// The fitted values.
    fn fitted(&self, solution: &Solution) -> Cow<'_, [f64]> {
        self.curve.map_or_else(|| Cow::Owned(fitted(solution, self.roots)), Cow::Borrowed)
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
        let columns: Vec<&[f64]> = solution.columns.iter().chain(&solution.derivatives).map(Vec::as_slice).collect();
        let inverse = solution.inverse_normal.as_deref().filter(|_| trust.known);
        let counted = trust.counted.unwrap_or(&solution.residuals);
        // Merged terms have columns that are one another's multiples, beside which no noise has a likelihood.
        let own = if inverse.is_some() { columns.clone() } else { independent(&columns) };
        let rounding = (trust.step > 0.0).then(|| trust.rounding(solution, counted)).flatten();
        let (taken_up, left) = rounding
            .as_ref()
            .filter(|_| trust.noise == NoiseChoice::FromResiduals)
            .and_then(|rounding| beside_waves(&columns, rounding, counted))
            .map_or_else(|| (own.clone(), None), |(taken_up, left)| (taken_up, Some(left)));
        let residuals = Residuals::of(left.as_deref().unwrap_or(counted), taken_up.len());
        let (times, time_unit) = trust.uneven_times();
        let taken = || inverse.map(|inverse| leverages(&columns, amplitudes, inverse));
        let spread = match times {
            None => trust.spread(solution, &residuals, &residuals.partial, taken),
            // What a sample brings beyond the one before changes with their distance where noise correlates in time.
            Some(_) => trust
                .spread(solution, &residuals, &[], taken)
                .filter(|spread| noise_of(&taken_up, &residuals, Some(spread), times).0.model == NoiseModel::White),
        };
        let observed = spread.as_ref().filter(|spread| spread.is_observed());
        effort.hear()?;
        let (noise, noise_p_value) = match trust.noise {
            NoiseChoice::White => {
                (Noise::white(residuals.square / (residuals.values.len() - units.len()) as f64), None)
            }
            NoiseChoice::FromResiduals => noise_of(&taken_up, &residuals, observed, times),
        };
        // How many samples count as independent follows from the residuals as they are: rounding that laws follow is no evidence.
        let as_they_are = left.as_ref().map(|_| Residuals::of(counted, own.len()));
        let stated = as_they_are.as_ref().map(|residuals| noise_of(&own, residuals, observed, times));
        effort.hear()?;
        let (model, stated_p_value) =
            stated.as_ref().map_or((noise.model, noise_p_value), |(noise, p_value)| (noise.model, *p_value));
        let mut assessed = Self {
            white: None,
            uncertainty: None,
            noise: model.in_unit(time_unit),
            noise_p_value: stated_p_value,
            correlation: as_they_are.as_ref().unwrap_or(&residuals).correlations[0],
            uneven: observed.is_some(),
            course: spread.as_ref().map(|spread| spread.course),
        };
        let Some(inverse) = inverse else { return Ok(assessed) };
        let weighed: Option<Vec<Vec<f64>>> =
            spread.as_ref().map(|spread| columns.iter().map(|column| spread.weighed(column)).collect());
        let views: Option<Vec<&[f64]>> = weighed.as_ref().map(|weighed| weighed.iter().map(Vec::as_slice).collect());
        let correlates = noise.likely.iter().any(|likely| likely.model != NoiseModel::White);
        let in_size = views.as_ref().filter(|_| observed.is_some()).unwrap_or(&columns);
        let correlated = correlates.then(|| Columns::new(in_size, times));
        let counted_square = trust.counted.map_or(solution.residual_square, |counted| dot(counted, counted));
        let ratio = solution.variance * (residuals.values.len() - units.len()) as f64 / counted_square;
        let fit = Sandwich {
            columns: &columns,
            amplitudes,
            inverse,
            units,
            residuals: residuals.values,
            ratio: if ratio.is_finite() { ratio } else { 1.0 },
            correlated: correlated.as_ref(),
            uneven: spread.as_ref().zip(views.as_deref()).map(|(spread, views)| (spread.probability, views)),
        };
        assessed.white = Some(fit.scaled(inverse, solution.variance)).filter(|rows| is_finite(rows));
        if assessed.white.is_some() {
            // The noise of a sample is that of all, outliers and rounding too.
            let is_part = trust.counted.is_some() || left.is_some();
            let unit = unit * if is_part { (solution.residual_square / residuals.square).sqrt() } else { 1.0 };
            let mut uncertainty = Uncertainty::of_noise(&fit, &noise, (trust.confidence, unit), effort)?;
            if noise_p_value.is_some_and(|p_value| p_value < UNEXPLAINED)
                && let Some(covariance) = fit.by_blocks()
            {
                uncertainty.widen(&covariance);
            }
            uncertainty.freedom -= (taken_up.len() - own.len()) as f64;
            if let Some(rounding) = &rounding {
                uncertainty.add(&fit.by_rounding(rounding));
            }
            assessed.uncertainty = Some(uncertainty).filter(|found| is_finite(&found.covariance));
        }
        Ok(assessed)
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
            counted: None,
            roots: None,
            curve: Some(&curve),
            times: None,
            step: step_between_levels(values),
        };
        Self::new(&solution, &[], &vec![1.0; size], 1.0, &trust, &Effort::default())
    }

    /// Adds a covariance of the parameters from another, independent cause.
    pub(crate) fn add(&mut self, covariance: &[Vec<f64>]) {
        self.white.iter_mut().for_each(|white| add(white, covariance));
        self.uncertainty.iter_mut().for_each(|uncertainty| uncertainty.add(covariance));
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
            course: None,
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

/// The noise of residuals beside these columns, both over the size of the noise where it changes, and the probability that it leaves such
/// residuals.
fn noise_of(
    columns: &[&[f64]],
    residuals: &Residuals<'_>,
    spread: Option<&Spread>,
    times: Option<&[f64]>,
) -> (Noise, Option<f64>) {
    let Some(spread) = spread else {
        let noise = Noise::of(columns, residuals, times);
        let p_value = times.is_none().then(|| p_value(residuals.values, noise.model)).flatten();
        return (noise, p_value);
    };
    let even: Vec<Vec<f64>> = columns.iter().map(|column| spread.even(column)).collect();
    let views: Vec<&[f64]> = even.iter().map(Vec::as_slice).collect();
    let values = spread.even(residuals.values);
    noise_of(&views, &Residuals::of(&values, columns.len()), None, times)
}

fn is_finite(rows: &[Vec<f64>]) -> bool {
    rows.iter().flatten().all(|entry| entry.is_finite())
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

/// The curve of a solution: its columns, over these roots of weights, times their amplitudes.
fn fitted(solution: &Solution, roots: Option<&[f64]>) -> Vec<f64> {
    let mut values = vec![0.0; solution.residuals.len()];
    for (column, amplitude) in solution.columns.iter().zip(&solution.linear) {
        add_multiple(&mut values, *amplitude, column);
    }
    if let Some(roots) = roots {
        values.iter_mut().zip(roots).for_each(|(value, root)| *value /= root);
    }
    values
}

/// Columns with the waves of rounding beside them, and what all of them leave of residuals; `None` where samples are few beside so many columns.
fn beside_waves<'a>(
    columns: &[&'a [f64]],
    rounding: &'a Rounding,
    residuals: &[f64],
) -> Option<(Vec<&'a [f64]>, Vec<f64>)> {
    /// Samples for each column.
    const ENOUGH: usize = 4;
    let all: Vec<&[f64]> = columns.iter().copied().chain(rounding.waves()).collect();
    if residuals.len() < ENOUGH * all.len() {
        return None;
    }
    let taken_up = independent(&all);
    let size = taken_up.len();
    let mut normal = vec![0.0; size * size];
    cross_products(&taken_up, &taken_up, &mut normal);
    let mut along: Vec<f64> = taken_up.iter().map(|column| dot(column, residuals)).collect();
    Cholesky::new(&normal, size)?.solve(&mut along);
    let mut left = residuals.to_vec();
    taken_up.iter().zip(along).for_each(|(column, by)| add_multiple(&mut left, -by, column));
    Some((taken_up, left))
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
