//! Files that are no description, and keys that mean nothing.

use std::fs;

use palpate_files::description::{DescriptionError, read_protocol, read_test};

use super::{protocol, says, test, with};

#[test]
fn unknown_keys_name_the_accepted_ones() {
    let text = with("radius =", "raduis =");
    says(
        protocol(&text),
        "specimen.raduis",
        "line 4: specimen.raduis: unknown key (accepted: shape, radius,",
        "did you mean radius?",
    );
    says(
        protocol(&with("hold =", "wait =")),
        "step[1].wait",
        "unknown key (accepted: to, to_force, rate, force_rate, hold, hold_force)",
        "",
    );
    says(
        protocol("titel = \"x\""),
        "titel",
        "accepted: title, specimen, law, contact, step, output",
        "did you mean title?",
    );
    says(
        test("[colums.time]\ncolumn = 1"),
        "colums",
        "accepted: about, file, columns, clock, force, machine,",
        "did you mean columns?",
    );
    says(
        test("[columns.temperature]\ncolumn = 1"),
        "columns.temperature",
        "accepted: time, displacement, force, stress",
        "",
    );
    says(
        test("columns.force.clock = { column = 1, units = \"s\" }"),
        "columns.force.clock.units",
        "accepted: column, unit",
        "did you mean unit?",
    );
    says(
        test("[file]\ndelimeter = \"comma\""),
        "file.delimeter",
        "accepted: part, delimiter, decimal, encoding, skip_lines, header",
        "did you mean delimiter?",
    );
}

#[test]
fn bad_toml_gives_its_line() {
    says(protocol(&with("\"35 mm\"", "35 mm")), "", "squeeze.toml, line 4, column", "radius = \"35 mm\"");
    says(protocol(&with("\"35 mm\"", "35 mm")), "", "expected TOML, found `radius = 35 mm`", "in quotes");
    says(protocol("[specimen\n"), "", "line 1", "[table]");
    says(test("a = 1\na = 2\n"), "", "line 2", "remove one of the two");
    let text = test("[columns]\nforce = 3\n");
    says(text, "columns.force", "line 2: columns.force: expected a table, found 3", "");
}

#[test]
fn files_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let error = read_protocol(&path("none.toml")).unwrap_err();
    assert!(error.to_string().ends_with("none.toml: no such file"), "{error}");
    assert!(error.hint().unwrap().contains("spelling"));
    let error = read_test(folder.path()).unwrap_err();
    assert!(error.to_string().contains("expected a file, found a directory"), "{error}");
    assert!(error.hint().unwrap().contains("TOML file inside"));
    fs::write(path("latin.toml"), b"[about]\ntitle = \"Gr\xF6\xDFe\"\n").unwrap();
    let error = read_test(&path("latin.toml")).unwrap_err();
    assert!(error.to_string().contains("latin.toml, line 2: expected text in UTF-8"), "{error}");
    assert!(error.hint().unwrap().contains("UTF-8"));
    fs::write(path("long.csv"), vec![b'#'; 2 << 20]).unwrap();
    let error = read_test(&path("long.csv")).unwrap_err();
    assert!(matches!(error, DescriptionError::TooLong { .. }), "{error}");
    assert!(
        error.to_string().contains("at most 1048576 bytes, found more") && error.hint().unwrap().contains("record")
    );
    fs::write(path("marked.toml"), b"\xEF\xBB\xBF[about]\r\ntitle = \"x\"\r\n").unwrap();
    let marked = read_test(&path("marked.toml")).unwrap();
    assert_eq!(marked.about.title.as_deref(), Some("x"));
}
