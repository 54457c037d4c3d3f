//! First touch and the zero of the force.
//!
//! | file | what |
//! |---|---|
//! | `contact_point.rs` | which rule holds, and what it gives |
//! | `early_rise.rs` | where the first part of a ramp begins, whatever relaxes in it |
//! | `estimators.rs` | first touch by rules that know no law |
//! | `loading_curve.rs` | the force of a first ramp under the law, and where it begins |
//! | `tilt.rs` | a force without contact that follows a line over the travel |

mod contact_point;
mod early_rise;
mod estimators;
mod loading_curve;
mod tilt;

pub use contact_point::{ContactChoice, ContactPoint, ForceDrift, find_contact_of, free_samples};
pub use estimators::{TouchEstimate, TouchMethod};
pub use tilt::BaselineTilt;
