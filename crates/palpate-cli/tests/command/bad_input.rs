//! Bad input: exit code 2, a message that says where, what was expected and what was found, and nothing half written.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use crate::common::{done, file, palpate, ramp_and_hold, refused};
use tempfile::tempdir;

/// Expects `analyze` to refuse a record with all of `words` in the message.
fn refuses(content: impl AsRef<[u8]>, words: &[&str]) {
    let folder = tempdir().unwrap();
    let name = file(folder.path(), "record.csv", content);
    let error = refused(folder.path(), &["analyze", &name, "--out", "study"]);
    for word in words.iter().chain(&["error:", "record.csv"]) {
        assert!(error.contains(word), "`{word}` is not in:\n{error}");
    }
    assert!(!folder.path().join("study").exists(), "something was written");
}

#[test]
fn files_that_are_no_records() {
    let folder = tempdir().unwrap();
    let error = refused(folder.path(), &["analyze", "absent.csv"]);
    assert!(error.contains("absent.csv") && error.contains("hint:"), "{error}");
    refuses("", &["empty"]);
    refuses(b"PK\x03\x04\x14\x00\x00\x00\x08\x00rest of a workbook".as_slice(), &[]);
    refuses(b"\x00\x01\x02\xff\xfe\x00\x00\x10\x80".repeat(50), &[]);
    refuses("force_n\n1\n2\n3\n", &["column"]);
}

/// A header in another language, or without units, was exit code 2 and a file to write.
#[test]
fn a_header_that_is_not_understood_is_one_option_away() {
    let folder = tempdir().unwrap();
    let rows = ramp_and_hold(5.0, 20.0).replacen("time_s,displacement_mm,force_n", "Zt,Eindrückung,Krft", 1);
    let record = file(folder.path(), "record.csv", &rows);
    let option = "force=Krft:N,displacement=Eindrückung:mm,time=Zt:s";
    let (analyze, batch) = (["analyze", &record], ["batch", &record, "--out", "b.csv"]);
    let error = refused(folder.path(), &analyze);
    assert!(error.contains(&format!("--columns \"{option}\"")), "{error}");
    let convert = ["convert", &record, "--out", "c.csv"];
    let others = ["inspect", "compare", "watch"].map(|command| [command, &record]);
    let requested = others.iter().map(|requested| &requested[..]).chain([&analyze[..], &batch, &convert]);
    for requested in requested {
        done(folder.path(), &[requested, &["--columns", option]].concat());
    }
    // What was typed stands in what is kept.
    let kept = std::fs::read_to_string(folder.path().join("c.csv")).unwrap();
    assert!(kept.lines().next().unwrap().contains("--columns") && kept.contains("time_s,displacement_m,force_n"));
    let error = refused(folder.path(), &[&analyze[..], &["--columns", "Krft"]].concat());
    assert!(error.contains("force=Kraft:N,displacement=Weg:mm,time=Zeit:s"), "{error}");
    let bare = file(folder.path(), "bare.csv", rows.replacen("Zt,Eindrückung,Krft", "Zeit,Weg,Kraft", 1));
    let error = refused(folder.path(), &["analyze", &bare]);
    assert!(error.contains("--columns \"time=Zeit:s,displacement=Weg:mm,force=Kraft:N\""), "{error}");
}

#[test]
fn cells_that_are_no_numbers() {
    let good = ramp_and_hold(5.0, 20.0);
    let text = good.replacen("\n2.0000,1.00000,1.668740", "\n2.0000,1.00000,slack", 1);
    refuses(text, &["line 42", "force", "slack", "number", "hint:"]);
    let infinite = good.replacen("\n2.0000,1.00000,1.668740", "\n2.0000,1.00000,inf", 1);
    refuses(infinite, &["line 42", "inf"]);
}

/// One `n/a` among thousands of rows refused the file.
#[test]
fn a_cell_without_a_number_costs_its_row_alone() {
    let folder = tempdir().unwrap();
    let good = ramp_and_hold(5.0, 20.0);
    for (number, word) in ["n/a", "", "NaN", "-"].into_iter().enumerate() {
        let one = good.replacen("\n2.0000,1.00000,1.668740", &format!("\n2.0000,1.00000,{word}"), 1);
        let both = one.replacen("\n3.0000,", &format!("\n{word},"), 1);
        assert_ne!(one, both);
        let record = file(folder.path(), &format!("{number}.csv"), &both);
        let reported = done(folder.path(), &["inspect", &record]);
        assert!(
            reported.contains("2 of 121 rows left out, in which a cell holds no number (lines 42, 62)"),
            "{reported}"
        );
        let reported = done(folder.path(), &["analyze", &record, "--no-compare"]);
        assert!(reported.contains("2 of 121 rows left out"), "{reported}");
    }
    // More than a few in a hundred are no slip.
    let bad = good.lines().enumerate().map(|(line, row)| match line % 20 {
        5 => format!("{},n/a\n", row.rsplit_once(',').unwrap().0),
        _ => format!("{row}\n"),
    });
    refuses(bad.collect::<String>(), &["line 6, column 3 (force)", "none in 6 of 121 (first lines: 6, 26, 46)"]);
}

#[test]
fn time_that_does_not_rise() {
    let good = ramp_and_hold(5.0, 20.0);
    refuses(good.replacen("\n2.0000,", "\n0.5000,", 1), &["line 42", "rise", "0.5 s after 1.95 s"]);
    // Two rows of one stamp are one, and that is stated.
    let folder = tempdir().unwrap();
    let name = file(folder.path(), "record.csv", good.replacen("\n2.0000,", "\n1.9500,", 1));
    let text = done(folder.path(), &["analyze", &name]);
    assert!(text.contains("stamps_merged") && text.contains("1 of 121 rows"), "{text}");
    let text = done(folder.path(), &["inspect", &name]);
    assert!(text.contains("a time stamp repeats the one before"), "{text}");
    assert!(text.contains("done: time stamps: 1 of 121 rows merged"), "{text}");
}

#[test]
fn records_with_nothing_to_fit() {
    refuses("time_s,displacement_mm,force_n\n0,0,0\n", &["rows", "found 1"]);
    let constant = |i: usize| format!("{},{},2.5\n", 0.1 * i as f64, if i < 10 { i } else { 10 });
    let rows: String = (0..60).map(constant).collect();
    refuses(format!("time_s,displacement_mm,force_n\n{rows}"), &["the force is 2.500 N throughout"]);
    let triangle = |i: usize| format!("{},{},{}\n", 0.1 * i as f64, 10.0 - (i as f64 / 10.0 - 10.0).abs(), i % 7);
    let rows: String = (0..200).map(triangle).collect();
    refuses(format!("time_s,displacement_mm,force_n\n{rows}"), &["no hold", "hint:"]);
    // Three samples of standstill.
    let short = ramp_and_hold(0.1, 20.0);
    refuses(&short, &["no hold", "hint:"]);
    let folder = tempdir().unwrap();
    let name = file(folder.path(), "record.csv", &short);
    let error = refused(folder.path(), &["analyze", &name, "--minimum-hold", "0.01 s"]);
    assert!(error.contains("3 samples"), "{error}");
}

/// "entity already exists" states nothing of what stands in the way.
#[test]
fn what_stands_where_a_report_should_go_is_reported() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "record.csv", ramp_and_hold(5.0, 20.0));
    std::fs::create_dir(folder.path().join("other")).unwrap();
    file(&folder.path().join("other"), "tables", "notes");
    let error = refused(folder.path(), &["analyze", &record, "--no-compare", "--out", "other"]);
    assert!(error.contains("other/tables: cannot write: expected a folder, found a file of 5 bytes"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path().join("other")).unwrap().count(), 1, "something was written");
    let error = refused(folder.path(), &["batch", &record, "--out", "other"]);
    assert!(
        error.contains("a directory that holds tables") && error.contains("--out other/table.parquet"),
        "{error}"
    );
    let error = refused(folder.path(), &["convert", &record, "--out", "other"]);
    assert!(error.contains("a directory that holds tables") && error.contains("other/FILE.csv"), "{error}");
}

/// "invalid float literal" for `3;5`, and a list of laws in which the one meant had to be found.
#[test]
fn lists_and_names_that_are_mistyped_are_shown_as_they_should_be() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "record.csv", ramp_and_hold(5.0, 20.0));
    for (requested, expected) in [
        (&["analyze", "--exponents", "3;5"][..], "numbers above 0 with commas between them, such as 3,5"),
        (&["analyze", "--exponents", "x"], "such as 1,3,5"),
        (&["compare", "--cuts", "0.1 0.2"], "such as 0.1,0.2"),
        (&["compare", "--laws", "latency;prony:2"], "such as latency,prony:2"),
        (
            &["compare", "--laws", "latncy"],
            "no law is called \"latncy\"; did you mean latency? Other laws are latency:N, ",
        ),
        (&["compare", "--laws", "Pronny:3"], "did you mean prony:K?"),
        (&["analyze", "--part", "2"], "expected the one test that the file holds, found \"2\""),
    ] {
        let error = refused(folder.path(), &[requested, &[&record]].concat());
        assert!(error.contains(expected), "{requested:?}: {error}");
    }
}

#[test]
fn descriptions_that_make_no_sense() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "record.csv", ramp_and_hold(5.0, 20.0));
    let refuses = |specimen: &str, words: &[&str]| {
        let text = format!("[specimen]\nshape = \"ball\"\n{specimen}\n");
        let test = file(folder.path(), "test.toml", text);
        let error = refused(folder.path(), &["analyze", &record, "--test", &test, "--out", "study"]);
        for word in words.iter().chain(&["test.toml"]) {
            assert!(error.contains(word), "`{word}` is not in:\n{error}");
        }
    };
    refuses("radius = \"35 furlong\"", &["radius", "furlong", "mm"]);
    refuses("radius = \"35\"", &["radius", "unit"]);
    refuses("radius = \"0 mm\"", &["radius", "0 mm"]);
    refuses("radius = \"35 mm\"\nmodulus = \"-28 kPa\"", &["modulus", "-28 kPa"]);
    refuses("radius = \"35 mm\"\ncolour = \"red\"", &["colour", "modulus"]);
    assert!(!folder.path().join("study").exists());
}

#[test]
fn protocols_that_make_no_sense() {
    let folder = tempdir().unwrap();
    let good = std::fs::read_to_string(crate::common::root().join("examples/protocols/paper-a.toml")).unwrap();
    let refuses = |from: &str, to: &str, words: &[&str]| {
        assert!(good.contains(from), "{from}");
        let name = file(folder.path(), "protocol.toml", good.replacen(from, to, 1));
        let error = refused(folder.path(), &["simulate", &name, "--out", "series.csv"]);
        for word in words {
            assert!(error.contains(word), "`{word}` is not in:\n{error}");
        }
    };
    refuses("to = \"5 mm\"", "to = \"80 mm\"", &["80 mm"]);
    refuses("rate = \"500 mm/min\"", "rate = \"0 mm/min\"", &["rate"]);
    refuses("exponent = 5", "exponent = -5", &["exponent", "-5"]);
    refuses("layers = 8", "layers = 0.5", &["layers", "0.5"]);
    refuses("[law]", "[law", &["line"]);
    assert!(!folder.path().join("series.csv").exists());
}

#[test]
fn output_that_cannot_be_written_leaves_nothing_behind() {
    let folder = tempdir().unwrap();
    let record = file(folder.path(), "record.csv", ramp_and_hold(5.0, 20.0));
    file(folder.path(), "taken", "a file, not a folder");
    let error = refused(folder.path(), &["analyze", &record, "--out", "taken"]);
    assert!(error.contains("taken") && error.contains("cannot write"), "{error}");
    let error = refused(folder.path(), &["analyze", &record, "--out", "taken/below"]);
    assert!(error.contains("cannot write"), "{error}");
    assert!(error.contains("found a file of 20 bytes") && error.contains("choose another name"), "{error}");
    let mut names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["record.csv", "taken"]);
}

#[test]
fn flags_that_do_not_exist_are_refused_by_name() {
    let folder = tempdir().unwrap();
    let output = palpate(folder.path(), &["analyze", "record.csv", "--radius", "3"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--radius"));
    let error = refused(folder.path(), &["analyze", "record.csv", "--fit-until", "600"]);
    assert!(error.contains("unit"), "{error}");
}

/// `convert press.csv --out press.csv` put the table in the place of the record, `batch` an empty one.
#[test]
fn a_record_is_not_written_over() {
    let folder = tempdir().unwrap();
    let name = file(folder.path(), "press.csv", ramp_and_hold(10.0, 20.0));
    let before = std::fs::read(folder.path().join(&name)).unwrap();
    for arguments in [
        ["convert", &name, "--out", &name].as_slice(),
        &["convert", &name, "--out", "./press.csv"],
        &["batch", &name, "--out", &name],
        &["batch", ".", "--out", &name],
        &["inspect", &name, "--figure", &name],
    ] {
        let text = refused(folder.path(), arguments);
        assert!(text.contains("expected an output file that is not an input"), "{arguments:?}: {text}");
        assert_eq!(std::fs::read(folder.path().join(&name)).unwrap(), before, "{arguments:?}");
    }
}
