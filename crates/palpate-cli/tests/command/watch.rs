//! `palpate watch`: a log as if live.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::process::Command;

use crate::common::{data, done, file, palpate, ramp_and_hold, refused, root};
use serde_json::Value;
use tempfile::tempdir;

fn objects(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn ball() -> String {
    root().join("examples/records/ball.csv").display().to_string()
}

#[test]
fn a_hold_is_observed_as_it_comes_and_a_warning_precedes_slip() {
    let folder = tempdir().unwrap();
    let log = file(folder.path(), "log.csv", ramp_and_hold(30.0, 100.0));
    // F = 1 + (1 + 4 t)^(-1/4): 1.5 N after 3.75 s of the hold, which begins at 1 s.
    let reported = objects(&done(folder.path(), &["watch", &log, "--slip-force", "1.5 N", "--format", "jsonl"]));
    let of = |event: &str| reported.iter().filter(|line| line["event"] == event).cloned().collect::<Vec<_>>();
    let began = of("hold_begins");
    assert_eq!(began.len(), 1);
    assert!((began[0]["held_since_s"].as_f64().unwrap() - 1.0).abs() < 0.03, "{began:?}");
    assert_eq!(began[0]["held"], "displacement");
    let warnings = of("warning");
    let first = |what: &str| {
        let line = warnings.iter().find(|line| line["warning"] == what).unwrap();
        line["time_s"].as_f64().unwrap()
    };
    assert!((first("slipping") - 4.75).abs() < 0.03 && first("soon") < 3.8, "{warnings:?}");
    let summary = reported.last().unwrap();
    assert_eq!(summary["event"], "summary");
    let hold = &summary["holds"][0];
    assert!((hold["equilibrium_force_n"].as_f64().unwrap() - 1.0).abs() < 0.01, "{hold}");
    assert!(of("tick").len() > 55, "{}", of("tick").len());
    let text = done(folder.path(), &["watch", &log, "--slip-force", "1.5 N", "--every", "10 s"]);
    assert!(text.contains("hold: displacement held since 1.0") && text.contains("WARNING: slips"), "{text}");
    assert!(text.contains("Equilibrium") && text.contains("Slipped"), "{text}");
}

#[test]
fn the_steps_of_the_example_are_holds_with_their_equilibrium() {
    let folder = tempdir().unwrap();
    let reported = objects(&done(folder.path(), &["watch", &ball(), "--format", "jsonl", "--every", "1 s"]));
    let holds = reported.last().unwrap()["holds"].as_array().unwrap().clone();
    // E (u/depth) A(u) at 5, 10 and 15 mm: 28 kPa, r = 35 mm, u = d/2
    for (start, displacement) in [(0.6, 5e-3), (21.2, 10e-3), (41.8, 15e-3)] {
        let hold = holds.iter().find(|hold| (hold["start_s"].as_f64().unwrap() - start).abs() < 0.11).unwrap();
        let u: f64 = displacement / 2.0;
        let truth = 28e3 * (u / 0.035) * std::f64::consts::PI * (0.07 * u - u * u);
        let (found, deviation) = (
            hold["equilibrium_force_n"].as_f64().unwrap(),
            hold["equilibrium_force_standard_error_n"].as_f64().unwrap(),
        );
        assert!((found - truth).abs() < 4.0 * deviation && deviation < 0.05, "{hold} {truth}");
        assert_eq!(hold["held"], "displacement");
    }
    let material = root().join("examples/records/ball-material.toml").display().to_string();
    let reported = objects(&done(folder.path(), &["watch", &ball(), "--material", &material, "--format", "jsonl"]));
    let strain = reported.iter().find_map(|line| line["excess_strain"].as_f64()).unwrap();
    assert!((0.09..0.14).contains(&strain), "{strain}");
}

/// A log through a pipe was "no such file".
#[test]
fn a_log_through_a_pipe_is_watched() {
    let folder = tempdir().unwrap();
    let log = file(folder.path(), "log.csv", ramp_and_hold(5.0, 100.0));
    let by_name = done(folder.path(), &["watch", &log]);
    for arguments in [&["watch", "-"][..], &["watch"]] {
        let piped = std::fs::File::open(folder.path().join(&log)).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_palpate")).args(arguments).stdin(piped).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(String::from_utf8(output.stdout).unwrap(), by_name);
    }
    assert!(refused(folder.path(), &["watch", "-"]).contains("standard input: the file is empty"));
}

#[test]
fn wrong_options_are_refused() {
    let folder = tempdir().unwrap();
    for (more, expected) in [
        (&["--slip-force", "-1 N"][..], "above 0"),
        (&["--slip-force", "2 mm"], "mm"),
        (&["--speed", "0"], "above 0"),
        (&["--speed", "slow"], "max"),
        (&["--every", "0 s"], "above 0"),
        (&["--exponent", "0.5"], "from 1 to 30"),
        (&["--exponent-standard-error", "-1"], "from 0 to 10"),
        (&["--confidence", "2"], "between 0 and 1"),
        (&["--warn-before", "1 s"], "--slip-force"),
        (&["--material", "none.toml"], "no such file"),
    ] {
        let reported = refused(folder.path(), &[&["watch", &ball()], more].concat());
        assert!(reported.contains(expected), "{more:?}: {reported}");
    }
    assert!(refused(folder.path(), &["watch", "none.csv"]).contains("no such file"));
}

#[test]
fn a_gripper_that_holds_a_force_creeps_and_does_not_slip() {
    let Some(log) = data("gripper-fruit/banana_ForceData_20240824_210940_refined.csv") else {
        return;
    };
    let own = tempdir().unwrap();
    let test = root().join("examples/tests/gripper.toml").display().to_string();
    let reported = objects(&done(
        own.path(),
        &["watch", &log.display().to_string(), "--test", &test, "--slip-force", "0.5 N", "--format", "jsonl"],
    ));
    let holds = reported.last().unwrap()["holds"].as_array().unwrap().clone();
    // Two grasps at a set force, 6 N and 5 N.
    for (start, force) in [(2.6, 6.0), (15.4, 5.05)] {
        let hold = holds.iter().find(|hold| (hold["start_s"].as_f64().unwrap() - start).abs() < 0.5).unwrap();
        assert_eq!(hold["held"], "force", "{hold}");
        assert!((hold["force_end_n"].as_f64().unwrap() - force).abs() < 0.3, "{hold}");
        assert!(hold["creep_rate_m_per_s"].as_f64().unwrap() > 0.0, "{hold}");
    }
}

#[test]
fn rows_out_of_order_are_reported_and_readings_that_are_none_are_refused() {
    let folder = tempdir().unwrap();
    let log = ramp_and_hold(5.0, 100.0);
    let mut rows: Vec<&str> = log.lines().collect();
    rows.swap(300, 301);
    let late = file(folder.path(), "late.csv", rows.join("\n"));
    let reported = palpate(folder.path(), &["watch", &late]);
    let stated = String::from_utf8(reported.stderr).unwrap();
    assert!(reported.status.success() && stated.contains("1 row up to 0.0100 s late"), "{stated}");
    rows[300] = "2.9900,inf,1.5";
    let none = file(folder.path(), "none.csv", rows.join("\n"));
    assert!(refused(folder.path(), &["watch", &none]).contains("expected a finite number"));
}

/// The force at the end of a hold was that of a reading of the release: 2.968 for 3.128 N.
#[test]
fn the_force_at_the_end_of_a_hold_is_that_of_its_end() {
    let folder = tempdir().unwrap();
    let row = |i: u32| {
        let t = 0.05 * f64::from(i);
        let travel = t.min(2.0).min((22.0 - t).max(0.0));
        format!("{t:.2},{travel:.4},{:.5}\n", travel * (1.0 + 0.5 * (-(t - 2.0).max(0.0) / 4.0).exp()))
    };
    let rows: String = (0..480).map(row).collect();
    let log = file(folder.path(), "log.csv", format!("Time (s),Displacement (mm),Force (N)\n{rows}"));
    let reported = objects(&done(folder.path(), &["watch", &log, "--format", "jsonl"]));
    let hold = &reported.last().unwrap()["holds"][0];
    assert!((hold["force_end_n"].as_f64().unwrap() - 2.013).abs() < 0.01, "{hold}");
}
