//! `palpate grip`: will it hold, and how to squeeze.

use palpate_jobs::output::{check_figure, keep_apart, picture, write_bundle, write_file};
use palpate_jobs::{JobError, MaterialSource, Results, Verdict};
use palpate_report::study::Pictures;

use crate::arguments::{Format, GripArguments};
use crate::progress::Bars;
use crate::terminal::{note_report, notes, print};

pub(crate) fn run(arguments: &GripArguments) -> Result<Verdict, JobError> {
    let GripArguments {
        material, out, figure, ..
    } = arguments;
    keep_apart([material], figure)?;
    figure.as_deref().map_or(Ok(()), check_figure)?;
    let material = MaterialSource::read(material)?;
    let outcome = arguments.job.run(&material, &mut Bars::default())?;
    let drawn = figure.as_ref().map(|path| picture(path, &outcome.figure())).transpose()?;
    if let Some(folder) = out {
        write_bundle(folder, &outcome.result.bundle(Pictures::default())?)?;
    }
    if let (Some(path), Some(bytes)) = (figure, drawn) {
        write_file(path, &bytes)?;
    }
    print(&match arguments.format {
        Format::Text => outcome.result.text(),
        Format::Json => outcome.result.json()?,
    })?;
    out.iter().for_each(|folder| note_report(folder));
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
