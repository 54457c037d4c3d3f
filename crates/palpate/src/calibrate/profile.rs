//! Intervals from the profile of the residual square: one parameter is held, all others are fitted again.
//!
//! With χ²(v) the residual sum of squares when a parameter is held at v, the interval is where
//!
//! ```text
//! z(v) = √((χ²(v)/χ²_min − 1)(N − p)) ≤ t √w
//! ```
//!
//! as for single holds ([`profile_interval`](crate::fit::profile_interval)): t is Student's quantile, w the variance of the parameter for
//! residuals that correlate as they do over that for white ones. Where χ² is a parabola of the logarithm this is the interval that stands
//! beside the parameter; where it is not, the profile is the one to believe.

use serde::{Deserialize, Serialize};

use super::fit::Calibration;
use super::prepared::Prepared;
use super::problem::{Held, Problem, sum_of_squares};
use super::uncertainty::FARTHEST;
use super::{CalibrateError, CalibrationData, Material, MaterialParameter};
use crate::fit::Interval;
use crate::watch::{Cancelled, Stages, Watch};

/// The profile interval of a parameter of a material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ParameterProfile {
    /// Name of the parameter.
    pub name: String,
    /// Its interval, whose ends the record may leave open.
    pub interval: Interval,
}

/// Accuracy of an end in shares of its distance.
const CLOSE: f64 = 1e-3;

/// Steps of a search with a parameter held.
const MOST_STEPS: usize = 40;

/// Profile intervals of the parameters of a calibration, in their order; those that were given have none.
///
/// Ends are searched to a thousandth of their distance. An end is open (`None`) if the profile stays below its bound as far as a factor
/// of a million, or as far as parameters are sought.
///
/// ```
/// use palpate::analysis::Geometry;
/// use palpate::calibrate::{CalibrationData, Candidate, EquilibriumLaw, calibrate, profile};
/// use palpate::simulate::{Separation, simulate_force};
/// use palpate::test_problems::{Rng, paper_ball, paper_test_a};
/// use palpate::watch::Unwatched;
/// let (motion, model) = (paper_test_a(), paper_ball(Separation::Unilateral));
/// let mut noise = Rng::new(1);
/// let times: Vec<f64> = (0..=220).map(|i| 0.3 * f64::from(i)).collect();
/// let forces = simulate_force(&motion, &model, &times)?.iter().map(|force| force + 0.2 * noise.normal()).collect();
/// let ball = Geometry { shape: model.specimen.shape().clone(), sides: model.specimen.sides(), modulus: None, equilibrium: Default::default() };
/// let data = CalibrationData::new(ball, model.separation, motion, times, forces, &[])?;
/// let found = calibrate(&data, Candidate::new("latency".parse()?, EquilibriumLaw::UniformStrain), 0.95, &mut Unwatched)?;
/// let exponent = profile(&data, &found, &mut Unwatched)?.into_iter().find(|parameter| parameter.name == "exponent").unwrap();
/// assert!(exponent.interval.low.unwrap() < 5.0 && 5.0 < exponent.interval.high.unwrap());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CalibrateError`] as for [`calibrate`](super::calibrate), of data that are not those of the calibration, and once `watch` ends it.
pub fn profile(
    data: &CalibrationData,
    calibration: &Calibration,
    watch: &mut dyn Watch,
) -> Result<Vec<ParameterProfile>, CalibrateError> {
    let material = &calibration.material;
    let data = &*data.with_law(material.candidate().equilibrium);
    let prepared = Prepared::new(material.candidate(), data)?;
    let best = &calibration.theta;
    let problem = Problem::of(&prepared, data);
    let least = sum_of_squares(&problem.residuals(best).ok_or(CalibrateError::NoStiffness)?);
    let freedom = (data.fitted() - calibration.free_parameters) as f64;
    let mut stages = Stages::new("following the profiles".to_owned(), watch);
    let ends = 2.0 * material.parameters().len() as f64;
    let of = |(parameter, known): (usize, &MaterialParameter)| {
        let (Some(error), Some((_, high))) = (known.estimate.white_standard_error, known.estimate.interval) else {
            return Ok(None);
        };
        let Some(searched) = follower(&prepared, material, best, parameter) else {
            return Ok(None);
        };
        let half = (high / known.estimate.value).ln();
        let profile = Profile {
            problem: &problem,
            best,
            least,
            freedom,
            searched,
            parameter,
            log: known.estimate.value.ln(),
            half,
            target: half / (error / known.estimate.value),
        };
        let mut end = |side: f64| {
            stages.enter(1.0 / ends);
            if half > 0.0 && profile.target.is_finite() { profile.end(side, &mut stages) } else { Ok(None) }
        };
        let (low, high) = (end(-1.0)?, end(1.0)?);
        Ok::<_, Cancelled>(Some(ParameterProfile {
            name: known.name.clone(),
            interval: Interval { low, high },
        }))
    };
    let found: Vec<ParameterProfile> = material
        .parameters()
        .iter()
        .enumerate()
        .map(of)
        .filter_map(Result::transpose)
        .collect::<Result<_, _>>()?;
    stages.finish()?;
    Ok(found)
}

/// The searched parameter that follows when a parameter of the material is held.
fn follower(prepared: &Prepared, material: &Material, theta: &[f64], parameter: usize) -> Option<usize> {
    let name = material.parameters()[parameter].name.as_str();
    let named = |wanted: &str| prepared.searched.iter().position(|searched| searched.name == wanted);
    match name {
        "rate_coefficient_per_s" => named("reference_rate"),
        "layer_thickness_m" => named("overshoot"),
        _ if name.starts_with("equilibrium_force") => Some(0),
        _ if name.starts_with("time_constant_") || name.starts_with("overshoot_") => {
            // Terms stand in the order of their times; those that are searched in any.
            let value = material.parameters()[parameter].estimate.value;
            let is_time = name.starts_with("time_constant_");
            let log = if is_time { -value.ln() } else { value.ln() };
            let kind = if is_time { "rate_" } else { "overshoot_" };
            let terms = prepared.searched.iter().enumerate().filter(|(_, searched)| searched.name.starts_with(kind));
            terms
                .map(|(index, _)| index)
                .min_by(|a, b| (theta[*a] - log).abs().total_cmp(&(theta[*b] - log).abs()))
        }
        _ => named(name),
    }
}

/// χ² over one parameter.
struct Profile<'a> {
    problem: &'a Problem<'a>,
    best: &'a [f64],
    least: f64,
    freedom: f64,
    searched: usize,
    parameter: usize,
    /// ln of the best value.
    log: f64,
    /// Half width of the usual interval, in logarithms.
    half: f64,
    /// z at an end.
    target: f64,
}

impl Profile<'_> {
    /// z with the parameter held at a distance, and the other parameters then; `None` beyond where parameters are sought.
    fn at(&self, distance: f64, near: &[f64], stages: &mut Stages<'_>) -> Result<Option<(f64, Vec<f64>)>, Cancelled> {
        let held = Held {
            searched: self.searched,
            parameter: self.parameter,
            log: self.log + distance,
        };
        let problem = Problem {
            held: Some(held),
            ..*self.problem
        };
        let Some(found) = problem.descend(near, MOST_STEPS, stages)? else {
            return Ok(None);
        };
        let more = (found.square / self.least - 1.0).max(0.0);
        let bounds = &self.problem.prepared.searched[self.searched];
        let within = |theta: &Vec<f64>| theta[self.searched] > bounds.low && theta[self.searched] < bounds.high;
        let theta = held.completed(self.problem.prepared, &found.theta).filter(within);
        Ok(theta.map(|theta| ((more * self.freedom).sqrt(), theta)))
    }

    /// The end on one side, as a value; `None` where it is open.
    fn end(&self, side: f64, stages: &mut Stages<'_>) -> Result<Option<f64>, Cancelled> {
        let mut near = (0.0, 0.0, self.best.to_vec());
        let mut distance = self.half;
        // Outwards until the bound is passed.
        let mut far = loop {
            let Some((z, theta)) = self.at(side * distance, &near.2, stages)? else {
                return Ok(None);
            };
            if z >= self.target {
                break (distance, z);
            }
            if distance >= FARTHEST {
                return Ok(None);
            }
            let slope = z / distance;
            near = (distance, z, theta);
            distance = (1.1 * self.target / slope).clamp(1.3 * distance, 4.0 * distance).min(FARTHEST);
        };
        // z is nearly straight: false position, with a bisection where it would creep.
        let mut stuck = 0;
        while far.0 - near.0 > CLOSE * far.0 && stuck < 40 {
            stuck += 1;
            let width = far.0 - near.0;
            let straight = near.0 + width * (self.target - near.1) / (far.1 - near.1);
            let inside = straight.clamp(near.0 + 0.02 * width, far.0 - 0.02 * width);
            let next = if stuck % 3 == 0 { near.0 + 0.5 * width } else { inside };
            let Some((z, theta)) = self.at(side * next, &near.2, stages)? else {
                return Ok(None);
            };
            if (z - self.target).abs() < 0.5 * CLOSE * self.target {
                return Ok(Some((self.log + side * next).exp()));
            }
            if z < self.target {
                near = (next, z, theta);
            } else {
                far = (next, z);
            }
        }
        Ok(Some((self.log + 0.5 * side * (near.0 + far.0)).exp()))
    }
}
