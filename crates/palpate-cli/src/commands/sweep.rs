//! `palpate sweep`: many runs of one protocol to one table.

use palpate_jobs::{JobError, Verdict};

use crate::arguments::SweepArguments;
use crate::progress::Bars;
use crate::terminal::notes;

pub(crate) fn run(asked: &SweepArguments) -> Result<Verdict, JobError> {
    let (out, figure) = (asked.out.as_deref(), asked.figure.as_deref());
    let outcome = asked.job.run(&asked.protocol, out, figure, &mut Bars::default())?;
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
