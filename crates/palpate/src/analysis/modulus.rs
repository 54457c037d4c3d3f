//! The modulus that the relaxed forces imply.

use serde::{Deserialize, Serialize};

use super::{AnalysisOptions, Geometry};
use crate::contact::Specimen;
use crate::identify::{ExponentChoice, fit_hold};
use crate::record::Record;
use crate::segment::{After, Phase, Segmentation};
use crate::statistics::median;

/// Where the modulus comes from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ModulusSource {
    /// Given by the user.
    Given,
    /// Estimated from the relaxed forces of the holds.
    Estimated,
}

/// E from the holds after loading: least squares of F_e = E · A(u₁) · u₁/depth, which is equation (11) at equilibrium.
///
/// F_e of each hold is the relaxed force of a fit with the middle listed exponent (the last force where that fit did not
/// end well). `None` if no hold has an area, or the forces are negative.
pub(super) fn implied_modulus(
    record: &Record,
    segmentation: &Segmentation,
    geometry: &Geometry,
    options: &AnalysisOptions,
) -> Option<f64> {
    let body = Specimen::new(geometry.shape, 1.0, geometry.sides).ok()?;
    let displacement = record.displacement()?;
    let exponent = options.exponents.get(options.exponents.len() / 2).copied().unwrap_or(3.0);
    let (mut square, mut shared) = (0.0, 0.0);
    let holds = segmentation.segments.iter().filter(|s| s.phase == Phase::Hold && s.after == Some(After::Loading));
    for hold in holds {
        let range = hold.fit_start..hold.end;
        let every = range.len().div_ceil(2000).max(1);
        let times: Vec<f64> = range.clone().step_by(every).map(|i| record.time()[i]).collect();
        let force: Vec<f64> = range.clone().step_by(every).map(|i| record.force()[i]).collect();
        let last = force[force.len() - 1];
        let relaxed = match fit_hold(&times, &force, ExponentChoice::Fixed(exponent), &options.fit) {
            Ok(fit) if fit.termination.is_good() => fit.equilibrium.value,
            _ => last,
        };
        let u = body.contact_displacement(median(&mut displacement[range].to_vec()));
        let unit_force = body.force(body.equilibrium_strain(u), u);
        square += unit_force * unit_force;
        shared += unit_force * relaxed;
    }
    let modulus = shared / square;
    (modulus.is_finite() && modulus > 0.0).then_some(modulus)
}
