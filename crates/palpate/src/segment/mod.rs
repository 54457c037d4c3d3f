//! Phases of a test found without labels: loading, hold, unloading; first touch; Type I and Type II.
//!
//! A checked `Record` comes in; its `Segmentation` and `ContactPoint` go out. Neither changes the record.
//!
//! | file | what |
//! |---|---|
//! | `segmentation.rs` | the phases of a record, and what else was found with them |
//! | `error.rs` | why no phases were found |
//! | `standstill/` | where a column stands still |
//! | `mode.rs` | what is held: the displacement, the force, or neither |
//! | `force_alone/` | holds and ramps by the shape of a force |
//! | `phases/` | the record cut into loading, hold and unloading |
//! | `relaxation.rs` | Type I or Type II, with its probability |
//! | `touch/` | first touch and the zero of the force |

use crate::watch::{Cancelled, Progress, Watch};

mod error;
mod force_alone;
mod mode;
mod phases;
mod relaxation;
mod segmentation;
mod standstill;
mod touch;

/// Share of its range by which a jaw wanders about what it holds.
const SERVO: f64 = 0.002;
/// Share of its range by which a force wanders that a controller holds.
const CONTROLLER: f64 = 0.02;

pub use error::SegmentError;
pub(crate) use mode::{OBSERVED, PARTS, change, creeps, error_of_mean};
use mode::{mode, mode_at_large};
pub(crate) use phases::{ForceDelay, force_delay, ramps_alone, stands_in};
pub use phases::{GivenHold, find_phases, phases_watched, phases_with};
pub use relaxation::{Relaxation, RelaxationType, classify_relaxation};
pub(crate) use segmentation::ramps_before;
pub use segmentation::{
    After, FitStartRule, HoldMode, HoldStart, LabelCheck, Phase, Ripple, Rupture, Segment, SegmentOptions,
    SegmentSettings, Segmentation,
};
use standstill::{Held, Level, Levels, levels};
pub use touch::{
    BaselineTilt, ContactChoice, ContactPoint, ForceDrift, TouchEstimate, TouchMethod, find_contact_of, free_samples,
};

/// Reports that the search goes on.
fn hear(watch: &mut dyn Watch) -> Result<(), Cancelled> {
    watch.report(Progress::open("finding the phases", 0))
}
