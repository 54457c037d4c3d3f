//! The compiled part of the Python package `palpate`: thin, one file for each Python type.
//!
//! | file | what |
//! |---|---|
//! | `records/` | `read`, `Record`, `Analysis`, `Finding`; laws compared by what they predict; a record in a pickle |
//! | `fits/` | `fit_hold`, `Fit`, `Estimate`; thousands of holds in one call; laws as functions of arrays |
//! | `contacts/` | `simulate`, `Trajectory`; one protocol with many numbers; `sweep`; `ContactState`, `ContactStates` |
//! | `materials/` | one set of numbers for a whole record, what it predicts, and how to squeeze and how long that holds |
//! | `observers/` | a contact watched tick by tick |
//! | `table.rs`, `html.rs` | results as Arrow, and as notebooks show them |
//! | `shown.rs` | classes that show what a result says |
//! | `arrays.rs`, `mappings/` | arrays and single numbers in; mappings as the text of a description |
//! | `work.rs` | long work without the GIL, ended by Ctrl-C |
//! | `errors.rs` | exceptions and warnings |
//! | `report_files.rs` | how the files of a report are written |
//! | `files.rs` | jobs from files to files |
//! | `shards.rs` | slices of a batch or a sweep, and all of them as one table |
//! | `command.rs` | the command line |

mod arrays;
mod command;
mod contacts;
mod errors;
mod files;
mod finding;
mod fits;
mod html;
mod listed;
mod mappings;
mod materials;
mod observers;
mod pickles;
mod records;
mod report_files;
mod shards;
mod shown;
mod table;
mod work;

use pyo3::prelude::*;

/// The compiled part of the package.
#[pymodule(gil_used = false)]
mod _palpate {
    use pyo3::prelude::*;
    use pyo3::types::IntoPyDict;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        // Both stand in tables: the sources that computed a row, and the commit that they are called by.
        let software = palpate_report::document::Software::this();
        module.add("_BUILD", format!("{} {software}", palpate_jobs::BUILD))?;
        module.add("_SI_ENDINGS", crate::mappings::UNITS.into_py_dict(module.py())?)
    }

    #[pymodule_export]
    use crate::{
        command::command,
        contacts::contact_state::ContactState,
        contacts::contact_states::ContactStates,
        contacts::numbers::_contact_numbers,
        contacts::simulate::{Trajectory, energy, simulate},
        contacts::simulate_many::simulate_many,
        contacts::sweep::{_checked_sweep, sweep},
        errors::{FitError, ModelError, OptionError, PalpateError, PalpateWarning, RecordError},
        files::{BatchResult, batch, convert, inspect, reproduce, watch},
        finding::Finding,
        fits::estimate::PyEstimate,
        fits::fit::PyFit,
        fits::fit_hold::fit_hold,
        fits::fit_many::fit_many,
        fits::laws::{latency, law_names},
        mappings::{_unit_factor, mapping_text},
        materials::calibration::Calibration,
        materials::card::card,
        materials::grip::Grip,
        materials::grip_parts::{BackOff, ForceHold, PositionHold, Schedule},
        materials::material::Material,
        materials::prediction::Prediction,
        observers::observation::Observation,
        observers::observer::Observer,
        pickles::Piece,
        records::analysis::{Analysis, report_all},
        records::compare::{Comparison, RecordComparison, compare},
        records::forecast::forecast,
        records::read::{read, read_all},
        records::record::Record,
        records::several::{SeveralCalibrations, calibrate},
        shards::{_checked, _forget, _found, _run_slice, _sliced, merge},
        table::Table,
    };
}
