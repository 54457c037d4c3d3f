//! `palpate compare`: which law to use.

use std::path::Path;

use palpate::analysis::{AnalysisOptions, analyze, corrected, creep_holds};
use palpate::fit::Loss;
use palpate::forecast::{CompareOptions, RampChoice};
use palpate::laws::Response;
use palpate_files::description::TestDescription;
use palpate_report::document::{ComparisonDocument, ComparisonSettingsDocument};
use palpate_report::result::{ComparedRecord, LeftOut};
use palpate_report::study::{Pictures, comparison_bundle, comparison_markdown, comparison_text};

use super::inputs::records_of;
use super::record::{Opened, called, description, input};
use crate::arguments::{CompareArguments, LossName, RampName, TableFormat};
use crate::failure::{Failure, Outcome};
use crate::files::write_bundle;
use crate::progress::Working;
use crate::terminal::{note, print};

pub(crate) fn run(arguments: &CompareArguments) -> Result<Outcome, Failure> {
    let test = description(arguments.test.as_deref(), arguments.part.as_deref())?;
    let options = options(arguments, test.as_ref())?;
    let paths = records_of(&arguments.records)?;
    let alone = paths.len() == 1 && arguments.records == paths;
    let (mut compared, mut left_out) = (Vec::new(), Vec::new());
    for path in paths {
        let opened = match Opened::open(&path, test.as_ref()) {
            Ok(opened) => opened,
            Err(failure) if alone => return Err(failure),
            Err(failure) => {
                left_out.push(without(&path, None, failure));
                continue;
            }
        };
        for part in opened.parts() {
            let name = opened.name(*part);
            match one(&opened, *part, arguments, &options) {
                Ok(record) if record.has_verdict() => compared.push(record),
                Ok(_) => left_out.push(LeftOut {
                    path: called(&path, name),
                    reason: "no law could be fitted to any hold".to_owned(),
                    hint: None,
                }),
                Err(failure) if alone && opened.parts().len() == 1 => return Err(failure),
                Err(failure) => left_out.push(without(&path, name, failure)),
            }
        }
    }
    if let Some(folder) = &arguments.out {
        let bundle = comparison_bundle(&compared, &left_out, settings(&options), Pictures::default())
            .map_err(|error| Failure::new(error, None))?;
        write_bundle(folder, &bundle)?;
    }
    let text = match arguments.format {
        TableFormat::Text => comparison_text(&compared, &left_out),
        TableFormat::Markdown => comparison_markdown(&compared, &left_out, &options.compared.laws()),
        TableFormat::Json => {
            let document = ComparisonDocument::new(&compared, &left_out, settings(&options));
            let text = serde_json::to_string_pretty(&document).map_err(|error| Failure::new(error, None))?;
            format!("{text}\n")
        }
    };
    print(&text)?;
    if let Some(folder) = &arguments.out {
        note(&format!("report written: {}", folder.join("report.html").display()));
    }
    Ok(if compared.is_empty() { Outcome::Negative } else { Outcome::Done })
}

/// What is asked of every record.
struct Options {
    analysis: AnalysisOptions,
    compared: CompareOptions,
}

/// The description's options, overridden by what was typed.
fn options(arguments: &CompareArguments, test: Option<&TestDescription>) -> Result<Options, Failure> {
    let mut analysis = test.map_or_else(AnalysisOptions::default, TestDescription::analysis_options);
    analysis.fit_until = arguments.fit_until.or(analysis.fit_until);
    let mut compared = CompareOptions::default();
    compared.fit.response = if arguments.creep { Response::Creep } else { Response::Relaxation };
    compared.fit.confidence = analysis.fit.confidence;
    compared.fit.samples = arguments.samples;
    compared.fit.loss = match arguments.loss {
        LossName::Squares => Loss::Squares,
        LossName::Huber => Loss::Huber,
        LossName::Tukey => Loss::Tukey,
    };
    compared.ramps = match arguments.ramps {
        RampName::Step => RampChoice::Step,
        RampName::Measured => RampChoice::Measured,
    };
    if let Some(laws) = &arguments.laws {
        compared.laws.clone_from(laws);
        compared.laws.dedup();
    }
    if let Some(law) = compared.laws.iter().find(|law| !law.describes(compared.fit.response)) {
        let (has, other) = if arguments.creep { ("creep", "without --creep") } else { ("relaxation", "with --creep") };
        return Err(Failure::new(
            format!("--laws: {law} has no form for {has}"),
            Some(format!("leave it out, or compare {other}")),
        ));
    }
    if let Some(cuts) = &arguments.cuts {
        compared.cuts.clone_from(cuts);
        compared.cuts.sort_by(f64::total_cmp);
        compared.cuts.dedup();
    }
    analysis.compare = Some(compared.clone());
    Ok(Options { analysis, compared })
}

fn settings(options: &Options) -> ComparisonSettingsDocument {
    ComparisonSettingsDocument::new(&options.compared, options.analysis.segment.hold_start, options.analysis.fit_until)
}

fn one(
    opened: &Opened<'_>,
    part: usize,
    arguments: &CompareArguments,
    options: &Options,
) -> Result<ComparedRecord, Failure> {
    let file = opened.read(part)?;
    let path = file.path.as_path();
    let input = input(&file, opened.name(part), arguments.test.as_deref(), opened.test())?;
    let _working = Working::new(format!("comparing laws on {}", path.display()));
    let asked = &options.analysis;
    if arguments.creep {
        let record = corrected(&file.record, asked)
            .map_err(|error| Failure::of_file(path, &error, Some(error.hint())))?
            .record;
        let holds = creep_holds(&record, (&asked.segment, &asked.given_holds), &options.compared, asked.fit_until)
            .map_err(|error| Failure::of_file(path, &error, Some(error.hint().to_owned())))?;
        return Ok(ComparedRecord::of_creep(holds, input));
    }
    let analysis = analyze(&file.record, asked).map_err(|error| Failure::of_file(path, &error, Some(error.hint())))?;
    Ok(ComparedRecord::of_analysis(&analysis, input))
}

/// A file that was left out, with the reason without its own name.
fn without(path: &Path, part: Option<&str>, failure: Failure) -> LeftOut {
    let (message, hint) = failure.into_parts();
    let own = path.display().to_string();
    let reason = message.strip_prefix(&own).map_or(message.as_str(), |rest| rest.trim_start_matches([':', ',', ' ']));
    LeftOut {
        reason: reason.to_owned(),
        path: called(path, part),
        hint,
    }
}
