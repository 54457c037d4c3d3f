//! `palpate reproduce`: the paper's study.

use palpate_jobs::output::{check_folder, write_bundle};
use palpate_jobs::{JobError, Reproduce, Results, Verdict};
use palpate_report::study::{Pictures, reproduction_bundle};

use crate::arguments::{Format, ReproduceArguments};
use crate::progress::Bars;
use crate::terminal::print;

pub(crate) fn run(arguments: &ReproduceArguments) -> Result<Verdict, JobError> {
    check_folder(&arguments.out)?;
    let outcome = Reproduce {}.run(&mut Bars::default())?;
    let bundle = reproduction_bundle(&outcome.result, Pictures { png: arguments.png }, &mut Bars::default())?;
    write_bundle(&arguments.out, &bundle)?;
    let (files, report) = (bundle.files.len(), arguments.out.join("report.html"));
    print(&match arguments.format {
        Format::Json => outcome.result.json()?,
        Format::Text => format!("{}\n{files} files written; open {}\n", outcome.result.text(), report.display()),
    })?;
    Ok(outcome.verdict)
}
