//! The text format of afmformats.

use palpate_files::{open::Format, record::read_record};

use super::{column, damage, labels, metadata, names, near, open, opened, read_all, refusal};

const METADATA: &str = "# BEGIN METADATA\r\n# {\r\n#   \"imaging mode\": \"stress-relaxation\",\r\n\
    #   \"spring constant\": 0.5,\r\n#   \"path\": \"a.jpk-force\"\r\n# }\r\n# END METADATA\r\n#\r\n";

const NAMES: &str = "# force\theight (measured)\theight (piezo)\tindex\tsegment\ttime\r\n";

const ROWS: &str = "0\t4e-06\t9e-06\t0\t0\t0\r\n1e-06\t0\t5e-06\t1\t0\t1\r\n\
    7.5e-07\t0\t5e-06\t2\t1\t2\r\n5e-07\t0\t5e-06\t3\t1\t3\r\n0\t4e-06\t9e-06\t4\t2\t4\r\n";

fn file(metadata: &str, names: &str, rows: &str) -> Vec<u8> {
    format!("# afmformats 0.18.7\r\n#\r\n{metadata}{names}{rows}").into_bytes()
}

fn press() -> Vec<u8> {
    file(METADATA, NAMES, ROWS)
}

#[test]
fn the_segments_are_labels() {
    let contents = opened(&press());
    assert_eq!(contents.format, Format::AfmTab);
    let part = &contents.parts[0];
    assert_eq!(labels(part), [("approach", 0, 2), ("intermediate", 2, 4), ("retract", 4, 5)]);
    assert_eq!(
        names(part),
        [
            "time",
            "force",
            "indentation",
            "cantilever deflection",
            "height (measured)",
            "height (piezo)",
            "index",
            "segment"
        ]
    );
    assert_eq!(metadata(part, "spring constant"), Some("0.5"));
    assert_eq!(metadata(part, "path"), Some("a.jpk-force"));
    assert_eq!(column(&contents, "time"), [0.0, 1.0, 2.0, 3.0, 4.0]);
    assert!(near(column(&contents, "indentation")[1], -2e-6));
    let read = contents.read(0, &[2, 2], &mut |_, _| Ok(())).unwrap();
    assert_eq!((read.line_of(0), read.line_of(4)), (Some(12), Some(16)));
    assert_eq!(read.values[0], read.values[1]);
}

#[test]
fn a_row_behind_the_names_is_the_first_row() {
    let glued = file(METADATA, NAMES.trim_end(), ROWS);
    let (contents, whole) = (opened(&glued), opened(&press()));
    assert_eq!(contents.parts[0].columns, whole.parts[0].columns);
    assert_eq!(labels(&contents.parts[0]), labels(&whole.parts[0]));
    for name in ["time", "force", "indentation", "index"] {
        assert_eq!(column(&contents, name), column(&whole, name), "{name}");
    }
    let read = contents.read(0, &[1], &mut |_, _| Ok(())).unwrap();
    // It stands in the line of the names.
    assert_eq!((read.line_of(0), read.line_of(1)), (Some(11), Some(12)));
    // Of one number too few, the line holds names alone, which the rows do not match.
    let other = file(METADATA, &NAMES.replace("time\r\n", "time\t1\r\n"), ROWS);
    assert!(refusal(&other).contains("expected 7 cells, found 6"), "{}", refusal(&other));
}

#[test]
fn a_record_needs_no_description() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.tab");
    std::fs::write(&path, press()).unwrap();
    let file = read_record(&path, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    let used: Vec<&str> = file.columns.iter().filter_map(|column| column.name.as_deref()).collect();
    assert_eq!(used, ["time", "indentation", "force"]);
}

#[test]
fn variants() {
    // Commas between the cells, truths for segments, no metadata.
    let rows = "0,4e-6,False\n1e-6,1e-6,True\n";
    let contents = opened(&file("", "# force,tip position,segment\n", rows));
    assert_eq!(labels(&contents.parts[0]), [("segment 0", 0, 1), ("segment 1", 1, 2)]);
    assert_eq!(column(&contents, "indentation"), [-4e-6, -1e-6]);
    assert_eq!(metadata(&contents.parts[0], "indentation"), Some("−tip position"));
    let plain = b"# a,b\n0,1\n1,2\n2,3\n";
    assert_eq!(opened(plain).format, Format::Text);
}

#[test]
fn what_is_wrong_is_stated_with_its_place() {
    let text = refusal(&file(METADATA, NAMES, "1\t2\t3\t4\t5\n"));
    assert!(text.contains("line 12: expected 6 cells, found 5"), "{text}");
    let text = refusal(&file(METADATA, NAMES, "1\t2\t3\t4\t5\t6\t7\n"));
    assert!(text.contains("expected 6 cells, found 7"), "{text}");
    let text = refusal(&file(METADATA, NAMES, "nan\t2\t3\t4\t5\t6\n"));
    assert!(text.contains("column 1 (force): expected a finite number, found `nan`"), "{text}");
    let text = refusal(&file(&METADATA.replace("# }", "#"), NAMES, ROWS));
    assert!(text.contains("metadata: expected an object in JSON"), "{text}");
    let text = refusal(&file(&METADATA.replace("# END METADATA", "#"), NAMES, ROWS));
    assert!(text.contains("expected a line `# END METADATA`"), "{text}");
    let text = refusal(&file(METADATA, NAMES, ""));
    assert!(text.contains("it has no rows"), "{text}");
    assert!(open(&file(METADATA, "", ROWS)).is_err());
    assert_eq!(read_all(&press()).unwrap(), 5);
}

#[test]
fn segments_that_change_all_the_time_are_none() {
    let rows: String = (0..10_000).map(|row| format!("0\t0\t0\t{row}\t{row}\t{row}\n")).collect();
    let contents = opened(&file(METADATA, NAMES, &rows));
    assert!(contents.parts[0].labels.is_empty());
    assert_eq!(contents.parts[0].rows, Some(10_000));
}

#[test]
fn damage_is_no_panic() {
    damage(&press());
}
