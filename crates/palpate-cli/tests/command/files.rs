//! The files of a report: formats of figures, the workbook, CSV for readers of other languages.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::fs;
use std::path::Path;

use calamine::{Data, DataType as _, Reader as _, Xlsx, open_workbook};

use crate::common::{done, file, palpate, ramp_and_hold, refused};

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// What stands in the cell below this heading in the first row of a sheet.
fn cell(path: &Path, sheet: &str, heading: &str) -> Data {
    let mut book: Xlsx<_> = open_workbook(path).unwrap();
    let range = book.worksheet_range(sheet).unwrap();
    let rows: Vec<&[Data]> = range.rows().collect();
    let column = rows[0].iter().position(|cell| cell.as_string().as_deref() == Some(heading));
    rows[1][column.unwrap_or_else(|| panic!("{heading} among {:?}", rows[0]))].clone()
}

/// Two holds: of one record as text.
fn two_holds() -> String {
    let mut text = String::from("time_s,displacement_mm,force_n\n");
    for i in 0..600 {
        let t = f64::from(i) * 0.05;
        let (d, f) = match t {
            t if t < 1.0 => (t, 2.0 * t),
            t if t < 14.0 => (1.0, 1.0 + (1.0 + 4.0 * (t - 1.0)).powf(-0.25)),
            t if t < 15.0 => (t - 13.0, 1.4 + 2.0 * (t - 14.0)),
            t => (2.0, 2.4 + (1.0 + 4.0 * (t - 15.0)).powf(-0.25)),
        };
        text.push_str(&format!("{t:.4},{d:.5},{f:.6}\n"));
    }
    text
}

#[test]
fn figures_have_the_formats_the_width_and_the_holds_that_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    file(folder, "two.csv", two_holds());
    let choice = ["--figures", "svg,pdf", "--column", "single", "--holds", "2", "--no-compare"];
    done(folder, &[&["analyze", "two.csv", "--out", "study"][..], &choice].concat());
    let figures = folder.join("study/figures");
    assert_eq!(
        names(&figures),
        ["holds", "record", "residuals", "summary"]
            .map(|name| [format!("{name}.pdf"), format!("{name}.svg")])
            .concat()
    );
    let svg = fs::read_to_string(figures.join("holds.svg")).unwrap();
    assert!(svg.contains("width=\"85mm\"") && svg.contains("Hold 2,") && !svg.contains("Hold 1,"), "{svg}");
    assert!(fs::read(figures.join("holds.pdf")).unwrap().starts_with(b"%PDF-"));
    // The page has its own width and both holds.
    let page = fs::read_to_string(folder.join("study/report.html")).unwrap();
    assert!(page.contains("Hold 1,") && page.contains("Hold 2,") && !page.contains("width=\"85mm\""));
}

#[test]
fn what_has_no_folder_or_no_hold_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    file(folder, "press.csv", ramp_and_hold(20.0, 20.0));
    let error = refused(folder, &["analyze", "press.csv", "--figures", "pdf"]);
    assert!(error.contains("--figures is for the files of a report") && error.contains("--out"), "{error}");
    let error = refused(folder, &["analyze", "press.csv", "--no-compare", "--out", "study", "--holds", "1,3"]);
    assert!(error.contains("the figures are to show hold 3, found 1 hold in the record"), "{error}");
    assert!(!folder.join("study").exists());
    let error = refused(folder, &["analyze", "press.csv", "--out", "study", "--csv-locale", "xx"]);
    assert!(error.contains("[possible values: en, de, es, fr, it, nl, pl, pt]"), "{error}");
}

#[test]
fn a_workbook_has_numbers_as_numbers_and_texts_as_texts() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    file(folder, "=1+1.csv", ramp_and_hold(20.0, 20.0));
    let analyze = |out: &str| done(folder, &["analyze", "=1+1.csv", "--no-compare", "--out", out]);
    analyze("study");
    analyze("again");
    let path = folder.join("study/tables.xlsx");
    assert_eq!(fs::read(&path).unwrap(), fs::read(folder.join("again/tables.xlsx")).unwrap());
    let mut book: Xlsx<_> = open_workbook(&path).unwrap();
    let sheets = book.sheet_names();
    let tables: Vec<String> = names(&folder.join("study/tables"));
    // A sheet a table, and their captions.
    assert_eq!(sheets.len(), tables.len() + 1, "{sheets:?} {tables:?}");
    assert_eq!(sheets.last().map(String::as_str), Some("captions"));
    for sheet in &sheets {
        assert!(tables.contains(&format!("{sheet}.csv")) || sheet == "captions", "{sheet}");
        assert!(book.worksheet_formula(sheet).unwrap().is_empty(), "{sheet}");
    }
    // Numbers read as in the CSV, a record by its name, as it is.
    let csv = fs::read_to_string(folder.join("study/tables/parameters.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let row = reader.records().next().unwrap().unwrap();
    assert_eq!(&row[0], "'=1+1.csv");
    assert_eq!(cell(&path, "parameters", "record"), Data::String("=1+1.csv".to_owned()));
    assert_eq!(cell(&path, "parameters", "value"), Data::Float(row[6].parse().unwrap()));
    assert!(matches!(cell(&path, "holds", "Force at start (N)"), Data::Float(force) if (force - 2.0).abs() < 0.05));
    // The header stays in view, and a text that looks like a formula stays a text when it is edited.
    let mut archive = zip::ZipArchive::new(fs::File::open(&path).unwrap()).unwrap();
    let mut member = |name: &str| std::io::read_to_string(archive.by_name(name).unwrap()).unwrap();
    assert!(member("xl/worksheets/sheet1.xml").contains("<pane ySplit=\"1\""));
    assert!(member("xl/styles.xml").contains("quotePrefix=\"1\""));
}

#[test]
fn a_record_goes_to_a_workbook_and_comes_back_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    file(folder, "press.csv", ramp_and_hold(20.0, 20.0));
    let rows = |path: &str| {
        let text = fs::read_to_string(folder.join(path)).unwrap();
        text.lines().skip(1).map(str::to_owned).collect::<Vec<_>>()
    };
    let convert =
        |from: &str, to: &str, more: &[&str]| done(folder, &[&["convert", from, "--out", to][..], more].concat());
    convert("press.csv", "plain.csv", &[]);
    convert("press.csv", "book.xlsx", &[]);
    convert("press.csv", "comma.csv", &["--csv-locale", "de"]);
    assert!(rows("comma.csv")[2].starts_with("0,05;0,00005;0,1"), "{}", rows("comma.csv")[2]);
    for name in ["book", "comma"] {
        let from = if name == "book" { "book.xlsx" } else { "comma.csv" };
        convert(from, "back.csv", &[]);
        assert_eq!(rows("back.csv"), rows("plain.csv"), "{name}");
    }
}

#[test]
fn every_table_of_a_reader_with_a_decimal_comma_has_semicolons() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    file(folder, "press.csv", ramp_and_hold(20.0, 20.0));
    done(folder, &["analyze", "press.csv", "--no-compare", "--out", "en"]);
    done(folder, &["analyze", "press.csv", "--no-compare", "--out", "de", "--csv-locale", "de"]);
    for name in names(&folder.join("en/tables")) {
        let read = |folder_name: &str, separator: u8| {
            let bytes = fs::read(folder.join(folder_name).join("tables").join(&name)).unwrap();
            let mut reader = csv::ReaderBuilder::new().delimiter(separator).from_reader(&bytes[..]);
            let header = reader.headers().unwrap().clone();
            let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
            (header, rows)
        };
        let ((header, rows), (other_header, other_rows)) = (read("en", b','), read("de", b';'));
        assert_eq!((&header, rows.len()), (&other_header, other_rows.len()), "{name}");
        for (one, other) in rows.iter().flatten().zip(other_rows.iter().flatten()) {
            let expected = if one.parse::<f64>().is_ok() { one.replace('.', ",") } else { one.to_owned() };
            assert_eq!(other, expected, "{name}");
        }
    }
    // The marked first line keeps a batch recognised.
    fs::create_dir(folder.join("curves")).unwrap();
    fs::copy(folder.join("press.csv"), folder.join("curves/press.csv")).unwrap();
    let batch = ["batch", "curves", "--out", "curves/holds.csv", "--csv-locale", "fr"];
    done(folder, &batch);
    let table = fs::read_to_string(folder.join("curves/holds.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert!(
        lines[0].starts_with("# palpate_batch: ") && lines[1].starts_with("record;part;hold;law;"),
        "{table}"
    );
    // Its own table is no record of the folder that it lies in.
    let again = palpate(folder, &batch);
    let reported = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(again.status.success() && reported.contains("in 1 file"), "{reported}");
}
