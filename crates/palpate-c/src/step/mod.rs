//! Steps: of one contact (`one.rs`), and of many in place (`many.rs`).

mod many;
mod one;

pub use many::{Many, palpate_step_force_many, palpate_step_many};
pub use one::{palpate_step, palpate_step_force, palpate_step_force_message, palpate_step_message};
