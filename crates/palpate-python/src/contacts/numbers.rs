//! The numbers of a contact, for its step in other frameworks.

use palpate::contact::{Equilibrium, Shape};
use palpate::simulate::Separation;
use pyo3::prelude::*;

use super::described::described;
use crate::errors::{ModelError, refused_plainly};

/// Modulus (Pa), depth (m), layers, radius of a round body (m; 0 of another), section of a body of constant section (m²; 0 of another),
/// exponent, rate coefficient (1/s), share of the displacement that one contact takes, and whether it is bonded: the fields of
/// `ContactParameters`.
#[pyfunction]
pub(crate) fn _contact_numbers(model: &Bound<'_, PyAny>) -> PyResult<[f64; 9]> {
    let (model, _) = described(model)?;
    let specimen = &model.specimen;
    let (radius, area) = match specimen.shape() {
        Shape::Ball { radius } | Shape::Pad { radius, .. } => (*radius, 0.0),
        Shape::Prism { area, .. } => (0.0, *area),
        Shape::Profile { .. } | Shape::Indenter { .. } => {
            return Err(refused_plainly::<ModelError>(
                "specimen.shape: expected a body that a twin has, ball, pad, strip, cylinder or block, found another",
            ));
        }
    };
    if *specimen.equilibrium() != Equilibrium::UniformStrain {
        let message = "specimen: expected the force of uniform strain, the only one that a twin has, found another";
        return Err(refused_plainly::<ModelError>(message));
    }
    Ok([
        specimen.modulus(),
        specimen.depth(),
        model.layers.count(),
        radius,
        area,
        model.law.exponent(),
        model.law.rate_coefficient(),
        specimen.contact_displacement(1.0),
        f64::from(u8::from(model.separation == Separation::Bonded)),
    ])
}
