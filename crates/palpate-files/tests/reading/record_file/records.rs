//! Real records, where they are at hand: they carry no licence to be part of this project.

use std::path::{Path, PathBuf};

use palpate::segment::{After, HoldMode, SegmentError, SegmentOptions, Segmentation, find_phases};
use palpate_files::{
    description::{TestDescription, read_test},
    record::{ReadError, RecordFile, read_record},
};

use super::described;

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
    read_record(path, test, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(path: &Path) -> ReadError {
    let error = read_record(path, None, &mut |_, _| Ok(())).expect_err("an error");
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
    let phases = find_phases(&file.record, &test.analysis.segment).unwrap();
    // Four squeezes to each of three levels, and the releases between them.
    assert_eq!(phases.holds().count(), 24);
    let text = refused(&path).to_string();
    assert!(text.contains("no names of columns in 7 columns"), "{text}");
}

/// The phases of a record after repair, as an analysis sees them.
fn phases(file: &RecordFile, options: &SegmentOptions) -> Result<Segmentation, SegmentError> {
    find_phases(&file.record.repaired(), options)
}

/// Start and end of every hold, s; what came before; what is held.
fn holds(file: &RecordFile, options: &SegmentOptions) -> Vec<(f64, f64, Option<After>, HoldMode)> {
    let time = file.record.time();
    let found = phases(file, options).unwrap_or_else(|error| panic!("{error}"));
    let mode = |mode: Option<HoldMode>| mode.unwrap_or_else(|| panic!("a hold that holds nothing"));
    let holds = found.holds().map(|hold| (time[hold.start], time[hold.end - 1], hold.after, mode(hold.mode)));
    holds.collect()
}

#[test]
fn the_foams_hold_is_the_one_its_cycle_column_labels() {
    let Some(folder) = folder() else { return };
    let path = folder.join("foam/XtraSoft.csv");
    let labels = std::fs::read_to_string(&path).unwrap();
    let hold: Vec<f64> = labels
        .lines()
        .filter(|line| line.contains("1-Hold"))
        .map(|line| line.split(',').nth(2).unwrap().parse().unwrap())
        .collect();
    let found = holds(&open(&path, None), &SegmentOptions::default());
    println!("{found:?}, labelled {} to {}", hold[0], hold[hold.len() - 1]);
    let (start, end, after, mode) = found[0];
    // Two samples of 0.2 s.
    assert!((start - hold[0]).abs() < 0.41 && (end - hold[hold.len() - 1]).abs() < 0.41);
    assert_eq!((after, mode), (Some(After::Loading), HoldMode::DisplacementHeld));
}

#[test]
fn the_tendons_hold_lasts_as_long_as_its_header_says() {
    let Some(folder) = folder() else { return };
    let found = holds(&open(&folder.join("tendon/fresh_1.csv"), None), &SegmentOptions::default());
    println!("{found:?}");
    let [(start, end, after, mode)] = found[..] else {
        panic!("{found:?}")
    };
    assert!((end - start - 180.0).abs() < 0.5, "{start} {end}");
    assert_eq!((after, mode), (Some(After::Loading), HoldMode::DisplacementHeld));
}

#[test]
fn muscle_is_held_after_ramps_of_known_times() {
    let Some(folder) = folder() else { return };
    let units = "[columns]\ntime = { unit = \"s\" }\ndisplacement = { column = \"L\", unit = \"mm\" }\n\
                 force = { column = \"F\", unit = \"N\" }";
    for (ramp, name) in [(0.1, "0.1"), (1.0, "1"), (10.0, "10"), (100.0, "100")] {
        let file = open(&folder.join(format!("titin-ramps/AvgRelaxed_{name}s.csv")), Some(&described(units)));
        let found = holds(&file, &SegmentOptions::default());
        println!("{ramp} s: {found:?}");
        let [(start, _, after, mode)] = found[..] else {
            panic!("{found:?}")
        };
        let time = file.record.time();
        let interval = time.windows(2).find(|pair| pair[1] > 2.0 + ramp).map_or(0.0, |pair| pair[1] - pair[0]);
        assert!((start - 2.0 - ramp).abs() <= 2.0 * interval, "{ramp} s: {start}, every {interval} s");
        assert_eq!((after, mode), (Some(After::Loading), HoldMode::DisplacementHeld));
    }
}

#[test]
fn silicone_is_held_up_and_down() {
    let Some(folder) = folder() else { return };
    let test = example("silicone-steps.toml");
    for (name, count) in [("1_7-5_Epin_20mm_v1.csv", 24), ("2_7-5_E2pin_20mm_capac_relax.csv", 9)] {
        let found = holds(&open(&folder.join("silicone-steps").join(name), Some(&test)), &test.analysis.segment);
        println!("{name}: {found:?}");
        assert_eq!(found.len(), count, "{name}");
        let up = found.iter().filter(|hold| hold.2 == Some(After::Loading)).count();
        assert_eq!(up, count.div_ceil(2), "{name}");
        assert!(found.iter().all(|hold| hold.3 == HoldMode::DisplacementHeld), "{name}");
    }
}

#[test]
fn a_tape_is_held_once_and_not_in_a_triangle() {
    let Some(folder) = folder() else { return };
    for name in ["relax_2d5.csv", "relax_3d0.csv"] {
        let found = holds(&open(&folder.join("vhb4910").join(name), None), &SegmentOptions::default());
        println!("{name}: {found:?}");
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        assert!(found[0].1 - found[0].0 > 1700.0 && found[0].3 == HoldMode::DisplacementHeld);
    }
    let cyclic = open(&folder.join("vhb4910/cyc_0d05_2d5_2.csv"), None);
    let found = phases(&cyclic, &SegmentOptions::default());
    assert!(matches!(found, Err(SegmentError::NoHold { .. })), "{found:?}");
    let test = example("silicone-steps.toml");
    let still = open(&folder.join("silicone-steps/1_10_E4pin_20mm_v7.csv"), Some(&test));
    let found = phases(&still, &test.analysis.segment);
    assert!(found.is_err(), "{found:?}");
}

#[test]
fn a_gripper_holds_the_force() {
    let Some(folder) = folder() else { return };
    let test = example("gripper.toml");
    let path = folder.join("gripper-fruit/banana_ForceData_20240824_210940_refined.csv");
    let file = open(&path, Some(&test));
    let found = holds(&file, &test.analysis.segment);
    let begin = file.record.time()[0];
    for (start, end, after, mode) in &found {
        println!("banana {:.2} to {:.2} {after:?} {mode:?}", start - begin, end - begin);
    }
    // At the end the fruit breaks, and the jaw stands.
    assert_eq!(found.len(), 3, "{found:?}");
    // The grasp at 6 N creeps; at 0.8 N the controller is slower than the fruit.
    assert_eq!((found[0].2, found[0].3), (Some(After::Loading), HoldMode::ForceHeld), "{found:?}");
    assert_eq!(found[1].2, Some(After::Unloading), "{found:?}");
    let kiwi = described(
        "[columns]\ntime = { column = \"Time\", unit = \"s\" }\ndisplacement = { column = \"Pos\", unit = \"mm\" }\n\
         force = { column = \"Force\", unit = \"N\" }",
    );
    let path = std::fs::read_dir(folder.join("gripper-fruit")).unwrap().map(|entry| entry.unwrap().path());
    let path = path.into_iter().find(|path| path.to_string_lossy().contains("kiwi")).unwrap();
    let file = open(&path, Some(&kiwi));
    let found = phases(&file, &kiwi.analysis.segment);
    assert!(matches!(found, Err(SegmentError::Ruptured(_))), "{found:?}");
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
        let reported = open(&path, Some(&example(example_name)));
        assert_eq!(reported.record, file.record, "{name}");
        assert_eq!(reported.columns, file.columns, "{name}");
    }
    let file = open(&folder.join("tendon/fresh_1.csv"), None);
    assert_eq!(numbers(&file), [4, 1, 2]);
    let force = file.record.force();
    assert_eq!((force[0], force[force.len() - 1]), (0.01146, 1.37036));
}

#[test]
fn grippers_and_muscle_are_requested_for_units() {
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
    assert_eq!((numbers(&file), file.record.force()[0]), (vec![2, 3, 4], 21.543));
    // Its stamps of whole milliseconds repeat, which is repaired; its stress is kept constant.
    let creep = open(&folder.join("creep/CM3_Creep.creep"), None);
    assert!(creep.record.force().iter().all(|force| *force == 10.0) && creep.record.displacement().is_some());
    let text = refused(&folder.join("creep/creep_perihepatic_data.csv")).to_string();
    assert!(text.contains("expected a unit for column 1 (Time), column 2 (Creep Compliance)"), "{text}");
}
