//! Goes through a drive piece by piece: in contact, jaw off, in contact again.
//!
//! A drive comes in with the layer of a contact, stretches go out to whoever visits them: series, energy, a summary.
//!
//! | file | what |
//! |---|---|
//! | `course.rs` | a drive with the times of its knots, and the walk through it |
//! | `walker.rs` | along straight pieces of motion and of force, where the body can be requested them |
//! | `program.rs` | through the steps of a program |
//! | `stretch.rs` | contacts lost and regained, and the stretches between, in which nothing changes its course |

mod course;
mod program;
mod stretch;
mod walker;

pub(super) use course::{Course, walk};
pub use program::{StepEnd, step_ends};
pub use stretch::{ContactEvent, ContactEventKind};
pub(super) use stretch::{Stretch, StretchState};
use walker::{Walker, check_force};
