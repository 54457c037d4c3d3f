//! `palpate calibrate`: a whole record, or several of them, to one set of numbers.

use palpate_files::description::MaterialFile;
use palpate_jobs::input::{Described, Measurement, OpenedFile};
use palpate_jobs::output::{Stage, check_figure, keep_apart, picture};
use palpate_jobs::{JobError, Outcome, Results, Verdict};
use palpate_report::figure::Figure;

use crate::arguments::{CalibrateArguments, Format};
use crate::progress::Bars;
use crate::terminal::{notes, print};

pub(crate) fn run(requested: &CalibrateArguments) -> Result<Verdict, JobError> {
    let (out, figure) = (&requested.out, &requested.figure);
    keep_apart(requested.records.iter().chain(&requested.test), out.iter().chain(figure))?;
    figure.as_deref().map_or(Ok(()), check_figure)?;
    if let [_] = requested.records[..] {
        let job = requested.job()?;
        let mut measured = measured(requested)?;
        let outcome = job.run(measured.remove(0), &mut Bars::default())?;
        let (material, drawn) = (outcome.result.material(), outcome.result.figure());
        finish(requested, &outcome, material, Some(drawn))
    } else {
        let job = requested.several()?;
        let outcome = job.run(measured(requested)?, &mut Bars::default())?;
        let (material, drawn) = (outcome.result.material(), outcome.result.figure());
        finish(requested, &outcome, material, drawn)
    }
}

/// The records, read.
fn measured(requested: &CalibrateArguments) -> Result<Vec<Measurement>, JobError> {
    let described = requested.described()?;
    let read = |(path, described): (&std::path::PathBuf, &Described)| {
        let opened = OpenedFile::open(path, described)?;
        notes(&opened.notes());
        let measured = opened.measurement(opened.only()?, &mut Bars::default())?;
        notes(&measured.notes);
        Ok(measured)
    };
    requested.records.iter().zip(&described).map(read).collect()
}

/// Writes the files and prints the result; an answer without the material that was to be written is a no.
fn finish<R: Results>(
    requested: &CalibrateArguments,
    outcome: &Outcome<R>,
    material: Option<MaterialFile>,
    drawn: Option<Figure>,
) -> Result<Verdict, JobError> {
    notes(&outcome.notes);
    let mut stage = Stage::default();
    let mut verdict = outcome.verdict;
    match (&requested.out, material) {
        (Some(path), Some(material)) => stage.bytes(path, material.to_toml().as_bytes())?,
        (Some(path), None) => {
            notes(&[format!("{} is not written: there is no material", path.display())]);
            verdict = Verdict::Negative;
        }
        (None, _) => {}
    }
    if let (Some(path), Some(figure)) = (&requested.figure, drawn) {
        stage.bytes(path, &picture(path, &figure)?)?;
    }
    stage.commit()?;
    print(&match requested.format {
        Format::Text => outcome.result.text(),
        Format::Json => outcome.result.json()?,
    })?;
    Ok(verdict)
}
