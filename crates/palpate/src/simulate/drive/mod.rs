//! What drives a contact: a motion of the jaw, a force, or a program of steps in both.
//!
//! | file | what |
//! |---|---|
//! | `motion.rs` | the displacement of the jaw: a protocol's steps, or a measured series; straight between its knots |
//! | `history.rs` | the force on the contact, straight between its knots |
//! | `program.rs` | steps in displacement and in force, one after the other |
//! | `any.rs` | any of them |

mod any;
mod history;
mod motion;
mod program;

pub use any::Drive;
pub use history::ForceHistory;
pub use motion::{Motion, MotionError, ProtocolStep, protocol};
pub use program::ProgramStep;
