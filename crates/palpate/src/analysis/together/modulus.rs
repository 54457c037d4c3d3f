//! The modulus that the equilibrium forces imply.

use serde::{Deserialize, Serialize};

use crate::analysis::options::{AnalysisOptions, Geometry};
use crate::contact::Specimen;
use crate::fit::{ExponentChoice, LatencyFit, fit_hold, select_order};
use crate::record::Record;
use crate::segment::{After, ContactPoint, Phase, Segment, Segmentation};
use crate::statistics::{effective_count, lag_one_correlation, median, noise};

/// Where the modulus comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModulusSource {
    /// Given by the user.
    Given,
    /// Estimated from the equilibrium forces of the holds.
    Estimated,
}

/// A modulus from equilibrium forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::analysis) struct ImpliedModulus {
    /// E, Pa.
    pub(in crate::analysis) value: f64,
    /// Its standard error, Pa; `None` where no fit gave the equilibrium forces.
    pub(in crate::analysis) standard_error: Option<f64>,
}

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

/// E from the first loading ramp by least squares of F = E g(u₁), with g the equilibrium force of the body at 1 Pa and first touch where it was
/// found: E = Σ g F/Σ g². `None` without a body or such a ramp.
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
    let samples = ramp.start.max(touch)..ramp.end;
    let (displacement, force) = (&displacement[samples.clone()], &record.force()[samples]);
    // Displacements are counted from a touch that may lie by `off` (m) elsewhere.
    let units = |off: f64| {
        let unit = |travel: &f64| {
            let u = body.contact_displacement(travel + off).max(0.0);
            body.force(body.equilibrium_strain(u), u)
        };
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
    let standard_error = (left / (independent - 1.0) / square).sqrt().hypot(by_touch);
    let largest = force.iter().fold(0.0, |most: f64, force| most.max(*force));
    let found = LoadingModulus {
        value,
        standard_error,
        relative_rmse: (left / residuals.len() as f64).sqrt() / largest,
    };
    let is_sound =
        residuals.len() >= FEWEST && value > 0.0 && (value + standard_error + found.relative_rmse).is_finite();
    is_sound.then_some(found)
}

/// A hold in contact: the force that a body of 1 Pa would keep, and the fits to the measured one.
struct RelaxedHold {
    unit_force: f64,
    last: f64,
    after_loading: bool,
    fits: Vec<LatencyFit>,
}

/// E from the holds: weighted least squares of F_e = E g(u₁), with g the equilibrium force of the body at 1 Pa: A(u₁) u₁/depth in
/// equation (11).
///
/// F_e is where the force of each hold tends to by the law with the exponent that all holds have in common; it needs no E,
/// since force and strain of a hold differ by a factor. Holds whose fit did not end well do not count; the others count by
/// the standard error of their F_e, and the error of E is widened where they scatter by more. Where nothing can be fitted
/// (a body that does not relax) the last forces of the holds after loading stand in. `None` if no hold has an area, or the
/// forces are negative.
pub(in crate::analysis) fn implied_modulus(
    record: &Record,
    segmentation: &Segmentation,
    geometry: &Geometry,
    options: &AnalysisOptions,
) -> Option<ImpliedModulus> {
    let body = geometry.specimen(1.0).ok()?;
    let displacement = record.displacement()?;
    let holds: Vec<RelaxedHold> = segmentation
        .holds()
        .filter_map(|hold| relaxed_hold(record, displacement, hold, &body, options))
        .collect();
    let common = common_choice(&holds, options);
    let relaxed = |hold: &RelaxedHold| {
        let fit = hold.fits.iter().find(|fit| Some(fit.choice()) == common)?;
        let error = fit.equilibrium().standard_error.filter(|_| fit.termination.is_good())?;
        // Noise-free holds leave rounding only, which is no measure of their weight.
        let floor = 1e-9 * (fit.equilibrium().value.abs() + fit.amplitude().value.abs());
        Some((hold.unit_force, fit.equilibrium().value, error.max(floor)))
    };
    let points: Vec<(f64, f64, f64)> = holds.iter().filter_map(relaxed).collect();
    let implied = if points.is_empty() {
        let loaded = holds.iter().filter(|hold| hold.after_loading);
        let last: Vec<(f64, f64, f64)> = loaded.map(|hold| (hold.unit_force, hold.last, 1.0)).collect();
        ImpliedModulus {
            standard_error: None,
            ..weighted(&last)
        }
    } else {
        weighted(&points)
    };
    (implied.value.is_finite() && implied.value > 0.0).then_some(implied)
}

/// E = Σ w g F/Σ w g² with w = 1/σ², g the force at 1 Pa; its variance 1/Σ w g², times χ² per freedom where that exceeds 1.
fn weighted(points: &[(f64, f64, f64)]) -> ImpliedModulus {
    let (mut square, mut shared) = (0.0, 0.0);
    for (unit, force, error) in points {
        square += (unit / error).powi(2);
        shared += unit * force / (error * error);
    }
    let value = shared / square;
    let chi: f64 = points.iter().map(|(unit, force, error)| ((force - value * unit) / error).powi(2)).sum();
    let freedom = (points.len() as f64 - 1.0).max(1.0);
    ImpliedModulus {
        value,
        standard_error: Some(((chi / freedom).max(1.0) / square).sqrt()),
    }
}

/// The fits to the force of a hold; `None` where the jaw may not touch the body.
fn relaxed_hold(
    record: &Record,
    displacement: &[f64],
    hold: &Segment,
    body: &Specimen,
    options: &AnalysisOptions,
) -> Option<RelaxedHold> {
    debug_assert_eq!(hold.phase, Phase::Hold);
    let range = hold.fit_start..hold.end;
    let every = range.len().div_ceil(2000).max(1);
    let start = record.time()[range.start];
    let times: Vec<f64> = range.clone().step_by(every).map(|i| record.time()[i] - start).collect();
    let force: Vec<f64> = range.clone().step_by(every).map(|i| record.force()[i]).collect();
    let after_loading = hold.after == Some(After::Loading);
    // A jaw that retreats may leave the body, and the force of an open contact says nothing about the modulus.
    let lowest = force.iter().fold(f64::MAX, |least, f| least.min(*f));
    let u = body.contact_displacement(median(&mut displacement[range].to_vec()));
    let unit_force = body.force(body.equilibrium_strain(u), u);
    if unit_force <= 0.0 || !(after_loading || lowest > 5.0 * noise(&force)) {
        return None;
    }
    let until = options.fitted(&times);
    let fit = |choice| fit_hold(&times[..until], &force[..until], choice, &options.fit).ok();
    Some(RelaxedHold {
        unit_force,
        last: *force.last()?,
        after_loading,
        fits: options.choices().filter_map(fit).collect(),
    })
}

/// The lowest listed exponent whose criteria, summed over the holds, are within 2 of the lowest sum; a free one where that
/// beats all listed ones by more than 2.
fn common_choice(holds: &[RelaxedHold], options: &AnalysisOptions) -> Option<ExponentChoice> {
    let requested: Vec<ExponentChoice> = options.choices().collect();
    let mut sums = vec![0.0; requested.len()];
    let mut counted = 0;
    for hold in holds.iter().filter(|hold| hold.fits.len() == requested.len()) {
        counted += 1;
        let order = select_order(&hold.fits);
        sums.iter_mut().zip(&order.candidates).for_each(|(sum, candidate)| *sum += candidate.delta_bic);
    }
    let lowest = sums.iter().copied().fold(f64::INFINITY, f64::min);
    let good = requested.iter().zip(&sums).filter(|(_, sum)| counted > 0 && **sum - lowest <= 2.0);
    let number = |choice: &ExponentChoice| match choice {
        ExponentChoice::Fixed(n) => *n,
        ExponentChoice::Free => f64::INFINITY,
    };
    good.map(|(choice, _)| *choice).min_by(|a, b| number(a).total_cmp(&number(b)))
}
