//! One step by displacement or by force.

use std::ffi::c_char;

use palpate::simulate::{ContactState, StepError};

use crate::call::{Message, Status, exclusive, guarded, shared, write};
use crate::model::Model;
use crate::state::State;

/// What drives a step; the number is that at its end.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Drive {
    /// Displacement of the jaw, m.
    Displacement(f64),
    /// Force, N.
    Force(f64),
}

impl Drive {
    fn step(self, contact: &mut ContactState, model: &Model, dt: f64) -> Result<f64, StepError> {
        match self {
            Self::Displacement(to) => contact.step(&model.contact, dt, to),
            Self::Force(to) => contact.step_force(&model.contact, dt, to),
        }
    }
}

/// Steps a state, or leaves it as it is. What results is finite.
pub(crate) fn stepped(model: &Model, state: &mut State, dt: f64, drive: Drive) -> Result<f64, Status> {
    let mut contact = state.contact_of(model)?;
    let result = drive.step(&mut contact, model, dt)?;
    let next = State::from(contact);
    if !(result.is_finite() && next.jaw_m.is_finite() && next.behind_m.is_finite()) {
        return Err(Status::Range);
    }
    *state = next;
    Ok(result)
}

/// # Safety
/// Each pointer is null or valid; nothing else uses the state meanwhile.
unsafe fn step(model: *const Model, state: *mut State, dt: f64, drive: Drive, result: *mut f64) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let model = unsafe { shared(model) }?;
        // SAFETY: the same.
        let state = unsafe { exclusive(state) }?;
        let found = stepped(model, state, dt, drive)?;
        // SAFETY: the same.
        unsafe { write(result, found) };
        Ok(())
    })
}

/// Moves the jaw to `displacement_m` (since first touch) within `dt_s` (0 or more) and writes the force at the end in N.
///
/// Of a body squeezed from two sides the displacement is that of both jaws together, and each contact takes half of it. `force_n` may be null.
/// A step of 0 s takes the motion at once. Refused steps leave the state as it was.
///
/// # Safety
/// Each pointer is null or valid; nothing else uses the state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_step(
    model: *const Model,
    state: *mut State,
    dt_s: f64,
    displacement_m: f64,
    force_n: *mut f64,
) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { step(model, state, dt_s, Drive::Displacement(displacement_m), force_n) }
}

/// Brings the force to `force_n` within `dt_s` (0 or more) and writes the displacement of the jaw at the end in m.
///
/// `displacement_m` may be null. Refused steps leave the state as it was.
///
/// # Safety
/// Each pointer is null or valid; nothing else uses the state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_step_force(
    model: *const Model,
    state: *mut State,
    dt_s: f64,
    force_n: f64,
    displacement_m: *mut f64,
) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { step(model, state, dt_s, Drive::Force(force_n), displacement_m) }
}

/// # Safety
/// Each pointer is null or valid, `message` for `capacity` bytes; nothing else uses the state or the message meanwhile.
unsafe fn explain(
    (model, state): (*const Model, *const State),
    dt: f64,
    drive: Drive,
    (message, capacity): (*mut c_char, usize),
) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let mut message = unsafe { Message::into(message, capacity) };
        // SAFETY: the same.
        let model = unsafe { shared(model) }?;
        // SAFETY: the same.
        let mut state = *unsafe { shared(state) }?;
        if let Err(error) = state.contact_of(model).and_then(|mut contact| drive.step(&mut contact, model, dt)) {
            message.set(format_args!("{error}"));
        }
        stepped(model, &mut state, dt, drive).map(drop)
    })
}

/// Writes why `palpate_step` refuses such a step: what was expected and what was found, at most `capacity` bytes with the closing zero.
///
/// It writes an empty message where the step would be taken. The state stays as it is. Returns what `palpate_step` would.
///
/// # Safety
/// Each pointer is null or valid, `message` for `capacity` bytes; nothing writes to the state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_step_message(
    model: *const Model,
    state: *const State,
    dt_s: f64,
    displacement_m: f64,
    message: *mut c_char,
    capacity: usize,
) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { explain((model, state), dt_s, Drive::Displacement(displacement_m), (message, capacity)) }
}

/// Writes why `palpate_step_force` refuses such a step, as `palpate_step_message` does.
///
/// # Safety
/// Each pointer is null or valid, `message` for `capacity` bytes; nothing writes to the state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_step_force_message(
    model: *const Model,
    state: *const State,
    dt_s: f64,
    force_n: f64,
    message: *mut c_char,
    capacity: usize,
) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { explain((model, state), dt_s, Drive::Force(force_n), (message, capacity)) }
}
