//! Whole commands on good input.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::path::Path;

use crate::common::{data, done, file, palpate, ramp_and_hold, root};
use serde_json::Value;
use tempfile::tempdir;

/// "palpate 0.1.0" in a report of a bug states nothing of the build.
#[test]
fn the_version_says_which_build_it_is() {
    let reported = done(&root(), &["--version"]);
    let lines: Vec<&str> = reported.lines().collect();
    assert!(lines[0].starts_with("palpate 0.") && lines[1].starts_with("commit: "), "{reported}");
    let commit = lines[1].trim_start_matches("commit: ");
    assert!(
        commit == "unknown" || commit.len() >= 12 && commit.chars().all(|c| c.is_ascii_hexdigit()),
        "{reported}"
    );
    let build = lines[2].trim_start_matches("build: ");
    assert!(build.len() == 32 && build.chars().all(|c| c.is_ascii_hexdigit()), "{reported}");
    assert!(lines[3].contains("-") && lines[4] == "features: arrow, png, robot-log, xlsx", "{reported}");
    assert_eq!(done(&root(), &["-V"]), format!("{}\n", lines[0]));
}

/// Intervals by another way are other intervals of the same numbers, and the document says which.
#[test]
fn intervals_rest_on_what_is_requested_for() {
    let folder = tempdir().unwrap();
    let example = |name: &str| root().join("examples/records").join(name).display().to_string();
    let (record, test) = (example("ball.csv"), example("ball.toml"));
    let analyzed = |more: &[&str]| {
        let plain = ["analyze", &record, "--test", &test, "--no-compare", "--format", "json"];
        json(folder.path(), &[&plain, more].concat())
    };
    let (plain, profile) = (analyzed(&[]), analyzed(&["--intervals", "profile"]));
    assert_eq!(
        (&plain["settings"]["intervals"], &profile["settings"]["intervals"]),
        (&Value::Null, &"profile".into())
    );
    let free = |document: &Value| document["holds"][0]["fits"].as_array().unwrap()[5].clone();
    let (plain, profile) = (free(&plain), free(&profile));
    assert_eq!((&plain["law"], &plain["domain"]), (&"latency".into(), &"time".into()), "{plain}");
    let exponent = |fit: &Value| fit["parameters"]["exponent"].clone();
    assert_eq!(exponent(&plain)["value"], exponent(&profile)["value"]);
    let ends = |fit: &Value| [0, 1].map(|i| exponent(fit)["interval"][i].as_f64().unwrap());
    let (plain, profile) = (ends(&plain), ends(&profile));
    assert!(
        plain != profile && (plain[0] - profile[0]).abs() < 0.5 * (plain[1] - plain[0]),
        "{plain:?} {profile:?}"
    );
    let compared = [
        "compare",
        &record,
        "--test",
        &test,
        "--laws",
        "maxwell",
        "--intervals",
        "bootstrap",
        "--format",
        "json",
    ];
    assert_eq!(json(folder.path(), &compared)["settings"]["intervals"], "bootstrap");
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&done(folder, arguments)).unwrap()
}

/// All numbers of a document are finite or absent: JSON has no NaN, so `null` where a number is promised gives it away.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn reproduce_judges_every_claim_and_shows_first_what_does_not_match() {
    let folder = tempdir().unwrap();
    let few = ["reproduce", "--out", "study", "--seeds", "4", "--sample-rate", "20"];
    let text = done(folder.path(), &few);
    let [failed, passed, unchecked] =
        ["\nNot reproduced\n", "\nReproduced\n", "\nCannot be checked\n"].map(|heading| text.find(heading).unwrap());
    assert!(failed < passed && passed < unchecked, "{text}");
    // 2.5 mm over 35 mm is not 0.1661.
    assert!(text[failed..passed].contains("−0.0714 (paper −0.1661 ± 0.00005, tolerance 0.0135)"), "{text}");
    let study = folder.path().join("study");
    let names = [
        "report.html",
        "summary.json",
        "tables/claims.csv",
        "tables/table_1.csv",
        "tables/table_2.csv",
        "tables/forces_by_step.csv",
        "tables/explanations.csv",
        "tables/last_unloading.csv",
        "tables/laboratories.csv",
        "tables/orders.csv",
        "tables/sensitivities.csv",
        "figures/figure_1.svg",
        "figures/figure_2.svg",
        "figures/figure_4a.svg",
        "figures/figure_4b.svg",
        "figures/figure_6a.svg",
        "figures/figure_6b.svg",
        "figures/figure_7.svg",
        "figures/figure_8.svg",
        "figures/closed_form.svg",
        "figures/forces_by_step.svg",
        "figures/equilibria.svg",
        "figures/sensitivities.svg",
        "figures/rate_coefficients.svg",
        "series/test_a_bonded.csv",
    ];
    for name in names {
        assert!(study.join(name).metadata().unwrap().len() > 100, "{name}");
    }
    let summary: Value = serde_json::from_slice(&std::fs::read(study.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["schema"], "palpate.reproduction/2");
    assert_eq!(summary["claims"][0]["verdict"], "not_reproduced");
    for (row, strain) in summary["table_1"].as_array().unwrap().iter().zip([1.0, 2.0, 3.0, 4.0, 5.0]) {
        // ε_e = −u₁/r = −2.5 mm · step / 35 mm: compression is negative, as in the paper.
        assert!((number(&row["equilibrium_strain"]) + strain * 2.5 / 35.0).abs() < 1e-9);
        assert!((number(&row["rate_coefficient_per_s"]) / 2e4 - 1.0).abs() < 1e-6);
    }
    let report = std::fs::read_to_string(study.join("report.html")).unwrap();
    assert!(
        !report.contains("http://") || report.matches("http://").count() == report.matches("http://www.w3.org").count()
    );
    // Figures and tables have the numbers of the paper, and every link to one leads somewhere.
    for number in ["Figure 1.", "Figure 4(a).", "Figure 6(b).", "Figure 8.", "Table I.", "Table II."] {
        assert!(report.contains(&format!("<b>{number}</b>")), "{number}");
    }
    let links: Vec<&str> = report.split("href=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    assert!(links.iter().filter(|link| link.starts_with("#figure-") || link.starts_with("#table-")).count() > 20);
    // Heat maps are pictures inside the page.
    for link in links.into_iter().filter(|link| !link.starts_with("data:")) {
        match link.strip_prefix('#') {
            Some(id) => assert!(report.contains(&format!("id=\"{id}\"")), "{link}"),
            None => assert!(study.join(link).exists(), "{link}"),
        }
    }
    // A second run into the same folder gives the same bytes.
    done(folder.path(), &few);
    assert_eq!(std::fs::read_to_string(study.join("report.html")).unwrap(), report);
}

#[test]
fn reproduce_shows_a_record_in_the_layout_of_the_paper() {
    let folder = tempdir().unwrap();
    let (record, test) = (root().join("examples/records/ball.csv"), root().join("examples/records/ball.toml"));
    let (record, test) = (record.to_str().unwrap(), test.to_str().unwrap());
    let summary = json(
        folder.path(),
        &["reproduce", "--record", record, "--test", test, "--out", "own", "--format", "json"],
    );
    assert_eq!(summary["schema"], "palpate.reproduced-record/1");
    let verdict = |start: &str| {
        let claims = summary["claims"].as_array().unwrap();
        let found = claims.iter().find(|claim| claim["statement"].as_str().unwrap().starts_with(start));
        found.unwrap()["verdict"].as_str().unwrap().to_owned()
    };
    // The record was made with n = 5 and one v, from steps up and down.
    assert_eq!(verdict("n = 5"), "reproduced");
    assert_eq!(verdict("Type I"), "reproduced");
    assert_eq!(verdict("Type II"), "reproduced");
    // At 5 mm the interval after unloading is as wide as a tenth of εₑ; v has an error too.
    assert_eq!([verdict("εₑ agrees"), verdict("v falls")], ["cannot_be_checked", "cannot_be_checked"]);
    assert_eq!((summary["table_1"].as_array().unwrap().len(), summary["table_2"].as_array().unwrap().len()), (3, 2));
    assert!(number(&summary["table_1"][0]["equilibrium_strain"]) < 0.0);
    let files = [
        "report.html",
        "figures/figure_4.svg",
        "figures/figure_6a.svg",
        "figures/figure_6b.svg",
        "figures/figure_8.svg",
        "figures/rate_coefficients.svg",
        "figures/equilibria.svg",
        "tables/claims.csv",
        "tables/table_1.csv",
        "tables/table_2.csv",
        "tables/orders.csv",
    ];
    for name in files {
        assert!(folder.path().join("own").join(name).exists(), "{name}");
    }
    let without = palpate(folder.path(), &["reproduce", "--test", test]);
    assert_eq!(without.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&without.stderr).contains("--test describes a record, and none is given"));
    for (option, value, message) in [
        ("--seeds", "0", "number of seeds: from 1 to 100000, found 0"),
        ("--sample-rate", "-3", "sampling rate: at least 2 Hz"),
        ("--sample-rate", "nan", "sampling rate: at least 2 Hz"),
    ] {
        let refused = palpate(folder.path(), &["reproduce", option, value]);
        assert_eq!(refused.status.code(), Some(2), "{option} {value}");
        assert!(String::from_utf8_lossy(&refused.stderr).contains(message), "{:?}", refused.stderr);
    }
}

#[test]
fn the_example_record_is_analysed_to_the_numbers_it_was_made_with() {
    let folder = tempdir().unwrap();
    let (record, test) = (root().join("examples/records/ball.csv"), root().join("examples/records/ball.toml"));
    let (record, test) = (record.to_str().unwrap(), test.to_str().unwrap());
    let document = json(folder.path(), &["analyze", record, "--test", test, "--format", "json", "--out", "study"]);
    assert_eq!(document["schema"], "palpate.analysis/1");
    let holds = document["holds"].as_array().unwrap();
    let kinds: Vec<_> = holds.iter().map(|hold| hold["relaxation"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["type_1", "type_1", "type_1", "type_2", "type_2"]);
    assert_eq!(document["tables"]["common_exponent"], 5.0);
    for row in document["tables"]["loading"].as_array().unwrap() {
        let (v, error) =
            (number(&row["rate_coefficient_per_s"]), number(&row["rate_coefficient_standard_error_per_s"]));
        assert!((v - 2e4).abs() < 4.0 * error, "v = {v} ± {error}");
        let (strain, error) = (number(&row["equilibrium_strain"]), number(&row["equilibrium_strain_standard_error"]));
        let truth = number(&row["displacement_m"]) / 2.0 / 0.035;
        assert!((strain - truth).abs() < 4.0 * error, "ε_e = {strain} ± {error}, not {truth}");
    }
    let layers = number(&document["overlay"]["layers"]);
    assert!((layers - 8.0).abs() < 1.0, "{layers} layers");
    assert!(number(&document["overlay"]["relative_rmse"]) < 0.01);
    let study = folder.path().join("study");
    for name in ["report.html", "analysis.json", "tables/holds.csv", "tables/fits.csv", "figures/record.svg"] {
        assert!(study.join(name).metadata().unwrap().len() > 100, "{name}");
    }
    let written: Value = serde_json::from_slice(&std::fs::read(study.join("analysis.json")).unwrap()).unwrap();
    assert_eq!(written, document);
}

#[test]
fn the_example_record_is_what_its_protocol_makes() {
    let folder = tempdir().unwrap();
    let protocol = root().join("examples/protocols/ball-record.toml");
    let noise = ["--force-noise", "0.05 N", "--displacement-noise", "0.001 mm", "--seed", "7"];
    let mut arguments = vec!["simulate", protocol.to_str().unwrap()];
    arguments.extend(noise);
    let made = done(folder.path(), &arguments);
    let shipped = std::fs::read_to_string(root().join("examples/records/ball.csv")).unwrap();
    assert_eq!(made.lines().count(), shipped.lines().count());
    // Equal to the last digit written on the machine that made it, to a hair on others: exp and ln differ in their last bit.
    let numbers = |line: &str| -> Vec<f64> { line.split(',').filter_map(|cell| cell.parse().ok()).collect() };
    for (a, b) in made.lines().zip(shipped.lines()) {
        for (x, y) in numbers(a).into_iter().zip(numbers(b)) {
            assert!((x - y).abs() <= 2e-6, "{a} is not {b}");
        }
    }
}

/// What a simulation wrote, replayed: displacement from force, and force from displacement.
#[test]
fn simulate_replays_a_record() {
    let folder = tempdir().unwrap();
    let protocol = root().join("examples/protocols/paper-b.toml");
    let protocol = protocol.to_str().unwrap();
    done(folder.path(), &["simulate", protocol, "--force-noise", "1 nN", "--out", "made.csv"]);
    done(
        folder.path(),
        &["simulate", protocol, "--drive", "made.csv", "--out", "moved.csv", "--energy", "work.csv"],
    );
    let column = |name: &str, at: usize| -> Vec<f64> {
        let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
        let rows = text.lines().skip_while(|line| !line.starts_with("time_s")).skip(1);
        rows.map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
    };
    let (made, moved) = (column("made.csv", 2), column("moved.csv", 3));
    let far = made.iter().zip(&moved).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(made.len() == moved.len() && far < 0.02, "{far}");
    // Only the steps of a protocol may be missing where a record drives.
    let bare = std::fs::read_to_string(protocol).unwrap();
    let bare = file(folder.path(), "bare.toml", &bare[..bare.find("[[step]]").unwrap()]);
    let moved_again = done(folder.path(), &["simulate", &bare, "--drive", "made.csv"]);
    assert_eq!(moved_again, std::fs::read_to_string(folder.path().join("moved.csv")).unwrap());
    let alone = palpate(folder.path(), &["simulate", &bare]);
    assert!(String::from_utf8_lossy(&alone.stderr).contains("[[step]]"));
    // The squeeze alone, pressed by its own force.
    let squeeze = std::fs::read_to_string(folder.path().join("made.csv")).unwrap();
    let rows: Vec<&str> = squeeze.lines().skip_while(|line| !line.starts_with("time_s")).take(1300).collect();
    let squeeze = file(folder.path(), "squeeze.csv", rows.join("\n"));
    done(
        folder.path(),
        &["simulate", &bare, "--drive", &squeeze, "--drive-by", "force", "--out", "pressed.csv"],
    );
    let (made, pressed) = (column("squeeze.csv", 1), column("pressed.csv", 1));
    let far = made.iter().zip(&pressed).map(|(a, b)| (1e-3 * a - b).abs()).fold(0.0, f64::max);
    assert!(made.len() == pressed.len() && far < 2e-5, "{far}");
}

#[test]
fn simulate_goes_to_forces_and_accounts_for_work() {
    let folder = tempdir().unwrap();
    let protocol = root().join("examples/protocols/creep.toml");
    let outputs = ["--out", "a.csv", "--energy", "work.csv", "--wave", "wave.csv"];
    done(folder.path(), &[["simulate", protocol.to_str().unwrap()].as_slice(), &outputs].concat());
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
        text.lines()
            .skip(1)
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect()
    };
    let (series, work) = (rows("a.csv"), rows("work.csv"));
    assert_eq!(series.len(), work.len());
    let forces: Vec<f64> = series.iter().map(|row| row[3]).collect();
    assert!(forces.iter().filter(|force| (**force - 10.0).abs() < 1e-9).count() > 1000);
    let (last, most) = (&work[work.len() - 1], work.iter().map(|row| row[1]).fold(0.0, f64::max));
    // Work is done, some of it is given back, and the rest is what the cycle cost.
    assert!(last.len() == 3 && last[1] > 0.0 && last[1] < most && last[2] > 0.0, "{last:?} {most}");
    assert!((most - last[2] - last[1]).abs() < 1e-6 * most, "{last:?} {most}");
}

#[test]
fn simulate_says_what_every_cycle_cost() {
    let folder = tempdir().unwrap();
    let protocol = root().join("examples/protocols/cycles.toml");
    let outputs = [
        "--out=series.csv",
        "--hysteresis=loop.svg",
        "--strain-map=map.svg",
        "--energy-by-step=steps.csv",
        "--energy-by-cycle=cycles.csv",
        "--layers-out=layers.csv",
    ];
    done(folder.path(), &[["simulate", protocol.to_str().unwrap()].as_slice(), &outputs].concat());
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let cycles: Vec<Vec<String>> = read("cycles.csv")
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect();
    let share: Vec<f64> = cycles.iter().map(|row| row[6].parse().unwrap()).collect();
    // The faster, the more of the work is lost.
    assert!(share.len() == 3 && share[0] < share[1] && share[1] < share[2] && share[2] < 1.0, "{share:?}");
    assert!(cycles.iter().all(|row| row[7] == "yes"));
    let number = |cell: &str| -> f64 { cell.parse().unwrap() };
    let work: f64 = read("steps.csv").lines().skip(1).map(|line| number(line.split(',').nth(5).unwrap())).sum();
    let lost: f64 = cycles.iter().map(|row| number(&row[5])).sum();
    assert!((work - lost).abs() < 1e-9 * work, "{work} {lost}");
    assert!(read("loop.svg").contains("cycle 3: 138 mJ of 188 mJ lost"));
    assert!(read("map.svg").contains("layer 8") && read("layers.csv").starts_with("time_s,strain_layer_1,"));
    let refused = palpate(folder.path(), &["simulate", protocol.to_str().unwrap(), "--energy-by-cycle", "loop.txt"]);
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn simulate_writes_series_figure_and_wave() {
    let folder = tempdir().unwrap();
    let protocol = root().join("examples/protocols/paper-a.toml");
    let protocol = protocol.to_str().unwrap();
    let outputs = ["--out", "a.csv", "--figure", "a.svg", "--wave", "wave.csv"];
    done(folder.path(), &[["simulate", protocol].as_slice(), &outputs].concat());
    let series = std::fs::read_to_string(folder.path().join("a.csv")).unwrap();
    let mut lines = series.lines();
    let header = "time_s,displacement_m,contact_displacement_m,force_n,strain,equilibrium_strain,excess_strain,strain_rate_per_s,in_contact";
    assert_eq!(lines.next(), Some(header));
    let peak = lines.find(|line| line.starts_with("43,")).unwrap();
    let force: f64 = peak.split(',').nth(3).unwrap().parse().unwrap();
    assert!((force / 30.991_117_046_3 - 1.0).abs() < 1e-9, "{force}");
    assert!(std::fs::read_to_string(folder.path().join("a.svg")).unwrap().starts_with("<svg"));
    let wave = std::fs::read_to_string(folder.path().join("wave.csv")).unwrap();
    assert!(wave.starts_with("time_s,strain_layer_1,strain_layer_2"));
    assert_eq!(done(folder.path(), &["simulate", protocol]), series);
}

#[test]
fn inspect_tells_columns_and_phases() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "my record.csv", ramp_and_hold(5.0, 20.0));
    let text = done(folder.path(), &["inspect", &record]);
    for word in ["displacement in mm", "force in n", "loading", "hold", "121 rows"] {
        assert!(text.contains(word), "`{word}` is not in:\n{text}");
    }
}

#[test]
fn several_records_get_a_folder_each_and_one_bad_one_does_not_stop_the_others() {
    let folder = tempdir().unwrap();
    let good = file(folder.path(), "good.csv", ramp_and_hold(5.0, 20.0));
    let bad = file(folder.path(), "bad.csv", "");
    let output = palpate(folder.path(), &["analyze", &bad, &good, "--out", "studies"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(folder.path().join("studies/good/report.html").exists());
    assert!(!folder.path().join("studies/bad").exists());
    assert!(String::from_utf8_lossy(&output.stderr).contains("bad.csv"));
    let index = std::fs::read_to_string(folder.path().join("studies/index.html")).unwrap();
    assert!(index.contains("href=\"good/report.html\"") && index.contains("Left out") && index.contains("bad.csv"));
}

#[test]
fn several_records_have_an_index_with_mean_and_interval_of_each_parameter() {
    let folder = tempdir().unwrap();
    let protocol = root().join("examples/protocols/ball-record.toml");
    let test = root().join("examples/records/ball.toml");
    let mut arguments = vec!["analyze".to_owned()];
    for seed in ["1", "2", "3"] {
        let record = format!("ball {seed}.csv");
        let noise = ["--force-noise", "0.05 N", "--seed", seed, "--out", &record];
        done(folder.path(), &[&["simulate", protocol.to_str().unwrap()][..], &noise].concat());
        arguments.push(record);
    }
    let options = ["--test", test.to_str().unwrap(), "--no-compare", "--out", "set"];
    arguments.extend(options.map(str::to_owned));
    done(folder.path(), &arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let read =
        |name: &str| -> Value { serde_json::from_slice(&std::fs::read(folder.path().join(name)).unwrap()).unwrap() };
    let document = read("set/specimens.json");
    assert_eq!((&document["schema"], &document["law"]), (&"palpate.specimens/1".into(), &"latency:5".into()));
    let rows = document["between_specimens"].as_array().unwrap();
    let row = |parameter: &str| rows.iter().find(|row| row["hold"] == 2 && row["parameter"] == parameter).unwrap();
    let values = |parameter: &str| -> Vec<f64> {
        let of = |record: &Value| {
            let report = record["report"].as_str().unwrap().replace("report.html", "analysis.json");
            let fits = read(&format!("set/{report}"))["holds"][1]["fits"].as_array().unwrap().clone();
            let fit = fits.iter().find(|fit| fit["law"] == "latency:5" && fit["domain"] == "time").unwrap();
            number(&fit["parameters"][parameter]["value"])
        };
        document["records"].as_array().unwrap().iter().map(of).collect()
    };
    let equilibrium = row("equilibrium");
    let found = values("equilibrium");
    let mean = found.iter().sum::<f64>() / 3.0;
    let deviation = (found.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
    // Student's t of 2 degrees of freedom, 95 %.
    let half = 4.302_652_729_7 * deviation / 3f64.sqrt();
    assert_eq!((&equilibrium["kind"], &equilibrium["specimens"]), (&"arithmetic".into(), &3.into()));
    for (key, expected) in [("mean", mean), ("standard_deviation", deviation)] {
        assert!((number(&equilibrium[key]) / expected - 1.0).abs() < 1e-9, "{key}: {equilibrium}");
    }
    assert!((number(&equilibrium["interval"][0]) / (mean - half) - 1.0).abs() < 1e-8, "{equilibrium}");
    let rate = row("rate_coefficient_per_s");
    let geometric = values("rate_coefficient_per_s").iter().product::<f64>().powf(1.0 / 3.0);
    assert_eq!(rate["kind"], "geometric");
    assert!(
        (number(&rate["mean"]) / geometric - 1.0).abs() < 1e-9 && number(&rate["interval"][0]) > 0.0,
        "{rate}"
    );
    let index = std::fs::read_to_string(folder.path().join("set/index.html")).unwrap();
    assert!(index.contains("href=\"ball%203/report.html\"") && index.contains("Between specimens"));
}

#[test]
fn schemas_describe_the_documents() {
    let folder = tempdir().unwrap();
    for (name, key) in [
        ("analysis", "holds"),
        ("comparison", "records"),
        ("specimens", "between_specimens"),
        ("reproduction", "claims"),
        ("reproduced-record", "table_1"),
        ("protocol", "step"),
        ("test", "specimen"),
        ("material", "calibration"),
        ("calibration", "laws"),
    ] {
        let schema = json(folder.path(), &["schema", name]);
        assert!(schema["properties"][key].is_object(), "{name} has no {key}");
    }
    let record = file(folder.path(), "record.csv", ramp_and_hold(5.0, 20.0));
    let document = json(folder.path(), &["analyze", &record, "--format", "json"]);
    let schema = json(folder.path(), &["schema", "analysis"]);
    let promised: Vec<_> = schema["required"].as_array().unwrap().iter().map(|key| key.as_str().unwrap()).collect();
    for key in promised {
        assert!(document.get(key).is_some(), "{key}");
    }
    for key in document.as_object().unwrap().keys() {
        assert!(schema["properties"][key].is_object(), "{key} is not in the schema");
    }
}

#[test]
fn completions_and_help() {
    let folder = tempdir().unwrap();
    assert!(done(folder.path(), &["completions", "bash"]).contains("palpate"));
    insta::assert_snapshot!("help", done(folder.path(), &["--help"]));
    insta::assert_snapshot!("help_analyze", done(folder.path(), &["analyze", "--help"]));
    insta::assert_snapshot!("help_calibrate", done(folder.path(), &["calibrate", "--help"]));
    insta::assert_snapshot!("help_predict", done(folder.path(), &["predict", "--help"]));
    insta::assert_snapshot!("help_watch", done(folder.path(), &["watch", "--help"]));
    insta::assert_snapshot!("help_compare", done(folder.path(), &["compare", "--help"]));
    insta::assert_snapshot!("help_simulate", done(folder.path(), &["simulate", "--help"]));
    insta::assert_snapshot!("help_sweep", done(folder.path(), &["sweep", "--help"]));
}

#[test]
fn silicone_steps_load_holds_are_type_1_and_unload_holds_type_2() {
    let Some(record) = data("silicone-steps/1_7-5_Epin_20mm_v1.csv") else {
        return;
    };
    let test = root().join("examples/tests/silicone-steps.toml");
    let arguments = ["analyze", record.to_str().unwrap(), "--test", test.to_str().unwrap(), "--format", "json"];
    let document = json(Path::new("."), &arguments);
    let holds = document["holds"].as_array().unwrap();
    assert_eq!(holds.len(), 24);
    for hold in holds {
        let expected = if hold["after"] == "loading" { "type_1" } else { "type_2" };
        assert_eq!(hold["relaxation"], expected, "hold {}", hold["index"]);
    }
}

#[test]
fn every_hold_says_what_was_held() {
    let folder = tempfile::tempdir().unwrap();
    let record = file(folder.path(), "press.csv", ramp_and_hold(7.0, 20.0));
    let document = json(folder.path(), &["analyze", &record, "--no-compare", "--format", "json"]);
    assert_eq!(document["holds"][0]["mode"], "displacement");
    let reported = done(folder.path(), &["analyze", &record, "--no-compare"]);
    assert!(reported.contains("Held") && reported.contains("displacement"), "{reported}");
    done(folder.path(), &["batch", &record, "--out", "holds.csv"]);
    let table = std::fs::read_to_string(folder.path().join("holds.csv")).unwrap();
    let mut lines = table.lines().skip_while(|line| line.starts_with('#'));
    let column = lines.next().unwrap().split(',').position(|name| name == "mode").unwrap();
    assert!(lines.all(|line| line.split(',').nth(column) == Some("displacement")), "{table}");
}

#[test]
fn foam_hold_lies_within_a_sample_of_its_labels() {
    let Some(record) = data("foam/XtraSoft.csv") else {
        return;
    };
    let document = json(Path::new("."), &["analyze", record.to_str().unwrap(), "--format", "json"]);
    let holds = document["holds"].as_array().unwrap();
    assert_eq!(holds.len(), 1);
    assert!((number(&holds[0]["start_s"]) - 5.01).abs() <= 0.2);
    assert!((number(&holds[0]["end_s"]) - 65.01).abs() <= 0.2);
}

#[test]
fn vhb_four_parameters_from_ten_minutes_predict_the_next_twenty() {
    for name in ["relax_3d0", "relax_2d5"] {
        let Some(record) = data(&format!("vhb4910/{name}.csv")) else {
            return;
        };
        let arguments = ["analyze", record.to_str().unwrap(), "--fit-until", "600 s", "--format", "json"];
        let document = json(Path::new("."), &arguments);
        let fits = document["holds"][0]["fits"].as_array().unwrap();
        let free = fits.iter().find(|fit| fit["domain"] == "time" && fit["law"] == "latency").unwrap();
        let error = number(&free["holdout_error"]);
        assert!(error < 0.006, "{name}: {error}");
    }
}

#[test]
fn records_without_a_hold_are_refused() {
    let folder = tempdir().unwrap();
    if let Some(cycle) = data("vhb4910/cyc_0d05_2d5_2.csv") {
        let error = crate::common::refused(folder.path(), &["analyze", cycle.to_str().unwrap()]);
        assert!(error.contains("no hold"), "{error}");
    }
    if let Some(still) = data("silicone-steps/1_10_E4pin_20mm_v7.csv") {
        let test = root().join("examples/tests/silicone-steps.toml");
        let arguments = ["analyze", still.to_str().unwrap(), "--test", test.to_str().unwrap()];
        crate::common::refused(folder.path(), &arguments);
    }
}

/// Stress without a section was shown in N without a word.
#[test]
fn stress_without_a_section_is_reported() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let text = ramp_and_hold(7.0, 20.0).replace("force_n", "Stress (Pa)");
    file(folder, "press.csv", text);
    let reported = done(folder, &["analyze", "press.csv"]);
    let reported = reported.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        reported.contains("the file gives stress") && reported.contains("stands for the same value in Pa"),
        "{reported}"
    );
    assert!(done(folder, &["inspect", "press.csv"]).contains("done: stress read as the force on 1 m²"));
    done(folder, &["convert", "press.csv", "--out", "plain.csv"]);
    assert!(std::fs::read_to_string(folder.join("plain.csv")).unwrap().contains("stress_as_force"));
}

/// Of 24 holds the text had 1,208 lines.
#[test]
fn many_holds_have_a_row_each_unless_details_are_requested() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut record = String::from("time_s,displacement_mm,force_n\n");
    for i in 0..1600 {
        let (t, step) = (0.05 * f64::from(i), f64::from(i / 400 + 1));
        let since = t - 20.0 * (step - 1.0);
        let place = step - 1.0 + since.min(1.0);
        let relaxing = if since < 1.0 { since } else { (-(since - 1.0) / 4.0).exp() };
        record.push_str(&format!("{t:.2},{place:.4},{:.5}\n", 5.0 * place + 2.0 * relaxing));
    }
    let record = file(folder, "steps.csv", record);
    let brief = done(folder, &["analyze", &record]);
    let full = done(folder, &["analyze", &record, "--details"]);
    assert!(
        brief.contains("Law to use for each hold") && !brief.contains("Every law fitted to every hold"),
        "{brief}"
    );
    assert!(brief.contains("--details prints") && brief.contains("Common exponent of all holds"), "{brief}");
    assert!(full.contains("Every law fitted to every hold") && full.contains("Hold 4, after loading"), "{full}");
    assert!(2 * brief.lines().count() < full.lines().count());
}
