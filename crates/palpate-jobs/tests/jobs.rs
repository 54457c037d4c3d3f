//! Jobs as front ends use them: their options as JSON, and work that is cancelled.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

#[path = "any_path/mod.rs"]
mod any_path;

use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use palpate::watch::{Cancelled, Progress, Unwatched, Watch};
use palpate_jobs::input::{Described, Measurement, NamedRecords, OpenedFile};
use palpate_jobs::{
    Analyze, Batch, Calibrate, Compare, Convert, ErrorKind, Inspect, JobError, MaterialSource, PlanGrip, Predict,
    Reproduce, Results, Simulate, Sweep, Verdict, WatchLog,
};
use schemars::{JsonSchema, schema_for};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A file of the repository's examples.
fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name)
}

fn ball() -> Measurement {
    let described = Described::read(Some(&example("records/ball.toml")), None).unwrap();
    let opened = OpenedFile::open(&example("records/ball.csv"), &described).unwrap();
    opened.measurement(opened.only().unwrap(), &mut Unwatched).unwrap()
}

fn options<J: Default + Serialize + DeserializeOwned + JsonSchema>() {
    let usual: J = serde_json::from_str("{}").unwrap();
    let json = serde_json::to_value(J::default()).unwrap();
    assert_eq!(serde_json::to_value(&usual).unwrap(), json, "what is left out has its default");
    let refused = serde_json::from_str::<J>("{\"fit_untill\": 1}").err().unwrap().to_string();
    assert!(refused.contains("unknown field"), "{refused}");
    let schema = schema_for!(J).to_value();
    let listed = schema["properties"].as_object().cloned().unwrap_or_default();
    assert!(json.as_object().unwrap().keys().all(|key| listed.contains_key(key)), "{schema}");
}

#[test]
fn every_job_has_a_json_form_with_defaults() {
    options::<Analyze>();
    options::<Batch>();
    options::<Calibrate>();
    options::<Compare>();
    options::<Convert>();
    options::<Inspect>();
    options::<Predict>();
    options::<Reproduce>();
    options::<Simulate>();
    options::<Sweep>();
    options::<WatchLog>();
    options::<PlanGrip>();
}

#[test]
fn options_that_exclude_each_other_name_themselves() {
    let job = Calibrate {
        poisson_ratio: Some(0.3),
        ..Calibrate::default()
    };
    let error = job.run(ball(), &mut Unwatched).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Option);
    assert_eq!(error.to_string(), "poisson_ratio is for Hertz's law, which is not requested");
}

#[test]
fn text_and_document_are_made_of_one_result() {
    let job = Analyze {
        compare: false,
        ..Analyze::default()
    };
    let outcome = job.run(ball(), None, &mut Unwatched).unwrap();
    assert_eq!(outcome.verdict, Verdict::Positive);
    let json: serde_json::Value = serde_json::from_str(&outcome.result.json().unwrap()).unwrap();
    assert_eq!(json["holds"].as_array().unwrap().len(), outcome.result.analysis.holds.len());
    assert!(outcome.result.text().contains("Hold"), "{}", outcome.result.text());
    assert_eq!(outcome.result.document().input.sha256, outcome.result.input.sha256);
}

/// A watch that cancels on request.
struct Impatient {
    cancelled: Arc<AtomicBool>,
}

impl Watch for Impatient {
    fn report(&mut self, _: Progress<'_>) -> Result<(), Cancelled> {
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }
}

/// The shortest time of a few from a cancellation to the end of the job that was cancelled; a job that is over before counts no more.
fn heard_after(mut job: impl FnMut(&mut Impatient) -> Result<(), JobError>) -> Duration {
    let mut shortest = Duration::MAX;
    for after in [20, 50, 100, 200].map(Duration::from_millis) {
        let cancelled = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&cancelled);
        let clock = thread::spawn(move || {
            thread::sleep(after);
            flag.store(true, Ordering::Relaxed);
            Instant::now()
        });
        let result = job(&mut Impatient { cancelled });
        let ended = Instant::now();
        let requested = clock.join().unwrap();
        match result {
            Err(error) => assert_eq!(error.kind, ErrorKind::Cancelled, "{error}"),
            Ok(()) => break,
        }
        shortest = shortest.min(ended.saturating_duration_since(requested));
    }
    shortest
}

const SOON: Duration = Duration::from_millis(200);

#[test]
fn an_analysis_and_a_comparison_hear_that_they_are_cancelled() {
    let measured = ball();
    let analyzed = heard_after(|watch| Analyze::default().run(measured.clone(), None, watch).map(drop));
    assert!(analyzed < SOON, "{analyzed:?}");
    let compared = heard_after(|watch| Compare::default().run_on(measured.clone(), watch).map(drop));
    assert!(compared < SOON, "{compared:?}");
}

#[test]
fn a_calibration_hears_that_it_is_cancelled() {
    let measured = ball();
    let job = Calibrate {
        profile: true,
        ..Calibrate::default()
    };
    let heard = heard_after(|watch| job.run(measured.clone(), watch).map(drop));
    assert!(heard < SOON, "{heard:?}");
}

#[test]
fn all_that_is_made_of_a_simulation_hears_its_watch() {
    let outcome = Simulate::default().run(&example("protocols/paper-a.toml"), None, &mut Unwatched).unwrap();
    let (simulated, path) = (outcome.result, Path::new("loop.svg"));
    let cancelled = |error: JobError| assert_eq!(error.kind, ErrorKind::Cancelled, "{error}");
    cancelled(simulated.energy(&mut until(0)).unwrap_err());
    cancelled(simulated.energy_by_step(&mut until(0)).unwrap_err());
    cancelled(simulated.energy_by_cycle(&mut until(0)).unwrap_err());
    cancelled(simulated.hysteresis(path, &mut until(0)).unwrap_err());
    cancelled(simulated.wave(&mut until(0)).unwrap_err());
    cancelled(Reproduce::default().run(&mut until(0)).unwrap_err());
}

/// A watch that cancels once so much is done.
fn until(done: u64) -> impl FnMut(Progress<'_>) -> Result<(), Cancelled> {
    move |progress| if progress.done < done { Ok(()) } else { Err(Cancelled) }
}

#[test]
fn a_cancelled_sweep_keeps_what_is_done_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(example("protocols/grip.toml")).unwrap();
    let protocol = |name: &str, runs: usize| {
        let path = folder.path().join(name);
        fs::write(&path, format!("{text}\n[sweep]\nspecimen.radius = \"linear 30..40 mm, {runs}\"\n")).unwrap();
        path
    };
    let anew = Sweep {
        restart: true,
        ..Sweep::default()
    };
    let (long, out) = (protocol("long.toml", 1_000_000), folder.path().join("t.parquet"));
    let heard = heard_after(|watch| anew.run(&long, Some(&out), None, watch).map(drop));
    assert!(heard < SOON && !out.exists(), "{heard:?}");
    let (job, short) = (Sweep::default(), protocol("short.toml", 500));
    let (out, whole) = (folder.path().join("s.parquet"), folder.path().join("whole.parquet"));
    let error = job.run(&short, Some(&out), None, &mut until(200)).unwrap_err();
    assert!(error.kind == ErrorKind::Cancelled && !out.exists(), "{error}");
    let outcome = job.run(&short, Some(&out), None, &mut Unwatched).unwrap();
    assert!(outcome.result.computed_before > 0 && outcome.result.computed_before < 500, "{:?}", outcome.result);
    job.run(&short, Some(&whole), None, &mut Unwatched).unwrap();
    assert!(fs::read(out).unwrap() == fs::read(whole).unwrap());
}

#[test]
fn a_cancelled_batch_keeps_what_is_done_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(example("records/ball.csv")).unwrap();
    for number in 0..40 {
        // Each is another file.
        fs::write(folder.path().join(format!("{number}.csv")), format!("{text}{}", "\n".repeat(number))).unwrap();
    }
    let described = Described::read(Some(&example("records/ball.toml")), None).unwrap();
    let records = NamedRecords::find([folder.path().to_owned()], described).unwrap();
    let out = folder.path().join("table.csv");
    let anew = Batch {
        restart: true,
        threads: NonZeroUsize::new(1),
        ..Batch::default()
    };
    let heard = heard_after(|watch| anew.run(records.clone(), &out, watch).map(drop));
    assert!(heard < SOON, "{heard:?}");
    let out = folder.path().join("again.csv");
    let job = Batch::default();
    let error = job.run(records.clone(), &out, &mut until(10)).unwrap_err();
    assert!(error.kind == ErrorKind::Cancelled && !out.exists(), "{error}");
    let outcome = job.run(records, &out, &mut Unwatched).unwrap();
    assert_eq!((outcome.result.tests, outcome.result.failures.len()), (40, 0));
    assert!(outcome.notes[0].contains(" done before"), "{:?}", outcome.notes);
}

/// No name of an output makes its writer panic, leave something half written, or write elsewhere.
#[test]
fn names_that_nobody_would_choose_are_written_or_refused() {
    let long = "n".repeat(300);
    let names = [
        "there",
        "folder",
        "there/below",
        "folder/new",
        "new/deep/er",
        "",
        ".",
        "./a",
        "a/",
        "a\0b",
        " ",
        "\u{202e}gpj.x",
        "CON",
        "-",
        &long,
        ".palpate-x",
        ".palpate-files",
        "folder/.palpate-x/lock",
        "a/./b",
        "\n",
        "=1+1.csv",
        "x.parquet/y",
        "\u{fffd}",
    ];
    for name in names {
        any_path::write_any(name.as_bytes());
    }
}

/// Sliders of a material that its record refutes answered as surely as those of another.
#[test]
fn a_squeeze_that_is_tried_by_a_refuted_law_says_so() {
    let mut source = MaterialSource::read(&example("records/ball-material.toml")).unwrap();
    let question: PlanGrip =
        serde_json::from_str(r#"{"mass_kg": 0.25, "friction": 0.6, "squeeze_m": 0.006, "hold_s": 10}"#).unwrap();
    let found = question.try_squeeze(&source, &mut Unwatched).unwrap();
    assert!(found.misfit.is_none() && !found.verdict.contains("refutes"), "{found:?}");
    source.file.origin.misfit = Some("prony:2".parse().unwrap());
    let found = question.try_squeeze(&source, &mut Unwatched).unwrap();
    assert!(found.verdict.contains(", by a law that the record refutes"), "{}", found.verdict);
    assert!(found.misfit.unwrap().contains("prony:2 describes it better than latency"));
}
