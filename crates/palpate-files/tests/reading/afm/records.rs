//! Real records, where they are at hand: they carry no licence to be part of this project.

use std::path::{Path, PathBuf};

use palpate_files::{
    input::Packing,
    open::Contents,
    record::{RecordFile, read_record},
    table::{Part, ReadOptions},
};

use super::{column, labels, metadata};

fn record(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("PALPATE_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let path = folder.join("afm-jpk").join(name);
    if path.is_file() {
        return Some(path);
    }
    eprintln!("SKIPPED: no {}; set PALPATE_DATA to the folder of real records", path.display());
    None
}

fn read(path: &Path) -> RecordFile {
    read_record(path, None, &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"))
}

/// How long the segment called `name` lasts in a record, and how much of its first force it has at its end.
fn lasting(file: &RecordFile, name: &str) -> (f64, f64) {
    let label = file.part.labels.iter().find(|label| label.name == name).expect("a label");
    let (time, force) = (file.record.time(), file.record.force());
    let last = label.end - 1;
    (time[last] - time[label.start], force[last] - force[label.start])
}

fn used(part: &Part, file: &RecordFile) -> Vec<String> {
    file.columns.iter().filter_map(|column| part.columns[column.number - 1].name.clone()).collect()
}

#[test]
fn a_held_cell() {
    let Some(path) = record("fmt-jpk-sr_cell1-0008.jpk-force") else {
        return;
    };
    let file = read(&path);
    assert_eq!(
        labels(&file.part),
        [("pause (1)", 0, 256), ("extend", 256, 2304), ("pause (2)", 2304, 9984), ("retract", 9984, 11_935)]
    );
    assert_eq!(used(&file.part, &file), ["time", "indentation", "force"]);
    assert_eq!(metadata(&file.part, "spring constant"), Some("1.0677"));
    assert_eq!(metadata(&file.part, "indentation"), Some("−(strainGaugeHeight + deflection)"));
    let (seconds, change) = lasting(&file, "pause (2)");
    assert!((seconds - 30.0).abs() < 0.01, "{seconds} s");
    // The cell relaxes under the tip: of some 400 nN a part is lost.
    assert!((-4e-7..-1e-8).contains(&change), "{change} N");
    let displacement = file.record.displacement().unwrap();
    // 20 µm of travel were requested, and the cantilever takes a little of them.
    let travel = displacement[2303] - displacement[256];
    assert!((18e-6..21e-6).contains(&travel), "{travel} m");
}

#[test]
fn four_pauses_of_ten_seconds() {
    let Some(path) = record("force-save-multi1.txt.gz") else {
        return;
    };
    let contents = Contents::open(&path, &ReadOptions::default()).unwrap();
    assert_eq!(contents.input.packing, Packing::Gzip);
    let file = read(&path);
    let rows: Vec<usize> = file.part.labels.iter().map(|label| label.end - label.start).collect();
    assert_eq!(rows, [4096, 4096, 1991, 4096, 1638, 4096, 1482, 4096, 4096]);
    assert_eq!(used(&file.part, &file), ["time", "indentation", "force"]);
    for pause in 1..=4 {
        let (seconds, _) = lasting(&file, &format!("pause ({pause})"));
        assert!((seconds - 10.0).abs() < 0.01, "{seconds} s");
    }
    // Pressed deeper for every pause.
    let displacement = file.record.displacement().unwrap();
    let depths: Vec<f64> = (1..=4)
        .map(|pause| {
            let name = format!("pause ({pause})");
            let label = file.part.labels.iter().find(|label| label.name == name).unwrap();
            displacement[label.end - 1]
        })
        .collect();
    assert!(depths.windows(2).all(|pair| pair[1] > pair[0] + 1e-7), "{depths:?}");
    // The file's own smoothed heights and forces lead to the same place of the tip, to its noise.
    let smoothed = column(&contents, "smoothedMeasuredHeight");
    let deflection = column(&contents, "cantilever deflection");
    let differ = (0..file.rows).map(|row| (displacement[row] + smoothed[row] + deflection[row]).abs());
    assert!(differ.fold(0.0, f64::max) < 2e-7);
}
