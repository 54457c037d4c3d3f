//! `palpate inspect`: what is in a record, and which machines are known.

use palpate_jobs::input::OpenedFile;
use palpate_jobs::output::{check_figure, check_new, keep_apart, picture, write_file};
use palpate_jobs::{Inspect, JobError, Results, Verdict, machines_text};

use crate::arguments::{Format, InspectArguments};
use crate::progress::Bars;
use crate::terminal::{note, notes, print};

pub(crate) fn run(requested: &InspectArguments) -> Result<Verdict, JobError> {
    let (test, figure, write_test) = (&requested.described.test, &requested.figure, &requested.write_test);
    // Without a list of machines there is a record: the command line asks for one.
    let Some(record) = requested.record.as_ref().filter(|_| !requested.machines) else {
        print(&machines_text())?;
        return Ok(Verdict::Positive);
    };
    let read = [record].into_iter().chain(test).chain(&requested.described.then);
    keep_apart(read, figure.iter().chain(write_test))?;
    figure.as_deref().map_or(Ok(()), check_figure)?;
    write_test.as_deref().map_or(Ok(()), check_new)?;
    let described = requested.described.read()?;
    let opened = OpenedFile::open(record, &described)?;
    let job = Inspect { only: figure.is_some() };
    let outcome = job.run(&opened, &mut Bars::default())?;
    notes(&outcome.notes);
    let found = outcome.result;
    let written = || -> Result<(), JobError> {
        if let (Some(path), Some(text)) = (write_test, &found.description) {
            write_file(path, text.as_bytes())?;
            note(&format!("test description written: {}", path.display()));
        }
        if let (Some(path), Some(drawn)) = (figure, found.figure()) {
            write_file(path, &picture(path, &drawn)?)?;
            note(&format!("figure written: {}", path.display()));
        }
        Ok(())
    };
    let written = written();
    print(&match requested.format {
        Format::Text => found.text(),
        Format::Json => found.json()?,
    })?;
    written.and(found.refused.map_or(Ok(outcome.verdict), Err))
}
