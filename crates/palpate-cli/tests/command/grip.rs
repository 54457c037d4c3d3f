//! `palpate grip`: verdicts and their exit codes, documents, reports, bad input.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use crate::common::{done, file, palpate, refused, root};
use serde_json::Value;
use tempfile::tempdir;

fn ball() -> String {
    root().join("examples/records/ball-material.toml").display().to_string()
}

/// A quarter of a kilogram with μ = 0.6 needs 2.043 N.
fn load(ball: &str) -> Vec<&str> {
    vec!["grip", ball, "--mass", "250g", "--friction", "0.6"]
}

fn json(more: &[&str]) -> (Option<i32>, Value) {
    let (folder, ball) = (tempdir().unwrap(), ball());
    let output = palpate(folder.path(), &[&load(&ball), more, &["--format", "json"]].concat());
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    (output.status.code(), serde_json::from_str(&text).unwrap_or_else(|_| panic!("{more:?}: {output:?}")))
}

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} in {value}"))
}

#[test]
fn the_verdict_is_the_exit_code() {
    let (code, found) = json(&["--squeeze", "5 mm"]);
    assert_eq!(
        (code, found["schema"].as_str(), found["holds"].as_bool()),
        (Some(0), Some("palpate.grip/1"), Some(true))
    );
    let time = number(&found["squeeze"]["time_to_slip"], "seconds");
    // The ball was simulated with n = 5 and 2e4 /s, with which the closed form says 0.611 s.
    assert!((time - 0.611).abs() < 0.03, "{time}");
    assert!(number(&found["squeeze"]["interval"][0], "seconds") < time);
    // It was a yes, to a hold of half a second.
    let verdict = found["verdict"].as_str().unwrap();
    assert!(
        verdict.starts_with("Not for long: a squeeze of 5.000 mm") && verdict.contains("holds for 0."),
        "{verdict}"
    );
    let (code, found) = json(&["--squeeze", "5 mm", "--hold", "10 s"]);
    assert_eq!((code, found["holds"].as_bool()), (Some(1), Some(false)));
    let (code, found) = json(&["--hold", "10 s"]);
    assert_eq!(code, Some(0));
    assert!((number(&found["squeeze"]["assured"], "seconds") / 10.0 - 1.0).abs() < 1e-3);
    let (code, found) = json(&["--hold", "always", "--objective", "peak-force"]);
    assert_eq!((code, found["squeeze"]["time_to_slip"]["always"].as_bool()), (Some(0), Some(true)));
    let (code, found) = json(&["--hold", "10 s", "--most-force", "2.5 N", "--close-within", "0.5 s"]);
    assert_eq!((code, found["holds"].as_bool()), (Some(1), Some(false)));
    assert!(found["verdict"].as_str().unwrap().starts_with("No: no squeeze within the limits holds"), "{found}");
}

#[test]
fn a_verdict_holds_with_a_probability_or_by_the_best_estimate() {
    let (code, best) = json(&["--hold", "60 s", "--confidence", "0.5"]);
    assert_eq!((code, number(&best, "confidence"), best["verdict_confidence"].as_f64()), (Some(0), 0.95, Some(0.5)));
    assert!((number(&best, "probability") - 0.5).abs() < 1e-6);
    assert!(best["verdict"].as_str().unwrap().starts_with("Yes (best estimate):"), "{best}");
    let (code, found) = json(&["--hold", "60 s", "--confidence", "0.9"]);
    assert_eq!((code, number(&found, "confidence"), number(&found, "verdict_confidence")), (Some(0), 0.95, 0.9));
    let verdict = found["verdict"].as_str().unwrap();
    assert!(verdict.contains("holds for 60.0 s with a probability of 90 %"), "{verdict}");
    assert!((number(&found["squeeze"]["assured"], "seconds") / 60.0 - 1.0).abs() < 1e-3);
    assert!(number(&found["squeeze"], "displacement_m") > number(&best["squeeze"], "displacement_m"));
    // The least squeeze by the best estimate does not hold with a confidence.
    let squeeze = format!("{} m", number(&best["squeeze"], "displacement_m"));
    let (code, short) = json(&["--squeeze", &squeeze, "--hold", "60 s"]);
    let verdict = short["verdict"].as_str().unwrap();
    assert_eq!(code, Some(1));
    assert!(verdict.starts_with("No:") && verdict.contains("; 95 % are required"), "{verdict}");
    // The squeeze that reaches it does, as it reads.
    let enough = verdict.split("A squeeze of ").nth(1).unwrap().split(" reaches 95 %").next().unwrap().to_owned();
    assert!(enough.ends_with(" mm"), "{verdict}");
    let (code, found) = json(&["--squeeze", &enough, "--hold", "60 s"]);
    assert_eq!((code, found["assured_squeeze_m"].as_f64()), (Some(0), None), "{found}");
}

/// Half of the parameters that the test allows let a hold slip that begins with just the equilibrium force that is needed.
#[test]
fn a_hold_that_may_slip_at_once_is_not_stated_to_hold_always() {
    let (folder, ball) = (tempdir().unwrap(), ball());
    let text = done(folder.path(), &[&load(&ball)[..], &["--confidence", "0.5"]].concat());
    let row = text.lines().find(|line| line.starts_with("overshoot and back off")).unwrap();
    assert!(row.contains("uncertain") && !row.contains("always"), "{row}");
    let remarks = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        remarks.contains("It may still slip at once: the interval of the time to slip starts at 0 s"),
        "{text}"
    );
    // With the usual one there is a margin.
    let text = done(folder.path(), &load(&ball));
    let row = text.lines().find(|line| line.starts_with("overshoot and back off")).unwrap();
    assert!(!row.contains("uncertain") && !text.contains("It may slip at once"), "{text}");
}

#[test]
fn both_ways_of_control_give_opposite_advice() {
    let (code, found) = json(&["--control", "force", "--hold", "100 s"]);
    assert_eq!(code, Some(0));
    let (held, squeeze) = (&found["force_held"], &found["squeeze"]);
    assert!(number(held, "force_n") < 0.7 * number(squeeze, "start_force_n"));
    assert!(number(held, "displacement_end_m") > 1.5 * number(held, "displacement_start_m"));
    assert!(found["extrapolations"].to_string().contains("the force is held"));
    let (code, short) = json(&["--control", "force", "--hold", "100 s", "--stroke", "5 mm"]);
    assert_eq!(code, Some(1));
    assert!(short["verdict"].as_str().unwrap().contains("come to the end of their stroke"), "{short}");
}

#[test]
fn the_report_has_all_of_it() {
    let (folder, ball) = (tempdir().unwrap(), ball());
    let more = ["--hold", "1 h", "--band", "2.1..3 N", "--out", "plan", "--figure", "grip.svg"];
    let text = done(folder.path(), &[&load(&ball)[..], &more].concat());
    for words in [
        "Yes: a force of",
        "Overshoot and back off (a preconditioning squeeze): squeeze to",
        "6 squeezes keep the force between 2.100 N and 3.000 N",
        "Beyond the test",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    for name in ["report.html", "grip.json", "figures/grip.svg", "tables/schedule.csv", "series/force_held.csv"] {
        assert!(folder.path().join("plan").join(name).exists(), "{name}");
    }
    let document: Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("plan/grip.json")).unwrap()).unwrap();
    let back_off = &document["back_off"];
    assert!(number(back_off, "drift_n").abs() < 1e-6 && number(back_off, "plain_drift_n") < -1.0, "{back_off}");
    assert_eq!(document["schedule"]["moves"].as_array().unwrap().len(), 6);
    assert!(!document.to_string().contains("NaN"));
    assert!(folder.path().join("grip.svg").exists());
}

#[test]
fn numbers_that_make_no_grip_are_reported_by_name() {
    let (folder, ball) = (tempdir().unwrap(), ball());
    for (arguments, words) in [
        (&["--mass", "250g", "--friction", "0"][..], "friction must be finite and above 0, found 0"),
        (&["--mass", "250", "--friction", "0.6"], "expected a unit after the number"),
        (&["--mass", "-1 kg", "--friction", "0.6"], "expected a mass above 0"),
        (&["--mass", "250g", "--friction", "NaN"], "friction must be finite"),
        (
            &["--mass", "250g", "--friction", "0.6", "--safety", "0.5"],
            "safety factor must be finite and not below 1",
        ),
        (&["--mass", "250g", "--friction", "0.6", "--band", "3..2 N"], "upper edge of the band"),
        (&["--mass", "250g", "--friction", "0.6", "--band", "3 N"], "expected two forces"),
        (&["--mass", "250g", "--friction", "0.6", "--force", "3 N"], "--force is for a force that is held"),
        (&["--mass", "250g", "--friction", "0.6", "--hold", "0 s"], "expected a time above 0"),
    ] {
        let error = refused(folder.path(), &[&["grip", &ball][..], arguments].concat());
        assert!(error.contains(words), "{arguments:?}: {error}");
    }
    let text = std::fs::read_to_string(&ball).unwrap();
    let version = text.replacen("version = 1", "version = 2", 1);
    assert_ne!(version, text);
    let name = file(folder.path(), "later.toml", version);
    let error = refused(folder.path(), &load(&name));
    assert!(error.contains("version"), "{error}");
}

const SERIES: &str = r#"
[specimen]
shape = "ball"
radius = "35 mm"
modulus = "28 kPa"

[law]
name = "prony"
terms = [{ overshoot = 0.5, time = "0.8 s" }, { overshoot = 0.4, time = "15 s" }]

[contact]
squeezed_from = "two sides"
separation = true

[[step]]
to = "10 mm"
rate = "500 mm/min"
hold = "20 s"

[[step]]
to = "15 mm"
rate = "500 mm/min"
hold = "20 s"

[output]
sample_rate = "10 Hz"
"#;

/// A grip of a material whose record has two time constants answered as surely by the latency law as by its own.
#[test]
fn a_grip_by_a_law_that_the_record_refutes_says_so_first() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    file(folder, "series.toml", SERIES);
    let noise = ["--force-noise", "0.05 N", "--displacement-noise", "0.001 mm", "--seed", "7"];
    done(folder, &[&["simulate", "series.toml", "--out", "series.csv"], &noise[..]].concat());
    let test = root().join("examples/records/ball.toml").display().to_string();
    let calibrate = |law: &str, alternatives: &[&str]| {
        let words = ["calibrate", "series.csv", "--test", &test, "--law", law, "--out", "material.toml"];
        let text = done(folder, &[&words, alternatives].concat());
        (text, std::fs::read_to_string(folder.join("material.toml")).unwrap())
    };
    let words = [&load("material.toml"), &["--squeeze", "8 mm", "--hold", "10 s"][..]].concat();
    let grip = || {
        let text = String::from_utf8(palpate(folder, &words).stdout).unwrap();
        let json = palpate(folder, &[&words[..], &["--format", "json"]].concat()).stdout;
        (text, serde_json::from_slice::<Value>(&json).unwrap())
    };
    let (text, material) = calibrate("latency", &["--alternatives", "prony:2"]);
    assert!(text.contains("The record refutes this law: prony:2"), "{text}");
    assert!(material.contains("\nmisfit = \"prony:2\"\n"), "{material}");
    let (text, document) = grip();
    let misfit = document["misfit"].as_str().unwrap();
    assert!(misfit.starts_with("The record refutes this law: prony:2"), "{misfit}");
    assert!(misfit.ends_with("What helps: calibrate with the law prony:2."), "{misfit}");
    assert_eq!(document["remarks"][0], misfit);
    let verdict = document["verdict"].as_str().unwrap();
    assert!(verdict.contains(", by a law that the record refutes"), "{verdict}");
    let unwrapped = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(unwrapped.find(misfit).unwrap() < unwrapped.find(verdict).unwrap(), "{text}");
    // So does a prediction.
    file(folder, "hold.toml", "[[step]]\nto = \"8 mm\"\nrate = \"500 mm/min\"\nhold = \"20 s\"\n");
    let predicted = palpate(folder, &["predict", "material.toml", "--protocol", "hold.toml", "--at", "5 s"]);
    let notes = String::from_utf8(predicted.stderr).unwrap();
    assert!(notes.contains("The record refutes this law: prony:2"), "{notes}");
    // Without another law its residuals speak.
    let (_, material) = calibrate("latency", &["--no-alternatives"]);
    assert!(material.contains("\nmisfit = \"residuals\"\n"), "{material}");
    assert!(grip().1["verdict"].as_str().unwrap().contains(", by a law that misses part of the record"));
    // With its own law there is nothing to say.
    let (_, material) = calibrate("prony:2", &["--alternatives", "standard-linear-solid"]);
    assert!(!material.contains("misfit"), "{material}");
    assert!(grip().1["misfit"].is_null());
}
