//! `palpate grip`: will it hold, and how to squeeze.

use palpate_jobs::output::{Stage, check_figure, check_folder, keep_apart, picture};
use palpate_jobs::{JobError, MaterialSource, Results, Verdict};
use palpate_report::study::{grip_bundle, grip_figure};

use crate::arguments::{Format, GripArguments};
use crate::progress::Bars;
use crate::terminal::{note_report, notes, print};

pub(crate) fn run(requested: &GripArguments) -> Result<Verdict, JobError> {
    let (out, figure) = (&requested.out, &requested.figure);
    out.as_deref().map_or(Ok(()), check_folder)?;
    let options = requested.files.options(out.is_some())?;
    keep_apart([&requested.material], figure)?;
    figure.as_deref().map_or(Ok(()), check_figure)?;
    let material = MaterialSource::read(&requested.material)?;
    let outcome = requested.job.run(&material, &mut Bars::default())?;
    let drawn = figure.as_ref().map(|path| picture(path, &grip_figure(&outcome.result, "grip"))).transpose()?;
    let mut stage = Stage::default();
    if let Some(folder) = out {
        stage.bundle(folder, &grip_bundle(&outcome.result, &options)?)?;
    }
    if let (Some(path), Some(bytes)) = (figure, drawn) {
        stage.bytes(path, &bytes)?;
    }
    stage.commit()?;
    print(&match requested.format {
        Format::Text => outcome.result.text(),
        Format::Json => outcome.result.json()?,
    })?;
    out.iter().for_each(|folder| note_report(folder));
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
