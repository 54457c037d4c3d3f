//! Files that hold several tests: listed, all analysed, one chosen by its name or number.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::common::{data, done, palpate, ramp_and_hold, refused};
use palpate_files::parquet_table::{Field, Kind, Rows, TableWriter, Values};

/// A table of two tests and of a third that never moves, distinguished by `test_id`.
fn table(folder: &Path) -> &'static str {
    let (mut tests, mut columns) = (Vec::new(), [Vec::new(), Vec::new(), Vec::new()]);
    for (name, hold) in [("left / 1", 5.0), ("right", 8.0)] {
        for line in ramp_and_hold(hold, 20.0).lines().skip(1) {
            tests.push(Some(name.to_owned()));
            for (column, cell) in columns.iter_mut().zip(line.split(',')) {
                column.push(cell.parse::<f64>().ok());
            }
        }
    }
    let names = ["time_s", "displacement_mm", "force_n"];
    let mut fields = vec![Field::new("test_id", Kind::Text)];
    fields.extend(names.map(|name| Field::new(name, Kind::Number)));
    let mut values = vec![Values::Text(tests)];
    values.extend(columns.map(Values::Number));
    let mut writer = TableWriter::new(fs::File::create(folder.join("two.parquet")).unwrap(), &fields).unwrap();
    writer.write(Rows { columns: values }).unwrap();
    writer.finish(&[]).unwrap();
    "two.parquet"
}

#[test]
fn inspect_lists_them_and_shows_one() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let file = table(folder);
    let reported = done(folder, &["inspect", file]);
    assert!(
        reported.contains("left / 1") && reported.contains("right") && reported.contains("Holds"),
        "{reported}"
    );
    assert!(!reported.contains("Used as"), "{reported}");
    for part in ["right", "2"] {
        let reported = done(folder, &["inspect", file, "--part", part]);
        assert!(reported.contains("phases        /") && reported.contains("over 9.0000 s"), "{reported}");
    }
    let error = refused(folder, &["inspect", file, "--part", "middle"]);
    assert!(
        error.contains("expected one of 2 parts, 1 (\"left / 1\"), 2 (\"right\"), found \"middle\""),
        "{error}"
    );
}

#[test]
fn analyze_takes_all_of_them_or_one() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let file = table(folder);
    done(folder, &["analyze", file, "--no-compare", "--out", "study"]);
    for part in ["left - 1", "right"] {
        let text = fs::read(folder.join("study").join(part).join("analysis.json")).unwrap();
        let document: serde_json::Value = serde_json::from_slice(&text).unwrap();
        assert_eq!(document["holds"].as_array().map(Vec::len), Some(1));
        assert_eq!(document["input"]["part"].as_str().map(|name| name.replace('/', "-")), Some(part.to_owned()));
    }
    let reported = done(folder, &["analyze", file, "--no-compare", "--part", "right", "--format", "json"]);
    let document: serde_json::Value = serde_json::from_str(&reported).unwrap();
    assert_eq!((document["input"]["part"].as_str(), document["input"]["rows"].as_u64()), (Some("right"), Some(181)));
}

#[test]
fn a_batch_has_rows_of_each() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let file = table(folder);
    let output = palpate(folder, &["batch", file, "--out", "holds.csv"]);
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.starts_with("12 rows of 2 tests in 1 file"), "{error}");
    let table = fs::read_to_string(folder.join("holds.csv")).unwrap();
    assert_eq!(table.lines().filter(|line| line.contains(",left / 1,")).count(), 6, "{table}");
    // The table of parameters named the test and its file in one column, by which no row of the other was found.
    let parameters = fs::read_to_string(folder.join("holds_parameters.csv")).unwrap();
    let keys = |table: &str| -> BTreeSet<String> {
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(table.as_bytes());
        let header = reader.headers().unwrap().clone();
        let places =
            ["record", "part", "hold", "law"].map(|name| header.iter().position(|column| column == name).unwrap());
        reader
            .records()
            .map(Result::unwrap)
            .map(|row| places.map(|place| row[place].to_owned()).join("|"))
            .collect()
    };
    assert_eq!((keys(&table), keys(&table).len()), (keys(&parameters), 12));
}

/// The same rows were four tests in Parquet and one test with spread stamps in text.
#[test]
fn rows_mixed_by_time_are_cut_in_text_as_in_parquet() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let file = table(folder);
    let mut rows: Vec<String> = Vec::new();
    for (name, hold) in [("left / 1", 5.0), ("right", 8.0)] {
        rows.extend(ramp_and_hold(hold, 20.0).lines().skip(1).map(|line| format!("{line},{name}")));
    }
    rows.sort_by_key(|row| row.split(',').next().map(|time| (1e4 * time.parse::<f64>().unwrap()) as u64));
    let text = format!("time_s,displacement_mm,force_n,test_id\n{}\n", rows.join("\n"));
    fs::write(folder.join("mixed.csv"), text).unwrap();
    let fitted = |file: &str| -> Vec<String> {
        done(folder, &["batch", file, "--out", "holds.csv"]);
        let table = fs::read_to_string(folder.join("holds.csv")).unwrap();
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(table.as_bytes());
        let header = reader.headers().unwrap().clone();
        let places = ["part", "law", "equilibrium", "amplitude"]
            .map(|name| header.iter().position(|column| column == name).unwrap());
        reader
            .records()
            .map(Result::unwrap)
            .map(|row| places.map(|place| row[place].to_owned()).join("|"))
            .collect()
    };
    assert_eq!(fitted("mixed.csv"), fitted(file));
}

/// A first description of a file of several tests was refused.
#[test]
fn one_first_description_serves_all_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let file = table(folder);
    done(folder, &["inspect", file, "--write-test", "all.toml"]);
    let written = fs::read_to_string(folder.join("all.toml")).unwrap();
    assert!(written.contains("for all its 2 tests") && !written.contains("part ="), "{written}");
    let before = done(folder, &["inspect", file]);
    assert_eq!(done(folder, &["inspect", file, "--test", "all.toml"]), before);
    let output = palpate(folder, &["batch", file, "--test", "all.toml", "--out", "holds.csv"]);
    assert!(String::from_utf8(output.stderr).unwrap().starts_with("12 rows of 2 tests in 1 file"));
}

#[test]
fn where_one_record_is_needed_one_is_requested_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let file = table(folder);
    let error = refused(folder, &["convert", file, "--out", "plain.csv"]);
    assert!(error.contains("expected one test, found 2: \"left / 1\", \"right\""), "{error}");
    assert!(error.contains("--part \"left / 1\""), "{error}");
    done(folder, &["convert", file, "--part", "right", "--out", "plain.csv"]);
    assert_eq!(fs::read_to_string(folder.join("plain.csv")).unwrap().lines().count(), 2 + 181);
}

#[test]
fn a_workbook_of_tests_names_what_it_skips() {
    let Some(book) = data("zwick-indentation/230403_C_Indentation_relaxation_500N_force.xlsx") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let reported = done(folder.path(), &["inspect", book.to_str().unwrap()]);
    assert!(reported.lines().filter(|line| line.starts_with("skipped ")).count() >= 3, "{reported}");
    assert!(reported.contains("Holds"), "{reported}");
}
