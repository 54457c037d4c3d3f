//! `palpate export`: cards read back, stated errors, bad input.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use crate::common::{done, palpate, refused, root};
use serde_json::Value;
use tempfile::tempdir;

const ENGINES: [&str; 9] = ["mujoco", "drake", "physx", "isaac", "newton", "abaqus", "openradioss", "febio", "felupe"];

/// From the root, so that cards are the same in every folder.
const BALL: &str = "examples/records/ball-material.toml";

fn ball() -> String {
    root().join(BALL).display().to_string()
}

/// Finite elements have no friction in their card.
const CONTINUA: [&str; 4] = ["abaqus", "openradioss", "febio", "felupe"];

fn export<'a>(engine: &'a str, ball: &'a str) -> Vec<&'a str> {
    let friction: &[&str] = if CONTINUA.contains(&engine) { &[] } else { &["--friction", "0.6"] };
    [&["export", engine, ball, "--mass", "250g"], friction].concat()
}

fn card(engine: &str, more: &[&str]) -> String {
    done(&root(), &[&export(engine, BALL), more].concat())
}

fn json(engine: &str, more: &[&str]) -> Value {
    serde_json::from_str(&card(engine, &[more, &["--format", "json"]].concat())).unwrap()
}

fn number(value: &Value, name: &str) -> f64 {
    value[name].as_f64().unwrap_or_else(|| panic!("{name} in {value}"))
}

fn parameter(document: &Value, name: &str) -> f64 {
    let found = document["parameters"].as_array().unwrap().iter().find(|row| row["name"] == name);
    number(found.unwrap_or_else(|| panic!("{name} in {}", document["parameters"])), "value")
}

/// A card without what differs between versions and platforms: numbers of four digits and more become `N`.
fn outline(card: &str) -> String {
    let card = card.replace(concat!("palpate ", env!("CARGO_PKG_VERSION")), "palpate VERSION");
    let mut out = String::new();
    let mut word = String::new();
    for letter in card.chars().chain(['\n']) {
        if letter.is_ascii_alphanumeric() || letter == '.' || (letter == '-' && word.ends_with('e')) {
            word.push(letter);
            continue;
        }
        let mantissa = word.split('e').next().unwrap_or_default();
        let digits = mantissa.chars().filter(char::is_ascii_digit).count();
        let is_number = word.starts_with(|first: char| first.is_ascii_digit());
        let is_digest = word.len() == 64;
        out.push_str(if is_digest || (is_number && digits >= 4) { "N" } else { &word });
        out.push(letter);
        word.clear();
    }
    out.trim_end().to_owned() + "\n"
}

#[test]
fn every_engine_has_a_card() {
    for engine in ENGINES {
        insta::assert_snapshot!(format!("card_{engine}"), outline(&card(engine, &[])));
    }
}

#[test]
fn no_card_speaks_of_another_program() {
    for engine in ["openradioss", "febio", "felupe"] {
        let text = card(engine, &[]);
        assert!(!text.contains("Abaqus") && !text.contains("*STATIC"), "{engine}");
    }
}

#[test]
fn a_card_states_its_range_its_error_and_what_is_missing() {
    for engine in ENGINES {
        let (text, document) = (card(engine, &[]), json(engine, &[]));
        assert_eq!(document["schema"], "palpate.card/1");
        assert_eq!(document["text"], text.as_str(), "{engine}");
        // Comments come first: of USD behind its mark.
        let head = text.trim_start_matches("#usda 1.0\n");
        assert!(["<!--", "//", "# ", "**"].iter().any(|mark| head.starts_with(mark)), "{engine}: {head:.40}");
        let flat = text.split_whitespace().filter(|word| !["#", "**", "//"].contains(word));
        let flat = flat.collect::<Vec<_>>().join(" ");
        for stated in [
            "Fitted to:",
            "15.0 mm of jaw travel",
            "mm/s",
            "at 1 s",
            "at 10 s",
            "at 60 s",
            "cannot show",
            "Beyond the test: the longest hold lasts 60.0 s",
        ] {
            assert!(flat.contains(stated), "{engine}: no \"{stated}\" in\n{flat}");
        }
        for row in document["hold"].as_array().unwrap() {
            let error = (number(row, "card_force_n") - number(row, "force_n")) / number(&document, "peak_force_n");
            assert!((error - number(row, "error")).abs() < 1e-12, "{engine}");
            let time = format!(" % at {} s", number(row, "time_s"));
            let before = flat.split(&time).next().unwrap().rsplit(' ').next().unwrap();
            let stated: f64 = before.parse().unwrap_or_else(|_| panic!("{engine}: {before} in\n{flat}"));
            assert!((stated - 100.0 * error).abs() <= 6e-3 * stated.abs(), "{engine}: {stated}, {error}");
        }
    }
}

/// g_i and τ_i of the text of a card, with the share that remains.
fn series(engine: &str, text: &str) -> (f64, Vec<(f64, f64)>) {
    let numbers =
        |line: &str| -> Vec<f64> { line.split([',', ' ']).filter_map(|word| word.trim().parse().ok()).collect() };
    let terms: Vec<(f64, f64)> = match engine {
        "abaqus" => {
            let lines = text.split("TIME=PRONY\n").nth(1).unwrap().lines();
            lines
                .map(numbers)
                .map(|row| {
                    assert_eq!(row[0], row[1]);
                    (row[0], row[2])
                })
                .collect()
        }
        "felupe" => {
            let list = |name: &str| -> Vec<f64> {
                let inside = text.split(&format!("{name} = [\n")).nth(1).unwrap().split(']').next().unwrap().to_owned();
                inside.lines().flat_map(numbers).collect()
            };
            list("SHARES").into_iter().zip(list("TIME_CONSTANTS_S")).collect()
        }
        "openradioss" => {
            // Moduli are absolute: of the relaxed body μ_1.
            let after = |mark: &str| -> Vec<f64> {
                let lines = text.split(mark).nth(1).unwrap().lines().skip(1);
                lines.take_while(|line| !line.starts_with('#')).flat_map(numbers).collect()
            };
            let (relaxed, moduli, times) = (after("MU_1")[0], after(" G_I"), after("TAU_I"));
            let all = relaxed + moduli.iter().sum::<f64>();
            moduli.iter().map(|modulus| modulus / all).zip(times).collect()
        }
        _ => {
            let tagged = |tag: char| -> Vec<f64> {
                let open = format!("<{tag}");
                let parts =
                    text.split(&open).skip(1).filter(|part| part.starts_with(|first: char| first.is_ascii_digit()));
                parts
                    .filter(|part| !part.starts_with('0'))
                    .map(|part| part.split(['>', '<']).nth(1).unwrap().parse().unwrap())
                    .collect()
            };
            let (shares, times) = (tagged('g'), tagged('t'));
            let all = 1.0 + shares.iter().sum::<f64>();
            shares.iter().map(|share| share / all).zip(times).collect()
        }
    };
    (1.0 - terms.iter().map(|(share, _)| share).sum::<f64>(), terms)
}

/// What stands in a card, evaluated, is the hold that is simulated.
#[test]
fn prony_cards_read_back_are_the_simulated_hold() {
    for engine in ["abaqus", "openradioss", "febio", "felupe"] {
        let document = json(engine, &[]);
        let (remaining, terms) = series(engine, document["text"].as_str().unwrap());
        assert!(terms.len() >= 10 && remaining > 0.0, "{engine}: {terms:?}");
        for row in document["hold"].as_array().unwrap() {
            let time = number(row, "time_s");
            let share = terms.iter().fold(remaining, |sum, (share, tau)| sum + share * (-time / tau).exp());
            let error = share - number(row, "force_n") / number(&document, "peak_force_n");
            assert!(error.abs() < 2e-3 && (error - number(row, "error")).abs() < 1e-8, "{engine}, {time} s: {error:e}");
        }
        assert!(number(&document, "worst_hold_error") < 2e-3);
        let ratio = parameter(&document, "equilibrium_modulus_pa") / parameter(&document, "instantaneous_modulus_pa");
        assert!((ratio - remaining).abs() < 1e-8, "{engine}");
    }
    // More terms, and fewer of a shorter hold.
    let terms = |more: &[&str]| json("abaqus", more)["prony"].as_array().unwrap().len();
    assert!(terms(&["--terms-per-decade", "3"]) > terms(&[]) && terms(&["--hold", "1 s"]) < terms(&[]));
}

#[test]
fn contacts_stay_within_two_percent_where_the_engine_can() {
    for engine in ["mujoco", "drake"] {
        let error = number(&json(engine, &[]), "loading_error");
        assert!(error < 0.02, "{engine}: {error}");
    }
    // A linear spring cannot, and its card and standard error state it.
    let output = palpate(&root(), &export("isaac", &ball()));
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success());
    assert!(error.contains("the contact of Isaac has an error of up to"), "{error}");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let document = json("isaac", &[]);
    let (stiffness, damping) = (parameter(&document, "stiffness_n_per_m"), parameter(&document, "damping_n_s_per_m"));
    for (name, value) in [("compliantContactStiffness", stiffness), ("compliantContactDamping", damping)] {
        let line = text.lines().find(|line| line.contains(name)).unwrap();
        let found: f64 = line.split('=').nth(1).unwrap().trim().parse().unwrap();
        assert!((found - value).abs() <= 1e-9 * value.abs(), "{line}");
    }
}

#[test]
fn a_question_beyond_the_test_is_noted_and_stands_in_the_card() {
    let (folder, ball) = (tempdir().unwrap(), ball());
    let deep = [&export("drake", &ball)[..], &["--depth", "20 mm", "--speed", "50 mm/s", "--out", "ball.sdf"]].concat();
    let output = palpate(folder.path(), &deep);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && output.stdout.is_empty(), "{error}");
    let text = std::fs::read_to_string(folder.path().join("ball.sdf")).unwrap();
    for beyond in [
        "the largest displacement is 20.0 mm",
        "the fastest ramp is 50.0 mm/s",
        "the longest hold lasts 60.0 s",
        // That at the end of loading, not that at the end of the hold.
        "the largest force is 25.1 N",
    ] {
        assert!(error.contains(&format!("beyond the test: {beyond}")), "{error}");
        assert!(text.contains(&format!("Beyond the test: {beyond}")), "{text}");
    }
}

#[test]
fn bad_input_is_refused_with_what_helps() {
    let (root, ball) = (root(), ball());
    let error = refused(&root, &["export", "mujocco", &ball]);
    assert!(error.contains("mujocco") && error.contains("'mujoco'"), "{error}");
    let error = refused(&root, &["export", "mujoco", &ball]);
    assert!(error.contains("a card for MuJoCo needs --mass") && error.contains("--mass 250g"), "{error}");
    let error = refused(&root, &["export", "abaqus", "examples/records/ball.toml"]);
    assert!(error.contains("examples/records/ball.toml"), "{error}");
    let error = refused(&root, &["export", "drake", &ball, "--depth", "80 mm"]);
    assert!(error.contains("contact displacement must stay below the radius of 0.035 m"), "{error}");
    assert!(error.contains("hint: the test went to 15.0 mm: --depth 15.0mm"), "{error}");
    let error = refused(&root, &["export", "drake", &ball, "--slowest", "1 m/s"]);
    assert!(error.contains("slowest speed must be at most the fastest"), "{error}");
    let error = refused(&root, &["export", "abaqus", &ball, "--terms-per-decade", "0"]);
    assert!(error.contains("number of terms a decade must be above 0 and at most 20"), "{error}");
    let error = refused(&root, &["export", "abaqus", &ball, "--poisson-ratio", "0.5"]);
    assert!(error.contains("--poisson-ratio must be 0 or more and below 0.5, found 0.5"), "{error}");
    let error = refused(&root, &["export", "drake", &ball, "--poisson-ratio", "0.3"]);
    assert!(error.contains("--poisson-ratio is for finite elements"), "{error}");
    for [engine, option, value] in [
        ["febio", "--friction", "0.5"],
        ["abaqus", "--slowest", "1 mm/s"],
        ["mujoco", "--terms-per-decade", "3"],
        ["mujoco", "--hold", "10 s"],
        ["newton", "--poisson-ratio", "0.3"],
    ] {
        let error = refused(&root, &["export", engine, &ball, "--mass", "250g", option, value]);
        let kind = if CONTINUA.contains(&engine) { "engines of contacts" } else { "finite elements" };
        assert!(error.contains(&format!("{option} is for {kind}, and the engine is {engine}")), "{error}");
        assert!(error.contains(&format!("hint: leave {option} out")), "{error}");
    }
    let error = refused(&root, &["export", "drake", &ball, "--friction", "-1"]);
    assert!(error.contains("--friction must be a number of 0 or more"), "{error}");
    let error = refused(&root, &["export", "drake", &ball, "--out", &ball]);
    assert!(error.contains("expected an output file that is not an input"), "{error}");
}

/// Below 1 a hold ends after a finite time, which no Prony series does; a contact without memory does not need one.
#[test]
fn an_exponent_below_one_has_no_prony_series() {
    let folder = tempdir().unwrap();
    let text = std::fs::read_to_string(ball()).unwrap();
    let exponent = "5.042530085014389";
    assert_eq!(text.matches(exponent).count(), 2);
    let text = text.replace("0.010927785007268907", "0.00195");
    std::fs::write(
        folder.path().join("m.toml"),
        text.replace(exponent, "0.9")
            .replace("interval = [5.021144885590048, 5.064006364613636]", "interval = [0.8, 1.0]"),
    )
    .unwrap();
    let error = refused(folder.path(), &["export", "abaqus", "m.toml"]);
    assert!(error.contains("a Prony series needs an exponent of 1 or more, found 0.9"), "{error}");
    done(folder.path(), &["export", "drake", "m.toml"]);
}
