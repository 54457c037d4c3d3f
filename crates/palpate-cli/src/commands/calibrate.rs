//! `palpate calibrate`: a whole record to one set of numbers.

use palpate_jobs::input::OpenedFile;
use palpate_jobs::output::{Stage, check_figure, keep_apart, picture};
use palpate_jobs::{JobError, Results, Verdict};

use crate::arguments::{CalibrateArguments, Format};
use crate::progress::Bars;
use crate::terminal::{notes, print};

pub(crate) fn run(requested: &CalibrateArguments) -> Result<Verdict, JobError> {
    let (out, figure) = (&requested.out, &requested.figure);
    keep_apart([&requested.record].into_iter().chain(&requested.described.test), out.iter().chain(figure))?;
    figure.as_deref().map_or(Ok(()), check_figure)?;
    let described = requested.described.read()?;
    let opened = OpenedFile::open(&requested.record, &described)?;
    notes(&opened.notes());
    let measured = opened.measurement(opened.only()?, &mut Bars::default())?;
    notes(&measured.notes);
    let outcome = requested.job().run(measured, &mut Bars::default())?;
    notes(&outcome.notes);
    let drawn = figure.as_ref().map(|path| picture(path, &outcome.result.figure())).transpose()?;
    let mut stage = Stage::default();
    if let (Some(path), Some(material)) = (out, outcome.result.material()) {
        stage.bytes(path, material.to_toml().as_bytes())?;
    }
    if let (Some(path), Some(bytes)) = (figure, drawn) {
        stage.bytes(path, &bytes)?;
    }
    stage.commit()?;
    print(&match requested.format {
        Format::Text => outcome.result.text(),
        Format::Json => outcome.result.json()?,
    })?;
    Ok(outcome.verdict)
}
