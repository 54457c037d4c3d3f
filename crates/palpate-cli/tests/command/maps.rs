//! Maps of force curves: positions in the tables, and a quantity over them as a figure.
#![expect(clippy::unwrap_used, reason = "a test that cannot run has failed")]

use std::fs;
use std::io::{Cursor, Write as _};
use std::path::Path;

use palpate_files::parquet_table::{TableReader, Values};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::common::{data, done, file, palpate, refused};

/// The end of an indentation of a soft half space by a ball of 5 µm, as JPK exports it: Hertz's F = 4/3 E/(1 − ν²) √R u^1.5.
fn curve(number: usize, [x, y]: [f64; 2], modulus: f64) -> String {
    let mut text = format!(
        "# index: {number}\n# xPosition: {x}\n# yPosition: {y}\n# segmentIndex: 0\n# segment: extend\n# springConstant: 0.05\n\
         # columns: measuredHeight vDeflection seriesTime\n# units: m N s\n\n"
    );
    for i in 0..200 {
        let depth = (f64::from(i) - 100.0) * 1e-8;
        let force = 4.0 / 3.0 * modulus / 0.75 * 5e-6_f64.sqrt() * depth.max(0.0).powf(1.5);
        text.push_str(&format!("{:.9e} {force:.9e} {:.4}\n", -(depth + force / 0.05), 0.001 * f64::from(i)));
    }
    text
}

/// A zip of curves at these positions with these moduli, Pa.
fn zip(curves: &[([f64; 2], f64)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (number, (position, modulus)) in curves.iter().enumerate() {
        zip.start_file(format!("curve-{number:03}.txt"), SimpleFileOptions::default()).unwrap();
        zip.write_all(curve(number, *position, *modulus).as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// Four columns and three rows 1 µm apart, one curve missing; the modulus is 500 Pa and 100 Pa more from curve to curve.
fn grid() -> Vec<([f64; 2], f64)> {
    let cells = (0..12).filter(|cell| *cell != 6);
    cells
        .map(|cell| ([1e-6 * (cell % 4) as f64, 1e-6 * (cell / 4) as f64], 500.0 + 100.0 * cell as f64))
        .collect()
}

fn described(folder: &Path) {
    let text =
        "[specimen]\nshape = \"spherical tip\"\nradius = \"5 um\"\npoisson_ratio = 0.5\n[contact]\ntouch = \"0 mm\"\n";
    file(folder, "tip.toml", text);
}

#[test]
fn positions_travel_into_the_table_and_its_map_has_a_cell_a_curve() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    described(folder);
    file(folder, "map.zip", zip(&grid()));
    let batch = [
        "batch",
        "map.zip",
        "--test",
        "tip.toml",
        "--out",
        "holds.csv",
        "--map",
        "E",
        "--map",
        "E=modulus.pdf",
    ];
    done(folder, &batch);
    let table = fs::read_to_string(folder.join("holds.csv")).unwrap();
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(table.as_bytes());
    let header = reader.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let number = |row: usize, name: &str| {
        rows[row][header.iter().position(|column| column == name).unwrap()].parse::<f64>().unwrap()
    };
    assert_eq!(rows.len(), 11);
    for (row, ([x, y], modulus)) in grid().iter().enumerate() {
        assert_eq!([number(row, "x_m"), number(row, "y_m"), number(row, "map_index")], [*x, *y, row as f64]);
        assert!(
            (number(row, "loading_modulus_pa") / modulus - 1.0).abs() < 0.01,
            "{}",
            number(row, "loading_modulus_pa")
        );
    }
    let svg = fs::read_to_string(folder.join("holds_map_E.svg")).unwrap();
    assert!(
        svg.contains(">Loading modulus (kPa)<") && svg.contains(">x (µm)<") && svg.contains("<image"),
        "{svg}"
    );
    assert!(svg.contains("11 of 11 curves have a value") && svg.contains("Grey: no value"), "{svg}");
    assert!(fs::read(folder.join("modulus.pdf")).unwrap().starts_with(b"%PDF-"));
    // The position stands in the document of a curve too.
    let json =
        done(folder, &["analyze", "map.zip", "--part", "curve-005.txt", "--test", "tip.toml", "--format", "json"]);
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!([&document["input"]["x_m"], &document["input"]["y_m"]].map(|x| x.as_f64().unwrap()), [1e-6, 1e-6]);
    assert_eq!(document["input"]["map_index"], 5);
}

#[test]
fn irregular_positions_are_points() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    described(folder);
    let curves: Vec<([f64; 2], f64)> = (0..9)
        .map(|i| {
            (
                [1e-6 * (f64::from(i) * 12.9898).sin().abs(), 1e-6 * (f64::from(i) * 78.233).cos().abs()],
                800.0 + 50.0 * f64::from(i),
            )
        })
        .collect();
    file(folder, "map.zip", zip(&curves));
    done(
        folder,
        &["batch", "map.zip", "--test", "tip.toml", "--out", "holds.parquet", "--map", "loading_modulus_pa"],
    );
    // Curves without a hold, and those with a number, are rows of Parquet too.
    let table = TableReader::new(fs::File::open(folder.join("holds.parquet")).unwrap()).unwrap();
    let values = |name: &str| {
        let column = table.fields().iter().position(|field| field.name == name).unwrap();
        table.values(0, column).unwrap()
    };
    assert_eq!(values("hold"), Values::OptionalCount(vec![None; 9]));
    assert_eq!(values("map_index"), Values::OptionalCount((0..9).map(Some).collect()));
    let svg = fs::read_to_string(folder.join("holds_map_loading_modulus_pa.svg")).unwrap();
    assert!(
        !svg.contains("<image") && svg.contains("fill=\"#440154\"") && svg.contains("fill=\"#fde725\""),
        "{svg}"
    );
}

#[test]
fn a_map_that_cannot_be_drawn_says_why_and_leaves_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    described(folder);
    file(folder, "map.zip", zip(&grid()));
    let error = refused_after_work(
        folder,
        &["batch", "map.zip", "--test", "tip.toml", "--out", "holds.csv", "--map", "stiffness"],
    );
    assert!(error.contains("expected a quantity of the curves for the map, found \"stiffness\""), "{error}");
    assert!(error.contains("these curves have loading_modulus_pa, loading_modulus_standard_error_pa"), "{error}");
    assert!(folder.join("holds.csv").exists());
    let error = refused(folder, &["batch", "map.zip", "--out", "other.csv", "--map", "E=map.jpg"]);
    assert!(error.contains("map.jpg: expected a figure ending in .svg, .png or .pdf"), "{error}");
    assert!(!folder.join("other.csv").exists());
    file(folder, "plain.csv", crate::common::ramp_and_hold(20.0, 20.0));
    let error = refused_after_work(folder, &["batch", "plain.csv", "--out", "plain_holds.csv", "--map", "n"]);
    assert!(error.contains("expected curves with a position, found none"), "{error}");
}

/// Runs the command, expects exit code 2, and returns standard error.
fn refused_after_work(folder: &Path, arguments: &[&str]) -> String {
    let output = palpate(folder, arguments);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_published_map_has_the_positions_of_its_headers() {
    let Some(path) = data("more/afm/fmt-jpk-fd_map2x2_extracted.jpk-force-map") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["batch", path.to_str().unwrap(), "--out", "holds.csv"]);
    let table = fs::read_to_string(folder.path().join("holds.csv")).unwrap();
    for position in
        ["0.000031972656250000005,-0.0007535351562500001,0,", "0.00003185546875,-0.00021373046875000003,99,"]
    {
        assert!(table.contains(position), "{table}");
    }
}
