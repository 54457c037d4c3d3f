//! What a body can be asked for at all.

use crate::contact::Specimen;
use crate::simulate::layer::Layer;
use crate::simulate::{Motion, Separation, SimulateError};

/// Checks that a force can be asked for at all.
pub(in crate::simulate) fn check_force(time: f64, force: f64, model: &impl Layer) -> Result<(), SimulateError> {
    let bonded = model.is_bonded();
    if force < 0.0 && !(bonded && model.specimen().has_constant_section()) {
        return Err(SimulateError::Tension { time, force, bonded });
    }
    Ok(())
}

/// Checks that the body can take every displacement of a motion.
pub(super) fn check_displacements(
    motion: &Motion,
    specimen: &Specimen,
    separation: Separation,
) -> Result<(), SimulateError> {
    let bonded = separation == Separation::Bonded;
    for (&time, &displacement) in motion.times().iter().zip(motion.displacements()) {
        specimen
            .check_contact_displacement(specimen.contact_displacement(displacement), bonded)
            .map_err(|source| SimulateError::Displacement {
                time,
                displacement,
                source,
            })?;
    }
    Ok(())
}
