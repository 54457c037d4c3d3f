//! `palpate analyze`: records to phases, laws, tables and reports.

use std::path::{Path, PathBuf};

use palpate::analysis::{Analysis, AnalysisOptions, analyze};
use palpate_files::description::TestDescription;
use palpate_report::document::{AnalysisDocument, Input};
use palpate_report::study::{Pictures, analysis_bundle, analysis_text};

use super::record::{description, input, record};
use crate::arguments::{AnalyzeArguments, Format};
use crate::failure::{Failure, Outcome};
use crate::files::{folders, write_bundle};
use crate::progress::Working;
use crate::terminal::{note, print};

pub(crate) fn run(arguments: &AnalyzeArguments) -> Result<Outcome, Failure> {
    let test = description(arguments.test.as_deref())?;
    let options = options(arguments, test.as_ref());
    let folders: Vec<Option<PathBuf>> = match &arguments.out {
        Some(out) => folders(out, &arguments.records).into_iter().map(Some).collect(),
        None => vec![None; arguments.records.len()],
    };
    let mut failed = None;
    for (path, folder) in arguments.records.iter().zip(folders) {
        let result = one(path, folder.as_deref(), arguments, test.as_ref(), &options);
        match result {
            Ok(()) => {}
            Err(failure) if arguments.records.len() == 1 => return Err(failure),
            // One bad record of many does not keep the others from being analysed.
            Err(failure) => {
                failure.tell();
                *failed.get_or_insert(0) += 1;
            }
        }
    }
    match failed {
        Some(count) => {
            Err(Failure::new(format!("{count} of {} records could not be analysed", arguments.records.len()), None))
        }
        None => Ok(Outcome::Done),
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
    path: &Path,
    folder: Option<&Path>,
    arguments: &AnalyzeArguments,
    test: Option<&TestDescription>,
    options: &AnalysisOptions,
) -> Result<(), Failure> {
    let file = record(path, test)?;
    let mut measured = file.record;
    if let Some(air) = &arguments.air_run {
        let air = record(air, test)?;
        measured = measured
            .without_air_run(&air.record)
            .map_err(|error| Failure::of_file(path, &error, Some(error.hint().to_owned())))?;
    }
    let working = Working::new(format!("fitting {}", path.display()));
    let analysis = analyze(&measured, options).map_err(|error| Failure::of_file(path, &error, Some(error.hint())))?;
    let input = input(path, file.rows, arguments.test.as_deref(), test)?;
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
