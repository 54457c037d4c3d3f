//! The `palpate` command, as a library: the same for the binary and for the Python package.
//!
//! A command is parsed, becomes one job of `palpate-jobs`, and its outcome is printed and written.
//!
//! | file | what |
//! |---|---|
//! | `arguments/` | what may be typed, and which job that is |
//! | `commands/` | one file a command |
//! | `failure.rs` | an error with its hint |
//! | `progress.rs` | progress on anything over a second |
//! | `terminal.rs` | standard output that survives a closed pipe |

mod arguments;
mod commands;
mod failure;
mod progress;
mod signals;
mod terminal;

use std::ffi::OsString;

use clap::Parser;
use palpate_jobs::{JobError, Verdict};

use crate::arguments::{Arguments, Command};

/// Runs the command as the work of this process, which ends at Ctrl-C, and then leaves nothing unfinished behind.
pub fn main<I, T>(arguments: I) -> u8
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    signals::watch();
    run(arguments)
}

/// Runs the command with these arguments, of which the first is the name of the program, and returns its exit code: 0 done, 1 done
/// but the verdict is negative, 2 could not run.
pub fn run<I, T>(arguments: I) -> u8
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    attempt(arguments).unwrap_or_else(|error| {
        failure::tell(&error);
        2
    })
}

/// Likewise, with what went wrong as a value.
///
/// # Errors
/// [`JobError`] where the command could not run.
#[doc(hidden)]
pub fn attempt<I, T>(arguments: I) -> Result<u8, JobError>
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help is requested and goes to standard output; nothing can be done about a closed one.
            let _ = error.print();
            return Ok(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    terminal::measure();
    let verdict = match arguments.command {
        Command::Reproduce(arguments) => commands::reproduce::run(&arguments),
        Command::Simulate(arguments) => commands::simulate::run(&arguments),
        Command::Sweep(arguments) => commands::sweep::run(&arguments),
        #[cfg(feature = "lab")]
        Command::Lab(arguments) => commands::lab::run(&arguments),
        Command::Inspect(arguments) => commands::inspect::run(&arguments),
        Command::Analyze(arguments) => commands::analyze::run(&arguments),
        Command::Batch(arguments) => commands::batch::run(&arguments),
        Command::Merge(arguments) => commands::merge::run(&arguments),
        Command::Convert(arguments) => commands::convert::run(&arguments),
        Command::Compare(arguments) => commands::compare::run(&arguments),
        Command::Calibrate(arguments) => commands::calibrate::run(&arguments),
        Command::Predict(arguments) => commands::predict::run(&arguments),
        Command::Grip(arguments) => commands::grip::run(&arguments),
        Command::Export(arguments) => commands::export::run(&arguments),
        Command::Watch(arguments) => commands::watch::run(&arguments),
        Command::Schema(arguments) => commands::schema::run(&arguments),
        Command::Completions(arguments) => commands::completions::run(&arguments),
    }?;
    Ok(match verdict {
        Verdict::Positive => 0,
        Verdict::Negative => 1,
    })
}
