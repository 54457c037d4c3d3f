//! `palpate predict`: what a calibrated body does under a protocol.

use palpate_files::description::{read_material, read_protocol_of};
use palpate_jobs::output::{Stage, check_figure, check_log, keep_apart, picture};
use palpate_jobs::{JobError, Verdict, is_log};

use crate::arguments::PredictArguments;
use crate::progress::Bars;
use crate::terminal::{notes, print, print_with};

pub(crate) fn run(requested: &PredictArguments) -> Result<Verdict, JobError> {
    let (material, protocol, figure) = (&requested.material, &requested.protocol, &requested.figure);
    keep_apart([material, protocol], requested.out.iter().chain(figure))?;
    figure.as_deref().map_or(Ok(()), check_figure)?;
    requested.out.as_deref().filter(|path| is_log(path)).map_or(Ok(()), check_log)?;
    let (job, file) = (&requested.job, read_material(material)?);
    let of = (&read_protocol_of(protocol, &file)?, &*protocol.display().to_string());
    let outcome = job.run((&file, &material.display().to_string()), of, figure.is_some(), &mut Bars::default())?;
    let predicted = &outcome.result;
    let mut stage = Stage::default();
    if let Some(path) = figure {
        stage.bytes(path, &picture(path, &predicted.figure())?)?;
    }
    if let Some(path) = &requested.out {
        predicted.stage(path, &mut stage)?;
    }
    stage.commit()?;
    if requested.out.is_none() && job.at_s.is_empty() {
        print_with(|out| predicted.write_series(out))?;
    }
    if !job.at_s.is_empty() {
        print(&predicted.text())?;
    }
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
