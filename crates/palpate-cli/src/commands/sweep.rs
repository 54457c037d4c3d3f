//! `palpate sweep`: many runs of one protocol to one table.

use palpate_jobs::{JobError, Verdict};

use crate::arguments::SweepArguments;
use crate::progress::Bars;
use crate::terminal::notes;

pub(crate) fn run(arguments: &SweepArguments) -> Result<Verdict, JobError> {
    let SweepArguments {
        protocol, out, figure, ..
    } = arguments;
    let outcome = arguments.job.run(protocol, out.as_deref(), figure.as_deref(), &mut Bars::default())?;
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
