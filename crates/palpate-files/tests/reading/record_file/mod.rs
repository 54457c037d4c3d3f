//! From a file to a record: choosing columns, units, clocks, and what is requested where they are not clear.

mod choosing;
mod errors;
mod machines;
mod quantities;
mod records;
mod units;

use std::path::Path;

use palpate_files::{
    description::{TestDescription, parse_test},
    record::{ReadError, RecordFile, read_record},
};

fn described(text: &str) -> TestDescription {
    parse_test(text, Path::new("test.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// Reads `bytes` as a file `press.csv`, described by `test` (TOML) unless that is empty.
fn read(bytes: impl AsRef<[u8]>, test: &str) -> Result<RecordFile, ReadError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("press.csv");
    std::fs::write(&path, bytes).expect("a file written");
    let test = described(test);
    read_record(&path, Some(&test), &mut |_, _| Ok(()))
}
