//! The modulus of the first loading ramp.

use serde::{Deserialize, Serialize};

use crate::analysis::options::Geometry;
use crate::record::Record;
use crate::segment::{ContactPoint, Phase, Segmentation};
use crate::statistics::{effective_count, lag_one_correlation};

/// Young's modulus of the first loading ramp, as force curves of atomic force microscopes and indenters give it: of a body that relaxes it is an
/// apparent modulus, which depends on the speed and lies above that of the equilibrium force.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LoadingModulus {
    /// E, Pa.
    pub value: f64,
    /// Its standard error, Pa: of the residuals with their correlation, and of first touch where that has one.
    pub standard_error: f64,
    /// Root mean square residual as a share of the largest force of the ramp: large where the body does not load by the law of its form.
    pub relative_rmse: f64,
}

/// Fewest samples of a ramp from which a modulus is taken.
const FEWEST: usize = 8;
/// How many times its standard error by the residuals a modulus must be: the force of a ramp that loads nothing drifts.
const OBSERVED: f64 = 3.0;

/// E from the first loading ramp, up to the sample at which the jaw arrives, by least squares of F = E g(u₁), with g the equilibrium force of the
/// body at 1 Pa and first touch where it was found: E = Σ g F/Σ g². `None` without a body or such a ramp, and where the force does not rise beyond its scatter.
pub(in crate::analysis) fn loading_modulus(
    record: &Record,
    segmentation: &Segmentation,
    contact: &ContactPoint,
    geometry: Option<&Geometry>,
) -> Option<LoadingModulus> {
    let body = geometry?.specimen(1.0).ok()?;
    let displacement = record.displacement()?;
    let touch = contact.sample.unwrap_or(0);
    let ramp = segmentation
        .segments
        .iter()
        .find(|segment| segment.phase == Phase::Loading && segment.end > touch)?;
    // The jaw still moves up to the sample at which it arrives, the first of the hold.
    let arrives = displacement.get(ramp.end).is_some_and(|there| *there > displacement[ramp.end - 1]);
    let samples = ramp.start.max(touch)..ramp.end + usize::from(arrives);
    let (displacement, force) = (&displacement[samples.clone()], &record.force()[samples]);
    // Displacements are counted from a touch that may lie by `off` (m) elsewhere.
    let units = |off: f64| {
        let unit = |travel: &f64| body.equilibrium_force(body.contact_displacement(travel + off).max(0.0));
        displacement.iter().map(unit).collect::<Vec<f64>>()
    };
    let modulus = |units: &[f64]| {
        let sum = |other: &[f64]| units.iter().zip(other).map(|(unit, other)| unit * other).sum::<f64>();
        (sum(force) / sum(units), sum(units))
    };
    let unit = units(0.0);
    let (value, square) = modulus(&unit);
    let residuals: Vec<f64> = force.iter().zip(&unit).map(|(force, unit)| force - value * unit).collect();
    let independent = effective_count(residuals.len(), lag_one_correlation(&residuals));
    let left = residuals.iter().map(|residual| residual * residual).sum::<f64>();
    let by_touch = contact.displacement_error.map_or(0.0, |error| modulus(&units(error)).0 - value);
    let by_residuals = (left / (independent - 1.0) / square).sqrt();
    let standard_error = by_residuals.hypot(by_touch);
    let largest = force.iter().fold(0.0, |most: f64, force| most.max(*force));
    let found = LoadingModulus {
        value,
        standard_error,
        relative_rmse: (left / residuals.len() as f64).sqrt() / largest,
    };
    let is_sound = residuals.len() >= FEWEST
        && value > OBSERVED * by_residuals
        && (value + standard_error + found.relative_rmse).is_finite();
    is_sound.then_some(found)
}
