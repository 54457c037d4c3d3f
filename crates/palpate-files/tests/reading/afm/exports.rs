//! JPK's text export.

use std::path::Path;

use palpate::record::Correction;
use palpate_files::{
    description::parse_test,
    open::Format,
    record::{ColumnError, ReadError, RecordFile, read_record},
};

use super::{column, damage, labels, metadata, names, near, open, opened, read_all, refusal};

/// The header of a segment and its rows.
struct Export {
    index: usize,
    style: &'static str,
    columns: &'static str,
    units: &'static str,
    more: &'static str,
    rows: Vec<String>,
}

impl Export {
    fn text(&self) -> String {
        let Self {
            index,
            style,
            columns,
            units,
            more,
            rows,
        } = self;
        format!(
            "# index: 0\r\n# segmentIndex: {index}\r\n# segment: {style}\r\n# columns: {columns}\r\n\
             # fancyNames: \"one\" \"two\"\r\n{more}# units: {units}\r\n#\r\n{}\r\n\r\n",
            rows.join("\r\n")
        )
    }
}

/// A spring of 0.5 N/m and a height that falls by 2 µm a row.
const CONSTANTS: &str = "# sensitivity: 4.0E-8\r\n# springConstant: 0.5\r\n";

fn press() -> Vec<Export> {
    let columns = "height vDeflection measuredHeight seriesTime time";
    let row = |time: f64, height: f64, force: f64, own: f64| {
        format!("{} {} {} {} {}", 3.0 * height, force, height, time, own)
    };
    let of = |index, style, rows| Export {
        index,
        style,
        columns,
        units: "m N m s s",
        more: CONSTANTS,
        rows,
    };
    vec![
        of(0, "extend", vec![row(0.5, 4e-6, 0.0, 0.5), row(1.5, 2e-6, 0.0, 1.5), row(2.5, 0.0, 1e-6, 2.5)]),
        of(1, "pause", vec![row(3.5, 0.0, 0.75e-6, 0.5), row(4.5, 0.0, 0.5e-6, 1.5)]),
        of(2, "extend", vec![row(5.5, -1e-6, 1e-6, 0.5)]),
        of(3, "pause", vec![row(6.5, -1e-6, 0.75e-6, 0.5), row(7.5, -1e-6, 0.5e-6, 1.5)]),
        of(4, "retract", vec![row(8.5, 2e-6, 0.0, 0.5)]),
    ]
}

fn written(exports: &[Export]) -> Vec<u8> {
    let head = "# TEXT EXPORT\r\n# data-description.instrument: JPK00001\r\n# force-settings.segments.size: 5\r\n";
    let all: String = exports.iter().map(Export::text).collect();
    format!("{head}{all}").into_bytes()
}

#[test]
fn segments_become_one_test_with_labels() {
    let contents = opened(&written(&press()));
    assert_eq!(contents.format, Format::JpkText);
    let part = &contents.parts[0];
    assert_eq!(
        labels(part),
        [
            ("extend (1)", 0, 3),
            ("pause (1)", 3, 5),
            ("extend (2)", 5, 6),
            ("pause (2)", 6, 8),
            ("retract", 8, 9)
        ]
    );
    assert_eq!(part.rows, Some(9));
    assert_eq!(
        names(part),
        [
            "time",
            "force",
            "indentation",
            "cantilever deflection",
            "height",
            "vDeflection",
            "measuredHeight",
            "seriesTime",
            "time (as in the file)"
        ]
    );
    assert_eq!(metadata(part, "springConstant"), Some("0.5"));
    assert_eq!(metadata(part, "data-description.instrument"), Some("JPK00001"));
    assert_eq!(metadata(part, "time"), Some("seriesTime of the file"));
    assert_eq!(metadata(part, "indentation"), Some("−(measuredHeight + deflection)"));
    assert_eq!(column(&contents, "time")[..4], [0.5, 1.5, 2.5, 3.5]);
    assert_eq!(column(&contents, "force")[2], 1e-6);
    // 1 µN bends the cantilever by 2 µm, and the tip has gone down by so much less.
    assert!(near(column(&contents, "cantilever deflection")[2], 2e-6));
    let indentation = column(&contents, "indentation");
    assert_eq!(indentation[..2], [-4e-6, -2e-6]);
    assert!(near(indentation[2], -2e-6));
    assert!(near(indentation[3], -1.5e-6));
}

#[test]
fn rows_keep_their_lines() {
    let bytes = written(&press());
    let contents = opened(&bytes);
    let read = contents.read(0, &[1], &mut |_, _| Ok(())).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let lines: Vec<usize> = text
        .lines()
        .enumerate()
        .filter(|(_, l)| !l.is_empty() && !l.starts_with('#'))
        .map(|(n, _)| n + 1)
        .collect();
    let found: Vec<usize> = (0..9).map(|row| read.line_of(row).unwrap()).collect();
    assert_eq!(found, lines);
}

#[test]
fn a_record_needs_no_description() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.txt");
    std::fs::write(&path, written(&press())).unwrap();
    let file = read_record(&path, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    let used: Vec<&str> = file.columns.iter().filter_map(|column| column.name.as_deref()).collect();
    assert_eq!(used, ["time", "indentation", "force"]);
    assert_eq!(file.record.len(), 9);
    let displacement = file.record.displacement().unwrap();
    assert!(displacement[5] > displacement[0], "{displacement:?}");
}

#[test]
fn the_travel_of_the_base_can_be_chosen_instead() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.txt");
    std::fs::write(&path, written(&press())).unwrap();
    let text = "[columns.displacement]\ncolumn = \"measuredHeight\"\nsign = -1\n";
    let test = parse_test(text, Path::new("test.toml")).unwrap_or_else(|error| panic!("{error}"));
    let file = read_record(&path, Some(&test), &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(file.record.displacement().unwrap()[..4], [-4e-6, -2e-6, 0.0, 0.0]);
}

#[test]
fn columns_may_change_their_places() {
    let mut exports = press();
    exports[1].columns = "measuredHeight seriesTime time vDeflection height";
    exports[1].units = "m s s N m";
    exports[1].rows = vec!["1e-6 3.5 0.5 2e-6 9e-6".to_owned()];
    let contents = opened(&written(&exports));
    assert_eq!(column(&contents, "force")[3], 2e-6);
    assert_eq!(column(&contents, "height")[3], 9e-6);
    assert!(near(column(&contents, "indentation")[3], -5e-6));
}

#[test]
fn a_spring_that_changes_is_used_where_it_stands() {
    let mut exports = press();
    exports[1].more = "# springConstant: 0.25\r\n";
    let contents = opened(&written(&exports));
    let deflection = column(&contents, "cantilever deflection");
    assert!(near(deflection[2], 2e-6) && near(deflection[3], 3e-6), "{deflection:?}");
}

/// A spring constant that stood above the first segment alone left the others without deflection and the record without
/// indentation.
#[test]
fn constants_that_are_not_repeated_are_those_of_the_first_segment() {
    let mut exports = press();
    let whole = record(&exports, "").unwrap().record;
    for export in &mut exports[1..] {
        export.more = "";
    }
    let once = record(&exports, "").unwrap().record;
    assert!(once.displacement().is_some());
    assert_eq!((once.displacement(), once.force()), (whole.displacement(), whole.force()));
}

#[test]
fn segments_without_what_the_others_have_are_skipped_with_a_reason() {
    let mut exports = press();
    exports[1].columns = "height hDeflection measuredHeight seriesTime time";
    exports[2].rows.clear();
    exports[4].columns = "height vDeflection other seriesTime time";
    let contents = opened(&written(&exports));
    let skipped: Vec<String> = contents.skipped.iter().map(|part| format!("{}: {}", part.name, part.reason)).collect();
    // The height that all segments have is "height" (in the file as the piezo was given).
    assert_eq!(
        skipped,
        [
            "segment 1 (pause (1)): it lacks the deflection of the cantilever",
            "segment 2 (extend (2)): it has no rows",
        ]
    );
    let part = &contents.parts[0];
    assert_eq!(labels(part), [("extend (1)", 0, 3), ("pause (2)", 3, 5), ("retract", 5, 6)]);
    assert_eq!(metadata(part, "indentation"), Some("−(height + deflection)"));
    assert_eq!(metadata(part, "channels left out"), Some("measuredHeight, other (not in every segment)"));
    assert_eq!(read_all(&written(&exports)).unwrap(), 6);
}

#[test]
fn time_without_a_series_is_put_together() {
    let mut exports = press();
    for export in &mut exports {
        export.columns = "height vDeflection measuredHeight other time";
    }
    let contents = opened(&written(&exports));
    // The first segment ends at 2.5 s with steps of 1 s: the next begins at 3.5 s.
    assert_eq!(column(&contents, "time"), [0.5, 1.5, 2.5, 4.0, 5.0, 6.5, 7.5, 8.5, 10.0]);
    assert!(metadata(&contents.parts[0], "time").unwrap().starts_with("time of the file"));
    for export in &mut exports {
        export.columns = "height vDeflection measuredHeight other another";
    }
    assert!(metadata(&opened(&written(&exports)).parts[0], "time").unwrap().starts_with("none"));
    let plan: String = (0..5)
        .map(|index| {
            let key = format!("# force-settings.segment.{index}");
            format!("{key}.duration: 8.0\r\n{key}.num-points: 4\r\n")
        })
        .collect();
    let whole: String = exports.iter().map(|export| format!("{plan}{}", export.text())).collect();
    let contents = opened(whole.as_bytes());
    // 8 s for four points is 2 s a point, though fewer were recorded.
    assert_eq!(column(&contents, "time"), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0]);
    let time = metadata(&contents.parts[0], "time").unwrap();
    assert!(time.starts_with("computed from the requested durations"), "{time}");
}

fn refused_as_record(exports: &[Export]) -> ReadError {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("curve.txt");
    std::fs::write(&path, written(exports)).expect("a file written");
    read_record(&path, None, &mut |_, _| Ok(())).expect_err("an error")
}

#[test]
fn volts_without_calibration_are_requested_about() {
    let mut exports = press();
    for export in &mut exports {
        export.units = "m V m s s";
        export.more = "# springConstant: NaN\r\n";
    }
    let contents = opened(&written(&exports));
    assert_eq!(names(&contents.parts[0])[..2], ["time", "uncalibrated force"]);
    let error = refused_as_record(&exports);
    assert!(
        matches!(
            error,
            ReadError::Column {
                source: ColumnError::Unit { .. },
                ..
            }
        ),
        "{error}"
    );
    assert!(error.to_string().contains("column 2 (uncalibrated force): \"V\" is not a unit of force"), "{error}");
    assert!(error.hint().unwrap().contains("[columns.force]"), "{:?}", error.hint());
    // With both numbers it is a force, and the tip is where it should be.
    for export in &mut exports {
        export.more = CONSTANTS;
        export.units = "m V m s s";
    }
    let contents = opened(&written(&exports));
    let (force, deflection) = (column(&contents, "force"), column(&contents, "cantilever deflection"));
    assert!(near(deflection[2], 4e-14) && near(force[2], 2e-14), "{deflection:?} {force:?}");
}

/// The record of exports, described by `test`.
fn record(exports: &[Export], test: &str) -> Result<RecordFile, ReadError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("curve.txt");
    std::fs::write(&path, written(exports)).expect("a file written");
    let test = parse_test(test, Path::new("test.toml")).unwrap_or_else(|error| panic!("{error}"));
    read_record(&path, Some(&test), &mut |_, _| Ok(()))
}

#[test]
fn the_lines_that_are_requested_for_make_volts_a_force_and_an_indentation() {
    let mut exports = press();
    for export in &mut exports {
        export.units = "m V m s s";
        export.more = "# springConstant: 0.04\r\n";
    }
    let error = record(&exports, "").unwrap_err();
    let hint = error.hint().unwrap();
    let (requested, lines) = hint.split_once('\n').unwrap();
    assert!(
        requested.starts_with("the file lacks a sensitivity (m/V) or a spring constant (N/m)"),
        "{requested}"
    );
    let file = record(&exports, lines).unwrap_or_else(|error| panic!("{error}"));
    // 1 µV is 50 fm and 2 fN; the base has gone down by 4 µm.
    let (displacement, force) = (file.record.displacement().unwrap(), file.record.force());
    assert!(near(force[2], 2e-15) && near(displacement[2], -5e-14), "{force:?} {displacement:?}");
    assert!(near(displacement[0], -4e-6));
    let done = file.record.corrections();
    assert!(matches!(done, [Correction::DeflectionRemoved { largest }] if near(*largest, 5e-14)), "{done:?}");
    // Without a sensitivity no deflection is made of volts.
    let without = lines.replace("\nscale = \"50 nm/V\"", "");
    let error = parse_test(&without, Path::new("test.toml")).unwrap_err();
    assert_eq!(error.key(), Some("columns.deflection.unit"));
    assert_eq!(error.hint().unwrap(), "also give the scale of a volt, such as scale = \"12.5 mm/V\"");
    let without = without.strip_suffix("unit = \"V\"").unwrap();
    let error = record(&exports, without).unwrap_err();
    assert!(error.hint().unwrap().contains("[columns.deflection]\nunit = \"V\"\nscale = "), "{:?}", error.hint());
}

#[test]
fn a_deflection_is_taken_off_a_height_and_not_off_an_indentation() {
    let by_itself = record(&press(), "").unwrap();
    let deflection = "[columns.deflection]\ncolumn = \"cantilever deflection\"\n[columns.displacement]\n";
    let stated = record(&press(), &format!("{deflection}column = \"measuredHeight\"\nsign = -1")).unwrap();
    let (one, other) = (by_itself.record.displacement().unwrap(), stated.record.displacement().unwrap());
    assert!(one.iter().zip(other).all(|(one, other)| near(*one, *other)), "{one:?} {other:?}");
    let error = record(&press(), &format!("{deflection}column = \"indentation\"")).unwrap_err();
    assert!(
        error.to_string().contains("column 3 (indentation): expected the height of the cantilever's base"),
        "{error}"
    );
    // Which column is the height is never guessed.
    let error = parse_test("columns.deflection.column = 4", Path::new("test.toml")).unwrap_err().to_string();
    assert!(error.contains("columns.displacement: missing, expected the column of the height"), "{error}");
    let error = parse_test("[columns.deflection]\nunit = \"nm\"", Path::new("test.toml")).unwrap_err().to_string();
    assert!(error.contains("columns.deflection.column: missing, expected the number of a column"), "{error}");
}

#[test]
fn what_is_wrong_is_stated_with_its_place() {
    let with = |change: &dyn Fn(&mut Vec<Export>)| {
        let mut exports = press();
        change(&mut exports);
        refusal(&written(&exports))
    };
    let text = with(&|exports| exports[0].rows[1] = "1 2 3 4".to_owned());
    assert!(text.contains("line 14: expected 5 cells, found 4"), "{text}");
    let text = with(&|exports| exports[0].rows[1] = "1 2 3 4 5 6".to_owned());
    assert!(text.contains("expected 5 cells, found 6"), "{text}");
    let text = with(&|exports| exports[0].rows[1] = "1 NaN 3 4 5".to_owned());
    assert!(text.contains("column 2 (vDeflection): expected a finite number, found `NaN`"), "{text}");
    let text = with(&|exports| exports[0].rows[1] = "1 2.5.1 3 4 5".to_owned());
    assert!(text.contains("expected a number with a decimal point, found `2.5.1`"), "{text}");
    let text = with(&|exports| exports[0].units = "m N m s");
    assert!(text.contains("expected a unit for each of 5 columns, found 4"), "{text}");
    let text = with(&|exports| exports[0].more = "# springConstant: 0\r\n");
    assert!(text.contains("springConstant: expected a number other than 0, found 0"), "{text}");
    let text = with(&|exports| exports[0].more = "# recorded-num-points: 7\r\n");
    assert!(text.contains("expected 7 rows (recorded-num-points), found 3"), "{text}");
    let text = with(&|exports| exports.iter_mut().for_each(|export| export.rows.clear()));
    assert!(text.contains("expected a test, found none: segment 0 (extend (1)): it has no rows"), "{text}");
    let text = with(&|exports| {
        exports[0].more = "# springConstant: 1e-307\r\n";
        exports[0].rows[1] = "0 1e5 0 1 1".to_owned();
    });
    assert!(text.contains("line 13, column 3 (indentation): expected a finite number"), "{text}");
}

#[test]
fn a_table_with_comments_is_not_an_export() {
    let table = b"# segment: 1\n# Time (s),Force (N)\n0,1\n1,2\n2,3\n";
    assert_eq!(opened(table).format, Format::Text);
    assert!(open(b"# segment: extend\n# columns: a b\n").is_err());
}

#[test]
fn damage_is_no_panic() {
    let exports = press();
    damage(&written(&exports[..2]));
}

#[test]
fn a_thousand_headers_without_rows_end() {
    let text = "# segment: pause\n# columns: a b\n".repeat(10_000);
    assert!(refusal(text.as_bytes()).contains("at most 4096"));
}
