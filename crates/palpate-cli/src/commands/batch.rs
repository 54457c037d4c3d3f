//! `palpate batch`: many records to one table.

use palpate_jobs::input::{Described, NamedRecords};
use palpate_jobs::{JobError, Verdict};

use crate::arguments::BatchArguments;
use crate::progress::Bars;
use crate::terminal::{notes, print};

pub(crate) fn run(arguments: &BatchArguments) -> Result<Verdict, JobError> {
    let described = Described::read(arguments.test.as_deref(), None)?.with_columns(arguments.columns.as_ref());
    let records = NamedRecords::find(arguments.records.clone(), described)?;
    let outcome = arguments.job.run(records, &arguments.out, &mut Bars::default())?;
    print(&outcome.result.answer.text())?;
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
