//! One candidate fitted to a whole record.

use super::displacement::from_displacement;
use super::prepared::Prepared;
use super::problem::Problem;
use super::search::search;
use super::systematic::systematic_effects;
use super::{
    CalibrateError, CalibrationData, CalibrationRange, Candidate, Material, MaterialParameter, MaterialParts,
    MaterialUncertainty,
};
use crate::analysis::HoldoutError;
use crate::fit::{Assessed, Estimate, NoiseModel, Scale, Termination};
use crate::forecast::{Criteria, criteria};
use crate::simulate::simulate_force;
use crate::statistics::{normal_factor, rms};
use crate::watch::{Stages, Watch};

/// Distance from the best value, as a logarithm, beyond which an end counts as open: a factor of a million.
pub(super) const FARTHEST: f64 = 14.0;

/// A candidate fitted to the whole of a record, ramps and holds alike.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Calibration {
    /// The body with its parameters.
    pub material: Material,
    /// Simulated force at every sample, fitted or predicted, N.
    pub simulated: Vec<f64>,
    /// Parameters that were searched.
    pub free_parameters: usize,
    /// Root mean square residual over the fitted samples, N.
    pub rmse: f64,
    /// The same as a share of the largest force of the record.
    pub relative: f64,
    /// Correlation of the residuals, which intervals and criteria take into account.
    pub noise: NoiseModel,
    /// Information criteria, every sample counted as one; only differences between candidates on the same data mean anything.
    pub criteria: Criteria,
    /// What comes after the fitted part, if it was fitted in part.
    pub holdout: Option<HoldoutError>,
    /// Why it ended.
    pub termination: Termination,
    /// Simulations it took.
    pub simulations: u64,
    /// The searched parameters.
    pub(super) theta: Vec<f64>,
}

/// Fits a law of the layer and one of the equilibrium force to a whole record: one set of parameters for all ramps and holds.
///
/// With the latency law these are n, v, the layer thickness ℓ and the coefficients of the equilibrium force (one modulus, or the rows of a
/// table): the holds carry n and v, the ramps ℓ, since the excess at their end is that of ẋ = u̇₁ (m − 1)/depth − v sgn(x)|x|ⁿ with
/// m = depth/ℓ, and the relaxed levels the stiffness S(u) of F = S(u)(u/depth + x), equations (10) and (11). No starting values: a grid is
/// searched first. Intervals are those of the logarithms of the parameters, for residuals that correlate as they do; `confidence` is their
/// coverage. A parameter that the record does not determine within a factor of a million either way has none.
///
/// ```
/// use palpate::analysis::Geometry;
/// use palpate::calibrate::{CalibrationData, Candidate, EquilibriumLaw, calibrate};
/// use palpate::laws::Law;
/// use palpate::simulate::{Separation, simulate_force};
/// use palpate::test_problems::{paper_ball, paper_test_a};
/// use palpate::watch::Unwatched;
/// let (motion, model) = (paper_test_a(), paper_ball(Separation::Unilateral));
/// let times: Vec<f64> = (0..=660).map(|i| 0.1 * f64::from(i)).collect();
/// let forces = simulate_force(&motion, &model, &times)?;
/// let ball = Geometry { shape: model.specimen.shape().clone(), sides: model.specimen.sides(), modulus: None, equilibrium: Default::default() };
/// let data = CalibrationData::new(ball, model.separation, motion, times, forces, &[])?;
/// let found = calibrate(&data, Candidate::new("latency".parse()?, EquilibriumLaw::UniformStrain), 0.95, &mut Unwatched)?;
/// let value = |name| found.material.estimate(name).unwrap().value;
/// assert!((value("modulus_pa") - 28e3).abs() < 1e-3);            // Pa
/// assert!((value("exponent") - 5.0).abs() < 1e-5);
/// assert!((value("layer_thickness_m") - 0.035 / 8.0).abs() < 1e-8); // m
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CalibrateError`] for a law that no contact is simulated with, an equilibrium law that does not go with the body, fewer samples than
/// parameters, and a force that does not rise with the squeeze; [`CalibrateError::Cancelled`] once `watch` ends it, which hears of every
/// step of the search.
pub fn calibrate(
    data: &CalibrationData,
    candidate: Candidate,
    confidence: f64,
    watch: &mut dyn Watch,
) -> Result<Calibration, CalibrateError> {
    let prepared = Prepared::new(candidate, data)?;
    let free = prepared.searched.len();
    if data.fitted() <= free {
        return Err(CalibrateError::TooFewSamples {
            samples: data.fitted(),
            parameters: free,
        });
    }
    let mut stages = Stages::new(format!("calibrating {candidate}"), watch);
    let found = search(&prepared, data, &mut stages)?;
    let problem = Problem::of(&prepared, data);
    let contact = prepared.contact(&found.theta).ok_or(CalibrateError::NoStiffness)?;
    let simulated = simulate_force(data.motion(), &contact, data.times())?;
    // A parameter at its bound has no error, the others have theirs beside it.
    let open: Vec<usize> = (0..free)
        .filter(|i| found.theta[*i] > prepared.searched[*i].low && found.theta[*i] < prepared.searched[*i].high)
        .collect();
    let jacobian = problem.jacobian(&found.theta, &found.residuals);
    if let (Some(missing), Some(factor)) =
        (candidate.rate.needs(), jacobian.as_ref().and_then(|columns| columns.last()))
        && factor.iter().all(|slope| *slope == 0.0)
    {
        return Err(CalibrateError::FactorUnseen { missing });
    }
    let gradients = gradients(&prepared, &found.theta, &open);
    let (assessed, systematic) = match &jacobian {
        Some(jacobian) => {
            let columns: Vec<Vec<f64>> = open.iter().map(|i| jacobian[*i].clone()).collect();
            let of_displacement = from_displacement(&problem, data, &found, &columns, &mut stages)?;
            let systematic = systematic_effects(&problem, data, &found, (&columns, &gradients), &mut stages)?;
            let mut assessed =
                Assessed::of_columns(columns, (&data.forces()[..data.fitted()], found.residuals.clone()), confidence)?;
            of_displacement.iter().for_each(|covariance| assessed.add(covariance));
            (Some(assessed), systematic)
        }
        None => (None, Vec::new()),
    };
    let is_reported = assessed.as_ref().is_some_and(|assessed| assessed.uncertainty.is_some());
    let termination = match found.termination {
        Termination::Converged
            if !is_reported && prepared.searched.iter().any(|searched| searched.name == "rate_2") =>
        {
            Termination::TermsMerged
        }
        Termination::Converged if !is_reported => Termination::Singular,
        other => other,
    };
    let values = prepared.values(&found.theta);
    let is_found = termination == Termination::Converged;
    let estimate = |index: usize, name: &str| match &assessed {
        Some(assessed) if is_found && !Material::is_given(candidate, name) => {
            let of_instrument: f64 = systematic.iter().map(|effect| (values[index] * effect.logs[index]).powi(2)).sum();
            let estimate = assessed.estimate(values[index], &gradients[index], Scale::Log);
            let estimate = estimate.beside(of_instrument, normal_factor(confidence));
            match estimate.interval {
                Some((_, high)) if (high / values[index]).ln() < FARTHEST => estimate,
                _ => Estimate::fixed(values[index]),
            }
        }
        _ => Estimate::fixed(values[index]),
    };
    let names = Material::names(candidate, prepared.body.levels.len());
    let parameters: Vec<MaterialParameter> = names
        .into_iter()
        .enumerate()
        .map(|(index, (name, unit))| MaterialParameter {
            estimate: estimate(index, &name),
            name,
            unit,
        })
        .collect();
    let uncertainty = assessed.as_ref().filter(|_| is_found).and_then(|assessed| {
        let uncertainty = assessed.uncertainty.as_ref()?;
        let mut covariance = transformed(&uncertainty.covariance, &gradients);
        systematic.iter().for_each(|effect| effect.add_to(&mut covariance));
        Some(MaterialUncertainty {
            confidence,
            freedom: uncertainty.freedom,
            covariance,
            systematic: systematic.clone(),
        })
    });
    let noise = assessed.as_ref().map_or(NoiseModel::White, |assessed| assessed.noise);
    let largest = data.forces().iter().fold(0.0, |most: f64, force| most.max(force.abs()));
    let holdout = (data.fitted() < data.times().len()).then(|| {
        let rest = data.fitted()..;
        let rmse = rms(&data.forces()[rest.clone()], &simulated[rest]);
        HoldoutError {
            rmse,
            relative: rmse / largest,
            samples: data.times().len() - data.fitted(),
        }
    });
    let rmse = (found.square / data.fitted() as f64).sqrt();
    stages.finish()?;
    Ok(Calibration {
        material: Material::new(MaterialParts {
            body: prepared.body.clone(),
            candidate,
            parameters,
            uncertainty,
            noise: (found.square / (data.fitted() - free) as f64).sqrt(),
            range: range(data),
        })?,
        simulated,
        free_parameters: free,
        rmse,
        relative: rmse / largest,
        noise,
        criteria: criteria(found.square, data.fitted() as f64, free as f64),
        holdout,
        termination,
        simulations: found.simulations,
        theta: found.theta,
    })
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

/// What the fitted part of the record has shown.
fn range(data: &CalibrationData) -> CalibrationRange {
    let largest_force = data.forces()[..data.fitted()].iter().fold(0.0, |most: f64, force| most.max(force.abs()));
    CalibrationRange::of(data.motion(), data.times()[data.fitted() - 1], largest_force)
}
