//! `palpate reproduce`: the paper's study.

use palpate_jobs::input::OpenedFile;
use palpate_jobs::output::{check_folder, write_bundle};
use palpate_jobs::{JobError, Outcome, Reproduce, Results, Verdict};
use palpate_report::study::{Bundle, reproduction_bundle};

use crate::arguments::{Format, ReproduceArguments};
use crate::progress::Bars;
use crate::terminal::{notes, print};

pub(crate) fn run(arguments: &ReproduceArguments) -> Result<Verdict, JobError> {
    check_folder(&arguments.out)?;
    let options = arguments.files.options(true)?;
    let Some(record) = &arguments.record else {
        arguments.described.refuse_without_record()?;
        let outcome = arguments.job.run(&mut Bars::default())?;
        let bundle = reproduction_bundle(&outcome.result, &options, &mut Bars::default())?;
        return finish(arguments, &outcome, &bundle);
    };
    let described = arguments.described.read()?;
    let opened = OpenedFile::open(record, &described)?;
    notes(&opened.notes());
    let measured = opened.measurement(opened.only()?, &mut Bars::default())?;
    notes(&measured.notes);
    let outcome = Reproduce::of_record(measured, &mut Bars::default())?;
    let bundle = outcome.result.bundle(&options, &mut Bars::default())?;
    finish(arguments, &outcome, &bundle)
}

/// Writes the files and prints the result.
fn finish<R: Results>(
    arguments: &ReproduceArguments,
    outcome: &Outcome<R>,
    bundle: &Bundle,
) -> Result<Verdict, JobError> {
    write_bundle(&arguments.out, bundle)?;
    let (files, report) = (bundle.files.len(), arguments.out.join("report.html"));
    print(&match arguments.format {
        Format::Json => outcome.result.json()?,
        Format::Text => format!("{}\n{files} files written; open {}\n", outcome.result.text(), report.display()),
    })?;
    Ok(outcome.verdict)
}
