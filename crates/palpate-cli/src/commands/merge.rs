//! `palpate merge`: the shards of a batch or a sweep as one table.

use palpate_jobs::{JobError, Verdict};

use crate::arguments::MergeArguments;
use crate::progress::Bars;
use crate::terminal::{notes, print};

pub(crate) fn run(arguments: &MergeArguments) -> Result<Verdict, JobError> {
    let outcome = arguments.job.run(&arguments.folders, &arguments.out, &mut Bars::default())?;
    print(&outcome.result.text())?;
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
