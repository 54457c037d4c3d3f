//! The compiled part of the Python package `palpate`: thin, one file for each Python type.
//!
//! | file | what |
//! |---|---|
//! | `record.rs`, `kept.rs` | `read`, `Record`; a record in a pickle |
//! | `analysis.rs` | `Analysis`, `Finding` |
//! | `fit.rs`, `fit_many.rs` | `fit_hold`, `Fit`, `Estimate`; thousands of holds in one call |
//! | `calibration.rs`, `material.rs`, `prediction.rs` | one set of numbers for a whole record, and what it predicts |
//! | `grip.rs`, `grip_parts.rs` | `Grip`: how to squeeze, and how long that holds; its parts |
//! | `observer.rs`, `observation.rs` | a contact watched tick by tick |
//! | `compare.rs` | laws compared by what they foretell |
//! | `simulate.rs`, `simulate_many.rs` | `simulate`, `Trajectory`; one protocol with many numbers |
//! | `contact_state.rs` | `ContactState`, `ContactStates` |
//! | `laws.rs` | laws as functions of arrays |
//! | `table.rs`, `html.rs` | results as Arrow, and as notebooks show them |
//! | `shown.rs` | classes that show what a result says |
//! | `arrays.rs` | numbers in |
//! | `work.rs` | long work without the GIL, ended by Ctrl-C |
//! | `errors.rs` | exceptions and warnings |
//! | `files.rs` | jobs from files to files |
//! | `command.rs` | the command line |

mod analysis;
mod arrays;
mod calibration;
mod command;
mod compare;
mod contact_state;
mod errors;
mod files;
mod fit;
mod fit_many;
mod grip;
mod grip_parts;
mod html;
mod kept;
mod laws;
mod material;
mod observation;
mod observer;
mod prediction;
mod record;
mod shown;
mod simulate;
mod simulate_many;
mod table;
mod work;

use pyo3::prelude::*;

/// The compiled part of the package.
#[pymodule(gil_used = false)]
mod _palpate {
    #[pymodule_export]
    use crate::{
        analysis::{Analysis, Finding},
        calibration::Calibration,
        command::command,
        compare::{Comparison, RecordComparison, compare},
        contact_state::{ContactState, ContactStates},
        errors::{FitError, ModelError, OptionError, PalpateError, PalpateWarning, RecordError},
        files::{batch, convert, inspect, reproduce, sweep, watch},
        fit::{PyEstimate, PyFit, fit_hold},
        fit_many::fit_many,
        grip::Grip,
        grip_parts::{BackOff, ForceHeld, Holding, Schedule},
        laws::{latency, law_names},
        material::Material,
        observation::Observation,
        observer::Observer,
        prediction::Prediction,
        record::{Record, read, read_all},
        simulate::{Trajectory, simulate},
        simulate_many::simulate_many,
        table::Table,
    };
}
