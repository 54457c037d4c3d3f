//! Sweeps: their tables, their restarts, their refusals.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{done, file, palpate, refused, root};
use palpate_files::parquet_table::{Rows, TableReader, Values};
use palpate_jobs::output::sha256;
use tempfile::tempdir;

const BALL: &str = r#"
title = "A ball"
[specimen]
shape = "ball"
radius = "35 mm"
modulus = "28 kPa"
[law]
name = "latency"
exponent = 5
rate_coefficient = "2e4 /s"
[[step]]
to = "5 mm"
rate = "500 mm/min"
hold = "10 s"
[output]
sample_rate = "20 Hz"
"#;

fn protocol(folder: &Path, sweep: &str) -> String {
    file(folder, "ball.toml", format!("{BALL}\n[sweep]\n{sweep}\n"))
}

/// A whole table, and the names of its columns.
fn table(path: &Path) -> (Vec<String>, Rows) {
    let reader = TableReader::new(File::open(path).unwrap()).unwrap();
    assert_eq!(reader.groups(), 1, "the tests keep to one row group");
    let names = reader.fields().iter().map(|field| field.name.clone()).collect();
    (names, reader.read(0).unwrap())
}

fn numbers(path: &Path, column: &str) -> Vec<Option<f64>> {
    let (names, rows) = table(path);
    let at = names.iter().position(|name| name == column).unwrap_or_else(|| panic!("no {column} in {names:?}"));
    match &rows.columns[at] {
        Values::Number(values) => values.clone(),
        Values::Count(values) => values.iter().map(|value| Some(*value as f64)).collect(),
        Values::OptionalCount(values) => values.iter().map(|value| value.map(|count| count as f64)).collect(),
        Values::Text(_) => panic!("{column} holds texts"),
    }
}

fn texts(path: &Path, column: &str) -> Vec<Option<String>> {
    let (names, mut rows) = table(path);
    match rows.columns.remove(names.iter().position(|name| name == column).unwrap()) {
        Values::Text(values) => values,
        _ => panic!("{column} holds numbers"),
    }
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn every_run_is_what_simulate_gives() {
    let folder = tempdir().unwrap();
    let sweep = protocol(folder.path(), "law.rate_coefficient = \"log 1e3..1e5 /s, 3\"\nstep.1.hold = \"1, 10 s\"");
    done(folder.path(), &["sweep", &sweep, "--out", "t.parquet"]);
    let out = folder.path().join("t.parquet");
    assert_eq!(names(folder.path()), ["ball.toml", "t.parquet"]);
    assert_eq!(numbers(&out, "run"), (1..=6).map(|run| Some(f64::from(run))).collect::<Vec<_>>());
    let (rates, holds) = (numbers(&out, "law_rate_coefficient_per_s"), numbers(&out, "step_1_hold_s"));
    assert_eq!(rates, [1e3, 1e3, 1e4, 1e4, 1e5, 1e5].map(Some));
    assert_eq!(holds, [1.0, 10.0, 1.0, 10.0, 1.0, 10.0].map(Some));
    let (peaks, ends) = (numbers(&out, "peak_force_n"), numbers(&out, "force_end_n"));
    let shares = numbers(&out, "step_1_relaxed_share");
    assert_eq!(numbers(&out, "step_1_end_force_n").len(), 6);
    for run in 0..6 {
        let (rate, hold) = (rates[run].unwrap(), holds[run].unwrap());
        let alone = BALL.replace("2e4 /s", &format!("{rate} /s")).replace("\"10 s\"", &format!("\"{hold} s\""));
        let alone = file(folder.path(), "alone.toml", alone);
        let series = done(folder.path(), &["simulate", &alone]);
        let forces: Vec<f64> =
            series.lines().skip(1).map(|line| line.split(',').nth(3).unwrap().parse().unwrap()).collect();
        let (peak, end) = (forces.iter().copied().fold(0.0, f64::max), forces[forces.len() - 1]);
        assert!((peaks[run].unwrap() / peak - 1.0).abs() < 1e-12);
        assert_eq!(ends[run].unwrap(), end);
        // One squeeze: its peak is the end of the ramp, and its hold relaxes from there.
        assert!((shares[run].unwrap() - (1.0 - end / peak)).abs() < 1e-9);
    }
    assert!(numbers(&out, "stored_j").iter().all(Option::is_none), "of a ball nobody knows what it stores");
    assert!(numbers(&out, "work_j").iter().all(|work| work.unwrap() > 0.0));
    assert!(texts(&out, "refused").iter().all(Option::is_none));
}

#[test]
fn steps_of_every_kind_have_their_columns() {
    let folder = tempdir().unwrap();
    let text = fs::read_to_string(root().join("examples/protocols/creep.toml")).unwrap();
    let sweep = file(folder.path(), "creep.toml", format!("{text}\n[sweep]\nlaw.exponent = \"3, 5\"\n"));
    done(folder.path(), &["sweep", &sweep]);
    let out = folder.path().join("creep.parquet");
    let two = |column: &str| numbers(&out, column).iter().map(|value| value.unwrap()).collect::<Vec<f64>>();
    for (column, force) in [("step_1_ramp_force_n", 10.0), ("step_2_end_force_n", 10.0), ("step_3_ramp_force_n", 2.0)] {
        assert!(two(column).iter().all(|found| (found - force).abs() < 1e-9), "{column}");
    }
    assert_eq!(numbers(&out, "step_2_relaxed_share"), [None, None], "a kept force does not relax");
    for (share, end) in two("step_1_relaxed_share").iter().zip(two("step_1_end_force_n")) {
        assert!((share - (1.0 - end / 10.0)).abs() < 1e-9);
    }
    assert!(two("contact_lost_s").iter().all(|time| *time > 0.0));
    assert_eq!(two("step_4_end_force_n"), two("force_end_n"));
}

#[test]
fn a_run_that_is_refused_is_a_row_with_a_reason() {
    let folder = tempdir().unwrap();
    let sweep = protocol(folder.path(), "specimen.radius = \"2, 35 mm\"\nstep.1.to = \"3, 5 mm\"");
    let output = palpate(folder.path(), &["sweep", &sweep, "--out", "t.parquet", "--figure", "t.svg"]);
    assert_eq!(output.status.code(), Some(0));
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        reported.contains("1 of 4 runs refused, first run 2: ") && reported.contains("step[1].to"),
        "{reported}"
    );
    let out = folder.path().join("t.parquet");
    let reasons = texts(&out, "refused");
    assert!(reasons[1].as_ref().unwrap().contains("found \"5 mm\""), "{reasons:?}");
    assert!(!reasons[1].as_ref().unwrap().contains("ball.toml"), "{reasons:?}");
    assert_eq!(numbers(&out, "peak_force_n").iter().filter(|force| force.is_none()).count(), 1);
    assert!(fs::read_to_string(folder.path().join("t.svg")).unwrap().starts_with("<svg"));
    // Where all of them are, the answer is no.
    let sweep = protocol(folder.path(), "specimen.radius = \"1, 2 mm\"");
    let output = palpate(folder.path(), &["sweep", &sweep, "--out", "u.parquet"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(texts(&folder.path().join("u.parquet"), "refused").iter().flatten().count(), 2);
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let folder = tempdir().unwrap();
    let rest =
        "method = \"latin hypercube\"\nsamples = 300\nlaw.exponent = \"linear 1..6\"\nstep.1.to = \"linear 1..60 mm\"";
    let sweep = protocol(folder.path(), rest);
    let bytes: Vec<Vec<u8>> = ["1", "2", "7"]
        .iter()
        .map(|threads| {
            let out = format!("{threads}.parquet");
            done(folder.path(), &["sweep", &sweep, "--out", &out, "--threads", threads]);
            fs::read(folder.path().join(out)).unwrap()
        })
        .collect();
    assert!(bytes[0] == bytes[1] && bytes[1] == bytes[2]);
}

/// Kills a sweep once it has finished some parts, and returns how many.
fn killed(folder: &Path, arguments: &[&str], parts: &Path, least: usize) -> usize {
    let mut child = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(arguments)
        .current_dir(folder)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let count = || pieces(parts);
    let since = Instant::now();
    while count() < least && since.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(child.try_wait().unwrap(), None, "the sweep was over before it could be killed");
    child.kill().unwrap();
    child.wait().unwrap();
    count()
}

/// How many finished parts there are.
fn pieces(parts: &Path) -> usize {
    let begin = b" {\"key\":";
    let bytes = fs::read(parts.join("pieces")).unwrap_or_default();
    bytes.windows(begin.len()).filter(|window| window == begin).count()
}

/// Makes a folder with parts of a sweep whose protocol has this digest.
fn parts_of(parts: &Path, digest: &str) {
    fs::create_dir(parts).unwrap();
    let head = format!("{{\"palpate\":\"sweep\",\"depends_on_sha256\":\"{digest}\"}}");
    let head = format!("{} {head}\nold", sha256(head.as_bytes()));
    fs::write(parts.join("pieces"), head).unwrap();
}

/// A sweep that was killed before the first line of its parts was whole was refused when it ran again, as one with the parts of another.
#[test]
fn a_sweep_that_was_killed_before_its_first_part_goes_on() {
    let folder = tempdir().unwrap();
    let sweep = protocol(folder.path(), "law.exponent = \"linear 1..6, 5\"");
    let arguments = ["sweep", &sweep, "--out", "t.parquet"];
    done(folder.path(), &arguments);
    let (parts, out) = (folder.path().join("t.parquet.parts"), folder.path().join("t.parquet"));
    let whole = fs::read(&out).unwrap();
    for pieces in [None, Some(""), Some("0f5c"), Some("0f5c {\"palpate\":")] {
        for is_made in [false, true] {
            if !is_made {
                fs::remove_file(&out).unwrap();
            }
            fs::create_dir(&parts).unwrap();
            fs::write(parts.join("lock"), "").unwrap();
            if let Some(pieces) = pieces {
                fs::write(parts.join("pieces"), pieces).unwrap();
            }
            done(folder.path(), &arguments);
            assert!(fs::read(&out).unwrap() == whole && !parts.exists(), "{pieces:?} {:?}", names(folder.path()));
        }
    }
}

/// A table that was whole was not written again, and the temporary folder of the killed run stayed beside it.
#[test]
fn a_sweep_that_was_killed_behind_its_last_step_leaves_nothing() {
    let folder = tempdir().unwrap();
    let sweep = protocol(folder.path(), "law.exponent = \"1, 2\"");
    let arguments = ["sweep", &sweep, "--out", "t.parquet"];
    done(folder.path(), &arguments);
    let before = names(folder.path());
    fs::create_dir(folder.path().join(".palpate-x1y2z3")).unwrap();
    fs::write(folder.path().join(".palpate-x1y2z3/lock"), "").unwrap();
    done(folder.path(), &arguments);
    assert_eq!(names(folder.path()), before);
}

#[test]
fn a_sweep_that_was_killed_goes_on_and_nothing_is_lost_or_doubled() {
    let folder = tempdir().unwrap();
    // Long enough to be killed in the middle: 4000 runs of 10,000 samples.
    let sweep =
        protocol(folder.path(), "law.exponent = \"linear 1..6, 80\"\nlaw.rate_coefficient = \"log 1e3..1e6 /s, 50\"");
    let text = fs::read_to_string(folder.path().join(&sweep)).unwrap().replace("20 Hz", "1 kHz");
    let sweep = file(folder.path(), "ball.toml", text);
    let arguments = ["sweep", &sweep, "--out", "t.parquet", "--threads", "2"];
    let (parts, out) = (folder.path().join("t.parquet.parts"), folder.path().join("t.parquet"));
    let first = killed(folder.path(), &arguments, &parts, 2);
    let second = killed(folder.path(), &arguments, &parts, first + 2);
    assert!(first >= 2 && second > first && !out.exists());
    // One part is damaged, one was being written, and somebody left a note.
    let part = parts.join("pieces");
    let mut bytes = fs::read(&part).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&part, bytes).unwrap();
    let half = folder.path().join(".palpate-x1y2z3");
    fs::create_dir(&half).unwrap();
    fs::write(half.join("lock"), "").unwrap();
    fs::write(half.join("1"), "half").unwrap();
    // Another protocol does not take these parts.
    let other =
        file(folder.path(), "other.toml", fs::read_to_string(folder.path().join(&sweep)).unwrap() + "# changed\n");
    let error = refused(folder.path(), &["sweep", &other, "--out", "t.parquet"]);
    assert!(error.contains("those of another") && error.contains("--restart"), "{error}");
    let output = palpate(folder.path(), &arguments);
    assert!(output.status.success());
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(reported.contains("4000 runs in ") && reported.contains(" computed before"), "{reported}");
    assert!(!parts.exists() && !half.exists(), "{:?}", names(folder.path()));
    done(folder.path(), &["sweep", &sweep, "--out", "whole.parquet"]);
    assert!(fs::read(&out).unwrap() == fs::read(folder.path().join("whole.parquet")).unwrap());
    assert_eq!(numbers(&out, "run"), (1..=4000).map(|run| Some(f64::from(run))).collect::<Vec<_>>());
    // What is done is not done again; what changed is.
    let reported = |arguments: &[&str]| String::from_utf8_lossy(&palpate(folder.path(), arguments).stderr).into_owned();
    assert!(reported(&arguments).contains("all computed before"));
}

#[test]
fn restart_computes_everything() {
    let folder = tempdir().unwrap();
    let sweep = protocol(folder.path(), "law.exponent = \"1, 2\"");
    let reported = |more: &[&str]| {
        let arguments = [&["sweep", &sweep, "--out", "t.parquet"], more].concat();
        String::from_utf8_lossy(&palpate(folder.path(), &arguments).stderr).into_owned()
    };
    assert!(!reported(&[]).contains("before"));
    assert!(reported(&[]).contains("all computed before"));
    assert!(!reported(&["--restart"]).contains("before"));
    // Parts of an older sweep make room.
    let parts = folder.path().join("t.parquet.parts");
    parts_of(&parts, "of another");
    fs::write(parts.join("note.md"), "mine").unwrap();
    assert!(!reported(&["--restart"]).contains("before"));
    assert_eq!(names(&parts), ["note.md"], "files of others stay");
    assert_eq!(numbers(&folder.path().join("t.parquet"), "law_exponent"), [Some(1.0), Some(2.0)]);
}

#[test]
fn parts_that_outlived_their_table_are_taken_away_and_those_of_others_are_not() {
    let folder = tempdir().unwrap();
    let sweep = protocol(folder.path(), "law.exponent = \"1, 2\"");
    let arguments = ["sweep", &sweep, "--out", "t.parquet"];
    done(folder.path(), &arguments);
    let out = folder.path().join("t.parquet");
    let table = TableReader::new(File::open(&out).unwrap()).unwrap();
    let digest = table.mark("palpate_sweep_sha256").unwrap();
    let parts = folder.path().join("t.parquet.parts");
    for (manifest, left) in [(digest, false), ("another", true)] {
        parts_of(&parts, manifest);
        let output = palpate(folder.path(), &arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(parts.exists(), left);
    }
    assert_eq!(names(&parts), ["pieces"]);
}

#[test]
fn two_sweeps_into_one_table_are_refused() {
    let folder = tempdir().unwrap();
    let sweep = protocol(folder.path(), "law.exponent = \"1, 2\"");
    let parts = folder.path().join("t.parquet.parts");
    fs::create_dir(&parts).unwrap();
    let lock = File::create(parts.join("lock")).unwrap();
    lock.lock().unwrap();
    let error = refused(folder.path(), &["sweep", &sweep, "--out", "t.parquet"]);
    assert!(error.contains("no other running sweep"), "{error}");
    drop(lock);
    done(folder.path(), &["sweep", &sweep, "--out", "t.parquet"]);
}

#[test]
fn every_kind_of_figure() {
    let folder = tempdir().unwrap();
    let one = "law.exponent = \"linear 1..6, 4\"\n";
    let two = format!("{one}specimen.radius = \"30, 35, 40 mm\"\n");
    let three = format!("{two}step.1.rate = \"5, 50, 500 mm/min\"\n");
    let points = format!("method = \"latin hypercube\"\nsamples = 40\n{}", two.replace(", 4", ""));
    for (sweep, panels) in [(one, 1), (&two, 1), (&three, 3), (&points, 2)] {
        let sweep = protocol(folder.path(), sweep);
        done(folder.path(), &["sweep", &sweep, "--figure", "f.svg", "--show", "force_end_n", "--restart"]);
        let figure = fs::read_to_string(folder.path().join("f.svg")).unwrap();
        // Each panel of several has its letter.
        let letters = ["(a)", "(b)", "(c)", "(d)"].iter().filter(|letter| figure.contains(**letter)).count();
        assert_eq!(letters, if panels > 1 { panels } else { 0 }, "{sweep}");
        assert!(figure.contains("Force at the end"), "{sweep}");
    }
    let four = format!("{three}specimen.modulus = \"20, 30 kPa\"");
    let sweep = protocol(folder.path(), &four);
    let error = refused(folder.path(), &["sweep", &sweep, "--out", "four.parquet", "--figure", "f.svg"]);
    assert!(error.contains("one to three swept parameters, found 4") && error.contains("hint:"), "{error}");
    let sweep = protocol(folder.path(), &format!("{two}step.1.rate = \"linear 5..500 mm/min, 13\""));
    let error = refused(folder.path(), &["sweep", &sweep, "--out", "four.parquet", "--figure", "f.svg"]);
    assert!(error.contains("at most 12 values of step[1].rate"), "{error}");
    let sweep = protocol(folder.path(), one);
    let error =
        refused(folder.path(), &["sweep", &sweep, "--out", "four.parquet", "--figure", "f.svg", "--show", "peak"]);
    assert!(error.contains("unknown result") && error.contains("peak_force_n"), "{error}");
    let error = refused(folder.path(), &["sweep", &sweep, "--out", "four.parquet", "--figure", "f.gif"]);
    assert!(error.contains(".svg, .png or .pdf"), "{error}");
    assert_eq!(names(folder.path()), ["ball.parquet", "ball.toml", "f.svg"]);
}

#[test]
fn sweeps_that_make_no_sense_write_nothing() {
    let folder = tempdir().unwrap();
    file(folder.path(), "taken", "a file, not a folder");
    let refuses = |sweep: &str, out: &str, words: &[&str]| {
        let sweep = protocol(folder.path(), sweep);
        let error = refused(folder.path(), &["sweep", &sweep, "--out", out]);
        for word in words.iter().chain(&["error:"]) {
            assert!(error.contains(word), "`{word}` is not in:\n{error}");
        }
        assert_eq!(names(folder.path()), ["ball.toml", "taken"]);
    };
    refuses("law.exponnt = \"1, 2\"", "t.parquet", &["line 19", "sweep.law.exponnt", "law.exponent?"]);
    refuses("law.exponent = \"log 0..5, 3\"", "t.parquet", &["sweep.law.exponent", "above 0"]);
    refuses("law.exponent = \"1, 2\"", "t.csv", &["t.csv", ".parquet"]);
    refuses("law.exponent = \"1, 2\"", "taken/t.parquet", &["taken", "cannot write"]);
    let error = refused(folder.path(), &["sweep", "absent.toml"]);
    assert!(error.contains("absent.toml: no such file"), "{error}");
    let plain = file(folder.path(), "ball.toml", BALL);
    let error = refused(folder.path(), &["sweep", &plain]);
    assert!(error.contains("sweep: missing") && error.contains("log 1e3..1e6 /s, 50"), "{error}");
    fs::create_dir(folder.path().join("folder.parquet")).unwrap();
    let sweep = protocol(folder.path(), "law.exponent = \"1, 2\"");
    let error = refused(folder.path(), &["sweep", &sweep, "--out", "folder.parquet"]);
    assert!(error.contains("found a directory"), "{error}");
    let output = palpate(folder.path(), &["simulate", &sweep]);
    assert!(output.status.success());
    assert!(String::from_utf8_lossy(&output.stderr).contains("palpate sweep"));
}

#[cfg(unix)]
#[test]
fn a_folder_that_may_not_be_written_to() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempdir().unwrap();
    let sweep = protocol(folder.path(), "law.exponent = \"1, 2\"");
    let closed = folder.path().join("closed");
    fs::create_dir(&closed).unwrap();
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o555)).unwrap();
    if File::create(closed.join("probe")).is_ok() {
        eprintln!("skipped: this user may write anywhere");
        return;
    }
    let error = refused(folder.path(), &["sweep", &sweep, "--out", "closed/t.parquet"]);
    assert!(error.contains("cannot write") && error.contains("choose a folder"), "{error}");
}

#[test]
fn the_example_runs() {
    let folder = tempdir().unwrap();
    let sweep = root().join("examples/protocols/sweep.toml");
    done(folder.path(), &["sweep", sweep.to_str().unwrap(), "--figure", "f.svg"]);
    let out = folder.path().join("sweep.parquet");
    let refusals = texts(&out, "refused");
    assert!(refusals.len() == 720 && refusals.iter().all(Option::is_none), "{refusals:?}");
    // A faster squeeze leaves less time to relax: the peak rises with the speed.
    let peaks = numbers(&out, "peak_force_n");
    assert!(peaks.chunks(24).all(|row| row.windows(2).all(|pair| pair[0].unwrap() < pair[1].unwrap())));
}
