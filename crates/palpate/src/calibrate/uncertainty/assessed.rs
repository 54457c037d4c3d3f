//! Parameters of a material with their errors and intervals.

use super::beyond::beyond_instrument;
use super::displacement::from_displacement;
use super::systematic::systematic_effects;
use crate::calibrate::material::correlates;
use crate::calibrate::prepared::Prepared;
use crate::calibrate::problem::{Found, Problem};
use crate::calibrate::{
    CalibrateError, CalibrationData, Material, MaterialParameter, MaterialUncertainty, ResidualCourse, SystematicEffect,
};
use crate::fit::{Assessed, Estimate, NoiseModel, Scale, Termination};
use crate::watch::Stages;

/// Distance from the best value, as a logarithm, beyond which an end counts as open: a factor of a million.
pub(crate) const FARTHEST: f64 = 14.0;

/// The searched parameters of a record, with what their errors follow from.
pub(crate) struct AssessedMaterial<'a> {
    prepared: &'a Prepared,
    /// All parameters, in SI units.
    values: Vec<f64>,
    /// Derivatives of the logarithms of all parameters by the searched ones that are not at a bound; rows of parameters.
    gradients: Vec<Vec<f64>>,
    /// From the noise of the residuals, if the record shows what each parameter does.
    assessed: Option<Assessed>,
    /// From the instrument and the body.
    systematic: Vec<SystematicEffect>,
    /// What no error of the instrument explains of the residuals.
    pub(crate) course: Option<ResidualCourse>,
    confidence: f64,
    pub(crate) termination: Termination,
}

impl<'a> AssessedMaterial<'a> {
    pub(crate) fn new(
        prepared: &'a Prepared,
        data: &CalibrationData,
        found: &Found,
        confidence: f64,
        stages: &mut Stages<'_>,
    ) -> Result<Self, CalibrateError> {
        let problem = Problem::of(prepared, data);
        let jacobian = problem.jacobian(&found.theta, &found.residuals);
        if let (Some(missing), Some(factor)) =
            (prepared.candidate.rate.needs(), jacobian.as_ref().and_then(|columns| columns.last()))
            && factor.iter().all(|slope| *slope == 0.0)
        {
            return Err(CalibrateError::FactorUnseen { missing });
        }
        // A parameter at its bound has no error, the others have theirs beside it.
        let inside = |i: &usize| {
            let (searched, value) = (&prepared.searched[*i], found.theta[*i]);
            value > searched.low && value < searched.high
        };
        let open: Vec<usize> = (0..prepared.searched.len()).filter(inside).collect();
        let mut new = Self {
            prepared,
            values: prepared.values(&found.theta),
            gradients: gradients(prepared, &found.theta, &open),
            assessed: None,
            systematic: Vec::new(),
            course: None,
            confidence,
            termination: found.termination,
        };
        if let Some(jacobian) = &jacobian {
            let columns: Vec<Vec<f64>> = open.iter().map(|i| jacobian[*i].clone()).collect();
            let of_displacement = from_displacement(&problem, data, found, &columns, stages)?;
            let (systematic, changes) = systematic_effects(&problem, data, found, (&columns, &new.gradients), stages)?;
            new.systematic = systematic;
            let left = beyond_instrument(&problem, data, found, (&columns, changes), stages)?;
            new.course = ResidualCourse::of(data, &columns, &left)?;
            let forces = &data.forces()[..data.fitted()];
            let mut assessed = Assessed::of_columns(columns, (forces, found.residuals.clone()), confidence)?;
            of_displacement.iter().for_each(|covariance| assessed.add(covariance));
            new.assessed = Some(assessed);
        }
        let has_errors = new.uncertainty().is_some();
        if found.termination == Termination::Converged && !has_errors {
            let merges = prepared.searched.iter().any(|searched| searched.name == "rate_2");
            new.termination = if merges { Termination::TermsMerged } else { Termination::Singular };
        }
        Ok(new)
    }

    /// How the residuals correlate.
    pub(crate) fn noise(&self) -> NoiseModel {
        self.assessed.as_ref().map_or(NoiseModel::White, |assessed| assessed.noise)
    }

    /// All parameters with their errors, where the record determines them.
    pub(crate) fn parameters(&self) -> Vec<MaterialParameter> {
        let names = Material::names(self.prepared.candidate, self.prepared.body.levels.len());
        let parameter = |(index, (name, unit)): (usize, (String, _))| MaterialParameter {
            estimate: self.estimate(index, &name),
            name,
            unit,
        };
        names.into_iter().enumerate().map(parameter).collect()
    }

    fn estimate(&self, index: usize, name: &str) -> Estimate {
        let value = self.values[index];
        let is_given = Material::is_given(self.prepared.candidate, name);
        let Some(assessed) = self.found().filter(|_| !is_given) else {
            return Estimate::fixed(value);
        };
        let of_instrument = self.systematic.iter().map(|effect| (value * effect.logs[index], effect.input.freedom));
        let freedom = assessed.uncertainty.as_ref().map_or(f64::INFINITY, |uncertainty| uncertainty.freedom);
        let estimate = assessed.estimate(value, &self.gradients[index], Scale::Log);
        let estimate = estimate.beside(freedom, of_instrument, self.confidence);
        match estimate.interval {
            Some((_, high)) if (high / value).ln() < FARTHEST => estimate,
            _ => Estimate::fixed(value),
        }
    }

    /// The covariance of the logarithms of all parameters.
    pub(crate) fn uncertainty(&self) -> Option<MaterialUncertainty> {
        let uncertainty = self.found()?.uncertainty.as_ref()?;
        let mut covariance = transformed(&uncertainty.covariance, &self.gradients);
        self.systematic.iter().for_each(|effect| effect.add_to(&mut covariance));
        // Parameters that the data leave open have variances of which others are lost in rounding: correlations come out above 1.
        correlates(&covariance).then_some(MaterialUncertainty {
            confidence: self.confidence,
            freedom: uncertainty.freedom,
            covariance,
            systematic: self.systematic.clone(),
        })
    }

    /// The errors of a search that has converged.
    fn found(&self) -> Option<&Assessed> {
        self.assessed.as_ref().filter(|_| self.termination == Termination::Converged)
    }
}

/// Derivatives of the logarithms of the parameters by the open searched ones: rows of parameters.
fn gradients(prepared: &Prepared, theta: &[f64], open: &[usize]) -> Vec<Vec<f64>> {
    /// Both are logarithms: all but the layer thickness are straight.
    const STEP: f64 = 1e-5;
    let logs = |i: usize, by: f64| -> Vec<f64> {
        let mut beside = theta.to_vec();
        beside[i] += by;
        prepared.values(&beside).into_iter().map(f64::ln).collect()
    };
    let columns: Vec<(Vec<f64>, Vec<f64>)> = open.iter().map(|i| (logs(*i, -STEP), logs(*i, STEP))).collect();
    let count = prepared.values(theta).len();
    let row = |k: usize| columns.iter().map(|(low, high)| (high[k] - low[k]) / (2.0 * STEP)).collect();
    (0..count).map(row).collect()
}

/// G C Gᵀ.
fn transformed(covariance: &[Vec<f64>], gradients: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let row = |(entry, by): (&Vec<f64>, &f64)| by * entry.iter().zip(b).map(|(c, g)| c * g).sum::<f64>();
        covariance.iter().zip(a).map(row).sum()
    };
    let entry = |i: usize, j: usize| product(&gradients[i.min(j)], &gradients[i.max(j)]);
    let size = gradients.len();
    (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()
}
