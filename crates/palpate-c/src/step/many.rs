//! Many contacts at once, in place.

use super::one::{Drive, stepped};
use crate::call::{Status, guarded, shared, write};
use crate::model::Model;
use crate::state::State;

/// Contacts that are stepped by one call, over arrays of the caller.
///
/// A stride is the distance in bytes between an entry and the next, as in NumPy; 0 makes the first entry stand for all contacts. So states may
/// be parts of a larger struct. Entries must be aligned as their type is.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Many {
    /// Number of contacts.
    pub count: usize,
    /// Pointers to models, one a contact or one for all.
    pub models: *const *const Model,
    /// Bytes from one of them to the next.
    pub model_stride: usize,
    /// States, one a contact.
    pub states: *mut State,
    /// Bytes from one of them to the next, at least the size of a state.
    pub state_stride: usize,
    /// Time steps in s.
    pub dt_s: *const f64,
    /// Bytes from one of them to the next.
    pub dt_stride: usize,
    /// Where the steps end: displacements of the jaws in m, or forces in N.
    pub to: *const f64,
    /// Bytes from one of them to the next.
    pub to_stride: usize,
    /// Results, `count` of them side by side: forces in N, or displacements of the jaws in m; those of refused steps stay as they are. May be
    /// null.
    pub results: *mut f64,
    /// Codes of the contacts, `count` of them side by side. May be null.
    pub statuses: *mut Status,
}

/// An entry of an array with a stride.
///
/// # Safety
/// Entries 0 to `index` lie within one object.
unsafe fn entry<T>(first: *const T, stride: usize, index: usize) -> *const T {
    // SAFETY: by the contract of this function.
    unsafe { first.byte_add(stride * index) }
}

impl Many {
    fn has_arrays(&self) -> bool {
        !(self.models.is_null() || self.states.is_null() || self.dt_s.is_null() || self.to.is_null())
    }

    /// Steps one contact.
    ///
    /// # Safety
    /// As for [`palpate_step_many`]; the arrays are not null, and `index` is below their count.
    unsafe fn one(&self, index: usize, drive: fn(f64) -> Drive) -> Result<f64, Status> {
        // SAFETY: by the contract of this function, for this and all blocks below.
        let model = unsafe { entry(self.models, self.model_stride, index) };
        // SAFETY: a valid entry of an array of pointers.
        let model = unsafe { model.read() };
        // SAFETY: a pointer to a model, or null.
        let model = unsafe { shared(model) }?;
        // SAFETY: the array of states.
        let state = unsafe { entry(self.states.cast_const(), self.state_stride, index) };
        // SAFETY: a valid entry, and nothing else uses it.
        let state = unsafe { &mut *state.cast_mut() };
        // SAFETY: the array of time steps.
        let dt = unsafe { entry(self.dt_s, self.dt_stride, index) };
        // SAFETY: a valid entry.
        let dt = unsafe { dt.read() };
        // SAFETY: the array of ends.
        let to = unsafe { entry(self.to, self.to_stride, index) };
        // SAFETY: a valid entry.
        let to = unsafe { to.read() };
        stepped(model, state, dt, drive(to))
    }

    /// Steps all contacts.
    ///
    /// # Safety
    /// As for [`palpate_step_many`].
    unsafe fn step(&self, drive: fn(f64) -> Drive) -> Result<(), Status> {
        if self.count == 0 {
            return Ok(());
        }
        if !self.has_arrays() {
            return Err(Status::NullPointer);
        }
        let mut refused = false;
        for index in 0..self.count {
            // SAFETY: the arrays are not null, and have `count` entries by the contract of this function.
            let stepped = unsafe { self.one(index, drive) };
            let status = match stepped {
                Ok(result) if !self.results.is_null() => {
                    // SAFETY: within the results.
                    let place = unsafe { self.results.add(index) };
                    // SAFETY: valid for writing.
                    unsafe { write(place, result) };
                    Status::Ok
                }
                Ok(_) => Status::Ok,
                Err(status) => status,
            };
            refused |= status != Status::Ok;
            if !self.statuses.is_null() {
                // SAFETY: within the codes.
                let place = unsafe { self.statuses.add(index) };
                // SAFETY: valid for writing.
                unsafe { write(place, status) };
            }
        }
        if refused { Err(Status::SomeRefused) } else { Ok(()) }
    }
}

/// # Safety
/// As for [`palpate_step_many`].
unsafe fn step_many(many: *const Many, drive: fn(f64) -> Drive) -> Status {
    guarded(|| {
        // SAFETY: by the contract of this function.
        let many = unsafe { shared(many) }?;
        // SAFETY: the same.
        unsafe { many.step(drive) }
    })
}

/// Moves many jaws to their displacements within their time steps, each as `palpate_step` does.
///
/// A contact that cannot be stepped stays as it was, has its own code and no new result; the others are stepped, and the call returns
/// PALPATE_STATUS_SOME_REFUSED.
///
/// # Safety
/// `many` is null or valid; its arrays are null or have `count` entries at their strides, and nothing else uses states, results and codes
/// meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_step_many(many: *const Many) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { step_many(many, Drive::Displacement) }
}

/// Brings many forces to their values within their time steps, each as `palpate_step_force` does; otherwise as `palpate_step_many`.
///
/// # Safety
/// As for `palpate_step_many`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_step_force_many(many: *const Many) -> Status {
    // SAFETY: by the contract of this function.
    unsafe { step_many(many, Drive::Force) }
}
