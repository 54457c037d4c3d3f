//! The conditions of a test, and R(t) at stated times, as reports of stress-relaxation tests give them.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{done, file, ramp_and_hold, refused};

/// The document of a record of 1 + (1 + 4 t)^(−1/4) N after a ramp of 1 s to 1 mm.
fn analyzed(folder: &Path, test: &str) -> Value {
    file(folder, "press.csv", ramp_and_hold(100.0, 20.0));
    file(folder, "test.toml", test);
    let json = done(folder, &["analyze", "press.csv", "--test", "test.toml", "--no-compare", "--format", "json"]);
    serde_json::from_str(&json).unwrap()
}

fn force(t: f64) -> f64 {
    1.0 + (1.0 + 4.0 * t).powf(-0.25)
}

/// Time and R(t), with its standard error.
fn stated(hold: &Value) -> Vec<[f64; 3]> {
    let number = |row: &Value, name: &str| row[name].as_f64().unwrap();
    let rows = hold["report"]["relaxation"].as_array().unwrap();
    rows.iter()
        .map(|row| ["time_s", "relaxation", "relaxation_standard_error"].map(|name| number(row, name)))
        .collect()
}

#[test]
fn relaxation_is_stated_as_far_as_it_was_measured() {
    let folder = tempfile::tempdir().unwrap();
    let document = analyzed(folder.path(), "");
    let hold = &document["holds"][0];
    let found = stated(hold);
    assert_eq!(found.iter().map(|row| row[0]).collect::<Vec<_>>(), [1.0, 3.0, 10.0, 30.0, 60.0]);
    for [time, relaxation, error] in found {
        let expected = 1.0 - force(time) / force(0.0);
        // The line over ln t through samples within 5 or 20 % bends by less.
        assert!((relaxation - expected).abs() < 2e-4 && error < 2e-4, "{time}: {relaxation} ± {error}, {expected}");
    }
    let report = &hold["report"];
    assert!((report["applied_in_s"].as_f64().unwrap() - 1.0).abs() < 0.06, "{report}");
    assert_eq!(report["constraint_variation_m"].as_f64(), Some(0.0));
    assert!((report["initial_force_n"].as_f64().unwrap() - 2.0).abs() < 1e-3, "{report}");
    for name in ["temperature_k", "relative_humidity", "medium", "conditioning", "specimen_form", "lubricant"] {
        assert!(document["conditions"][name].is_null(), "{name}");
    }
}

#[test]
fn the_initial_force_and_the_times_are_those_of_the_description() {
    let folder = tempfile::tempdir().unwrap();
    let test = "[conditions]\ninitial_force_after = \"10 s\"\nrelaxation_at = [\"1 min\", \"20 s\", \"95 s\"]\n";
    let document = analyzed(folder.path(), test);
    let found = stated(&document["holds"][0]);
    // 95 s after those 10 s were not measured.
    assert_eq!(found.iter().map(|row| row[0]).collect::<Vec<_>>(), [20.0, 60.0]);
    for [time, relaxation, _] in found {
        let expected = 1.0 - force(10.0 + time) / force(10.0);
        assert!((relaxation - expected).abs() < 2e-4, "{time}: {relaxation}, {expected}");
    }
}

#[test]
fn a_report_shows_what_is_stated_and_what_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let test =
        "[conditions]\ntemperature = \"23 °C\"\nrelative_humidity = \"50 %\"\nspecimen_form = \"moulded <cylinder>\"\n";
    let document = analyzed(folder, test);
    assert_eq!(document["conditions"]["temperature_k"].as_f64(), Some(296.15));
    assert_eq!(document["conditions"]["relative_humidity"].as_f64(), Some(0.5));
    done(folder, &["analyze", "press.csv", "--test", "test.toml", "--no-compare", "--out", "study"]);
    let page = fs::read_to_string(folder.join("study/report.html")).unwrap();
    assert!(page.contains("23.00 °C") && page.contains("moulded &lt;cylinder&gt;"), "{page}");
    assert!(page.matches("not stated").count() == 3 && page.contains("without a claim of conformity"), "{page}");
    let table = fs::read_to_string(folder.join("study/tables/relaxation_at.csv")).unwrap();
    assert!(
        table.starts_with("hold,time_s,force_n,force_n_standard_error,force_n_low,force_n_high,relaxation,"),
        "{table}"
    );
    assert_eq!(table.lines().count(), 6);
}

/// A time beyond the hold that the description states vanished from the table.
#[test]
fn a_stated_time_beyond_the_hold_is_shown_as_not_measured() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let document = analyzed(folder, "[conditions]\nrelaxation_at = [\"10 s\", \"1 h\"]\n");
    assert_eq!(document["holds"][0]["report"]["not_measured_s"], serde_json::json!([3600.0]));
    done(folder, &["analyze", "press.csv", "--test", "test.toml", "--no-compare", "--out", "study"]);
    let table = fs::read_to_string(folder.join("study/tables/relaxation_at.csv")).unwrap();
    assert_eq!(table.lines().nth(2), Some("1,3600,,,,,,,,"), "{table}");
    assert!(fs::read_to_string(folder.join("study/report.html")).unwrap().contains("beyond the hold"));
}

#[test]
fn conditions_that_make_no_sense_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    file(folder, "press.csv", ramp_and_hold(20.0, 20.0));
    for (line, expected) in [
        ("temperature = \"warm\"", "conditions.temperature"),
        ("temperature = \"-300 °C\"", "a temperature above absolute zero"),
        ("temperature = 23", "conditions.temperature"),
        ("relative_humidity = \"120 %\"", "a share up to 100 %"),
        ("relaxation_at = [\"1 min\", \"-1 s\"]", "conditions.relaxation_at[2]"),
        ("initial_force_after = \"1 mm\"", "conditions.initial_force_after"),
        ("temprature = \"23 °C\"", "temperature"),
    ] {
        file(folder, "test.toml", format!("[conditions]\n{line}\n"));
        let error = refused(folder, &["analyze", "press.csv", "--test", "test.toml"]);
        assert!(error.contains(expected), "{line}: {error}");
    }
}
