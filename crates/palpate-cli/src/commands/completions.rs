//! `palpate completions`: for shells.

use clap::CommandFactory;
use palpate_jobs::{JobError, Verdict};

use crate::arguments::{Arguments, CompletionsArguments};
use crate::terminal::print;

pub(crate) fn run(arguments: &CompletionsArguments) -> Result<Verdict, JobError> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "palpate", &mut script);
    print(&String::from_utf8_lossy(&script))?;
    Ok(Verdict::Positive)
}
