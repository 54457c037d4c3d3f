//! The state of a contact, what it is at an instant, and its bytes.

use palpate::simulate::{ContactState, Separation, StepError};

use crate::call::{Status, exclusive, guarded, shared};
use crate::model::Model;

/// Length of the bytes of a state.
pub const PALPATE_STATE_BYTES: usize = 24;

const _: () = assert!(PALPATE_STATE_BYTES == ContactState::BYTES, "the library's own length");

/// The state of one contact: two doubles, to be copied and kept anywhere. All zeros are a body that nothing has touched yet.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct State {
    /// One contact's share of the displacement of the jaw, m.
    pub jaw_m: f64,
    /// Displacement of the node behind the contact layer, m.
    pub behind_m: f64,
}

impl State {
    /// The state of the library, if its numbers are finite.
    fn contact(self) -> Result<ContactState, StepError> {
        ContactState::from_displacements(self.jaw_m, self.behind_m)
    }

    /// The same of a contact of this model, whose jaw is not beyond the body.
    pub(crate) fn contact_of(self, Model { contact: model, .. }: &Model) -> Result<ContactState, StepError> {
        let contact = self.contact()?;
        model.specimen.check_contact_displacement(self.jaw_m, model.separation == Separation::Bonded)?;
        Ok(contact)
    }
}

impl From<ContactState> for State {
    fn from(contact: ContactState) -> Self {
        let (jaw_m, behind_m) = contact.displacements();
        Self { jaw_m, behind_m }
    }
}

/// Writes what a function of model and state says, a finite number.
///
/// # Safety
/// Each pointer is null or valid; nothing writes to model and state meanwhile.
unsafe fn look(
    (model, state): (*const Model, *const State),
    to: *mut f64,
    of: impl FnOnce(&Model, &ContactState) -> f64,
) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let model = unsafe { shared(model) }?;
        // SAFETY: the same.
        let state = unsafe { shared(state) }?;
        // SAFETY: the same.
        let to = unsafe { exclusive(to) }?;
        let found = of(model, &state.contact_of(model)?);
        if !found.is_finite() {
            return Err(Status::Range);
        }
        *to = found;
        Ok(())
    })
}

/// Contact force in N; 0 while the jaw is off.
///
/// # Safety
/// Each pointer is null or valid; nothing writes to model and state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_force(model: *const Model, state: *const State, force_n: *mut f64) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { look((model, state), force_n, |model, state| state.force(&model.contact)) }
}

/// Tangent stiffness in N/m: slope of the force against the displacement of the jaw for a step of 0 s; 0 while the jaw is off.
///
/// # Safety
/// Each pointer is null or valid; nothing writes to model and state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_stiffness(
    model: *const Model,
    state: *const State,
    stiffness_n_per_m: *mut f64,
) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { look((model, state), stiffness_n_per_m, |model, state| state.stiffness(&model.contact)) }
}

/// Strain of the contact layer in excess of equilibrium.
///
/// # Safety
/// Each pointer is null or valid; nothing writes to model and state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_excess_strain(
    model: *const Model,
    state: *const State,
    excess_strain: *mut f64,
) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { look((model, state), excess_strain, |model, state| state.excess_strain(&model.contact)) }
}

/// Displacement of the surface of the body at one contact in m: where the jaw is or, once it is off, the dent that remains.
///
/// # Safety
/// Each pointer is null or valid; nothing writes to model and state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_surface(model: *const Model, state: *const State, surface_m: *mut f64) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { look((model, state), surface_m, |model, state| state.surface(&model.contact)) }
}

/// Whether the jaw touches the body: 1, or 0.
///
/// # Safety
/// Each pointer is null or valid; nothing writes to model and state meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_is_touching(model: *const Model, state: *const State, touching: *mut i32) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let model = unsafe { shared(model) }?;
        // SAFETY: the same.
        let state = unsafe { shared(state) }?;
        // SAFETY: the same.
        let touching = unsafe { exclusive(touching) }?;
        *touching = i32::from(state.contact_of(model)?.is_touching(&model.contact));
        Ok(())
    })
}

/// Writes a state as PALPATE_STATE_BYTES bytes, the same on every machine.
///
/// # Safety
/// Each pointer is null or valid, `bytes` for PALPATE_STATE_BYTES bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_state_save(state: *const State, bytes: *mut u8) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let state = unsafe { shared(state) }?;
        // SAFETY: the same; an array of bytes has no alignment.
        let bytes = unsafe { exclusive(bytes.cast::<[u8; PALPATE_STATE_BYTES]>()) }?;
        *bytes = state.contact()?.to_bytes();
        Ok(())
    })
}

/// Reads a state from the bytes of `palpate_state_save`, to the last bit.
///
/// # Safety
/// Each pointer is null or valid, `bytes` for PALPATE_STATE_BYTES bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_state_restore(bytes: *const u8, state: *mut State) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function; an array of bytes has no alignment.
        let bytes = unsafe { shared(bytes.cast::<[u8; PALPATE_STATE_BYTES]>()) }?;
        // SAFETY: the same.
        let state = unsafe { exclusive(state) }?;
        *state = ContactState::from_bytes(*bytes)?.into();
        Ok(())
    })
}
