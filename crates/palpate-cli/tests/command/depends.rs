//! What a result depends on is in its digest: each input of each job is changed once.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::fs::{self, File};
use std::path::Path;

use crate::common::{done, file, palpate, ramp_and_hold, root};
use palpate_files::parquet_table::TableReader;
use serde_json::Value;
use tempfile::tempdir;

const TEST: &str = "specimen = { shape = \"ball\", radius = \"35 mm\", modulus = \"28 kPa\" }\n";

const PROTOCOL: &str = "material = \"m.toml\"\n\
    step = [{ to = \"5 mm\", rate = \"500 mm/min\", hold = \"10 s\" }]\n\
    [output]\nsample_rate = \"20 Hz\"\n";

/// Every digest in a document.
fn digests(document: &Value) -> Vec<String> {
    match document {
        Value::Object(entries) => entries
            .iter()
            .flat_map(|(key, value)| match (key.as_str(), value) {
                ("depends_on_sha256", Value::String(digest)) => vec![digest.clone()],
                _ => digests(value),
            })
            .collect(),
        Value::Array(items) => items.iter().flat_map(digests).collect(),
        _ => Vec::new(),
    }
}

/// The one digest of the document that a command prints.
fn digest(folder: &Path, arguments: &[&str]) -> String {
    let output = palpate(folder, &[arguments, &["--format", "json"]].concat());
    let document: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{arguments:?}: {error}: {}", String::from_utf8_lossy(&output.stderr)));
    let found = digests(&document);
    assert_eq!(found.len(), 1, "{arguments:?}: {found:?}");
    found[0].clone()
}

/// A change to a file of the folder, or another argument.
enum Change<'a> {
    File(&'a str, &'a dyn Fn(&str) -> String),
    Argument(&'a [&'a str]),
}

/// Makes each change once, alone, and expects another digest of each; without a change it is the same.
fn each_changes(folder: &Path, arguments: &[&str], changes: &[Change<'_>]) {
    let before = digest(folder, arguments);
    assert_eq!(digest(folder, arguments), before, "{arguments:?}");
    let mut all = vec![before];
    for change in changes {
        let (what, found) = match change {
            Change::Argument(more) => (more.join(" "), digest(folder, &[arguments, more].concat())),
            Change::File(name, change) => {
                let text = fs::read_to_string(folder.join(name)).unwrap();
                file(folder, name, change(&text));
                let found = digest(folder, arguments);
                file(folder, name, text);
                ((*name).to_owned(), found)
            }
        };
        assert!(!all.contains(&found), "{arguments:?}: {what} changes nothing");
        all.push(found);
    }
    assert_eq!(digest(folder, arguments), all[0], "{arguments:?}");
}

/// The body of the example, with a modulus a little above, still within its interval, wherever it stands.
fn stiffer(text: &str) -> String {
    let modulus = text.split_once("modulus = \"").and_then(|(_, rest)| rest.split_once(' ')).unwrap().0;
    text.replace(modulus, &(1.0003 * modulus.parse::<f64>().unwrap()).to_string())
}

#[test]
fn each_input_of_a_document_is_in_its_digest() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    file(folder, "r.csv", ramp_and_hold(5.0, 20.0));
    file(folder, "t.toml", TEST);
    let air: String = ramp_and_hold(5.0, 20.0)
        .lines()
        .map(|line| line.rsplit_once(',').unwrap().0.to_owned() + ",0.001\n")
        .collect();
    file(folder, "air.csv", air.replace("mm,0.001", "mm,force_n"));
    let example = root().join("examples/records/ball-material.toml");
    file(folder, "m.toml", fs::read_to_string(example).unwrap());
    let last_digit = |text: &str| text.trim_end().to_owned() + "1\n";
    let titled = |text: &str| text.to_owned() + "[about]\ntitle = \"another\"\n";
    let in_air = |text: &str| text.replacen("0.001", "0.002", 1);
    let (record, test) = (Change::File("r.csv", &last_digit), Change::File("t.toml", &titled));
    each_changes(
        folder,
        &["analyze", "r.csv", "--test", "t.toml", "--air-run", "air.csv", "--no-compare"],
        &[
            record,
            test,
            Change::File("air.csv", &in_air),
            Change::Argument(&["--fit-until", "3 s"]),
            Change::Argument(&["--exponents", "3,5"]),
            Change::Argument(&["--intervals", "profile"]),
            Change::Argument(&["--hold-start", "settled"]),
            Change::Argument(&["--touch", "0.01 mm"]),
            Change::Argument(&["--tolerance", "0.1 mm"]),
            Change::Argument(&["--minimum-hold", "2 s"]),
            Change::Argument(&["--columns", "force=force_n:N"]),
        ],
    );
    each_changes(
        folder,
        &["compare", "r.csv", "--test", "t.toml", "--laws", "latency:5,stretched"],
        &[
            Change::File("r.csv", &last_digit),
            Change::File("t.toml", &titled),
            Change::Argument(&["--fit-until", "3 s"]),
            Change::Argument(&["--cuts", "0.5"]),
            Change::Argument(&["--intervals", "profile"]),
        ],
    );
    each_changes(
        folder,
        &["calibrate", "r.csv", "--test", "t.toml", "--no-alternatives"],
        &[
            Change::File("r.csv", &last_digit),
            Change::File("t.toml", &titled),
            Change::Argument(&["--fit-until", "3 s"]),
            Change::Argument(&["--law", "standard-linear-solid"]),
            Change::Argument(&["--confidence", "0.9"]),
        ],
    );
    each_changes(
        folder,
        &["grip", "m.toml", "--mass", "150g", "--friction", "0.6"],
        &[
            Change::File("m.toml", &stiffer),
            Change::Argument(&["--hold", "2 s"]),
            Change::Argument(&["--safety", "1.1"]),
            Change::Argument(&["--confidence", "0.9"]),
            Change::Argument(&["--speed", "1 mm/s"]),
        ],
    );
}

/// A sweep over a body in a material file kept its old table after a calibration, and after a kill mixed two bodies.
#[test]
fn a_sweep_over_a_material_that_changed_is_computed_again() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let example = fs::read_to_string(root().join("examples/records/ball-material.toml")).unwrap();
    file(folder, "m.toml", &example);
    file(folder, "s.toml", format!("{PROTOCOL}[sweep]\nstep.1.hold = \"1 s, 2 s\"\n"));
    let arguments = ["sweep", "s.toml", "--out", "t.parquet"];
    let run = || {
        let output = palpate(folder, &arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let table = TableReader::new(File::open(folder.join("t.parquet")).unwrap()).unwrap();
        let before = String::from_utf8_lossy(&output.stderr).contains("computed before");
        (
            before,
            table.mark("palpate_sweep_sha256").unwrap().to_owned(),
            fs::read(folder.join("t.parquet")).unwrap(),
        )
    };
    let first = run();
    assert_eq!(run(), (true, first.1.clone(), first.2.clone()));
    file(folder, "m.toml", stiffer(&example));
    let other = run();
    assert!(!other.0 && other.1 != first.1 && other.2 != first.2);
    file(folder, "m.toml", &example);
    assert_eq!(run(), first);
    // The protocol itself.
    let protocol = fs::read_to_string(folder.join("s.toml")).unwrap();
    file(folder, "s.toml", protocol.replace("2 s\"\n", "3 s\"\n"));
    assert!(!run().0);
}

#[test]
fn a_batch_keeps_no_result_of_another_record_description_or_option() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("in")).unwrap();
    let record = ramp_and_hold(5.0, 20.0);
    file(&folder.join("in"), "r.csv", &record);
    file(folder, "t.toml", TEST);
    let usual = ["batch", "in", "--test", "t.toml", "--out", "t.csv"];
    let is_kept = |more: &[&str]| {
        let output = palpate(folder, &[&usual, more].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stderr).contains("(1 done before)")
    };
    assert!(!is_kept(&[]) && is_kept(&[]));
    file(&folder.join("in"), "r.csv", record.trim_end().to_owned() + "1\n");
    assert!(!is_kept(&[]) && is_kept(&[]));
    file(folder, "t.toml", format!("{TEST}[about]\ntitle = \"another\"\n"));
    assert!(!is_kept(&[]) && is_kept(&[]));
    for more in [
        &["--fit-until", "3 s"][..],
        &["--laws", "stretched"],
        &["--intervals", "profile"],
        &["--hold-start", "settled"],
        &["--columns", "force=force_n:N"],
    ] {
        assert!(!is_kept(more) && is_kept(more), "{more:?}");
    }
    // The number of threads is no part of a result.
    assert!(!is_kept(&[]) && is_kept(&["--threads", "2"]));
    assert!(done(folder, &["--version"]).contains("\nbuild: "));
}
