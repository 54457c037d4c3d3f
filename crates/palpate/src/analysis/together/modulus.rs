//! The modulus that the equilibrium forces imply.

use serde::{Deserialize, Serialize};

use crate::analysis::options::{AnalysisOptions, Geometry};
use crate::contact::Specimen;
use crate::fit::{ErrorParts, Estimate, ExponentChoice, LatencyFit, fit_hold, select_order};
use crate::instrument::{Deviation, Instrument, InstrumentInput};
use crate::record::Record;
use crate::segment::{After, ContactPoint, Phase, Segment, Segmentation};
use crate::statistics::{median, noise};

/// Where the modulus comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModulusSource {
    /// Given by the user.
    Given,
    /// Estimated from the equilibrium forces of the holds.
    Estimated,
}

/// A modulus that the equilibrium forces imply.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EstimatedModulus {
    /// E, Pa.
    pub estimate: Estimate,
    /// What its error is made of, where the instrument is described.
    pub parts: Option<ErrorParts>,
}

/// A modulus from equilibrium forces.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::analysis) struct ImpliedModulus {
    /// E, Pa.
    pub(in crate::analysis) value: f64,
    /// Its standard error, Pa; `None` where no fit gave the equilibrium forces.
    pub(in crate::analysis) standard_error: Option<f64>,
    /// The forces that it follows from.
    forces: Vec<RelaxedForce>,
}

/// The force that a hold tends to.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RelaxedForce {
    /// Displacement of the jaw, m.
    displacement: f64,
    /// F_e, N.
    force: f64,
    /// Its standard error, N.
    error: f64,
}

/// A hold in contact, and the fits to its force.
struct RelaxedHold {
    displacement: f64,
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
        Some(RelaxedForce {
            displacement: hold.displacement,
            force: fit.equilibrium().value,
            error: error.max(floor),
        })
    };
    let forces: Vec<RelaxedForce> = holds.iter().filter_map(relaxed).collect();
    let is_fitted = !forces.is_empty();
    let last = |hold: &RelaxedHold| RelaxedForce {
        displacement: hold.displacement,
        force: hold.last,
        error: 1.0,
    };
    let forces = match is_fitted {
        true => forces,
        false => holds.iter().filter(|hold| hold.after_loading).map(last).collect(),
    };
    let (value, error) = weighted(&forces, &body)?;
    Some(ImpliedModulus {
        value,
        standard_error: is_fitted.then_some(error),
        forces,
    })
}

impl ImpliedModulus {
    /// With the error that the scatter of the forces leaves.
    pub(in crate::analysis) fn estimate(&self) -> EstimatedModulus {
        EstimatedModulus {
            estimate: Estimate {
                standard_error: self.standard_error,
                ..Estimate::fixed(self.value)
            },
            parts: None,
        }
    }

    /// The same with the errors of first touch and of the zero of the force, where they were found.
    pub(in crate::analysis) fn estimate_beside(&self, geometry: &Geometry, contact: &ContactPoint) -> EstimatedModulus {
        let found = Instrument::default().with_found(contact.displacement_error, contact.force_error);
        let half = |input: &InstrumentInput| {
            let by = input.uncertainty.standard_uncertainty;
            let at = |by: f64| self.with(geometry, &Deviation::of(input.quantity, by));
            Some(0.5 * (at(by)? - at(-by)?))
        };
        let by_found = found.inputs.iter().filter_map(half).fold(0.0, f64::hypot);
        let mut modulus = self.estimate();
        modulus.estimate.standard_error = self.standard_error.map(|error| error.hypot(by_found));
        modulus
    }

    /// What the same holds imply with a quantity of the instrument off its estimate, Pa, at the temperature of the test; `None` where they
    /// imply none.
    pub(in crate::analysis) fn with(&self, geometry: &Geometry, deviation: &Deviation) -> Option<f64> {
        let body = geometry.with_shape(deviation.shape(&geometry.shape)).specimen(1.0).ok()?;
        let changed = |found: &RelaxedForce| RelaxedForce {
            displacement: deviation.displacement(found.displacement, found.force),
            force: deviation.force(found.force),
            ..*found
        };
        let forces: Vec<RelaxedForce> = self.forces.iter().map(changed).collect();
        Some(weighted(&forces, &body)?.0)
    }
}

/// E = Σ w g F/Σ w g² with w = 1/σ², g the force at 1 Pa; its variance 1/Σ w g², times χ² per freedom where that exceeds 1.
///
/// `None` unless E is above zero.
fn weighted(forces: &[RelaxedForce], body: &Specimen) -> Option<(f64, f64)> {
    let unit = |found: &RelaxedForce| unit_force(body, found.displacement);
    let (mut square, mut shared) = (0.0, 0.0);
    for found in forces {
        square += (unit(found) / found.error).powi(2);
        shared += unit(found) * found.force / (found.error * found.error);
    }
    let value = shared / square;
    let off = |found: &RelaxedForce| ((found.force - value * unit(found)) / found.error).powi(2);
    let chi: f64 = forces.iter().map(off).sum();
    let freedom = (forces.len() as f64 - 1.0).max(1.0);
    (value.is_finite() && value > 0.0).then(|| (value, ((chi / freedom).max(1.0) / square).sqrt()))
}

/// The force that a body of 1 Pa keeps at a displacement of the jaw (m), N.
fn unit_force(body: &Specimen, displacement: f64) -> f64 {
    body.equilibrium_force(body.contact_displacement(displacement))
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
    let displacement = median(&mut displacement[range].to_vec());
    if unit_force(body, displacement) <= 0.0 || !(after_loading || lowest > 5.0 * noise(&force)) {
        return None;
    }
    let until = options.fitted(&times);
    let fit = |choice| fit_hold(&times[..until], &force[..until], choice, &options.fit).ok();
    Some(RelaxedHold {
        displacement,
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
