//! MATLAB files of level 5.

use palpate_files::open::Format;

use super::{check, column, open, opened};
use crate::corpus;

#[test]
fn vectors_side_by_side_are_one_test() {
    for name in ["good_plain.mat", "good_highest_byte_first.mat", "good_packed.mat"] {
        let contents = opened(&corpus(&format!("matlab/{name}")));
        assert_eq!((contents.format, contents.parts.len()), (Format::Matlab, 1), "{name}");
        let units: Vec<Option<&str>> = contents.parts[0].columns.iter().map(|column| column.unit.as_deref()).collect();
        assert_eq!(units, [Some("s"), Some("N"), Some("mm")], "{name}");
        check(&contents, 0);
    }
}

/// Written by SciPy.
#[test]
fn a_structure_is_a_test_with_its_named_values() {
    let contents = opened(&corpus("matlab/good_structure.mat"));
    let part = &contents.parts[0];
    assert_eq!((contents.parts.len(), part.name.as_deref()), (1, Some("a")));
    let values: Vec<(&str, &str, Option<&str>)> = part
        .metadata
        .iter()
        .map(|entry| (entry.name.as_str(), entry.value.as_str(), entry.unit.as_deref()))
        .collect();
    assert_eq!(values, [("note", "first", None), ("radius", "20.0", Some("mm"))]);
    check(&contents, 0);
    let contents = opened(&corpus("matlab/good_cells.mat"));
    let names: Vec<&str> = contents.parts.iter().filter_map(|part| part.name.as_deref()).collect();
    assert_eq!(names, ["runs.runs{1}", "runs.runs{2}"]);
    assert_eq!(column(&contents, 1, "force"), super::table()[1]);
    let skipped: Vec<String> = contents.skipped.iter().map(|part| format!("{}: {}", part.name, part.reason)).collect();
    assert_eq!(skipped, ["ints: no other array of 3 rows stands beside it"]);
}

#[test]
fn cut_off_or_changed_anywhere_does_no_harm() {
    for name in ["good_plain.mat", "good_packed.mat", "good_structure.mat"] {
        let whole = corpus(&format!("matlab/{name}"));
        let read = |bytes: &[u8]| {
            let contents = open(bytes)?;
            for (index, part) in contents.parts.iter().enumerate() {
                let all: Vec<usize> = (1..=part.columns.len()).collect();
                let read = contents.read(index, &all, &mut |_, _| Ok(()))?;
                assert!(read.values.iter().flatten().all(|value| value.is_finite()));
            }
            Ok::<_, palpate_files::FileError>(contents.parts.first().map_or(0, |part| part.columns.len()))
        };
        for length in 0..whole.len() {
            // Cut off between two elements the file is whole, and holds less.
            let columns = read(&whole[..length]).unwrap_or(0);
            assert!(columns < 3 || name == "good_structure.mat", "{name}: {length}");
        }
        for place in 0..whole.len() {
            for change in [0x01, 0x80, 0xFF] {
                let mut other = whole.clone();
                other[place] ^= change;
                let _either = read(&other);
            }
        }
    }
}
