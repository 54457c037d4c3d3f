//! `palpate compare`: which law to use.

use palpate_jobs::input::NamedRecords;
use palpate_jobs::output::{check_folder, write_bundle};
use palpate_jobs::{JobError, Results, Verdict};

use crate::arguments::{CompareArguments, TableFormat};
use crate::progress::Bars;
use crate::terminal::{note_report, notes, print};

pub(crate) fn run(arguments: &CompareArguments) -> Result<Verdict, JobError> {
    arguments.out.as_deref().map_or(Ok(()), check_folder)?;
    let options = arguments.files.options(arguments.out.is_some())?;
    let described = arguments.described.read()?;
    let records = NamedRecords::find(arguments.records.clone(), described)?;
    let alone = arguments.records.iter().eq(records.names());
    let outcome = arguments.job.run(&records, alone, &mut Bars::default(), notes)?;
    if let Some(folder) = &arguments.out {
        write_bundle(folder, &outcome.result.bundle(&options, &mut Bars::default())?)?;
    }
    print(&match arguments.format {
        TableFormat::Text => outcome.result.text(),
        TableFormat::Markdown => outcome.result.markdown(),
        TableFormat::Json => outcome.result.json()?,
    })?;
    arguments.out.iter().for_each(|folder| note_report(folder));
    Ok(outcome.verdict)
}
