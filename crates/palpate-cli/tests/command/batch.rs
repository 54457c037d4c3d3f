//! `palpate batch`: many records to one table, whatever some of them are like, and however often it is stopped.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{done, file, palpate, ramp_and_hold, refused};
use palpate_files::parquet_table::{TableReader, Values};

/// A folder of so many records, each a little different.
fn records(folder: &Path, count: usize) {
    fs::create_dir_all(folder.join("curves/deep")).unwrap();
    for i in 0..count {
        let name = format!("curves/{}c{i:03}.csv", if i % 3 == 0 { "deep/" } else { "" });
        file(folder, &name, ramp_and_hold(5.0 + i as f64 / 10.0, 20.0));
    }
}

fn lines(folder: &Path, name: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
}

/// The cells of one column, by its name.
fn column(table: &[String], name: &str) -> Vec<String> {
    let text = table.join("\n");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let index = reader.headers().unwrap().iter().position(|column| column == name).unwrap();
    reader.records().map(|row| row.unwrap()[index].to_owned()).collect()
}

/// A conical tip on a gel of 1 kPa: 2/π E/(1 − ν²) tan α u² once relaxed, and with one layer, which does not relax, at any time.
#[test]
fn moduli_of_an_indented_gel_are_those_that_it_was_simulated_with() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let specimen =
        "[specimen]\nshape = \"conical tip\"\nhalf_angle = \"35 deg\"\nthickness = \"20 um\"\npoisson_ratio = 0.5\n";
    file(folder, "cone.toml", format!("{specimen}[contact]\ntouch = \"as recorded\"\n").as_bytes());
    fs::create_dir(folder.join("curves")).unwrap();
    for (name, layers) in [("elastic", 1), ("soft", 4)] {
        let law = "[law]\nname = \"latency\"\nexponent = 1\nrate_coefficient = \"2 /s\"\n";
        let steps = "[[step]]\nto = \"1 um\"\nrate = \"2 um/s\"\nhold = \"20 s\"\n";
        let protocol = format!("{specimen}modulus = \"1 kPa\"\n{law}[contact]\nlayers = {layers}\n{steps}");
        file(folder, "protocol.toml", protocol.as_bytes());
        let curve = done(folder, &["simulate", "protocol.toml"]);
        file(folder, &format!("curves/{name}.csv"), curve.as_bytes());
    }
    done(folder, &["batch", "curves", "--test", "cone.toml", "--out", "holds.csv"]);
    let table = lines(folder, "holds.csv");
    let (records, laws) = (column(&table, "record"), column(&table, "law"));
    let number = |name: &str, row: usize| column(&table, name)[row].parse::<f64>().unwrap();
    // A hold that does not relax has one row without a law.
    assert_eq!((records[0].as_str(), laws[0].as_str()), ("curves/elastic.csv", ""));
    assert!((number("loading_modulus_pa", 0) - 1e3).abs() < 1.0, "{}", number("loading_modulus_pa", 0));
    assert!(number("loading_relative_rmse", 0) < 1e-3);
    assert_eq!((records[1].as_str(), laws[1].as_str()), ("curves/soft.csv", "latency:1"));
    let relaxed = number("equilibrium_modulus_pa", 1);
    assert!((relaxed - 1e3).abs() < 2.0, "{relaxed}");
    assert!(number("equilibrium_modulus_standard_error_pa", 1) < 5.0);
    // The ramp of 0.5 s leaves the excess strain of three more layers, at first in full: between E and 4 E.
    let apparent = number("loading_modulus_pa", 1);
    assert!((2.0 * relaxed..4.0 * relaxed).contains(&apparent), "{apparent}");
}

/// Approach and retraction without a hold between them, of a ball on a half space: Hertz's F = 4/3 E/(1 − ν²) √R u^1.5.
fn approach(modulus_pa: f64) -> String {
    let (radius_m, poisson_ratio) = (5e-6_f64, 0.5_f64);
    let row = |index: i32| {
        let height = 2e-6 - 1e-8 * f64::from(index - 300).abs();
        let depth = height.max(0.0);
        let force = 4.0 / 3.0 * modulus_pa / (1.0 - poisson_ratio * poisson_ratio) * radius_m.sqrt() * depth.powf(1.5);
        format!("{},{},{}\n", 0.001 * f64::from(index), 1e9 * height, 1e9 * force)
    };
    (0..600).map(row).fold("Time (s),Indentation (nm),Force (nN)\n".to_owned(), |text, row| text + &row)
}

const BALL_TIP: &str =
    "[specimen]\nshape = \"spherical tip\"\nradius = \"5 um\"\npoisson_ratio = 0.5\n[contact]\ntouch = \"0 mm\"\n";

#[test]
fn curves_without_a_hold_in_a_zip_have_a_row_with_their_modulus() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let curves = [("map/curve1.csv", 500.0), ("map/curve2.csv", 2000.0), ("map/curve3.csv", 1000.0)];
    let mut zip = zip::ZipWriter::new(fs::File::create(folder.join("map.zip")).unwrap());
    for (name, modulus_pa) in curves {
        zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        std::io::Write::write_all(&mut zip, approach(modulus_pa).as_bytes()).unwrap();
    }
    zip.finish().unwrap();
    file(folder, "tip.toml", BALL_TIP.as_bytes());
    let printed = done(folder, &["batch", "map.zip", "--test", "tip.toml", "--out", "holds.csv"]);
    assert!(
        printed.starts_with("No hold in 3 tests. Apparent modulus of the first loading ramp: median 1000 Pa"),
        "{printed}"
    );
    let table = lines(folder, "holds.csv");
    assert_eq!(column(&table, "part"), curves.map(|(name, _)| name));
    for (found, (_, expected)) in column(&table, "loading_modulus_pa").iter().zip(curves) {
        let found: f64 = found.parse().unwrap();
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} for {expected}");
    }
    for name in ["hold", "law", "start_s", "mode", "force_end_n", "signal"] {
        assert_eq!(column(&table, name), ["", "", ""], "{name}");
    }
    for (reason, findings) in column(&table, "termination").iter().zip(column(&table, "findings")) {
        assert!(reason.starts_with("no hold found: "), "{reason}");
        assert!(findings.split(' ').any(|code| code == "no_hold"), "{findings}");
    }
    // Without a body there is the reason alone, and it is no failure.
    let printed = done(folder, &["batch", "map.zip", "--out", "bare.csv"]);
    assert_eq!(printed.trim(), "No hold in 3 tests.");
    assert_eq!(column(&lines(folder, "bare.csv"), "loading_modulus_pa"), ["", "", ""]);
    // Any other command takes one of them, or says how.
    assert!(done(folder, &["inspect", "map.zip"]).contains("3 files in a zip archive"));
    assert!(done(folder, &["convert", "map.zip", "--part", "map/curve2.csv", "--out", "one.csv"]).is_empty());
    let error = refused(folder, &["convert", "map.zip", "--out", "one.csv"]);
    assert!(
        error.contains("expected one test, found 3") && error.contains("--part \"map/curve1.csv\""),
        "{error}"
    );
    // One curve gives its modulus, with the finding.
    let document: serde_json::Value = serde_json::from_str(&done(
        folder,
        &["analyze", "map.zip", "--part", "2", "--test", "tip.toml", "--format", "json"],
    ))
    .unwrap();
    let modulus = document["loading_modulus"]["modulus_pa"].as_f64().unwrap();
    assert!((modulus / 2000.0 - 1.0).abs() < 1e-3, "{modulus}");
    assert!(document["holds"].as_array().unwrap().is_empty());
    let codes: Vec<&str> =
        document["findings"].as_array().unwrap().iter().filter_map(|found| found["code"].as_str()).collect();
    assert!(codes.contains(&"no_hold"), "{codes:?}");
    // Its text once was three tables without a row, and no modulus.
    let text = done(folder, &["analyze", "map.zip", "--part", "2", "--test", "tip.toml"]);
    assert!(text.contains("Apparent modulus of the first loading ramp: 2000 Pa"), "{text}");
    assert!(text.contains("no_hold") && !text.contains("Holds of the record"), "{text}");
    assert!(refused(folder, &["analyze", "map.zip", "--part", "2"]).contains("no hold found"));
}

#[test]
fn a_folder_becomes_one_table_of_holds_and_laws() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 4);
    let printed = done(folder, &["batch", "curves", "--out", "holds.csv"]);
    // The answer over all holds comes first.
    assert!(
        printed.starts_with("Law recommended most often: latency:5, on 4 of 4 holds. Only exponents"),
        "{printed}"
    );
    assert!(printed.contains("relative rate") && printed.contains("Median"), "{printed}");
    let table = lines(folder, "holds.csv");
    assert!(
        table[0].starts_with("record,part,hold,law,recommended,formula,holdout_error,probability,indistinguishable,")
    );
    assert_eq!(column(&table, "recommended")[..3], ["1", "0", "0"]);
    // Five exponents given and one free, in four records of one hold.
    assert_eq!(table.len(), 1 + 4 * 6, "{table:?}");
    let laws = column(&table, "law");
    assert_eq!(laws[..6], ["latency:5", "latency:1", "latency:2", "latency:3", "latency:7", "latency"]);
    let paths = column(&table, "record");
    assert_eq!((paths[0].as_str(), paths[12].as_str()), ("curves/c001.csv", "curves/deep/c000.csv"));
    // The record is (1 + 4 t)^(-1/4) above 1 N: n = 5, and λ = 1/s.
    let number = |name: &str, row: usize| column(&table, name)[row].parse::<f64>().unwrap();
    assert!((number("exponent", 5) - 5.0).abs() < 0.02, "{}", number("exponent", 5));
    assert!((number("equilibrium_force_n", 0) - 1.0).abs() < 1e-3);
    assert!((number("relative_rate_per_s", 0) - 1.0).abs() < 1e-2);
    assert!(number("exponent_low", 5) < number("exponent", 5) && number("exponent", 5) < number("exponent_high", 5));
    let parameters = lines(folder, "holds_parameters.csv");
    let header = "record,part,hold,law,parameter,unit,value,standard_error,low,high,termination,white_standard_error,role,domain,recommended";
    assert_eq!(parameters[0], header);
    let of_law = |law: &str| column(&parameters, "law").iter().filter(|found| *found == law).count();
    // Equilibrium, amplitude, λ, v, n, and in the time domain the force at the start, in four records.
    assert_eq!((of_law("latency"), of_law("latency:5")), (44, 44));
    let text = fs::read_to_string(folder.join("holds.csv")).unwrap();
    assert!(
        text.starts_with("# palpate_batch: {") && text.contains("\"build\":\"") && text.contains("\"commit\":\""),
        "{}",
        &text[..200]
    );
}

#[test]
fn a_hold_without_a_fit_has_its_row_and_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut text = "Time (s),Displacement (mm),Force (N)\n".to_owned();
    for i in 0..400 {
        let (t, later) = (0.1 * f64::from(i), (0.1 * f64::from(i) - 20.0).max(0.0));
        let displacement = t.min(2.0) + later.min(2.0);
        let relaxing = if (2.0..20.0).contains(&t) { 2.0 * (-(t - 2.0) / 3.0).exp() } else { 0.0 };
        text.push_str(&format!("{t:.1},{displacement:.4},{:.5}\n", 5.0 * displacement + relaxing));
    }
    file(folder, "two.csv", text);
    done(folder, &["batch", "two.csv", "--out", "holds.csv"]);
    let table = lines(folder, "holds.csv");
    assert_eq!(column(&table, "hold"), ["1", "1", "1", "1", "1", "1", "2"]);
    let last = |name: &str| column(&table, name)[6].clone();
    assert_eq!((last("law"), last("exponent"), last("start_s")), (String::new(), String::new(), "22.0".to_owned()));
    assert!(last("findings").contains("no_relaxation"), "{}", last("findings"));
}

/// A record of nothing but creep had no row at all.
#[test]
fn a_record_of_creep_has_a_row_for_each_hold() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut text = "Time (s),Displacement (mm),Force (N)\n".to_owned();
    for i in 0..1300 {
        let t = 0.05 * f64::from(i);
        let force = if t < 2.0 { 5.0 * t } else { 10.0 };
        let creep = if t < 2.0 { 0.0 } else { 0.8 * (1.0 - (-(t - 2.0) / 8.0).exp()) };
        text.push_str(&format!("{t:.2},{:.5},{force:.4}\n", 0.2 * force + creep));
    }
    file(folder, "creep.csv", text);
    let answer = done(folder, &["batch", "creep.csv", "--out", "holds.csv"]).replace('\n', " ");
    // Nothing stated why no law was fitted, and which command fits one.
    let why =
        "In 1 hold the machine held the force, and the body creeps: `palpate compare --creep` fits the displacement.";
    assert!(answer.contains(why), "{answer}");
    let table = lines(folder, "holds.csv");
    assert_eq!(
        (table.len(), column(&table, "law"), column(&table, "mode")),
        (2, vec![String::new()], vec!["force".to_owned()])
    );
    let findings = column(&table, "findings");
    assert!(findings[0].contains("feedback_controlled"), "{findings:?}");
    // It stated the way between the means of the first tenth and of the last, 0.6 mm.
    let error = refused(folder, &["analyze", "creep.csv"]);
    assert!(error.contains("the jaw moves by 0.800 mm in the hold"), "{error}");
}

/// A file named by itself and by its folder was in the table twice, and a second batch read the table and the journal of the first.
#[test]
fn every_record_is_analysed_once_and_tables_are_no_records() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 2);
    done(folder, &["batch", "curves", "--out", "curves/a.csv"]);
    done(folder, &["batch", "curves", "--out", "curves/b.parquet"]);
    let named = ["batch", "curves/c001.csv", "curves", "curves/*.csv", "curves/**/*", "--out", "c.csv"];
    let error = String::from_utf8(palpate(folder, &named).stderr).unwrap();
    assert!(error.contains("12 rows of 2 tests in 2 files"), "{error}");
    assert_eq!(lines(folder, "c.csv").len(), 1 + 2 * 6);
}

#[test]
fn parquet_holds_what_csv_holds() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 3);
    done(folder, &["batch", "curves", "--out", "holds.csv", "--laws", "maxwell,standard-linear-solid"]);
    done(
        folder,
        &["batch", "curves/**/*.csv", "--out", "holds.parquet", "--laws", "maxwell,standard-linear-solid"],
    );
    let table = lines(folder, "holds.csv");
    let parquet = TableReader::new(fs::File::open(folder.join("holds.parquet")).unwrap()).unwrap();
    assert_eq!(parquet.rows() as usize, table.len() - 1);
    let names: Vec<&str> = parquet.fields().iter().map(|field| field.name.as_str()).collect();
    assert_eq!(names.join(","), table[0]);
    assert!(parquet.mark("palpate_batch").unwrap().contains("options"));
    let rmse = names.iter().position(|name| *name == "relative_rmse").unwrap();
    let Values::Number(stored) = parquet.values(0, rmse).unwrap() else {
        panic!("no numbers")
    };
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(folder.join("holds.csv")).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    for (row, value) in rows.iter().zip(&stored) {
        assert_eq!(row[rmse].parse().ok(), *value);
    }
    let others = rows.iter().filter(|row| row.iter().any(|cell| cell == "standard-linear-solid")).count();
    assert_eq!(others, 3);
}

/// Only the laws of `--laws` were compared, each table had two zeros of the criterion and two denominators of the residuals, and the
/// residuals of other laws than the latency law were left out.
#[test]
fn the_latency_law_takes_part_in_a_comparison_on_one_scale() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 1);
    done(folder, &["batch", "curves", "--out", "holds.csv", "--laws", "standard-linear-solid,stretched"]);
    let table = lines(folder, "holds.csv");
    let numbers =
        |name: &str| -> Vec<Option<f64>> { column(&table, name).iter().map(|cell| cell.parse().ok()).collect() };
    let (laws, criteria, errors) = (column(&table, "law"), numbers("delta_bic"), numbers("holdout_error"));
    assert_eq!(laws[0], "latency");
    let compared: BTreeSet<&str> =
        laws.iter().zip(&errors).filter(|(_, error)| error.is_some()).map(|(law, _)| law.as_str()).collect();
    assert_eq!(compared, BTreeSet::from(["latency", "standard-linear-solid", "stretched"]));
    assert_eq!(
        criteria.iter().map(Option::is_some).collect::<Vec<_>>(),
        errors.iter().map(Option::is_some).collect::<Vec<_>>()
    );
    assert_eq!(criteria.iter().filter(|value| **value == Some(0.0)).count(), 1);
    let (rmse, shares) = (numbers("rmse"), numbers("relative_rmse"));
    let change = rmse[0].unwrap() / shares[0].unwrap();
    for (rmse, share) in rmse.iter().zip(&shares) {
        assert!((rmse.unwrap() / share.unwrap() / change - 1.0).abs() < 1e-9, "{rmse:?} {share:?}");
    }
}

/// Of exponents that all fit a short hold the largest was recommended, with an equilibrium of −19 N where it is 1 N.
#[test]
fn the_lowest_of_exponents_that_are_not_distinguishable_is_recommended() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("curves")).unwrap();
    let mut state = 1u64;
    let mut noise = || {
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        0.02 * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0)
    };
    for record in 0..6 {
        let mut text = String::from("time_s,displacement_mm,force_n\n");
        for i in 0..620 {
            let t = 0.05 * f64::from(i);
            let (d, f) = if t < 1.0 { (t, 2.0 * t.powf(1.5)) } else { (1.0, 1.0 + (-0.02 * (t - 1.0)).exp()) };
            text.push_str(&format!("{t:.2},{d:.5},{:.6}\n", f + noise()));
        }
        file(folder, &format!("curves/{record}.csv"), text);
    }
    fs::copy(folder.join("curves/0.csv"), folder.join("curves/copy.csv")).unwrap();
    let text = done(folder, &["batch", "curves", "--out", "holds.csv"]);
    let table = lines(folder, "holds.csv");
    let recommended: Vec<String> = (column(&table, "law").into_iter())
        .zip(column(&table, "recommended"))
        .filter(|(_, recommended)| recommended == "1")
        .map(|(law, _)| law)
        .collect();
    assert!(recommended.iter().all(|law| ["latency:1", "latency:2"].contains(&law.as_str())), "{recommended:?}");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("other exponents are not distinguishable from it"), "{text}");
    assert!(text.contains("curves/copy.csv has the same bytes as curves/0.csv"), "{text}");
    let others = column(&table, "indistinguishable");
    let others: Vec<&str> = others[0].split(' ').collect();
    assert!(others.len() > 1 && !others.contains(&recommended[0].as_str()), "{others:?}");
}

/// "On 12 of these other exponents are not distinguishable" stood beside a free exponent that is better by a criterion of 3,000.
#[test]
fn a_free_exponent_that_the_data_distinguish_has_none_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut text = String::from("time_s,displacement_mm,force_n\n");
    for i in 0..620 {
        let t = 0.05 * f64::from(i);
        let relaxed = 1.0 + (1.0 + 6.0 * (t - 1.0).max(0.0)).powf(-1.0 / 3.0);
        let noise = 1e-3 * (f64::from(i) * 12.9898).sin();
        let (d, f) = if t < 1.0 { (t, 2.0 * t) } else { (1.0, relaxed) };
        text.push_str(&format!("{t:.2},{d:.5},{:.6}\n", f + noise));
    }
    file(folder, "one.csv", text);
    let text = done(folder, &["batch", "one.csv", "--out", "holds.csv"]);
    let table = lines(folder, "holds.csv");
    let of_recommended: Vec<(String, String)> = (column(&table, "law").into_iter())
        .zip(column(&table, "indistinguishable"))
        .zip(column(&table, "recommended"))
        .filter(|(_, recommended)| recommended == "1")
        .map(|(of, _)| of)
        .collect();
    assert_eq!(of_recommended, [("latency".to_owned(), String::new())]);
    assert!(!text.contains("not distinguishable"), "{text}");
}

/// A link to a file that is no longer there was passed over without a word.
#[test]
#[cfg(unix)]
fn a_link_that_leads_nowhere_is_a_record_that_failed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 2);
    std::os::unix::fs::symlink("moved.csv", folder.join("curves/lost.csv")).unwrap();
    for records in ["curves", "curves/**/*.csv"] {
        let output = palpate(folder, &["batch", records, "--out", "holds.csv", "--restart"]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains("failed: curves/lost.csv: no such file"), "{error}");
        assert!(error.contains("it is a link to a file that is missing"), "{error}");
        assert!(error.contains("12 rows of 2 tests in 3 files, 1 of 3 tests failed"), "{error}");
        assert_eq!(output.status.code(), Some(1), "{error}");
    }
}

#[test]
fn bad_records_are_listed_and_do_not_stop_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 3);
    file(folder, "curves/empty.csv", "");
    file(folder, "curves/picture.csv", b"\x89PNG\r\n\x1a\n");
    file(folder, "curves/still.csv", "time_s,displacement_mm,force_n\n0,0,0\n1,0,0.5\n2,0,0\n");
    let output = palpate(folder, &["batch", "curves", "--out", "holds.csv"]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert_eq!(error.lines().filter(|line| line.starts_with("failed: curves/")).count(), 3, "{error}");
    assert!(error.contains("failed: curves/empty.csv: the file is empty"), "{error}");
    assert!(error.contains("18 rows of 3 tests in 6 files, 3 of 6 tests failed"), "{error}");
    assert_eq!(lines(folder, "holds.csv").len(), 1 + 3 * 6);
    // Repaired, it is the only one that is read anew; so is a file that changed.
    file(folder, "curves/empty.csv", ramp_and_hold(3.0, 20.0));
    file(folder, "curves/c001.csv", ramp_and_hold(3.0, 30.0));
    let output = palpate(folder, &["batch", "curves", "--out", "holds.csv"]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.contains("24 rows of 4 tests in 6 files (4 done before), 2 of 6 tests failed"), "{error}");
}

#[test]
fn the_table_does_not_depend_on_threads_or_on_being_killed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 60);
    done(folder, &["batch", "curves", "--out", "whole.csv", "--threads", "1"]);
    let whole = fs::read(folder.join("whole.csv")).unwrap();
    let mut kept = 0;
    for round in 0..40 {
        let mut child = Command::new(env!("CARGO_BIN_EXE_palpate"))
            .args(["batch", "curves", "--out", "killed.csv", "--threads", "3"])
            .current_dir(folder)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let until = Instant::now() + Duration::from_millis(20 + 15 * round);
        while Instant::now() < until && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(2));
        }
        if child.try_wait().unwrap().is_some() {
            break;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        // The table is there whole, if it was killed behind the last step, or not at all.
        if let Ok(table) = fs::read(folder.join("killed.csv")) {
            assert!(table == whole, "half a table");
            break;
        }
        let journal = fs::read_to_string(folder.join("killed.csv.journal/pieces")).unwrap_or_default();
        let entries = journal.matches("\n{\"key\":").count();
        assert!(entries + 1 >= kept, "{entries} results after {kept}");
        kept = entries;
    }
    done(folder, &["batch", "curves", "--out", "killed.csv"]);
    assert!(fs::read(folder.join("killed.csv")).unwrap() == whole);
    // Nothing temporary stays.
    let both = fs::read_dir(folder).unwrap().chain(fs::read_dir(folder.join("killed.csv.journal")).unwrap());
    let left: Vec<String> = both
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .filter(|name| name.starts_with(".palpate"))
        .collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn other_options_are_another_batch() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 2);
    let test = file(folder, "t.toml", "[fit]\nexponents = [2]\n");
    done(folder, &["batch", "curves", "--out", "holds.csv"]);
    let output = palpate(folder, &["batch", "curves", "--out", "holds.csv", "--test", &test]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.starts_with("4 rows of 2 tests in 2 files, "), "{error}");
}

#[test]
fn bad_input() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    records(folder, 1);
    let error = refused(folder, &["batch", "curves", "--out", "holds.xlsx"]);
    assert!(error.contains("expected a table ending in .parquet or .csv"), "{error}");
    let error = refused(folder, &["batch", "nothing/*.csv", "--out", "holds.csv"]);
    assert!(error.contains("expected a pattern that matches files, found none"), "{error}");
    fs::create_dir(folder.join("bare")).unwrap();
    let error = refused(folder, &["batch", "bare", "--out", "holds.csv"]);
    assert!(error.contains("expected a folder with records, found none"), "{error}");
    let error = refused(folder, &["batch", "nowhere", "--out", "holds.csv"]);
    assert!(error.contains("nowhere: no such file"), "{error}");
    assert!(!folder.join("holds.csv").exists());
}
