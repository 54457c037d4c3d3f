//! From the best point to parameters with their errors.

use super::arrow::Point;
use super::hold::Hold;
use crate::fit::{Assessed, Fit, Fitted, JointFit, JointOptions};
use crate::laws::{Law, ShapeParameterKind};
use crate::optimise::{Cholesky, Few, Solution, Termination, Work};
use crate::statistics::{effective_count, lag_one_correlation};

/// Holds brought together, with what each stated alone.
pub(crate) struct Joint {
    pub(crate) law: Law,
    pub(crate) options: JointOptions,
    pub(crate) holds: Vec<Hold>,
    pub(crate) solutions: Vec<Solution>,
    /// Bounds of the shared parameters.
    pub(crate) bounds: Vec<(f64, f64)>,
    /// ln of the shared unit of time.
    pub(crate) log_time: f64,
    /// ln of the shared unit of the signal.
    pub(crate) log_signal: f64,
}

impl Joint {
    pub(crate) fn report(&self, point: &Point, termination: Termination, separate: Vec<Fit>, work: Work) -> JointFit {
        let inverse = self.inverse_normal(point);
        let termination = match (&inverse, termination) {
            (None, Termination::Converged) => Termination::Singular,
            _ => termination,
        };
        let inverse = inverse.filter(|_| termination == Termination::Converged);
        let samples: usize = self.holds.iter().map(|hold| hold.scaled.times.len()).sum();
        let correlations: Vec<f64> = point.parts.iter().map(|part| lag_one_correlation(&part.residuals)).collect();
        let counts = self.holds.iter().zip(&correlations);
        let effective: f64 = counts.map(|(hold, rho)| effective_count(hold.scaled.times.len(), *rho)).sum();
        let parameters = self.size(point);
        let widening = (samples as f64 / effective).sqrt();
        let freedom = (effective - parameters as f64).max(1.0);
        let variance = point.square / (samples - parameters) as f64;
        let hold = |(index, rho): (usize, &f64)| {
            let fitted = self.fitted(point, index, inverse.as_deref(), variance, termination);
            let white = fitted.white_covariance(variance);
            let deviation = variance.sqrt() * fitted.scaled.range;
            let trust = (self.options.fit.confidence, freedom);
            let assessed = Assessed::widened(white, deviation, trust, widening, *rho);
            fitted.report_with(self.law, assessed, work)
        };
        let holds: Vec<Fit> = correlations.iter().enumerate().map(hold).collect();
        let parameter = |name: String| holds[0].parameters.iter().find(|parameter| parameter.name == *name).cloned();
        let shared = self.shared_names().into_iter().filter_map(parameter).collect();
        let signal = (2.0 * self.log_signal).exp();
        let alone = self.solutions.iter().zip(&self.holds);
        JointFit {
            law: self.law,
            response: self.options.response,
            shared,
            separate_residual_square: alone.map(|(own, hold)| hold.weight.powi(2) * own.residual_square).sum::<f64>()
                * signal,
            separate,
            parameters: self.names(&holds),
            values: self.values(point, &holds),
            white_covariance: inverse.map(|inverse| self.covariance(point, &inverse, variance)),
            holds,
            residual_square: point.square * signal,
            samples,
            effective_samples: effective,
            options: self.options,
            termination,
            work,
        }
    }

    /// All parameters.
    fn size(&self, point: &Point) -> usize {
        point.shared.len() + self.first(self.holds.len())
    }

    /// Place of the first own parameter of a hold among all.
    fn first(&self, index: usize) -> usize {
        self.holds[..index].iter().map(|hold| hold.model.linear()).sum()
    }

    /// (JᵀJ)⁻¹ over the own parameters of every hold, then the shared ones.
    fn inverse_normal(&self, point: &Point) -> Option<Vec<f64>> {
        let (size, q) = (self.size(point), point.shared.len());
        let mut normal = vec![0.0; size * size];
        for (index, (hold, part)) in self.holds.iter().zip(&point.parts).enumerate() {
            let weight = hold.weight.powi(2);
            let places = self.places(index, q);
            for (a, &i) in places.iter().enumerate() {
                for (b, &j) in places.iter().enumerate() {
                    normal[i * size + j] += weight * part.normal[a * places.len() + b];
                }
            }
        }
        Some(Cholesky::new(&normal, size)?.inverse())
    }

    /// Where the parameters of a hold, own and shared, stand among all.
    fn places(&self, index: usize, shared: usize) -> Vec<usize> {
        let (first, after) = (self.first(index), self.first(self.holds.len()));
        (first..first + self.holds[index].model.linear()).chain(after..after + shared).collect()
    }

    /// A hold as if it had been fitted alone, with the errors of the joint fit.
    fn fitted(
        &self,
        point: &Point,
        index: usize,
        inverse: Option<&[f64]>,
        variance: f64,
        termination: Termination,
    ) -> Fitted {
        let (hold, part) = (&self.holds[index], &point.parts[index]);
        let (size, places) = (self.size(point), self.places(index, point.shared.len()));
        let rows = hold.sensitivity(&point.shared, &part.own);
        let entry = |inverse: &[f64], a: usize, b: usize| -> f64 {
            let along = |i: usize| places.iter().zip(&rows[b]).map(|(j, y)| inverse[i * size + j] * y).sum::<f64>();
            places.iter().zip(&rows[a]).filter(|(_, x)| **x != 0.0).map(|(&i, x)| x * along(i)).sum()
        };
        let count = rows.len();
        Fitted {
            model: hold.model.clone(),
            scaled: hold.scaled.clone(),
            solution: Solution {
                linear: part.own.clone(),
                nonlinear: hold.theta(&point.shared, &part.own),
                residuals: part.residuals.clone(),
                residual_square: part.square,
                variance,
                columns: Vec::new(),
                derivatives: Vec::new(),
                column_squares: Few::new(),
                inverse_normal: inverse
                    .map(|inverse| (0..count * count).map(|i| entry(inverse, i / count, i % count)).collect()),
                termination,
            },
            counted: None,
        }
    }

    /// Names of the shared parameters in the caller's units.
    fn shared_names(&self) -> Vec<String> {
        let rate = self.holds[0].coupling.map(|_| "rate_coefficient_per_s".to_owned());
        let skipped = usize::from(rate.is_some());
        let others = self.holds[0].model.free().skip(skipped).map(|parameter| parameter.name.clone());
        rate.into_iter().chain(others).collect()
    }

    fn names(&self, holds: &[Fit]) -> Vec<String> {
        let own = self.holds[0].model.linear();
        let mut names = Vec::new();
        for (index, fit) in holds.iter().enumerate() {
            names.extend(fit.searched[..own].iter().map(|name| format!("{name}_hold_{}", index + 1)));
        }
        names.extend(holds[0].searched[own..].iter().cloned());
        if self.holds[0].coupling.is_some() {
            names[holds.len() * own] = "ln rate_coefficient_per_s".to_owned();
        }
        names
    }

    fn values(&self, point: &Point, holds: &[Fit]) -> Vec<f64> {
        let own = self.holds[0].model.linear();
        let constants = holds.iter().flat_map(|fit| fit.values[..own].iter().copied());
        let exponent = self.holds[0].coupling.map_or(1.0, |held| held.unwrap_or_else(|| point.shared[1]));
        let natural = |(parameter, value): (&crate::fit::problem::model::ModelParameter, &f64)| match parameter.kind {
            ShapeParameterKind::Pure { .. } => *value,
            _ => value - self.log_time - (exponent - 1.0) * self.log_signal,
        };
        constants.chain(self.holds[0].model.free().zip(&point.shared).map(natural)).collect()
    }

    /// The covariance of all parameters in the caller's units.
    fn covariance(&self, point: &Point, inverse: &[f64], variance: f64) -> Vec<Vec<f64>> {
        let (size, q) = (self.size(point), point.shared.len());
        let units: Vec<f64> = self
            .holds
            .iter()
            .flat_map(|hold| vec![hold.scaled.range; hold.model.linear()])
            .chain(vec![1.0; q])
            .collect();
        let rate = size - q;
        // ln v counts in shared units of the signal, to the power n − 1.
        let through = if self.holds[0].coupling == Some(None) { -self.log_signal } else { 0.0 };
        let row = |i: usize, j: usize| {
            let more = if i == rate && q > 1 { through * inverse[(rate + 1) * size + j] } else { 0.0 };
            inverse[i * size + j] + more
        };
        let entry = |i: usize, j: usize| {
            let more = if j == rate && q > 1 { through * row(i, rate + 1) } else { 0.0 };
            (row(i, j) + more) * units[i] * units[j] * variance
        };
        (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()
    }
}
