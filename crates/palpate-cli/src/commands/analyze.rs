//! `palpate analyze`: records to phases, laws, tables and reports.

use std::path::Path;

use palpate_jobs::input::{Measurement, NamedRecords, OpenedFile};
use palpate_jobs::output::{check_folder, write_bundle};
use palpate_jobs::{Analyze, Analyzed, ErrorKind, JobError, ReportIndex, Results, Verdict};
use palpate_report::study::FileOptions;

use crate::arguments::{AnalyzeArguments, Format};
use crate::failure::tell;
use crate::progress::Bars;
use crate::terminal::{note, note_report, notes, print};

pub(crate) fn run(arguments: &AnalyzeArguments) -> Result<Verdict, JobError> {
    arguments.out.as_deref().map_or(Ok(()), check_folder)?;
    let options = FileOptions {
        holds: arguments.holds.clone(),
        ..arguments.files.options(arguments.out.is_some())?
    };
    let described = arguments.described.read()?;
    let records = NamedRecords::find(arguments.records.clone(), described)?;
    let alone = records.described.clone().with_then(None);
    let air = arguments.air_run.as_ref().map(|air| OpenedFile::open(air, &alone)).transpose()?;
    let air = air.map(|air| air.measurement(air.only()?, &mut Bars::default())).transpose()?;
    let (mut tests, mut failed, mut index) = (0, 0, ReportIndex::default());
    let out = arguments.out.as_deref();
    let job = Analyze {
        compare: !arguments.no_compare,
        ..arguments.job.clone()
    };
    records.each(out, &mut Bars::default(), notes, |part, _| {
        tests += 1;
        let made = part
            .measurement
            .and_then(|measured| one(arguments, (&job, &options), measured, air.as_ref(), part.folder.as_deref()))
            .and_then(|analyzed| match (out, &part.folder) {
                (Some(out), Some(folder)) => index.add(&analyzed, folder, out, &mut Bars::default()),
                _ => Ok(()),
            });
        // One bad record of many does not keep the others from being analysed.
        made.or_else(|error| {
            if part.only {
                return Err(error);
            }
            tell(&error);
            index.leave_out(part.path, &error);
            failed += 1;
            Ok(())
        })
    })?;
    if let Some(out) = out.filter(|_| tests > 1 && !index.is_empty()) {
        write_bundle(out, &index.bundle(&options, &mut Bars::default())?)?;
        note(&format!("index written: {}", out.join("index.html").display()));
    }
    match failed {
        0 => Ok(Verdict::Positive),
        count => {
            let message = format!("{count} of {tests} records could not be analysed");
            Err(JobError::new(ErrorKind::Record, message, None))
        }
    }
}

fn one(
    arguments: &AnalyzeArguments,
    (job, options): (&Analyze, &FileOptions),
    measured: Measurement,
    air: Option<&Measurement>,
    folder: Option<&Path>,
) -> Result<Analyzed, JobError> {
    notes(&measured.notes);
    let mut bars = Bars::default();
    let outcome = job.run(measured, air, &mut bars)?;
    notes(&outcome.notes);
    if let Some(folder) = folder {
        write_bundle(folder, &outcome.result.bundle(options, &mut bars)?)?;
    }
    drop(bars);
    print(&match arguments.format {
        Format::Json => outcome.result.json()?,
        Format::Text => {
            let analyzed = &outcome.result;
            let text = if arguments.details { analyzed.text() } else { analyzed.brief_text() };
            format!("{}\n\n{text}", analyzed.input.title)
        }
    })?;
    folder.into_iter().for_each(note_report);
    Ok(outcome.result)
}
