//! `palpate calibrate`: a whole record to one set of numbers.

use palpate::analysis::AnalysisOptions;
use palpate::calibrate::{CalibrationData, Candidate, EquilibriumLaw, RateLaw, calibrate, profile};
use palpate::watch::Unwatched;
use palpate_files::description::{MaterialFile, MaterialOrigin, TestDescription};
use palpate_report::document::CalibrationDocument;
use palpate_report::result::CalibratedRecord;
use palpate_report::study::{calibration_figure, calibration_text};

use super::picture::{check_picture, picture};
use super::record::{Opened, description, input, one_part, tell_skipped};
use crate::arguments::{CalibrateArguments, EquilibriumLawName, Format, RateLawName};
use crate::failure::{Failure, Outcome};
use crate::files::write_file;
use crate::progress::Working;
use crate::terminal::{note, print};

pub(crate) fn run(arguments: &CalibrateArguments) -> Result<Outcome, Failure> {
    if let Some(path) = &arguments.figure {
        check_picture(path)?;
    }
    let equilibrium = equilibrium(arguments)?;
    let test = description(arguments.test.as_deref(), arguments.part.as_deref())?;
    let opened = Opened::open(&arguments.record, test.as_ref())?;
    tell_skipped(&opened);
    let part = one_part(&opened)?;
    let file = opened.read(part)?;
    let options = test.as_ref().map_or_else(AnalysisOptions::default, TestDescription::analysis_options);
    let confidence = arguments.confidence.unwrap_or(options.fit.confidence);
    let refused = |error: palpate::calibrate::CalibrateError| {
        let hint = error.hint();
        Failure::of_file(&arguments.record, &error, (!hint.is_empty()).then_some(hint))
    };
    let data = CalibrationData::of_record(&file.record, &options).map_err(refused)?;
    let data = match arguments.fit_until {
        Some(until) => data.fitted_until(until).map_err(refused)?,
        None => data,
    };
    if data.samples() > data.times().len() {
        note(&format!("{} of {} samples are used, evenly chosen", data.times().len(), data.samples()));
    }
    let chosen = Candidate {
        law: arguments.law,
        equilibrium,
        rate: match arguments.rate {
            RateLawName::Constant => RateLaw::Constant,
            RateLawName::ByStrain => RateLaw::ByStrain,
            RateLawName::ByDirection => RateLaw::ByDirection,
        },
    };
    let mut rows = Vec::new();
    let candidates = if arguments.no_rivals { vec![chosen] } else { chosen.with_rivals(&arguments.rivals) };
    for candidate in candidates {
        let _working = Working::new(format!("calibrating {candidate}"));
        let made = calibrate(&data, candidate, confidence, &mut Unwatched);
        if rows.is_empty()
            && let Err(error) = made
        {
            // Without the law that was asked for its rivals are of no use.
            return Err(refused(error));
        }
        rows.push((candidate, made));
    }
    let profiles = match rows.first() {
        Some((_, Ok(made))) if arguments.profile => {
            let _working = Working::new("following the profiles".to_owned());
            profile(&data, made, &mut Unwatched).map_err(refused)?
        }
        _ => Vec::new(),
    };
    let record = CalibratedRecord {
        profiles,
        input: input(&file, opened.name(part), arguments.test.as_deref(), test.as_ref())?,
        data,
        rows,
    };
    let mut made = Vec::new();
    if let (Some(path), Some(material)) = (&arguments.out, material(&record)) {
        made.push((path, material.to_toml().into_bytes()));
    }
    if let Some(path) = &arguments.figure {
        made.push((path, picture(path, &calibration_figure(&record, "calibration"))?));
    }
    for (path, bytes) in made {
        write_file(path, &bytes)?;
    }
    let text = match arguments.format {
        Format::Text => calibration_text(&record),
        Format::Json => {
            let document = CalibrationDocument::new(&record, confidence);
            let text = serde_json::to_string_pretty(&document).map_err(|error| Failure::new(error, None))?;
            format!("{text}\n")
        }
    };
    print(&text)?;
    Ok(Outcome::Done)
}

/// The material of the law that was asked for, with where it comes from.
pub(crate) fn material(record: &CalibratedRecord) -> Option<MaterialFile> {
    let chosen = record.chosen()?;
    Some(MaterialFile {
        material: chosen.material.clone(),
        origin: MaterialOrigin {
            record: record.input.called(),
            sha256: record.input.sha256.clone(),
            test: record.input.test.clone(),
            palpate: env!("CARGO_PKG_VERSION").to_owned(),
            samples: record.data.fitted(),
        },
    })
}

fn equilibrium(arguments: &CalibrateArguments) -> Result<EquilibriumLaw, Failure> {
    match (arguments.equilibrium, arguments.poisson_ratio) {
        (EquilibriumLawName::Hertz, ratio) => Ok(EquilibriumLaw::Hertz {
            poisson_ratio: ratio.unwrap_or(0.5),
        }),
        (_, Some(_)) => Err(Failure::new(
            "--poisson-ratio is for Hertz's law, which is not asked for",
            Some("add --equilibrium hertz, or leave --poisson-ratio out".to_owned()),
        )),
        (EquilibriumLawName::EvenStrain, None) => Ok(EquilibriumLaw::EvenStrain),
        (EquilibriumLawName::Table, None) => Ok(EquilibriumLaw::Table),
    }
}
