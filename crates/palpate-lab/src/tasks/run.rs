//! From a request to what it makes: one job each.

use std::path::Path;

use palpate::calibrate::Candidate;
use palpate::grip::PlanKind;
use palpate::laws::Law;
use palpate::watch::Watch;
use palpate_jobs::input::OpenedFile;
use palpate_jobs::{
    Analyze, Analyzed, Batch, BatchedTest, Calibrate, CalibrateSeveral, Compare, Inspect, JobError, MaterialSource,
    PlanGrip, ReportIndex, Results,
};
use palpate_report::figure::Figure;
use palpate_report::page::{Block, fragment};
use palpate_report::result::{Answer, ComparedRecord};
use palpate_report::spelling::with_flags;
use palpate_report::study::{Bundle, FileOptions, grip_bundle, grip_figure};
use serde_json::{Value, json};

use super::{Made, Request};
use crate::folder::{Folder, Subject};
use crate::lines;
use crate::refusal::refusal;

impl Request {
    /// Runs the job; `take` gets the tests of a batch as they are done.
    ///
    /// # Errors
    /// [`JobError`] where there is no result, or the watch ends it.
    pub(super) fn run(
        &self,
        folder: &Folder,
        watch: &mut dyn Watch,
        take: impl FnMut(BatchedTest),
    ) -> Result<Made, JobError> {
        match self {
            Self::Inspect { subject } => inspect(folder, subject, watch),
            Self::Analyze { subject, options } => analyze(folder, subject, options, watch),
            Self::Creep { subject } => creep(folder, subject, watch),
            Self::Batch { subject, options } => batch(folder, subject, options, watch, take),
            Self::Compare { subjects } => compare(folder, subjects, watch),
            Self::Calibrate { subjects, options } => calibrate(folder, subjects, options, watch),
            Self::Grip { material, options } => grip(folder, material, options, watch),
        }
    }
}

/// What a map shows first.
const MAPPED: [&str; 3] = ["loading_modulus_pa", "relative_rate_per_s", "exponent"];

/// Files without figures: those are made when they are wanted.
fn without_figures() -> FileOptions {
    FileOptions {
        figures: Vec::new(),
        ..FileOptions::default()
    }
}

/// A figure for the page.
fn shown(figure: &Figure) -> Result<String, JobError> {
    let block = Block::figure(figure).map_err(palpate_report::study::StudyError::from)?;
    Ok(fragment(&[block]))
}

/// What belongs before everything else of a page.
fn first(bundle: &Bundle) -> String {
    bundle.page.as_ref().map_or_else(String::new, |page| fragment(&page.first))
}

fn names(bundle: &Bundle) -> Vec<&str> {
    bundle.files.iter().map(|(name, _)| name.as_str()).collect()
}

fn inspect(folder: &Folder, subject: &Subject, watch: &mut dyn Watch) -> Result<Made, JobError> {
    let described = folder.described(subject)?;
    let opened = OpenedFile::open(&folder.file(&subject.file)?, &described)?;
    let outcome = Inspect::default().run(&opened, watch)?;
    let found = outcome.result;
    let figure = found.figure().as_ref().map(shown).transpose()?;
    let mut document = serde_json::to_value(found.document())?;
    document["path"] = subject.file.clone().into();
    if let Some(error) = &found.refused {
        document["tests"][0]["refused"] = serde_json::to_value(refusal(error, folder))?;
    }
    let answer = json!({
        "document": document,
        "figure": figure,
        "guess": found.description.as_deref().and_then(|draft| toml::from_str::<Value>(draft).ok()),
        "draft": found.description,
        "notes": outcome.notes.iter().map(|note| with_flags(note)).collect::<Vec<_>>(),
    });
    Ok(Made::new(answer, Bundle::default()))
}

fn analyze(folder: &Folder, subject: &Subject, options: &Analyze, watch: &mut dyn Watch) -> Result<Made, JobError> {
    let outcome = options.run(folder.measured(subject, watch)?, None, watch)?;
    let analyzed = outcome.result;
    let bundle = analyzed.bundle(&without_figures(), watch)?;
    let stated = folder.stated(subject)?.name;
    let answer = json!({
        "title": analyzed.input.title,
        "first": first(&bundle),
        "holds": analyzed.analysis.holds.len(),
        "has_geometry": analyzed.analysis.options.geometry.is_some(),
        "law": recommended_law(&analyzed),
        "files": names(&bundle),
        "lines": lines::of_analysis(subject, stated.as_deref()),
    });
    Ok(Made::new(answer, bundle).of_analysis(analyzed))
}

/// The law that an analysis recommends, and the one to calibrate: `null` where a calibration does not accept it. Of the latency law that is the one
/// whose exponent is estimated, so that its error counts.
fn recommended_law(analyzed: &Analyzed) -> Option<Value> {
    let record = ComparedRecord::of_analysis(&analyzed.analysis, analyzed.input.clone());
    let recommended: Law = Answer::new(&record).law?.parse().ok()?;
    let calibrated = match recommended {
        Law::Latency { .. } => Calibrate::default().law,
        other => other,
    };
    let calibrated = Candidate::accepts(calibrated).then(|| calibrated.to_string());
    Some(json!({ "recommended": recommended.to_string(), "calibrated": calibrated }))
}

fn creep(folder: &Folder, subject: &Subject, watch: &mut dyn Watch) -> Result<Made, JobError> {
    let job = Compare {
        creep: true,
        ..Compare::default()
    };
    let compared = job.run_on(folder.measured(subject, watch)?, watch)?.result;
    let bundle = compared.bundle(&without_figures(), watch)?;
    let stated = folder.stated(subject)?.name;
    let answer = json!({
        "first": first(&bundle),
        "left_out": compared.left_out,
        "files": names(&bundle),
        "lines": lines::of_creep(subject, stated.as_deref()),
    });
    Ok(Made::new(answer, bundle))
}

fn batch(
    folder: &Folder,
    subject: &Subject,
    options: &Batch,
    watch: &mut dyn Watch,
    take: impl FnMut(BatchedTest),
) -> Result<Made, JobError> {
    let described = folder.described(subject)?;
    let opened = OpenedFile::open(&folder.file(&subject.file)?, &described)?;
    let batched = options.each_test(&opened, watch, take)?;
    let stated = folder.stated(subject)?.name;
    let quantities: Vec<&str> = batched.map.quantities().collect();
    // Of those that have one unit for all curves, whatever law is recommended.
    let shown = MAPPED.into_iter().find(|name| quantities.contains(name)).or(quantities.first().copied());
    let answer = json!({
        "first": fragment(&batched.answer.blocks()),
        "refused": batched.failures.len(),
        "quantities": quantities,
        "shown": shown,
        "lines": lines::of_batch(subject, stated.as_deref(), shown),
    });
    Ok(Made::new(answer, Bundle::default()).of_map(batched.map))
}

/// Several tests: each analysed, with the index of their reports.
fn compare(folder: &Folder, subjects: &[Subject], watch: &mut dyn Watch) -> Result<Made, JobError> {
    let (mut index, mut files) = (ReportIndex::default(), Vec::new());
    let job = Analyze::default();
    for (number, subject) in subjects.iter().enumerate() {
        let analyzed = folder.measured(subject, watch).and_then(|measured| job.run(measured, None, watch));
        let own = (number + 1).to_string();
        match analyzed {
            Ok(outcome) => {
                let analyzed: Analyzed = outcome.result;
                index.add(&analyzed, Path::new(&own), Path::new(""), watch)?;
                let bundle = analyzed.bundle(&without_figures(), watch)?;
                files.extend(bundle.files.into_iter().map(|(name, content)| (format!("{own}/{name}"), content)));
            }
            Err(error) if error.kind == palpate_jobs::ErrorKind::Cancelled => return Err(error),
            Err(error) => index.leave_out(Path::new(&subject.file), &error),
        }
    }
    let bundle = index.bundle(&without_figures(), watch)?;
    let stated: Vec<Option<String>> =
        subjects.iter().map(|subject| Ok(folder.stated(subject)?.name)).collect::<Result<_, JobError>>()?;
    let answer = json!({
        "files": names(&bundle),
        "lines": lines::of_comparison(subjects, &stated),
    });
    let mut made = Made::new(answer, bundle);
    made.files.extend(files);
    Ok(made)
}

/// A material; it is written into the folder.
fn calibrate(
    folder: &Folder,
    subjects: &[Subject],
    options: &Calibrate,
    watch: &mut dyn Watch,
) -> Result<Made, JobError> {
    let mut measured = Vec::with_capacity(subjects.len());
    for subject in subjects {
        measured.push(folder.measured(subject, watch)?);
    }
    let stated: Vec<Option<String>> =
        subjects.iter().map(|subject| Ok(folder.stated(subject)?.name)).collect::<Result<_, JobError>>()?;
    let Some(name) = subjects.first().map(|subject| match &subject.part {
        Some(part) => format!("{} {part}.x", Path::new(&subject.file).with_extension("").display()),
        None => subject.file.clone(),
    }) else {
        return Err(JobError::option("expected a record to calibrate, found none", "choose one"));
    };
    let (material, text, remarks, figure, document, notes) = if measured.len() == 1 {
        let outcome = options.run(measured.remove(0), watch)?;
        let made = outcome.result;
        let document = serde_json::to_value(made.document())?;
        (made.material(), made.text(), made.record.remarks(), Some(made.figure()), document, outcome.notes)
    } else {
        let several = CalibrateSeveral {
            law: options.law,
            equilibrium: options.equilibrium,
            poisson_ratio: options.poisson_ratio,
            rate: options.rate,
            confidence: options.confidence,
            ..CalibrateSeveral::default()
        };
        let outcome = several.run(measured, watch)?;
        let made = outcome.result;
        let document = serde_json::to_value(made.document())?;
        (made.material(), made.text(), made.batch.remarks(), made.figure(), document, outcome.notes)
    };
    let written = material.map(|material| folder.keep_material(&name, &material)).transpose()?;
    let answer = json!({
        "material": written,
        "text": text,
        "remarks": remarks,
        "figure": figure.as_ref().map(shown).transpose()?,
        "notes": notes.iter().map(|note| with_flags(note)).collect::<Vec<_>>(),
        "lines": lines::of_calibration(subjects, &stated, options.law, written.as_deref()),
    });
    let mut bundle = Bundle::default();
    let json = serde_json::to_vec_pretty(&document)?;
    bundle.files.push(("calibration.json".to_owned(), json));
    Ok(Made::new(answer, bundle))
}

fn grip(folder: &Folder, material: &str, options: &PlanGrip, watch: &mut dyn Watch) -> Result<Made, JobError> {
    let source = material_of(folder, material)?;
    let outcome = options.run(&source, watch)?;
    let body = outcome.result;
    let bundle = grip_bundle(&body, &without_figures())?;
    let made = body.answer.squeeze.as_ref().ok();
    // Of another motion than a plain squeeze the displacement alone would be another grip.
    let squeeze = made.and_then(|made| match made.found.plan.kind {
        PlanKind::Squeeze { displacement, .. } => Some(displacement),
        _ => None,
    });
    let answer = json!({
        "verdict": body.verdict(),
        "holds": body.answer.holds().ok(),
        "squeeze_m": squeeze,
        "remarks": body.remarks(),
        "figure": made.map(|_| shown(&grip_figure(&body, "grip"))).transpose()?,
        "files": names(&bundle),
        "lines": lines::of_grip(material, options),
    });
    Ok(Made::new(answer, bundle))
}

/// A material of the folder, under its name there.
///
/// # Errors
/// [`JobError`] where there is none of that name.
pub(crate) fn material_of(folder: &Folder, name: &str) -> Result<MaterialSource, JobError> {
    let mut source = MaterialSource::read(&folder.file(name)?)?;
    name.clone_into(&mut source.name);
    Ok(source)
}

/// What the sliders of a grip may be set to, by what the test of the material has shown.
pub(crate) fn grip_range(source: &MaterialSource) -> Value {
    let range = source.file.material.range();
    json!({
        "deepest_m": range.deepest,
        "fastest_m_per_s": range.fastest,
        "largest_force_n": range.largest_force,
        "longest_hold_s": range.longest_hold,
        "text": source.file.to_toml(),
    })
}
