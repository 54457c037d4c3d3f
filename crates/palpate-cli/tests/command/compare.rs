//! `palpate compare`, and the comparison inside `palpate analyze`.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::path::Path;

use crate::common::{data, done, file, palpate, ramp_and_hold, refused, root};
use serde_json::Value;
use tempfile::tempdir;

fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&done(folder, arguments)).unwrap()
}

/// The example record and its description, as paths from the root.
const BALL: [&str; 3] = ["examples/records/ball.csv", "--test", "examples/records/ball.toml"];

#[test]
fn the_example_record_is_compared() {
    let arguments = [["compare"].as_slice(), &BALL, &["--laws", "latency,latency:5,sls,prony:2,spectrum"]].concat();
    let text = done(&root(), &arguments);
    assert!(text.lines().all(|line| line.chars().count() <= 100), "wider than a terminal");
    insta::assert_snapshot!("compare_text", text);
    let markdown = done(&root(), &[arguments.as_slice(), &["--format", "markdown"]].concat());
    insta::assert_snapshot!("compare_markdown", markdown);
}

#[test]
fn the_law_that_made_the_record_is_chosen_and_the_sentence_says_so() {
    let arguments = [["compare"].as_slice(), &BALL, &["--format", "json"]].concat();
    let document = json(&root(), &arguments);
    assert_eq!(document["schema"], "palpate.comparison/1");
    assert_eq!(document["settings"]["laws"].as_array().unwrap().len(), 12);
    let holds = document["records"][0]["holds"].as_array().unwrap();
    assert_eq!(holds.len(), 5);
    for hold in &holds[..4] {
        let comparison = &hold["comparison"];
        assert_eq!((&comparison["ranking"], &comparison["signal"]), (&"forward".into(), &"strain".into()));
        assert_eq!(comparison["verdict"]["law"], "latency:5", "hold {}", hold["index"]);
        let sentence = comparison["verdict"]["sentence"].as_str().unwrap();
        assert!(sentence.contains("the nonlinear latency law with n = 5 (3 parameters)"), "{sentence}");
        // The noise of these holds leaves open which of the laws about it predicts best.
        let probability = comparison["verdict"]["probability"].as_f64().unwrap();
        assert!((0.3..0.75).contains(&probability) && comparison["verdict"]["certainty"] == "open", "{probability}");
        assert!(sentence.contains(&format!("With a probability of {:.0} % (", 100.0 * probability)), "{sentence}");
        let laws = comparison["laws"].as_array().unwrap();
        let made = laws.iter().find(|law| law["law"] == "latency:5").unwrap();
        let rate = &made["parameters"]["rate_coefficient_per_s"];
        let (value, error) = (rate["value"].as_f64().unwrap(), rate["standard_error"].as_f64().unwrap());
        assert!((value - 2e4).abs() < 4.0 * error, "v = {value} ± {error}");
        // Its error beyond the first half is the noise of what is predicted.
        let last = made["forecasts"].as_array().unwrap().last().unwrap();
        let (error, noise) = (last["error"].as_f64().unwrap(), comparison["noise"].as_f64().unwrap());
        let noise = noise / comparison["change"].as_f64().unwrap();
        assert!((error / noise - 1.0).abs() < 0.35, "{error} is not {noise}");
    }
}

#[test]
fn documents_agree_with_their_schema_and_each_other() {
    let folder = tempdir().unwrap();
    let schema = json(folder.path(), &["schema", "comparison"]);
    let record = file(folder.path(), "record.csv", ramp_and_hold(10.0, 20.0));
    // Intervals that are not the usual ones are stated in the settings.
    let requested = |command: &str, out: &str| {
        json(folder.path(), &[command, &record, "--intervals", "profile", "--format", "json", "--out", out])
    };
    let document = requested("compare", "laws");
    let same_keys = |value: &Value, schema: &Value| {
        let promised: Vec<&String> = schema["properties"].as_object().unwrap().keys().collect();
        let mut found: Vec<&String> = value.as_object().unwrap().keys().collect();
        found.sort();
        assert_eq!(found, promised);
    };
    same_keys(&document, &schema);
    let comparison = &document["records"][0]["holds"][0]["comparison"];
    for (value, name) in [
        (&document["settings"], "ComparisonSettingsDocument"),
        (&document["records"][0], "ComparedRecordDocument"),
        (&document["records"][0]["holds"][0], "ComparedHoldDocument"),
        (comparison, "HoldComparisonDocument"),
        (&comparison["laws"][0], "LawDocument"),
        (&comparison["verdict"], "VerdictDocument"),
        (&comparison["forecast"], "HoldForecastDocument"),
        (&comparison["forecast"]["at"][0], "ForecastedDocument"),
    ] {
        same_keys(value, &schema["$defs"][name]);
    }
    let laws = folder.path().join("laws");
    let written: Value = serde_json::from_slice(&std::fs::read(laws.join("comparison.json")).unwrap()).unwrap();
    assert_eq!(written, document);
    for name in [
        "report.html",
        "comparison.md",
        "tables/laws.csv",
        "figures/forecasts.svg",
        "figures/forward_errors.svg",
        "figures/spectra.svg",
    ] {
        assert!(laws.join(name).metadata().unwrap().len() > 100, "{name}");
    }
    let analysis = requested("analyze", "study");
    assert_eq!(&analysis["holds"][0]["comparison"], comparison);
    let study = folder.path().join("study");
    let page = std::fs::read_to_string(study.join("report.html")).unwrap();
    for answer in ["verdict", "forecast"] {
        let sentence = comparison[answer]["sentence"].as_str().unwrap();
        assert!(page.contains(&sentence[..40]), "{sentence}");
    }
    assert!(study.join("tables/laws.csv").exists() && study.join("figures/spectra.svg").exists());
    let without = json(folder.path(), &["analyze", &record, "--format", "json", "--no-compare", "--out", "study"]);
    assert!(without["holds"][0]["comparison"].is_null());
    assert!(!study.join("tables/laws.csv").exists() && !study.join("figures/spectra.svg").exists());
}

#[test]
fn a_folder_is_searched_and_what_cannot_be_compared_is_listed() {
    let folder = tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("records/below")).unwrap();
    file(folder.path(), "records/below/hold.csv", ramp_and_hold(10.0, 20.0));
    file(folder.path(), "records/notes.txt", "no table here");
    file(folder.path(), "records/test.toml", "[specimen]");
    file(folder.path(), "records/.hidden.csv", "");
    let text = done(folder.path(), &["compare", "records", "--laws", "latency,sls", "--format", "markdown"]);
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("| records")).collect();
    assert_eq!(rows.len(), 1, "{text}");
    assert!(rows[0].contains("hold.csv") && rows[0].contains("**"), "{text}");
    assert!(
        text.contains("- records/notes.txt: ") && !text.contains("toml") && !text.contains("hidden"),
        "{text}"
    );
    // The page of several begins with all of them, that of one does not.
    file(folder.path(), "records/other.csv", ramp_and_hold(5.0, 20.0));
    for (records, several) in [("records", true), ("records/other.csv", false)] {
        let out = if several { "both" } else { "alone" };
        done(folder.path(), &["compare", records, "--laws", "latency,sls", "--out", out]);
        let page = std::fs::read_to_string(folder.path().join(out).join("report.html")).unwrap();
        let (table, first) = (page.find("All records"), page.find("Hold 1"));
        assert_eq!(table.is_some_and(|table| first.is_some_and(|first| table < first)), several);
    }
    std::fs::remove_file(folder.path().join("records/other.csv")).unwrap();
    std::fs::remove_file(folder.path().join("records/below/hold.csv")).unwrap();
    let output = palpate(folder.path(), &["compare", "records"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("notes.txt"));
}

#[test]
fn a_short_hold_is_ranked_by_information() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "record.csv", ramp_and_hold(2.0, 20.0));
    let document = json(folder.path(), &["compare", &record, "--format", "json", "--laws", "latency:5,sls"]);
    let comparison = &document["records"][0]["holds"][0]["comparison"];
    assert_eq!(comparison["ranking"], "information");
    assert!(comparison["verdict"]["sentence"].as_str().unwrap().contains("too short"));
}

#[test]
fn creep_at_constant_force() {
    let folder = tempdir().unwrap();
    let creep = |sign: f64| {
        let mut text = String::from("time_s,displacement_mm,force_n\n");
        for i in 0..=420 {
            let t = 0.05 * f64::from(i);
            let crept = 0.3 * (1.0 - (-(t - 1.0).max(0.0) / 5.0).exp());
            text.push_str(&format!("{t:.2},{:.9},{:.6}\n", t.min(1.0) + crept, 6.0 * sign * t.min(1.0)));
        }
        text
    };
    let negative = file(folder.path(), "negative.csv", creep(-1.0));
    let document = json(folder.path(), &["compare", &negative, "--creep", "--laws", "sls", "--format", "json"]);
    assert_eq!(document["records"][0]["findings"][0]["code"], "sign_suspicious");
    let record = file(folder.path(), "creep.csv", creep(1.0));
    let document = json(folder.path(), &["compare", &record, "--creep", "--format", "json"]);
    assert_eq!(document["settings"]["response"], "creep");
    let hold = &document["records"][0]["holds"][0];
    assert!((hold["force_n"].as_f64().unwrap() - 6.0).abs() < 1e-6 && hold["displacement_m"].is_null());
    let comparison = &hold["comparison"];
    assert_eq!(
        (&comparison["signal_unit"], &comparison["verdict"]["law"]),
        (&"m".into(), &"standard-linear-solid".into())
    );
    let laws = comparison["laws"].as_array().unwrap();
    let sls = laws.iter().find(|law| law["law"] == "standard-linear-solid").unwrap();
    assert!((sls["parameters"]["time_constant_s"]["value"].as_f64().unwrap() - 5.0).abs() < 1e-3);
    assert!((sls["parameters"]["amplitude"]["value"].as_f64().unwrap() - 3e-4).abs() < 1e-6);
    // A hold whose limits are given is that one; one in which the displacement is stated to be held does not creep.
    let given = |mode: &str| format!("[[phases.hold]]\nfrom = \"3 s\"\nto = \"13 s\"\n{mode}");
    file(folder.path(), "given.toml", given(""));
    let arguments = ["compare", &record, "--creep", "--format", "json", "--test", "given.toml"];
    let document = json(folder.path(), &arguments);
    let holds = document["records"][0]["holds"].as_array().unwrap();
    assert_eq!((holds.len(), &holds[0]["start_s"], &holds[0]["end_s"]), (1, &3.0.into(), &13.0.into()));
    assert_eq!(holds[0]["comparison"]["verdict"]["law"], "standard-linear-solid");
    file(folder.path(), "given.toml", given("mode = \"displacement\""));
    let error = refused(folder.path(), &arguments);
    assert!(error.contains("no hold found in which the force is constant"), "{error}");
    file(folder.path(), "given.toml", given("").replace("13 s", "99 s"));
    let error = refused(folder.path(), &arguments);
    assert!(error.contains("99") && error.contains("21"), "{error}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "record.csv", ramp_and_hold(5.0, 20.0));
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    for (arguments, words) in [
        (["compare", &record, "--laws", "latency,quadratic"].as_slice(), ["quadratic", "fractional-zener"]),
        (&["compare", &record, "--laws", "prony:9"], ["prony:9", "prony:K"]),
        (&["compare", &record, "--laws", "kelvin-voigt"], ["kelvin-voigt", "--creep"]),
        (&["compare", &record, "--cuts", "0.5,1.5"], ["1.5", "between 0 and 1"]),
        (&["compare", &record, "--cuts", "-0.5"], ["-0.5", "between 0 and 1"]),
        (&["compare", &record, "--samples", "log"], ["log", "log:400"]),
        (&["compare", &record, "--samples", "log:2"], ["log:2", "at least 10"]),
        (&["compare", &record, "--loss", "cubes"], ["cubes", "huber"]),
        (&["compare", "empty"], ["empty", "expected a folder with records"]),
        (&["compare", "absent.csv"], ["absent.csv", "error"]),
        (&["compare", &record, "--creep"], ["record.csv", "hint"]),
    ] {
        let error = refused(folder.path(), arguments);
        for word in words {
            assert!(error.contains(word), "`{word}` is not in:\n{error}");
        }
    }
}

#[test]
fn the_gripper_creeps_at_its_set_force() {
    let Some(record) = data("gripper-fruit/banana_ForceData_20240824_210940_refined.csv") else {
        return;
    };
    let test = root().join("examples/tests/gripper.toml");
    let arguments =
        ["compare", record.to_str().unwrap(), "--test", test.to_str().unwrap(), "--creep", "--format", "json"];
    let document = json(Path::new("."), &arguments);
    let holds = document["records"][0]["holds"].as_array().unwrap();
    let held = holds.iter().find(|hold| (hold["force_n"].as_f64().unwrap() - 6.0).abs() < 0.1).unwrap();
    let change = held["comparison"]["change"].as_f64().unwrap();
    assert!((1e3 * change - 0.29).abs() < 0.1, "{change} m");
}
