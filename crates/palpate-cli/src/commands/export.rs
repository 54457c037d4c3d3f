//! `palpate export`: a material as a card of another simulator.

use palpate_jobs::output::{keep_apart, write_file};
use palpate_jobs::{JobError, MaterialSource, Results, Verdict};

use crate::arguments::{ExportArguments, Format};
use crate::progress::Bars;
use crate::terminal::{note, notes, print};

pub(crate) fn run(requested: &ExportArguments) -> Result<Verdict, JobError> {
    let out = &requested.out;
    keep_apart([&requested.material], out)?;
    let material = MaterialSource::read(&requested.material)?;
    let outcome = requested.job.run(&material, &mut Bars::default())?;
    let card = &outcome.result;
    if let Some(path) = out {
        write_file(path, card.text().as_bytes())?;
    }
    match (requested.format, out) {
        (Format::Json, _) => print(&card.json()?)?,
        (Format::Text, None) => print(&card.text())?,
        (Format::Text, Some(path)) => note(&format!("card written: {}", path.display())),
    }
    notes(&outcome.notes);
    Ok(outcome.verdict)
}
