//! One candidate fitted to a whole record.

use super::prepared::Prepared;
use super::search::search;
use super::uncertainty::AssessedMaterial;
use super::{CalibrateError, CalibrationData, CalibrationRange, Candidate, Material, MaterialParts, ResidualCourse};
use crate::analysis::HoldoutError;
use crate::fit::{NoiseModel, Termination};
use crate::forecast::{Criteria, criteria};
use crate::simulate::simulate_force;
use crate::statistics::{range, rms};
use crate::watch::{Stages, Watch};

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
    /// How the residuals show that the law misses part of the record; `None` where they do not.
    pub course: Option<ResidualCourse>,
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
    let data = &*data.with_law(candidate.equilibrium);
    let prepared = Prepared::new(candidate, data)?;
    let free = prepared.searched.len();
    if data.fitted() <= free {
        return Err(CalibrateError::TooFewSamples {
            samples: data.fitted(),
            parameters: free,
        });
    }
    // A force that no machine held is of a load cell that was not read.
    if data.held().force.is_empty() && range(data.forces()) == 0.0 {
        return Err(CalibrateError::ConstantForce {
            force: data.forces()[0],
        });
    }
    let mut stages = Stages::new(format!("calibrating {candidate}"), watch);
    let found = search(&prepared, data, &mut stages)?;
    let assessed = AssessedMaterial::new(&prepared, data, &found, confidence, &mut stages)?;
    let contact = prepared.contact(&found.theta).ok_or(CalibrateError::NoStiffness)?;
    let simulated = simulate_force(data.motion(), &contact, data.times())?;
    let rmse = (found.square / data.fitted() as f64).sqrt();
    stages.finish()?;
    Ok(Calibration {
        material: Material::new(MaterialParts {
            body: prepared.body.clone(),
            candidate,
            parameters: assessed.parameters(),
            uncertainty: assessed.uncertainty(),
            noise: (found.square / (data.fitted() - free) as f64).sqrt(),
            range: shown(data),
        })?,
        free_parameters: free,
        rmse,
        relative: rmse / largest(data.forces()),
        noise: assessed.noise(),
        course: assessed.course,
        criteria: criteria(found.square, data.fitted() as f64, free as f64),
        holdout: holdout(data, &simulated),
        termination: assessed.termination,
        simulated,
        simulations: found.simulations,
        theta: found.theta,
    })
}

/// The error behind the fitted part.
fn holdout(data: &CalibrationData, simulated: &[f64]) -> Option<HoldoutError> {
    let forces = &data.forces()[data.fitted()..];
    (!forces.is_empty()).then(|| {
        let rmse = rms(forces, &simulated[data.fitted()..]);
        HoldoutError {
            rmse,
            relative: rmse / largest(data.forces()),
            samples: forces.len(),
        }
    })
}

fn largest(forces: &[f64]) -> f64 {
    forces.iter().fold(0.0, |most, force| most.max(force.abs()))
}

/// What the fitted part of the record has shown.
fn shown(data: &CalibrationData) -> CalibrationRange {
    let until = data.times()[data.fitted() - 1];
    CalibrationRange::of(data.motion(), data.held(), until, largest(&data.forces()[..data.fitted()]))
}
