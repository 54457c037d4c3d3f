//! `palpate analyze`: records to phases, laws, tables and reports.

use std::path::{Path, PathBuf};

use palpate::analysis::{Analysis, AnalysisOptions, analyze};
use palpate_files::description::TestDescription;
use palpate_report::document::AnalysisDocument;
use palpate_report::result::Input;
use palpate_report::study::{Pictures, analysis_bundle, analysis_text};

use super::inputs::records_of;
use super::record::{Opened, called, description, input, record, tell_skipped};
use crate::arguments::{AnalyzeArguments, Format};
use crate::failure::{Failure, Outcome};
use crate::files::{file_name, folder_in, folders, write_bundle};
use crate::progress::Working;
use crate::terminal::{note, print};

pub(crate) fn run(arguments: &AnalyzeArguments) -> Result<Outcome, Failure> {
    let test = description(arguments.test.as_deref(), arguments.part.as_deref())?;
    let options = options(arguments, test.as_ref());
    let paths = records_of(&arguments.records)?;
    let folders: Vec<Option<PathBuf>> = match &arguments.out {
        Some(out) => folders(out, &paths).into_iter().map(Some).collect(),
        None => vec![None; paths.len()],
    };
    let (mut tests, mut failed) = (0, 0);
    for (path, folder) in paths.iter().zip(folders) {
        // One bad record of many does not keep the others from being analysed.
        let opened = match Opened::open(path, test.as_ref()) {
            Ok(opened) => opened,
            Err(failure) if paths.len() == 1 => return Err(failure),
            Err(failure) => {
                failure.tell();
                (tests, failed) = (tests + 1, failed + 1);
                continue;
            }
        };
        tell_skipped(&opened);
        tests += opened.parts().len();
        let (several, mut taken) = (opened.parts().len() > 1, Vec::new());
        for part in opened.parts() {
            let folder = folder.as_ref().map(|folder| match opened.name(*part) {
                Some(name) if several => folder_in(folder, &file_name(name), &mut taken),
                _ => folder.clone(),
            });
            match one(&opened, *part, folder.as_deref(), arguments, &options) {
                Ok(()) => {}
                Err(failure) if paths.len() == 1 && opened.parts().len() == 1 => return Err(failure),
                Err(failure) => {
                    failure.tell();
                    failed += 1;
                }
            }
        }
    }
    match failed {
        0 => Ok(Outcome::Done),
        count => Err(Failure::new(format!("{count} of {tests} records could not be analysed"), None)),
    }
}

/// The description's options, overridden by what was typed.
fn options(arguments: &AnalyzeArguments, test: Option<&TestDescription>) -> AnalysisOptions {
    let mut options = test.map_or_else(AnalysisOptions::default, TestDescription::analysis_options);
    options.fit_until = arguments.fit_until.or(options.fit_until);
    if let Some(exponents) = &arguments.exponents {
        options.exponents.clone_from(exponents);
    }
    options.exponents.sort_by(f64::total_cmp);
    options.exponents.dedup();
    options.segment.hold_start = arguments.hold_start.unwrap_or(options.segment.hold_start);
    options.segment.tolerance = arguments.tolerance.or(options.segment.tolerance);
    options.segment.minimum_hold = arguments.minimum_hold.or(options.segment.minimum_hold);
    options.touch = arguments.touch.unwrap_or(options.touch);
    if arguments.no_compare {
        options.compare = None;
    }
    options
}

fn one(
    opened: &Opened<'_>,
    part: usize,
    folder: Option<&Path>,
    arguments: &AnalyzeArguments,
    options: &AnalysisOptions,
) -> Result<(), Failure> {
    let test = opened.test();
    let file = opened.read(part)?;
    let path = file.path.as_path();
    let input = input(&file, opened.name(part), arguments.test.as_deref(), test)?;
    let mut measured = file.record.clone();
    if let Some(air) = &arguments.air_run {
        let air = record(air, test)?;
        measured = measured
            .without_air_run(&air.record)
            .map_err(|error| Failure::of_file(path, &error, Some(error.hint().to_owned())))?;
    }
    let working = Working::new(format!("fitting {}", called(path, opened.name(part))));
    let analysis = analyze(&measured, options).map_err(|error| Failure::of_file(path, &error, Some(error.hint())))?;
    if let Some(folder) = folder {
        let pictures = Pictures { png: arguments.png };
        let bundle = analysis_bundle(&analysis, input.clone(), pictures).map_err(|error| Failure::new(error, None))?;
        write_bundle(folder, &bundle)?;
    }
    drop(working);
    match arguments.format {
        Format::Json => {
            let document = AnalysisDocument::new(&analysis, input);
            let text = serde_json::to_string_pretty(&document).map_err(|error| Failure::new(error, None))?;
            print(&format!("{text}\n"))?;
        }
        Format::Text => print(&text(&analysis, &input))?,
    }
    if let Some(folder) = folder {
        note(&format!("report written: {}", folder.join("report.html").display()));
    }
    Ok(())
}

fn text(analysis: &Analysis, input: &Input) -> String {
    format!("{}\n\n{}", input.title, analysis_text(analysis, input))
}
