//! Real records, where they are at hand: they carry no licence to be part of this project.

use std::path::{Path, PathBuf};

use palpate::segment::find_phases;
use palpate_files::{
    description::{TestDescription, read_test},
    record_file::{ReadError, RecordFile, read_record},
};

use crate::described;

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

fn example(name: &str) -> TestDescription {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/tests");
    read_test(&examples.join(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn open(path: &Path, test: Option<&TestDescription>) -> RecordFile {
    read_record(path, test, &mut |_, _| {}).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(path: &Path) -> ReadError {
    let error = read_record(path, None, &mut |_, _| {}).expect_err("an error");
    eprintln!("{error}\n   hint: {}", error.hint().unwrap_or_default());
    error
}

fn numbers(file: &RecordFile) -> Vec<usize> {
    file.columns.iter().map(|column| column.number).collect()
}

#[test]
fn silicone_has_two_clocks() {
    let Some(folder) = folder() else { return };
    let test = example("silicone-steps.toml");
    let path = folder.join("silicone-steps/1_7-5_Epin_20mm_v1.csv");
    let file = open(&path, Some(&test));
    assert_eq!(file.rows, 12_973);
    assert!(file.record.len() > 12_900 && file.record.len() <= file.rows);
    let most = file.record.displacement().unwrap().iter().fold(0.0f64, |most, d| most.max(*d));
    assert!((0.011..0.014).contains(&most), "{most}");
    let phases = find_phases(&file.record, &test.segment).unwrap();
    // Four squeezes to each of three levels, and the releases between them.
    assert_eq!(phases.holds().count(), 24);
    let text = refused(&path).to_string();
    assert!(text.contains("no names of columns in 7 columns"), "{text}");
}

#[test]
fn headers_that_tell_all() {
    let Some(folder) = folder() else { return };
    for (name, example_name, rows, columns) in [
        ("foam/XtraSoft.csv", "foam.toml", 377, [3, 5, 6]),
        ("vhb4910/relax_2d5.csv", "vhb4910.toml", 90_304, [1, 2, 3]),
        ("vhb4910/relax_3d0.csv", "vhb4910.toml", 36_164, [1, 2, 3]),
        ("vhb4910/cyc_0d05_2d5_2.csv", "vhb4910.toml", 2012, [1, 2, 3]),
    ] {
        let path = folder.join(name);
        let file = open(&path, None);
        assert_eq!((file.rows, numbers(&file).as_slice()), (rows, columns.as_slice()), "{name}");
        let told = open(&path, Some(&example(example_name)));
        assert_eq!(told.record, file.record, "{name}");
        assert_eq!(told.columns, file.columns, "{name}");
    }
    let file = open(&folder.join("tendon/fresh_1.csv"), None);
    assert_eq!(numbers(&file), [4, 1, 2]);
    let force = file.record.force();
    assert_eq!((force[0], force[force.len() - 1]), (0.01146, 1.37036));
}

#[test]
fn grippers_and_muscle_are_asked_for_units() {
    let Some(folder) = folder() else { return };
    let path = folder.join("gripper-fruit/banana_ForceData_20240824_210940_refined.csv");
    let text = refused(&path).to_string();
    assert!(text.contains("column 2 (Time), column 5 (Pos), column 3 (Force)"), "{text}");
    let units =
        described("[columns]\ntime = { unit = \"s\" }\ndisplacement = { unit = \"mm\" }\nforce = { unit = \"N\" }");
    let file = open(&path, Some(&units));
    assert_eq!((file.rows, numbers(&file)), (3552, vec![2, 5, 3]));
    assert_eq!((file.start, file.record.time()[0]), (Some(1_724_504_945.198_464_4), 0.0));
    let text = refused(&folder.join("titin-ramps/AvgRelaxed_1s.csv")).to_string();
    assert!(text.contains("expected a unit for column 1 (Time), column 3 (F)"), "{text}");
}

#[test]
fn rheometers_measure_stress() {
    let Some(folder) = folder() else { return };
    let file = open(&folder.join("creep/HC1_stressrelaxation_20C_5.csv"), None);
    assert!(file.per_unit_area);
    assert_eq!((numbers(&file), file.record.force()[0]), (vec![2, 4], 21.543));
    let text = refused(&folder.join("creep/CM3_Creep.creep")).to_string();
    // Its stamps of whole milliseconds repeat, which is mended; its stress is kept constant.
    assert!(text.contains("the force is 10 N in all 279 rows"), "{text}");
    let text = refused(&folder.join("creep/creep_perihepatic_data.csv")).to_string();
    assert!(text.contains("expected a column of force"), "{text}");
}
