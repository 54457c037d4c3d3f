//! Igor binary waves.

use std::path::Path;

use palpate_files::{description::parse_test, open::Format, record::read_record};

use super::{column, labels, metadata, names, near, open, opened, read_all};

const NOTE: &str =
    "SpringConstant: 0.05\rInvOLS: 4.5e-08\rIndexes: 0,2,3,5\rDirection: NaN,1,0,-1,\rImagingMode: Contact\r";

/// Raw, deflection and sensor, in m.
const COLUMNS: [[f32; 6]; 3] = [
    [1e-6, 2e-6, 3e-6, 3e-6, 2e-6, 1e-6],
    [0.0, 0.0, 2e-8, 1e-8, 0.0, -1e-8],
    [1e-6, 2e-6, 3e-6, 3e-6, 2e-6, 1e-6],
];

/// A wave of version 5 with these columns, and the fields of its header changed by `change`.
fn wave(highest_first: bool, note: &str, change: impl Fn(&mut [u8])) -> Vec<u8> {
    let long = |value: i32| if highest_first { value.to_be_bytes() } else { value.to_le_bytes() };
    let short = |value: i16| if highest_first { value.to_be_bytes() } else { value.to_le_bytes() };
    let double = |value: f64| if highest_first { value.to_be_bytes() } else { value.to_le_bytes() };
    let numbers: Vec<u8> = COLUMNS
        .iter()
        .flatten()
        .flat_map(|value| if highest_first { value.to_be_bytes() } else { value.to_le_bytes() })
        .collect();
    let mut file = vec![0; 384];
    let mut put = |at: usize, bytes: &[u8]| file[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, &short(5));
    put(4, &long(320 + numbers.len() as i32));
    put(12, &long(note.len() as i32));
    put(40, &long(4 * 32));
    put(76, &long(18));
    put(80, &short(2));
    put(92, b"curve0007");
    put(132, &long(6));
    put(136, &long(3));
    put(148, &double(0.5));
    put(180, &double(2.0));
    put(212, b"m");
    put(216, b"s");
    change(&mut file);
    file[2..4].fill(0);
    let word = |pair: &[u8]| match highest_first {
        true => u16::from_be_bytes([pair[0], pair[1]]),
        false => u16::from_le_bytes([pair[0], pair[1]]),
    };
    let sum = file.chunks_exact(2).fold(0_u16, |sum, pair| sum.wrapping_add(word(pair))).wrapping_neg();
    file[2..4].copy_from_slice(&short(sum as i16));
    file.extend(numbers);
    file.extend(note.as_bytes());
    for label in ["", "Raw", "Defl", "ZSnsr"] {
        file.extend(label.bytes().chain(std::iter::repeat(0)).take(32));
    }
    file
}

#[test]
fn a_curve_of_asylum_research_has_force_and_indentation() {
    for highest_first in [false, true] {
        let contents = opened(&wave(highest_first, NOTE, |_| {}));
        assert_eq!(contents.format, Format::Igor);
        let part = &contents.parts[0];
        assert_eq!(
            names(part),
            [
                "time",
                "force",
                "indentation",
                "cantilever deflection",
                "height (measured)",
                "height (piezo)",
                "Raw",
                "Defl",
                "ZSnsr"
            ]
        );
        assert_eq!(labels(part), [("extend", 0, 3), ("pause", 3, 4), ("retract", 4, 6)]);
        assert_eq!(metadata(part, "SpringConstant"), Some("0.05"));
        // Its scale begins at 2 s and goes on by 0.5 s.
        assert_eq!(column(&contents, "time"), [2.0, 2.5, 3.0, 3.5, 4.0, 4.5]);
        let (force, indentation) = (column(&contents, "force"), column(&contents, "indentation"));
        for (row, force) in force.iter().enumerate() {
            let [_, deflection, height] = COLUMNS.map(|column| f64::from(column[row]));
            assert!(near(*force, 0.05 * deflection), "{row}: {force}");
            // The height less the deflection.
            assert!(near(indentation[row], height - deflection), "{row}: {}", indentation[row]);
        }
    }
}

#[test]
fn a_record_needs_no_description() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.ibw");
    std::fs::write(&path, wave(false, NOTE, |_| {})).unwrap();
    let file = read_record(&path, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    let used: Vec<&str> = file.columns.iter().filter_map(|column| column.name.as_deref()).collect();
    assert_eq!(used, ["time", "indentation", "force"]);
}

#[test]
fn without_a_spring_constant_there_is_no_force() {
    let contents = opened(&wave(false, "ImagingMode: Contact\r", |_| {}));
    assert_eq!(
        metadata(&contents.parts[0], "force"),
        Some("not calibrated: the file lacks a sensitivity or a spring constant")
    );
    assert_eq!(labels(&contents.parts[0]), [("curve", 0, 6)]);
    // The lines of the hint make a record of it.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.ibw");
    std::fs::write(&path, wave(false, "ImagingMode: Contact\r", |_| {})).unwrap();
    let error = read_record(&path, None, &mut |_, _| Ok(())).expect_err("no force");
    let reported =
        "column 2 (uncalibrated force): expected a force, found a deflection in m without the spring constant";
    assert!(error.to_string().contains(reported), "{error}");
    let hint = error.hint().expect("a hint");
    let lines = hint.split_once('\n').expect("lines").1.replace("0.04 N/m", "0.05 N/m");
    let test = parse_test(&lines, Path::new("test.toml")).unwrap_or_else(|error| panic!("{error}"));
    let record =
        |path: &Path, test| read_record(path, test, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    let stated = record(&path, Some(&test));
    std::fs::write(&path, wave(false, NOTE, |_| {})).unwrap();
    let calibrated = record(&path, None);
    for (one, other) in [
        (stated.record.force(), calibrated.record.force()),
        (stated.record.displacement().expect("heights"), calibrated.record.displacement().expect("heights")),
    ] {
        assert!(one.iter().zip(other).all(|(one, other)| near(*one, *other)), "{one:?} {other:?}");
    }
}

#[test]
fn damage_to_any_field_does_no_harm() {
    let whole = wave(false, NOTE, |_| {});
    for length in 0..whole.len() {
        assert!(read_all(&whole[..length]).is_err(), "{length}");
    }
    for place in (0..384).filter(|place| !(2..4).contains(place)) {
        for value in [0x00, 0x7F, 0x80, 0xFF] {
            let _either = read_all(&wave(false, NOTE, |header| header[place] = value));
        }
    }
    for place in 384..whole.len() {
        let mut other = whole.clone();
        other[place] ^= 0xFF;
        let _either = read_all(&other);
    }
    // What is no wave by its checksum is not read as one.
    let mut other = whole;
    other[200] ^= 1;
    assert!(open(&other).is_err_and(|error| error.to_string() == "curve: expected a record, found binary data"));
}
