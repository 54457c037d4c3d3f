//! The `palpate` command, as a library: the same for the binary and for the Python package.
//!
//! | file | what |
//! |---|---|
//! | `arguments.rs` | what may be typed |
//! | `commands/` | one file a command |
//! | `failure.rs` | an error with its hint, and the exit codes |
//! | `files.rs` | output that appears whole or not at all |
//! | `progress.rs` | progress on anything over a second |
//! | `terminal.rs` | standard output that survives a closed pipe |

mod apart;
mod arguments;
mod commands;
mod failure;
mod files;
mod progress;
mod terminal;

use std::ffi::OsString;
use std::ops::Range;
use std::path::Path;

use clap::Parser;
use palpate_files::description::{MaterialFile, Sweep};
use palpate_files::parquet_table::{Field, Rows};
use palpate_report::result::CalibratedRecord;
use palpate_report::study::Bundle;

use crate::arguments::{Arguments, Command};
use crate::failure::Outcome;

/// Runs the command with these arguments, of which the first is the name of the program, and returns its exit code: 0 done, 1 done
/// but the verdict is negative, 2 could not run.
pub fn run<I, T>(arguments: I) -> u8
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help is asked for and goes to standard output; nothing can be done about a closed one.
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    if let Err(failure) = apart::keep_apart(&arguments.command) {
        failure.tell();
        return 2;
    }
    let result = match arguments.command {
        Command::Reproduce(arguments) => commands::reproduce::run(&arguments),
        Command::Simulate(arguments) => commands::simulate::run(&arguments),
        Command::Sweep(arguments) => commands::sweep::run(&arguments),
        Command::Inspect(arguments) => commands::inspect::run(&arguments),
        Command::Analyze(arguments) => commands::analyze::run(&arguments),
        Command::Batch(arguments) => commands::batch::run(&arguments),
        Command::Convert(arguments) => commands::convert::run(&arguments),
        Command::Compare(arguments) => commands::compare::run(&arguments),
        Command::Calibrate(arguments) => commands::calibrate::run(&arguments),
        Command::Predict(arguments) => commands::predict::run(&arguments),
        Command::Grip(arguments) => commands::grip::run(&arguments),
        Command::Watch(arguments) => commands::watch::run(&arguments),
        Command::Schema(arguments) => commands::schema::run(&arguments),
        Command::Completions(arguments) => commands::completions::run(&arguments),
    };
    match result {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::Negative) => 1,
        Err(failure) => {
            failure.tell();
            2
        }
    }
}

/// Writes all files of a study below a folder, all or none.
///
/// # Errors
/// What is wrong, and what would help.
pub fn write_study(folder: &Path, study: &Bundle) -> Result<(), (String, Option<String>)> {
    files::write_bundle(folder, study).map_err(failure::Failure::into_parts)
}

/// Writes one file, whole or not at all.
///
/// # Errors
/// What is wrong, and what would help.
pub fn write_file(path: &Path, content: &[u8]) -> Result<(), (String, Option<String>)> {
    files::write_file(path, content).map_err(failure::Failure::into_parts)
}

/// The file that `palpate calibrate` writes: the law that was asked for with where its numbers come from; `None` where it has none.
#[must_use]
pub fn material_file(record: &CalibratedRecord) -> Option<MaterialFile> {
    commands::calibrate::material(record)
}

/// The columns that `palpate sweep` writes: the number of the run, the swept numbers, the results, why there are none.
#[must_use]
pub fn sweep_fields(sweep: &Sweep) -> Vec<Field> {
    commands::sweep::rows::fields(sweep)
}

/// Simulates runs of a sweep, from 0, as rows of that table, and tells `done` of each; `path` stands in messages.
pub fn sweep_rows(sweep: &Sweep, path: &Path, runs: Range<u64>, done: impl FnMut()) -> Rows {
    commands::sweep::rows::simulated(sweep, path, runs, done)
}

/// SHA-256 of a file, in hexadecimal.
///
/// # Errors
/// What is wrong, and what would help.
pub fn sha256(path: &Path) -> Result<String, (String, Option<String>)> {
    files::sha256(path).map_err(failure::Failure::into_parts)
}

/// The same of what a file would hold.
#[must_use]
pub fn sha256_of(content: &[u8]) -> String {
    files::sha256_of(content)
}
