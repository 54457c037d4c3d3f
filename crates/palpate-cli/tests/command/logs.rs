//! Logs of ROS 2 out of `simulate`, `predict` and `watch`, and back into the command.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::fs;

use palpate_files::input::Input;
use palpate_files::open::Contents;
use palpate_files::table::ReadOptions;
use serde_json::Value;
use tempfile::tempdir;

use crate::common::{done, file, palpate, ramp_and_hold, refused, root};

const PROTOCOL: &str = r#"
[specimen]
shape = "ball"
radius = "35 mm"
modulus = "28 kPa"
[law]
name = "latency"
exponent = 5
rate_coefficient = "2e4 /s"
[contact]
layers = 8
squeezed_from = "two sides"
[[step]]
to = "10 mm"
rate = "500 mm/min"
hold = "20 s"
[output]
sample_rate = "100 Hz"
"#;

/// A log, and a column of it by name.
struct Log(Contents);

impl Log {
    fn open(path: &std::path::Path) -> Self {
        let bytes = fs::read(path).unwrap();
        Self(Contents::of(Input::from_bytes("log.mcap", bytes).unwrap(), &ReadOptions::default()).unwrap())
    }

    fn values(&self, name: &str) -> Vec<f64> {
        let column = self.0.parts[0].column_named(name).unwrap_or_else(|| panic!("no column {name}"));
        self.0.read(0, &[column.number], &mut |_, _| Ok(())).unwrap().values.remove(0)
    }
}

/// The columns of a CSV file by name.
fn columns(text: &str) -> std::collections::BTreeMap<String, Vec<f64>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows: Vec<Vec<f64>> = reader
        .records()
        .map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    let column = |index: usize| rows.iter().map(|row| row[index]).collect();
    names.into_iter().enumerate().map(|(index, name)| (name, column(index))).collect()
}

#[test]
fn a_simulated_squeeze_is_analysed_from_its_log_as_from_its_table() {
    let folder = tempdir().unwrap();
    let protocol = file(folder.path(), "squeeze.toml", PROTOCOL);
    let series = columns(&done(folder.path(), &["simulate", &protocol]));
    assert_eq!(done(folder.path(), &["simulate", &protocol, "--out", "run.mcap"]), "");
    let log = Log::open(&folder.path().join("run.mcap"));
    for (topic, column) in [
        ("/palpate/joint_states.position[finger]", "displacement_m"),
        ("/palpate/wrench.wrench.force.z", "force_n"),
        ("/palpate/contact_displacement_m.data", "contact_displacement_m"),
        ("/palpate/excess_strain.data", "excess_strain"),
        ("/palpate/strain_rate_per_s.data", "strain_rate_per_s"),
        ("/palpate/in_contact.data", "in_contact"),
    ] {
        assert_eq!(log.values(topic), series[column], "{topic}");
    }
    // The jaw moves at 500 mm/min for 1.2 s, then holds.
    let (time, velocity) = (&series["time_s"], log.values("/palpate/joint_states.velocity[finger]"));
    for (time, velocity) in time.iter().zip(velocity) {
        let expected = if *time < 1.2 - 1e-9 { 0.5 / 60.0 } else { 0.0 };
        assert!((velocity - expected).abs() < 1e-9, "{time}: {velocity}");
    }
    // E (u/r) A(u) at u = 5 mm, once it holds.
    let truth = 28e3 * (5.0 / 35.0) * std::f64::consts::PI * (0.07 * 0.005 - 0.005 * 0.005);
    let equilibrium = log.values("/palpate/equilibrium_force_n.data");
    assert!((equilibrium.last().unwrap() - truth).abs() < 1e-9 * truth);
    let text = done(folder.path(), &["inspect", "run.mcap"]);
    assert!(text.contains("/palpate/wrench.wrench.force.z") && !text.contains("skipped"), "{text}");
    let fitted = |record: &str| -> Value {
        let json = done(folder.path(), &["analyze", record, "--no-compare", "--format", "json"]);
        serde_json::from_str(&json).unwrap()
    };
    fs::write(folder.path().join("run.csv"), done(folder.path(), &["simulate", &protocol])).unwrap();
    let (log, table) = (fitted("run.mcap"), fitted("run.csv"));
    let fit = |analysis: &Value, key: &str| {
        let fits = analysis["holds"][0]["fits"].as_array().unwrap();
        let of_law = fits.iter().find(|fit| fit["law"] == "latency:5").unwrap();
        of_law["parameters"][key]["value"].as_f64().unwrap()
    };
    for key in ["equilibrium", "amplitude", "relative_rate_per_s"] {
        let (found, expected) = (fit(&log, key), fit(&table, key));
        // Stamps are whole nanoseconds.
        assert!((found / expected - 1.0).abs() < 1e-6, "{key}: {found} {expected}");
    }
    assert!((fit(&log, "equilibrium") / truth - 1.0).abs() < 0.002);
}

#[test]
fn logs_are_the_same_bytes_each_time_and_name_what_wrote_them() {
    let folder = tempdir().unwrap();
    let protocol = file(folder.path(), "squeeze.toml", PROTOCOL);
    for name in ["one.mcap", "two.mcap"] {
        done(folder.path(), &["simulate", &protocol, "--out", name]);
    }
    let [one, two] = ["one.mcap", "two.mcap"].map(|name| fs::read(folder.path().join(name)).unwrap());
    assert!(one == two);
    let text = String::from_utf8_lossy(&one);
    assert!(text.contains("palpate simulate") && text.contains("time_zero_ns"), "no metadata");
}

#[test]
fn a_log_with_noise_has_readings_alone() {
    let folder = tempdir().unwrap();
    let protocol = file(folder.path(), "squeeze.toml", PROTOCOL);
    let noise = ["--force-noise", "0.05 N", "--displacement-noise", "1 µm", "--seed", "7"];
    let text = done(folder.path(), &[&["simulate", &protocol][..], &noise].concat());
    done(folder.path(), &[&["simulate", &protocol][..], &noise, &["--out", "noisy.mcap"]].concat());
    let log = Log::open(&folder.path().join("noisy.mcap"));
    let table = &text[text.find("time_s").unwrap()..];
    let forces = &columns(table)["force_n"];
    let logged = log.values("/palpate/wrench.wrench.force.z");
    assert!(forces.iter().zip(&logged).all(|(one, other)| (one - other).abs() < 1e-6));
    assert!(log.0.parts[0].column_named("/palpate/strain.data").is_none());
}

#[test]
fn a_prediction_is_logged_with_its_band() {
    let folder = tempdir().unwrap();
    let (material, protocol) = (
        root().join("examples/records/ball-material.toml").display().to_string(),
        root().join("examples/protocols/hold.toml").display().to_string(),
    );
    let predict = ["predict", &material, "--protocol", &protocol];
    let series = columns(&done(folder.path(), &predict));
    done(folder.path(), &[&predict[..], &["--out", "p.mcap"]].concat());
    let log = Log::open(&folder.path().join("p.mcap"));
    for (topic, column) in [
        ("/palpate/wrench.wrench.force.z", "force_n"),
        ("/palpate/force_low_n.data", "force_low_n"),
        ("/palpate/reading_high_n.data", "reading_high_n"),
    ] {
        assert_eq!(log.values(topic), series[column], "{topic}");
    }
    // Single times have no velocity between them.
    done(folder.path(), &[&predict[..], &["--at", "5 s", "--at", "50 s", "--out", "at.mcap"]].concat());
    let log = Log::open(&folder.path().join("at.mcap"));
    assert_eq!(log.values("/palpate/wrench log time"), [0.0, 45.0]);
    assert!(log.0.parts[0].column_named("/palpate/joint_states.velocity[finger]").is_none());
    // A log of one time would be none that `inspect` reads.
    let error = refused(folder.path(), &[&predict[..], &["--at", "60 s", "--out", "one.mcap"]].concat());
    assert!(error.contains("one.mcap: a log needs 2 times or more, found 1"), "{error}");
    assert!(error.contains("hint: add another --at, or write CSV"), "{error}");
    assert!(!folder.path().join("one.mcap").exists());
}

#[test]
fn what_is_watched_is_logged_tick_by_tick() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "log.csv", ramp_and_hold(30.0, 100.0));
    let watch = ["watch", &record, "--slip-force", "1.5 N", "--format", "jsonl", "--every", "1 ms"];
    let lines = done(folder.path(), &[&watch[..], &["--out", "observed.mcap"]].concat());
    assert_eq!(lines, done(folder.path(), &watch), "the lines are those without a log");
    let lines: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let ticks: Vec<&Value> = lines.iter().filter(|line| line["event"] == "tick").collect();
    let log = Log::open(&folder.path().join("observed.mcap"));
    assert_eq!(log.values("/palpate/wrench.wrench.force.z").len(), ticks.len());
    for (topic, key) in [
        ("/palpate/equilibrium_force_n.data", "equilibrium_force_n"),
        ("/palpate/filtered_force_n.data", "force_n"),
        ("/palpate/time_to_slip_low_s.data", "time_to_slip_low_s"),
    ] {
        let reported: Vec<f64> = ticks.iter().filter_map(|tick| tick[key].as_f64()).collect();
        assert!(reported.len() > 300, "{key}");
        assert_eq!(log.values(topic), reported, "{key}");
    }
    // F = 1 + (1 + 4 t)^(-1/4) is 1.5 N after 3.75 s of the hold, which begins at 1 s: 1 s into it, in 2.75 s.
    let (time, slip) = (log.values("/palpate/time_to_slip_s time"), log.values("/palpate/time_to_slip_s.data"));
    let at = time.iter().position(|time| *time >= 2.0).unwrap();
    assert!((slip[at] - 2.75).abs() < 0.05, "{}", slip[at]);
    // A hold begins, a warning, it slips; the last two are not harmless.
    let levels = log.values("/palpate/diagnostics.status[0].level");
    assert!(levels.contains(&0.0) && levels.contains(&1.0) && levels.contains(&2.0), "{levels:?}");
    assert!(log.values("/palpate/joint_states.position[finger]").len() == ticks.len());
}

#[test]
fn a_log_of_a_log_keeps_its_stamps() {
    let folder = tempdir().unwrap();
    let protocol = file(folder.path(), "squeeze.toml", PROTOCOL);
    done(folder.path(), &["simulate", &protocol, "--out", "run.mcap"]);
    done(folder.path(), &["watch", "run.mcap", "--out", "observed.mcap"]);
    done(folder.path(), &["simulate", &protocol, "--drive", "run.mcap", "--out", "again.mcap"]);
    let stamps = |name: &str| {
        let bytes = fs::read(folder.path().join(name)).unwrap();
        let contents = Contents::of(Input::from_bytes(name, bytes).unwrap(), &ReadOptions::default()).unwrap();
        (contents.parts[0].metadata[0].value.clone(), Log(contents).values("/palpate/wrench time"))
    };
    assert!(stamps("run.mcap") == stamps("observed.mcap") && stamps("run.mcap") == stamps("again.mcap"));
    assert_eq!(stamps("run.mcap").0, "1.000000000");
}

#[test]
fn a_record_without_displacement_is_watched_and_logged() {
    let folder = tempdir().unwrap();
    let text: String = ramp_and_hold(10.0, 50.0)
        .lines()
        .map(|line| {
            line.split(',')
                .enumerate()
                .filter(|(i, _)| *i != 1)
                .map(|(_, cell)| cell)
                .collect::<Vec<_>>()
                .join(",")
        })
        .map(|line| line + "\n")
        .collect();
    let record = file(folder.path(), "force.csv", text);
    done(folder.path(), &["watch", &record, "--out", "observed.mcap"]);
    let log = Log::open(&folder.path().join("observed.mcap"));
    assert!(log.0.parts[0].column_named("/palpate/joint_states.position[finger]").is_none());
    assert_eq!(log.values("/palpate/joint_states.effort[finger]").len(), 551);
    // It is a record of forces for palpate, too.
    done(folder.path(), &["watch", "observed.mcap"]);
}

#[test]
fn a_pre_trigger_is_shifted_and_times_that_have_no_stamp_are_refused() {
    let folder = tempdir().unwrap();
    let at = |first: f64, step: f64| -> String {
        let row = |i: u32| format!("{},{}\n", first + step * f64::from(i), 1.0 + f64::from(i % 3));
        format!("time_s,force_n\n{}", (0..60).map(row).collect::<String>())
    };
    let early = file(folder.path(), "early.csv", at(-2.5, 0.1));
    done(folder.path(), &["watch", &early, "--out", "early.mcap"]);
    let bytes = fs::read(folder.path().join("early.mcap")).unwrap();
    let contents = Contents::of(Input::from_bytes("early.mcap", bytes).unwrap(), &ReadOptions::default()).unwrap();
    assert_eq!(contents.parts[0].metadata[0].value, "1.500000000");
    let late = file(folder.path(), "late.csv", at(0.0, 4e7));
    let error = palpate(folder.path(), &["watch", &late, "--out", "late.mcap", "--format", "jsonl"]);
    let error = String::from_utf8_lossy(&error.stderr).into_owned();
    assert!(
        error.contains("late.mcap: expected times that ROS 2 can stamp") && error.contains("hint:"),
        "{error}"
    );
    let close = file(folder.path(), "close.csv", at(0.0, 1e-10));
    let error = palpate(folder.path(), &["watch", &close, "--out", "close.mcap"]);
    let error = String::from_utf8_lossy(&error.stderr).into_owned();
    assert!(error.contains("expected samples at least 1 ns apart"), "{error}");
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 4, "{left:?}");
}

#[test]
fn names_that_are_no_logs_are_refused_before_any_work() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "log.csv", ramp_and_hold(2.0, 50.0));
    let error = refused(folder.path(), &["watch", &record, "--out", "observed.txt"]);
    assert!(error.contains("observed.txt: expected a log ending in .mcap"), "{error}");
    let protocol = file(folder.path(), "squeeze.toml", PROTOCOL);
    let error = refused(folder.path(), &["simulate", &protocol, "--out", "run.txt"]);
    assert!(error.contains("run.txt: expected a series ending in .csv or .mcap"), "{error}");
    let kept = file(folder.path(), "kept.mcap", "something");
    let error = refused(folder.path(), &["watch", &kept, "--out", &kept]);
    assert!(error.contains("expected an output file that is not an input"), "{error}");
    assert_eq!(fs::read(folder.path().join(kept)).unwrap(), b"something");
}
