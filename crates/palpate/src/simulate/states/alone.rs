//! One of many contacts of the latency law, where it is not stepped in vectors; and what is checked of any contact.

use super::block::{FARTHEST, between};
use crate::contact::Specimen;
use crate::simulate::step::check_step;
use crate::simulate::{ContactModel, ContactState, Separation, StepError};

/// A number, or 0 in the place of one that is none: what a contact shows whose state is none.
pub(super) fn finite(number: f64) -> f64 {
    if number.is_finite() { number } else { 0.0 }
}

/// The force that a contact shows which keeps its state (N), of what its formula gives at its jaw (m): 0 where the state is none.
pub(super) fn kept((specimen, separation): (&Specimen, Separation), jaw: f64, force: f64) -> f64 {
    match specimen.check_contact_displacement(jaw, separation == Separation::Bonded) {
        Ok(()) => finite(force),
        Err(_) => 0.0,
    }
}

/// Checks that a state is one: numbers near the body.
pub(super) fn check_state(numbers: &[f64], depth: f64) -> Result<(), StepError> {
    match numbers.iter().find(|number| !number.is_finite() || number.abs() >= FARTHEST * depth) {
        None => Ok(()),
        Some(found) => Err(StepError::Number {
            expected: "the numbers of a state must be finite, and displacements below a million depths of the body",
            found: *found,
        }),
    }
}

/// Checks that a contact can be moved to a displacement (m).
pub(super) fn check_move(
    model: &ContactModel,
    state: ContactState,
    (dt, to): (f64, f64),
    parts: u32,
) -> Result<(), StepError> {
    check_step(dt, "displacement must be a finite number", to)?;
    let specimen = &model.specimen;
    let u = specimen.contact_displacement(to);
    check_state(&[state.jaw, state.behind, u], specimen.depth())?;
    let bonded = model.separation == Separation::Bonded;
    for place in [between(state.jaw, u, (1, parts)), u] {
        specimen.check_contact_displacement(place, bonded)?;
    }
    Ok(())
}

/// A contact after a step of its displacement (m) in equal parts, and its force (N).
pub(super) fn moved_alone(
    model: &ContactModel,
    before: ContactState,
    (dt, to): (f64, f64),
    parts: u32,
) -> Result<(ContactState, f64), StepError> {
    check_move(model, before, (dt, to), parts)?;
    let share = model.specimen.contact_displacement(1.0);
    let (mut state, mut force) = (before, 0.0);
    for part in 1..=parts {
        let u = between(before.jaw, model.specimen.contact_displacement(to), (part, parts));
        force = state.step(model, dt / f64::from(parts), u / share)?;
    }
    check_result(&[force, state.jaw, state.behind])?;
    Ok((state, force))
}

/// A contact after a step of its force (N) in equal parts, and the displacement of its jaw (m).
pub(super) fn forced_alone(
    model: &ContactModel,
    before: ContactState,
    (dt, to): (f64, f64),
    parts: u32,
) -> Result<(ContactState, f64), StepError> {
    check_step(dt, "force must be a finite number", to)?;
    check_state(&[before.jaw, before.behind], model.specimen.depth())?;
    let (mut state, mut place, from) = (before, 0.0, before.force(model));
    for part in 1..=parts {
        place = state.step_force(model, dt / f64::from(parts), between(from, to, (part, parts)))?;
    }
    check_result(&[place, state.jaw, state.behind])?;
    // A force that goes with a state that no later step takes is none that the body carries.
    if check_state(&[state.jaw, state.behind], model.specimen.depth()).is_err() {
        return Err(StepError::Force { force: to });
    }
    Ok((state, place))
}

/// Checks that numbers that a step leaves behind are finite.
pub(super) fn check_result(numbers: &[f64]) -> Result<(), StepError> {
    match numbers.iter().find(|number| !number.is_finite()) {
        None => Ok(()),
        Some(found) => Err(StepError::Number {
            expected: "the result of a step must be a finite number",
            found: *found,
        }),
    }
}
