//! Goes through a drive piece by piece: in contact, jaw off, in contact again.
//!
//! A drive comes in with the layer of a contact, stretches go out to whoever visits them: series, energy, a summary.
//!
//! | file | what |
//! |---|---|
//! | `course.rs` | a drive with the times of its knots |
//! | `whole.rs` | through whatever drives a contact |
//! | `walker.rs` | along straight pieces of motion and of force |
//! | `program.rs` | through the steps of a program |
//! | `stretch.rs` | a stretch of time in which nothing changes its course |
//! | `event.rs` | contacts lost and regained |
//! | `checks.rs` | what a body can be asked for at all |

mod checks;
mod course;
mod event;
mod program;
mod stretch;
mod walker;
mod whole;

pub(super) use course::Course;
pub use event::{ContactEvent, ContactEventKind};
pub use program::{StepEnd, step_ends};
pub(super) use stretch::{Stretch, StretchState};
pub(super) use whole::walk;
