//! `palpate sweep`: many runs of one protocol to one table.

use palpate_jobs::{JobError, Verdict};

use crate::arguments::SweepArguments;
use crate::progress::Bars;
use crate::terminal::notes;

pub(crate) fn run(requested: &SweepArguments) -> Result<Verdict, JobError> {
    let (out, figure) = (requested.out.as_deref(), requested.figure.as_deref());
    let outcome = requested.job.run(&requested.protocol, out, figure, &mut Bars::default())?;
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
