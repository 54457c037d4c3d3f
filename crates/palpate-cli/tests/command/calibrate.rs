//! `palpate calibrate` and `palpate predict`: from a record to a material, and from that to any other squeeze.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::path::Path;

use crate::common::{data, done, file, palpate, refused, root};
use serde_json::Value;
use tempfile::{TempDir, tempdir};

/// A folder with the material of the example record.
fn calibrated() -> (TempDir, String) {
    let folder = tempdir().unwrap();
    let text = calibrate(folder.path(), &["--no-alternatives", "--out", "ball.toml"]);
    (folder, text)
}

fn example(name: &str) -> String {
    root().join("examples").join(name).display().to_string()
}

fn calibrate(folder: &Path, more: &[&str]) -> String {
    let (record, test) = (example("records/ball.csv"), example("records/ball.toml"));
    done(folder, &[&["calibrate", &record, "--test", &test], more].concat())
}

const HOLD: &str = "[[step]]\nto = \"12 mm\"\nrate = \"500 mm/min\"\nhold = \"60 s\"\n";

/// The numbers of a row of a table, behind its first cell.
fn row(text: &str, start: &str) -> Vec<f64> {
    let line = text.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{start}: {text}"));
    line[start.len()..].split_whitespace().filter_map(|cell| cell.parse().ok()).collect()
}

#[test]
fn one_record_gives_numbers_with_intervals_and_alternatives_beside_them() {
    let folder = tempdir().unwrap();
    let more = ["--alternatives", "standard-linear-solid,prony:2", "--figure", "cal.svg", "--format", "json"];
    let document: Value = serde_json::from_str(&calibrate(folder.path(), &more)).unwrap();
    assert_eq!(document["schema"], "palpate.calibration/1");
    let laws = document["laws"].as_array().unwrap();
    assert_eq!(
        laws.iter().map(|law| law["law"].as_str().unwrap()).collect::<Vec<_>>(),
        ["latency", "standard-linear-solid", "prony:2"]
    );
    // Simulated with E = 28 kPa, n = 5, ℓ = 4.375 mm and 0.05 N of noise.
    for (index, (name, truth)) in [("modulus_pa", 28e3), ("exponent", 5.0), ("layer_thickness_m", 0.035 / 8.0)]
        .into_iter()
        .enumerate()
    {
        let number = &laws[0]["parameters"][if index < 2 { index } else { 3 }];
        assert_eq!(number["name"], name);
        let (value, error) = (number["value"].as_f64().unwrap(), number["standard_error"].as_f64().unwrap());
        assert!((value - truth).abs() < 4.5 * error && error < 0.01 * truth, "{name} {value} ± {error}");
    }
    assert!((laws[0]["rmse_n"].as_f64().unwrap() - 0.05).abs() < 0.002);
    assert!(laws[1]["rmse_n"].as_f64().unwrap() > 0.2 && laws[1]["delta_bic"].as_f64().unwrap() > 1000.0);
    let figure = std::fs::read_to_string(folder.path().join("cal.svg")).unwrap();
    assert!(figure.contains("measured") && figure.contains("standard-linear-solid"));
    assert!(!folder.path().join("ball.toml").exists());
}

#[test]
fn calibrated_on_the_loading_the_unloading_is_predicted() {
    let folder = tempdir().unwrap();
    let text = calibrate(folder.path(), &["--fit-until", "61 s"]);
    let (latency, solid) = (row(&text, "latency"), row(&text, "standard-linear-solid"));
    // p, RMSE, of peak, ΔBIC, predicted to, of peak: the noise of 0.05 N is met, and no more.
    assert!(latency[4] < 0.06 && solid[4] > 5.0 * latency[4], "{text}");
    assert!(text.contains("latency predicts the rest of the record best"), "{text}");
}

#[test]
fn a_material_predicts_and_every_command_takes_it() {
    let (folder, _) = calibrated();
    let folder = folder.path();
    file(folder, "hold.toml", HOLD);
    let output = palpate(
        folder,
        &[
            "predict",
            "ball.toml",
            "--protocol",
            "hold.toml",
            "--at",
            "61.44 s",
            "--at",
            "2 s",
            "--figure",
            "p.svg",
            "--out",
            "p.csv",
        ],
    );
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let reported = String::from_utf8(output.stderr).unwrap();
    assert!(
        reported.contains("beyond the test: the longest hold lasts 60.0 s, that of the test 20.0 s"),
        "{reported}"
    );
    assert!(std::fs::read_to_string(folder.join("p.csv")).unwrap().lines().count() == 3);
    assert!(folder.join("p.svg").exists());
    // The truth, by the protocol that the record was simulated with.
    let truth = format!(
        "specimen = {{ shape = \"ball\", radius = \"35 mm\", modulus = \"28 kPa\" }}\nlaw = {{ name = \"latency\", exponent = 5, rate_coefficient = \"2e4 /s\" }}\noutput = {{ times = [\"2 s\", \"61.44 s\"] }}\n{HOLD}"
    );
    file(folder, "truth.toml", truth);
    let simulated = done(folder, &["simulate", "truth.toml"]);
    let forces: Vec<f64> =
        simulated.lines().skip(1).map(|line| line.split(',').nth(3).unwrap().parse().unwrap()).collect();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .map(|line| line.split_whitespace().filter_map(|cell| cell.parse().ok()).collect())
        .filter(|row: &Vec<f64>| row.len() == 7)
        .collect();
    assert_eq!(rows.len(), 2, "{text}");
    for (row, truth) in rows.iter().zip(forces) {
        let (low, high) = (row[3], row[4]);
        assert!((row[2] - truth).abs() < 2.0 * (high - low), "{row:?} {truth}");
        assert!(row[5] < low && high < row[6], "{row:?}");
    }
    // The test held for 20 s: what is predicted to change after that is uncertain by half of it.
    let widths = [&rows[0], &rows[1]].map(|row| row[4] - row[3]);
    let readings = [&rows[0], &rows[1]].map(|row| row[6] - row[5]);
    assert!(widths[0].max(widths[1]) > 20.0 * widths[0].min(widths[1]), "{rows:?}");
    assert!((readings[0].min(readings[1]) - 4.0 * 0.05).abs() < 0.02, "{rows:?}");
    // The body of a protocol, of a driven simulation, of a sweep and of an analysis.
    file(folder, "named.toml", format!("material = \"ball.toml\"\noutput = {{ times = [\"2 s\"] }}\n{HOLD}"));
    let named = done(folder, &["simulate", "named.toml"]);
    let force: f64 = named.lines().nth(1).unwrap().split(',').nth(3).unwrap().parse().unwrap();
    assert!((force - rows[0][2]).abs() < 1e-3 * force, "{force} {rows:?}");
    let record = example("records/ball.csv");
    assert!(done(folder, &["simulate", "ball.toml", "--drive", &record]).lines().count() > 2000);
    file(folder, "sweep.toml", format!("material = \"ball.toml\"\n{HOLD}[sweep]\nlaw.exponent = \"4, 5\"\n"));
    done(folder, &["sweep", "sweep.toml", "--out", "sweep.parquet"]);
    let analysis = done(folder, &["analyze", &record, "--test", "ball.toml", "--no-compare"]);
    assert!(analysis.contains("1/s") && analysis.contains("2.24") || analysis.contains("×10⁴"), "{analysis}");
}

#[test]
fn what_cannot_be_calibrated_or_predicted_is_stated_and_nothing_is_written() {
    let (folder, _) = calibrated();
    let folder = folder.path();
    file(folder, "hold.toml", HOLD);
    let record = example("records/ball.csv");
    let reported = refused(folder, &["calibrate", &record, "--out", "new.toml"]);
    assert!(reported.contains("needs the geometry of the body") && reported.contains("[specimen]"), "{reported}");
    let test = example("records/ball.toml");
    for (more, expected) in [
        (&["--law", "power"][..], "not a law of a whole contact"),
        (&["--law", "latency:-1"], "latency:-1"),
        (&["--poisson-ratio", "0.3"], "Hertz"),
        (&["--equilibrium", "hertz", "--poisson-ratio", "0.7"], "Poisson"),
        (&["--fit-until", "200 s"], "within the record"),
        (&["--confidence", "95"], "between 0 and 1"),
        (&["--figure", "x.eps"], ".svg"),
    ] {
        let reported = refused(
            folder,
            &[&["calibrate", &record, "--test", &test, "--no-alternatives", "--out", "new.toml"], more].concat(),
        );
        assert!(reported.contains(expected), "{more:?}: {reported}");
    }
    assert!(!folder.join("new.toml").exists());
    let text = std::fs::read_to_string(folder.join("ball.toml")).unwrap();
    file(folder, "edited.toml", text.replacen("radius = \"0.035 m\"", "radius = \"-1 m\"", 1));
    file(folder, "later.toml", text.replacen("version = 1", "version = 7", 1));
    file(folder, "deep.toml", HOLD.replace("12 mm", "80 mm"));
    for (material, protocol, more, expected) in [
        ("edited.toml", "hold.toml", &[][..], "specimen.radius"),
        ("later.toml", "hold.toml", &[], "calibrate again"),
        ("none.toml", "hold.toml", &[], "no such file"),
        ("ball.toml", "none.toml", &[], "no such file"),
        ("hold.toml", "hold.toml", &[], "expected a material file, found a protocol"),
        ("ball.toml", "deep.toml", &[], "step[1].to"),
        ("ball.toml", "hold.toml", &["--at", "99 s"], "99"),
        ("ball.toml", "hold.toml", &["--out", "ball.toml"], "an output file"),
    ] {
        let reported = refused(folder, &[&["predict", material, "--protocol", protocol], more].concat());
        assert!(reported.contains(expected), "{material} {protocol} {more:?}: {reported}");
    }
    assert_eq!(std::fs::read_to_string(folder.join("ball.toml")).unwrap(), text);
}

/// A test of a block counts it as bonded where the description is silent. Nothing stated so, and `grip` reported grips that could pull,
/// which no description had mentioned.
#[test]
fn that_jaws_may_pull_on_a_block_is_stated() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let body = "[specimen]\nshape = \"block\"\narea = \"10 cm^2\"\nlength = \"50 mm\"\nmodulus = \"30 kPa\"\n[contact]\nsqueezed_from = \"two sides\"\n";
    let law = "[law]\nname = \"latency\"\nexponent = 3\nrate_coefficient = \"200 /s\"\n";
    file(
        folder,
        "protocol.toml",
        format!("{body}{law}[output]\nsample_rate = \"20 Hz\"\n{}", HOLD.replace("12 mm", "6 mm")),
    );
    done(folder, &["simulate", "protocol.toml", "--force-noise", "0.01 N", "--out", "block.csv"]);
    let remark = "The jaws count as bonded to the body and can pull: separation = false in [contact]";
    for (stated, pulls) in [("", true), ("separation = false\n", true), ("separation = true\n", false)] {
        file(folder, "test.toml", format!("{body}{stated}"));
        let calibrate = [
            "calibrate",
            "block.csv",
            "--test",
            "test.toml",
            "--law",
            "latency:3",
            "--no-alternatives",
            "--out",
            "material.toml",
        ];
        let text = done(folder, &calibrate);
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(words.contains(remark), pulls, "{stated}: {text}");
        let card = done(folder, &["export", "mujoco", "material.toml", "--mass", "0.1 kg"]);
        assert_eq!(card.contains("separation = false in the material: its jaws can pull"), pulls, "{stated}: {card}");
        let grip = ["grip", "material.toml", "--mass", "0.1 kg", "--friction", "0.6"];
        if pulls {
            let reported = refused(folder, &grip);
            assert!(reported.contains("separation = false in the material: its contacts can pull"), "{reported}");
            assert!(reported.contains("set separation = true under [contact] of the test description"), "{reported}");
        } else {
            done(folder, &grip);
        }
    }
}

#[test]
fn silicone_steps_are_predicted_from_their_first_part() {
    let Some(folder) = data("silicone-steps") else { return };
    let Some(record) = std::fs::read_dir(folder)
        .unwrap()
        .flatten()
        .map(|entry| entry.path())
        .find(|path| path.to_string_lossy().contains("2_7-5"))
    else {
        return;
    };
    let own = tempdir().unwrap();
    let test = std::fs::read_to_string(example("tests/silicone-steps.toml")).unwrap();
    let test = file(own.path(), "test.toml", test.replace("length = \"20 mm\"", "length = \"40 mm\""));
    let record = record.display().to_string();
    let text = done(
        own.path(),
        &["calibrate", &record, "--test", &test, "--fit-until", "160 s", "--alternatives", "prony:2"],
    );
    let holdout = row(&text, "latency")[5];
    assert!(holdout < 3.0, "{holdout} % of the peak: {text}");
}

/// Fung's rates, far faster than the motion, had the contact lost and regained without end: the command never returned.
#[test]
fn a_calibration_on_the_first_hold_ends_for_every_law() {
    let folder = tempfile::tempdir().unwrap();
    let (record, test) = (example("records/ball.csv"), example("records/ball.toml"));
    let printed = done(folder.path(), &["calibrate", &record, "--test", &test, "--fit-until", "10 s"]);
    assert!(printed.contains("Held-out error beyond the fitted part"), "{printed}");
}

/// Where the residual is large the bottom is steeper than the first derivatives say; the search went from one side of it to the other until its
/// steps were spent. And the ends of intervals of 80 decades were numbers.
#[test]
fn a_record_that_the_law_does_not_describe_ends_at_an_optimum_with_its_numbers_left_open() {
    let Some(record) = data("vhb4910/relax_3d0.csv") else {
        return;
    };
    let (record, test) =
        (record.display().to_string(), root().join("validation/records/vhb4910.toml").display().to_string());
    let arguments = [
        "calibrate",
        &record,
        "--test",
        &test,
        "--fit-until",
        "600 s",
        "--no-alternatives",
        "--format",
        "json",
    ];
    let document: Value = serde_json::from_str(&done(Path::new("."), &arguments)).unwrap();
    let law = &document["laws"][0];
    assert_eq!(law["termination"], "converged");
    assert!(law["holdout"]["relative"].as_f64().unwrap() < 0.003, "{law}");
    for parameter in law["parameters"].as_array().unwrap() {
        if let Some(ends) = parameter["interval"].as_array() {
            assert!(ends[1].as_f64().unwrap() / ends[0].as_f64().unwrap() < 1e13, "{parameter}");
        }
    }
    assert!(
        law["parameters"][0]["interval"].is_null() && law["parameters"][0]["standard_error"].is_null(),
        "{law}"
    );
}

/// Records of balls of these moduli (kPa), and their description.
fn batch(folder: &Path, moduli: &[f64]) -> Vec<String> {
    file(folder, "ball.toml", "[specimen]\nshape = \"ball\"\nradius = \"35 mm\"\n");
    let simulated = |(index, modulus): (usize, &f64)| {
        let (protocol, record) = (format!("p{index}.toml"), format!("specimen-{index}.csv"));
        let text = format!(
            "specimen = {{ shape = \"ball\", radius = \"35 mm\", modulus = \"{modulus} kPa\" }}\nlaw = {{ name = \"latency\", exponent = 5, rate_coefficient = \"2e4 /s\" }}\noutput = {{ sample_rate = \"10 Hz\" }}\n[[step]]\nto = \"5 mm\"\nrate = \"500 mm/min\"\nhold = \"10 s\"\n[[step]]\nto = \"10 mm\"\nrate = \"500 mm/min\"\nhold = \"10 s\"\n"
        );
        file(folder, &protocol, text);
        let seed = (index + 1).to_string();
        done(folder, &["simulate", &protocol, "--force-noise", "0.05 N", "--seed", &seed, "--out", &record]);
        record
    };
    moduli.iter().enumerate().map(simulated).collect()
}

#[test]
fn a_batch_gives_the_spread_and_the_material_of_another_specimen() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let records = batch(folder, &[24.0, 28.0, 31.0, 26.0]);
    let names: Vec<&str> = records.iter().map(String::as_str).collect();
    let shared = ["--test", "ball.toml", "--shared", "exponent,rate_coefficient,layer_thickness"];
    let more = ["--out", "batch.toml", "--figure", "batch.svg", "--format", "json"];
    let text = done(folder, &[&["calibrate"], &names[..], &shared, &more].concat());
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["schema"], "palpate.several-calibrations/1");
    let parameters = document["parameters"].as_array().unwrap();
    let between: Vec<&str> = parameters.iter().map(|parameter| parameter["between"].as_str().unwrap()).collect();
    assert_eq!(between, ["own", "shared", "shared", "shared"]);
    let within = |parameter: &Value, truth: f64| {
        let interval = &parameter["interval"];
        interval[0].as_f64().unwrap() < truth && truth < interval[1].as_f64().unwrap()
    };
    assert!(
        within(&parameters[1], 5.0) && within(&parameters[2], 2e4) && within(&parameters[3], 0.035 / 8.0),
        "{text}"
    );
    // The standard deviation of the logarithms of 24, 28, 31 and 26 is 0.1103.
    let spread = &parameters[0]["spread"];
    assert!((spread["deviation"].as_f64().unwrap() - 0.1103).abs() < 0.003, "{spread}");
    assert!(spread["low"].as_f64().unwrap() < 0.1103 && 0.1103 < spread["high"].as_f64().unwrap(), "{spread}");
    assert_eq!(document["new_specimen"]["freedom"], 3.0);
    let figure = std::fs::read_to_string(folder.join("batch.svg")).unwrap();
    assert!(figure.contains("specimen-0.csv") && figure.contains("specimen-3.csv"));
    let material = std::fs::read_to_string(folder.join("batch.toml")).unwrap();
    assert!(material.contains("specimens = 4\n") && material.contains("specimen of the batch that was not tested"));
    // Within what the batch was tested for.
    file(folder, "hold.toml", "[[step]]\nto = \"9 mm\"\nrate = \"500 mm/min\"\nhold = \"10 s\"\n");
    let predicted = done(folder, &["predict", "batch.toml", "--protocol", "hold.toml", "--at", "11 s"]);
    let row = predicted.lines().find(|line| line.trim_start().starts_with("11.00")).unwrap();
    let cells: Vec<f64> = row.split_whitespace().filter_map(|cell| cell.parse().ok()).collect();
    // Three degrees of freedom and a spread of 11 %: t = 3.18, √(1 + 1/4), so that the interval is ± 39 % of the force.
    let half = 0.5 * (cells[4] - cells[3]) / cells[2];
    assert!((0.34..0.45).contains(&half), "{predicted}");
    let text = done(folder, &[&["calibrate"], &names[..], &shared].concat());
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("shared parameters: exponent, rate coefficient, layer thickness."), "{text}");
    assert!(words.contains("intervals contain the spread between the 4 specimens"), "{text}");
}

#[test]
fn what_is_no_batch_is_refused_before_or_after_reading() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let records = batch(folder, &[24.0, 28.0]);
    let [one, two] = [records[0].as_str(), records[1].as_str()];
    let test = ["--test", "ball.toml"];
    for (arguments, expected) in [
        (vec![one, "--shared", "all"], "--shared is for two or more records, found 1 record"),
        (vec![one, two, "--shared", "stiffness"], "expected shared parameters among modulus_pa, exponent"),
        (vec![one, one], "are the same record"),
        (vec![one, two, "--profile"], "--profile is for a single record, found 2 records"),
        (
            vec![one, two, "--alternatives", "prony:1"],
            "--alternatives is for a single record, found 2 records",
        ),
        (vec![one, two, "--equilibrium", "table"], "a table of equilibrium forces has its rows"),
        (
            vec![one, two, two, "--test", "ball.toml"],
            "one test description for all records or one for each, found 2 for 3",
        ),
        (vec![one, two, "--out", two], "expected an output file that is not an input"),
    ] {
        let error = refused(folder, &[&["calibrate"], &arguments[..], &test].concat());
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
    // Two specimens have no material of a third; a body of which there are two tests has one.
    let output = palpate(folder, &[&["calibrate", one, two, "--out", "third.toml"], &test[..]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().contains("third.toml is not written"));
    assert!(String::from_utf8(output.stdout).unwrap().contains("which needs 3 records or more"));
    assert!(!folder.join("third.toml").exists());
}

/// A displacement of the other sign gave a range of calibration of 2e-6 nm, or an error about a covariance.
#[test]
fn a_displacement_against_the_direction_of_loading_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut record = String::from("Time (s),Displacement (mm),Force (N)\n");
    for i in 0..600 {
        let t = 0.1 * f64::from(i);
        let relaxing = if t < 2.0 { 1.0 } else { 0.5 + 0.5 * (-(t - 2.0) / 5.0).exp() };
        let place = (t / 2.0).min(1.0);
        record.push_str(&format!("{t:.1},{:.4},{:.4}\n", -5.0 * place, -20.0 * place * relaxing));
    }
    let record = file(folder, "pull.csv", record);
    let test = file(folder, "block.toml", "[specimen]\nshape = \"block\"\nlength = \"20 mm\"\narea = \"100 mm2\"\n");
    let reported = refused(folder, &["calibrate", &record, "--test", &test]);
    assert!(reported.contains("expected a displacement that rises from first touch, found one that falls to −5.00 mm"));
    assert!(reported.contains("sign = -1 in [columns.displacement]"), "{reported}");
}
