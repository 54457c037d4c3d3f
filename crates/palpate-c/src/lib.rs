//! The C interface of palpate: soft contact with memory, one step at a time, for simulators and controllers.
//!
//! A model is read once from a description or a material file and never changes, so that any number of threads may use it at once. A state is
//! a plain struct of two doubles that the caller owns, copies and keeps where it likes; all zeros are a body that nothing has touched yet. One
//! thread at a time may write to a state.
//!
//! Every function returns a [`Status`]; a call that does not return `PALPATE_STATUS_OK` has written nothing but its message. A null pointer, a
//! number that is not finite, a displacement beyond the body are refused by code. No panic leaves a function, and a step allocates nothing.
//!
//! | file | content |
//! |---|---|
//! | `call/` | codes, messages and pointers; what no panic passes |
//! | `model.rs` | a body with its law, from a file or a text |
//! | `state.rs` | the state, what it is at an instant, its bytes |
//! | `step/` | steps by displacement or by force, of one contact and of many in place |
//! | `version.rs` | versions of interface and library |
//!
//! `include/palpate.h` is the header, written by cbindgen; a test compares it with these sources.

mod call;
mod model;
mod state;
mod step;
mod version;

pub use call::{Status, palpate_status_text};
pub use model::{
    Model, palpate_model_calibrated_m, palpate_model_deepest_m, palpate_model_depth_m, palpate_model_free,
    palpate_model_from_file, palpate_model_from_text, palpate_model_is_bonded, palpate_model_sides,
};
pub use state::{
    PALPATE_STATE_BYTES, State, palpate_excess_strain, palpate_force, palpate_is_touching, palpate_state_restore,
    palpate_state_save, palpate_stiffness, palpate_surface,
};
pub use step::{
    Many, palpate_step, palpate_step_force, palpate_step_force_many, palpate_step_force_message, palpate_step_many,
    palpate_step_message,
};
pub use version::{PALPATE_ABI_VERSION, palpate_abi_version, palpate_version};
