//! From a motion of the jaw to the force of the contact.
//!
//! | file | what |
//! |---|---|
//! | `motion.rs` | the displacement of the jaw: a protocol's steps, or a measured series; straight between its knots |
//! | `history.rs` | the force on the contact, straight between its knots |
//! | `program.rs` | steps in displacement and in force, one after the other |
//! | `course.rs` | what drives a contact: a motion, a force history or a program |
//! | `model.rs` | the contact model: specimen, law, layers, and whether the jaw can pull |
//! | `varying.rs` | the same with a rate coefficient that depends on the state |
//! | `contact.rs` | a contact, whichever law it obeys |
//! | `layer.rs` | what the walk asks of the contact layer, whichever law it obeys |
//! | `walk.rs` | goes through a motion piece by piece: in contact, jaw off, in contact again |
//! | `trajectory.rs` | the series at the asked times |
//! | `wave.rs` | all layers over time (the strain wave) |
//! | `step.rs` | one step at a time, for controllers |
//! | `energy.rs` | work of the jaw, what is stored and what is lost |
//! | `linear/` | linear laws under the same drives |
//! | `cycles.rs` | the same step by step and cycle by cycle |
//! | `summary.rs` | what a whole simulation comes to, for sweeps |
//! | `error.rs` | why one could not run |

#[cfg(feature = "std")]
mod contact;
#[cfg(feature = "std")]
mod course;
#[cfg(feature = "std")]
mod cycles;
#[cfg(feature = "std")]
mod energy;
#[cfg(feature = "std")]
mod error;
#[cfg(feature = "std")]
mod history;
#[cfg(feature = "std")]
mod layer;
#[cfg(feature = "std")]
mod linear;
mod model;
#[cfg(feature = "std")]
mod motion;
#[cfg(feature = "std")]
mod program;
mod step;
#[cfg(feature = "std")]
mod summary;
#[cfg(feature = "std")]
mod trajectory;
#[cfg(feature = "std")]
mod varying;
#[cfg(feature = "std")]
mod walk;
#[cfg(feature = "std")]
mod wave;

pub use model::{ContactModel, Separation};
pub use step::{ContactState, StepError};

#[cfg(feature = "std")]
pub(crate) use walk::check_displacements;
#[cfg(feature = "std")]
pub use {
    crate::contact::Work,
    contact::{Contact, ContactRef},
    course::Drive,
    cycles::{Cycle, StepWork, cycles, work_by_step},
    energy::{Energy, EnergySplit, energy},
    error::SimulateError,
    history::ForceHistory,
    linear::{LinearContact, LinearLaw, LinearLawError, LinearTerm, Memory},
    motion::{Motion, MotionError, ProtocolStep, protocol},
    program::{ProgramStep, StepEnd, step_ends},
    summary::{Summary, summary},
    trajectory::{Sampling, Trajectory, simulate, simulate_force},
    walk::{ContactEvent, ContactEventKind},
    wave::{StrainWave, strain_wave, strain_wave_within},
};
