//! Real records, where they are at hand: they carry no licence to be part of this project.

use std::path::{Path, PathBuf};

use palpate_files::{
    description::TestDescription,
    open::{Contents, Format},
    record,
    table::ReadOptions,
};

use super::{message, names, open};

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

#[test]
fn every_test_of_two_workbooks_becomes_a_record() {
    let Some(folder) = folder() else { return };
    for (name, format, parts, skipped) in [
        ("230403_C_Indentation_relaxation_500N_force.xlsx", Format::Xlsx, 29, 3),
        ("230515_C_Indentation_relaxation_500N_force.xls", Format::Xls, 12, 1),
    ] {
        let contents = Contents::open(&folder.join("zwick-indentation").join(name), &ReadOptions::default());
        let contents = contents.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(contents.format, format);
        for part in &contents.skipped {
            println!("{name}: {} skipped: {}", part.name, part.reason);
        }
        let tests = record::tests(&contents, &TestDescription::default()).expect("tests");
        for &index in &tests.parts {
            let part = &contents.parts[index];
            let file = record::read_part(&contents, index, None, &mut |_, _| Ok(()));
            let file = file.unwrap_or_else(|error| panic!("{}: {error}", part.title()));
            println!(
                "{}: {} rows; {:?}; {}",
                part.title(),
                file.rows,
                file.columns.iter().map(|used| (used.number, used.unit.as_str())).collect::<Vec<_>>(),
                part.written
            );
            let expected = [
                ("Temps d'essai", "s"),
                ("Force standard", "N"),
                ("Allongement", "mm"),
                ("Ecartement entre outils", "mm"),
            ];
            assert_eq!(names(part), expected);
            assert!(file.rows > 100 && file.record.displacement().is_some());
            assert_eq!(file.record.time()[0], 0.0);
        }
        assert_eq!((tests.parts.len(), tests.skipped.len()), (parts, skipped));
    }
}

#[test]
fn a_real_workbook_cut_off_anywhere_is_an_error() {
    let Some(folder) = folder() else { return };
    let path = folder.join("zwick-indentation/230515_C_Indentation_relaxation_500N_force.xls");
    let bytes = std::fs::read(path).expect("a file");
    for length in (0..bytes.len()).step_by(30_011).skip(1) {
        assert!(!message(open(&bytes[..length])).is_empty());
    }
}
