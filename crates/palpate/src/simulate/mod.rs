//! From a motion of the jaw to the force of the contact.
//!
//! A [`Drive`] and a [`Contact`] come in; out go a [`Trajectory`], its [`Energy`], a [`Summary`] of it, or the [`StrainWave`] of all layers.
//! Every law of the layer answers the same questions (`layer.rs`), so that the walk through a drive is written once.
//!
//! | file | what |
//! |---|---|
//! | `drive/` | what drives a contact: a motion, a force history or a program |
//! | `model.rs` | the contact model: specimen, law, layers, and whether the jaw can pull |
//! | `contact.rs` | a contact, whichever law it obeys |
//! | `layer.rs` | what the walk asks of the contact layer, whichever law it obeys |
//! | `latency.rs`, `linear/` | the contact layer by the latency law, and by linear laws |
//! | `walk/` | goes through a drive piece by piece: in contact, jaw off, in contact again |
//! | `trajectory.rs` | the series at the requested times |
//! | `energy.rs`, `cycles.rs` | work of the jaw, what is stored and what is lost; the same step by step and cycle by cycle |
//! | `summary.rs` | what a whole simulation comes to, for sweeps |
//! | `wave/` | all layers over time (the strain wave) |
//! | `step.rs` | one step at a time, for controllers; with `model.rs` and `stiffness.rs` all that there is without std |
//! | `stiffness.rs` | stiffness and excess strain of a contact at an instant |
//! | `states/` | many contacts, one step at a time, in place |
//! | `error.rs` | why one could not run |

#[cfg(feature = "std")]
mod contact;
#[cfg(feature = "std")]
mod cycles;
#[cfg(feature = "std")]
mod drive;
#[cfg(feature = "std")]
mod energy;
#[cfg(feature = "std")]
mod error;
#[cfg(feature = "std")]
mod latency;
#[cfg(feature = "std")]
mod layer;
#[cfg(feature = "std")]
mod linear;
mod model;
#[cfg(feature = "std")]
mod states;
mod step;
mod stiffness;
#[cfg(feature = "std")]
mod summary;
#[cfg(feature = "std")]
mod trajectory;
#[cfg(feature = "std")]
mod walk;
#[cfg(feature = "std")]
mod wave;

pub use model::{ContactModel, Separation};
pub use step::{ContactState, StepError};

#[cfg(feature = "std")]
pub use {
    crate::contact::SimulationWork,
    contact::{Contact, ContactRef},
    cycles::{Cycle, StepWork, cycles, work_by_step, work_by_step_watched},
    drive::{Drive, ForceHistory, MeasuredMotion, Motion, MotionError, ProgramStep, ProtocolStep, protocol},
    energy::{Energy, EnergySplit, energy, energy_watched},
    error::SimulateError,
    linear::{LinearContact, LinearLaw, LinearLawError, LinearTerm, Memory},
    states::{
        ContactModels, ContactModelsError, ContactParameter, ContactQuantity, ContactStates, ContactsStep, Imposed,
        OneStepError, Refusal, ValueProblem,
    },
    summary::{RunSummary, Summary, summary},
    trajectory::{Sampling, Trajectory, simulate, simulate_force, simulate_watched},
    walk::{ContactEvent, ContactEventKind, StepEnd, step_ends},
    wave::{StrainWave, WAVE_TOLERANCE, strain_wave, strain_wave_within},
};
#[cfg(feature = "std")]
pub(crate) use {drive::Resolution, summary::run_summary};

#[cfg(feature = "std")]
use {
    contact::by_law,
    latency::Latency,
    layer::{InMotion, Layer, crossing},
    walk::{Course, Stretch, StretchState, walk},
};
