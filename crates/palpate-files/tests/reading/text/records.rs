//! Real records, where they are at hand: they carry no licence to be part of this project.

use std::path::{Path, PathBuf};

use palpate_files::cell::{DecimalMark, Delimiter};
use palpate_files::formats::text::{detect, read_columns};
use palpate_files::input::{Encoding, Input};
use palpate_files::table::{Columns, Layout, ReadOptions};

use super::{names, units};

/// The folder of real records, or a word on why the test is skipped.
fn folder() -> Option<PathBuf> {
    let folder = std::env::var_os("PALPATE_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: no real records at {}; set PALPATE_DATA to their folder", folder.display());
    None
}

fn open(folder: &Path, name: &str, columns: &[usize]) -> (Layout, Columns) {
    let path = folder.join(name);
    let input = Input::open(&path).unwrap_or_else(|error| panic!("{error}"));
    let layout = detect(&input, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    let read = read_columns(&input, &layout, columns, &mut |_, _| Ok(()));
    (layout, read.unwrap_or_else(|error| panic!("{error}")))
}

fn first_and_last(read: &Columns) -> Vec<(f64, f64)> {
    let ends = |values: &Vec<f64>| (values[0], values[values.len() - 1]);
    read.values.iter().map(ends).collect()
}

#[test]
fn silicone_has_no_header() {
    let Some(folder) = folder() else { return };
    let (layout, read) = open(&folder, "silicone-steps/1_7-5_Epin_20mm_v1.csv", &[5, 4, 7, 6]);
    assert_eq!((layout.columns.len(), layout.header_line), (7, None));
    assert_eq!((layout.first_data_line, read.rows()), (1, 12_973));
    assert_eq!(read.values[3][12_972], -0.107_449_778_382_543_8);
    assert_eq!(read.line_of(12_972), Some(12_973));
}

#[test]
fn foam_has_labels_between_numbers() {
    let Some(folder) = folder() else { return };
    let (layout, read) = open(&folder, "foam/XtraSoft.csv", &[3, 5, 6]);
    assert_eq!(names(&layout), ["SetName", "Cycle", "Time", "Size", "Displacement", "Force"]);
    assert_eq!(units(&layout), ["-", "-", "S", "mm", "mm", "N"]);
    assert_eq!(read.rows(), 377);
    assert_eq!(first_and_last(&read), [(0.0, 74.85), (-0.0, 0.296), (-0.033, -0.033)]);
}

#[test]
fn tape_comes_in_two_encodings() {
    let Some(folder) = folder() else { return };
    for (name, encoding, rows, first, blank) in [
        ("vhb4910/relax_2d5.csv", Encoding::Gbk, 90_304, 3, 1),
        ("vhb4910/relax_3d0.csv", Encoding::Utf8, 36_164, 3, 0),
        ("vhb4910/cyc_0d05_2d5_2.csv", Encoding::Gbk, 2012, 4, 1),
    ] {
        let (layout, read) = open(&folder, name, &[1, 2, 3]);
        assert_eq!(layout.encoding, encoding, "{name}");
        assert_eq!(units(&layout), ["s", "mm", "N"], "{name}");
        assert_eq!(names(&layout)[0], "时间", "{name}");
        assert_eq!(layout.first_data_line, first, "{name}");
        assert_eq!((read.rows(), read.ignored.blank), (rows, blank), "{name}");
        assert_eq!(read.ignored.footer, None, "{name}");
    }
}

#[test]
fn tendon_has_named_values() {
    let Some(folder) = folder() else { return };
    let (layout, read) = open(&folder, "tendon/fresh_1.csv", &[4, 1, 2]);
    assert_eq!(layout.metadata.len(), 6);
    assert_eq!(layout.metadata[1].value, "0.39900");
    assert_eq!(layout.metadata[3].unit.as_deref(), Some("mm/min"));
    assert_eq!((layout.header_line, layout.units_line), (Some(8), Some(9)));
    assert_eq!(names(&layout)[7], "Tensile strain (Extension)");
    assert_eq!(units(&layout)[..5], ["mm", "N", "MPa", "s", "-"]);
    assert_eq!(first_and_last(&read), [(0.0, 188.596), (0.0, 0.71646), (0.01146, 1.37036)]);
}

#[test]
fn muscle_and_gripper() {
    let Some(folder) = folder() else { return };
    for seconds in ["0.1", "1", "10", "100"] {
        let name = format!("titin-ramps/AvgRelaxed_{seconds}s.csv");
        let (layout, read) = open(&folder, &name, &[1, 2, 3, 4]);
        assert_eq!(names(&layout), ["Time", "L", "F", "SD"]);
        assert_eq!(read.values[0][0], 2.0);
    }
    let (layout, read) = open(&folder, "gripper-fruit/banana_ForceData_20240824_210940_refined.csv", &[2, 3, 5]);
    assert_eq!(names(&layout), ["-", "Time", "Force", "GoalForce", "Pos", "k"]);
    assert_eq!(read.rows(), 3552);
    assert_eq!(read.values[0][0], 1_724_504_945.198_464_4);
    let (_, read) = open(&folder, "gripper-fruit/kiwi_ForceData_20241127_224354_refined.csv", &[2, 3, 5]);
    assert_eq!(read.rows(), 299);
}

#[test]
fn rheometer_writes_utf16_and_decimal_commas() {
    let Some(folder) = folder() else { return };
    let (layout, read) = open(&folder, "creep/HC1_stressrelaxation_20C_5.csv", &[2, 3, 4]);
    assert_eq!((layout.encoding, layout.decimal), (Encoding::Utf16Le, DecimalMark::Comma));
    assert_eq!(layout.delimiter, Delimiter::Tab);
    assert_eq!(names(&layout)[..3], ["Point No.", "Time", "Shear Strain"]);
    assert_eq!(units(&layout), ["-", "s", "%", "Pa", "Pa", "mN·m", "°C", "-"]);
    assert_eq!(read.rows(), 264);
    assert_eq!(first_and_last(&read), [(0.01, 57.046), (0.019, 0.1), (21.543, 0.070_354)]);
    let (layout, _) = open(&folder, "creep/CM3_Creep.creep", &[1, 2]);
    assert_eq!(units(&layout), ["s", "-", "Pa", "C"]);
    let (layout, _) = open(&folder, "creep/CM3_CreepRecovery.creep", &[1, 2]);
    assert_eq!(names(&layout), ["t", "strain"]);
    open(&folder, "creep/creep_perihepatic_data.csv", &[1, 2]);
}
