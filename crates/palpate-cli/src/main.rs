//! The `palpate` command.
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

use std::process::ExitCode;

use clap::Parser;

use crate::arguments::{Arguments, Command};
use crate::failure::Outcome;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match arguments.command {
        Command::Reproduce(arguments) => commands::reproduce::run(&arguments),
        Command::Simulate(arguments) => commands::simulate::run(&arguments),
        Command::Sweep(arguments) => commands::sweep::run(&arguments),
        Command::Inspect(arguments) => commands::inspect::run(&arguments),
        Command::Analyze(arguments) => commands::analyze::run(&arguments),
        Command::Batch(arguments) => commands::batch::run(&arguments),
        Command::Compare(arguments) => commands::compare::run(&arguments),
        Command::Schema(arguments) => commands::schema::run(&arguments),
        Command::Completions(arguments) => commands::completions::run(&arguments),
    };
    match result {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Negative) => ExitCode::from(1),
        Err(failure) => {
            failure.tell();
            ExitCode::from(2)
        }
    }
}
