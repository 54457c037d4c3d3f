//! The command line after `pip install`.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the command with these arguments, the first of them its name, and returns the exit code; signals end the process.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| palpate_cli::main(arguments))
}
