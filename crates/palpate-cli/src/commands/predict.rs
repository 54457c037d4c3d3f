//! `palpate predict`: what a calibrated body does under a protocol.

use palpate_files::description::{read_material, read_protocol_of};
use palpate_jobs::output::{check_figure, keep_apart, picture, write_file, write_file_with};
use palpate_jobs::{JobError, Verdict};

use crate::arguments::PredictArguments;
use crate::progress::Bars;
use crate::terminal::{notes, print, print_with};

pub(crate) fn run(requested: &PredictArguments) -> Result<Verdict, JobError> {
    let (material, protocol, figure) = (&requested.material, &requested.protocol, &requested.figure);
    keep_apart([material, protocol], requested.out.iter().chain(figure))?;
    figure.as_deref().map_or(Ok(()), check_figure)?;
    let (job, file) = (&requested.job, read_material(material)?);
    let of = (&read_protocol_of(protocol, &file)?, &*protocol.display().to_string());
    let outcome = job.run((&file, &material.display().to_string()), of, figure.is_some(), &mut Bars::default())?;
    let predicted = &outcome.result;
    if let Some(path) = figure {
        write_file(path, &picture(path, &predicted.figure())?)?;
    }
    match &requested.out {
        Some(path) => write_file_with(path, |out| predicted.write_series(out))?,
        None if job.at_s.is_empty() => print_with(|out| predicted.write_series(out))?,
        None => {}
    }
    if !job.at_s.is_empty() {
        print(&predicted.text())?;
    }
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
