//! What drives a contact: a motion of the jaw, a force, or a program of steps in both.
//!
//! | file | what |
//! |---|---|
//! | `motion.rs` | the displacement of the jaw: a protocol's steps, or a measured series; straight between its knots |
//! | `measured.rs` | the motion that noisy samples of a displacement show |
//! | `hats.rs`, `bends.rs` | its knots by least squares; more of them along a curve |
//! | `history.rs` | the force on the contact, straight between its knots |
//! | `any.rs` | steps in displacement and in force, one after the other; any of the three |

mod any;
mod bends;
mod hats;
mod history;
mod measured;
mod motion;

pub use any::{Drive, ProgramStep};
pub use history::ForceHistory;
pub use measured::MeasuredMotion;
pub(crate) use measured::Resolution;
pub use motion::{Motion, MotionError, ProtocolStep, protocol};
