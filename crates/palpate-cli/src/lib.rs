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

mod arguments;
mod commands;
mod failure;
mod files;
mod progress;
mod terminal;

use std::ffi::OsString;
use std::path::Path;

use clap::Parser;
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
    let result = match arguments.command {
        Command::Reproduce(arguments) => commands::reproduce::run(&arguments),
        Command::Simulate(arguments) => commands::simulate::run(&arguments),
        Command::Sweep(arguments) => commands::sweep::run(&arguments),
        Command::Inspect(arguments) => commands::inspect::run(&arguments),
        Command::Analyze(arguments) => commands::analyze::run(&arguments),
        Command::Batch(arguments) => commands::batch::run(&arguments),
        Command::Convert(arguments) => commands::convert::run(&arguments),
        Command::Compare(arguments) => commands::compare::run(&arguments),
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

/// SHA-256 of a file, in hexadecimal.
///
/// # Errors
/// What is wrong, and what would help.
pub fn sha256(path: &Path) -> Result<String, (String, Option<String>)> {
    files::sha256(path).map_err(failure::Failure::into_parts)
}
