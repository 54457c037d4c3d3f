//! `palpate convert`: a record of any format as a plain table in SI.

use palpate_jobs::input::OpenedFile;
use palpate_jobs::output::keep_apart;
use palpate_jobs::{Converted, JobError, Verdict};

use crate::arguments::ConvertArguments;
use crate::progress::Bars;
use crate::terminal::{note, notes};

pub(crate) fn run(requested: &ConvertArguments) -> Result<Verdict, JobError> {
    let (record, out) = (&requested.record, &requested.out);
    let read = [record].into_iter().chain(&requested.described.test).chain(&requested.described.then);
    keep_apart(read, [out])?;
    Converted::check_name(out)?;
    let described = requested.described.read()?;
    let opened = OpenedFile::open(record, &described)?;
    notes(&opened.notes());
    let mut bars = Bars::default();
    let outcome = requested.job.run(&opened, &mut bars)?;
    notes(&outcome.notes);
    outcome.result.write(out, &mut bars)?;
    note(&format!("{} rows written: {}", outcome.result.file.record.len(), out.display()));
    Ok(outcome.verdict)
}
