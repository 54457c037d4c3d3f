//! Logs of robots: MCAP files written here by the reference library, their messages encoded by hand.

mod damage;
mod grippers;
mod reading;
mod writing;
mod written;

use std::path::Path;

use palpate_files::{
    FileError,
    description::parse_test,
    input::Input,
    open::Contents,
    record::{ReadError, RecordFile, read_part, tests},
    table::ReadOptions,
};

fn look(bytes: &[u8]) -> Result<Contents, FileError> {
    Contents::of(Input::from_bytes("log.mcap", bytes)?, &ReadOptions::default())
}

fn opened(bytes: &[u8]) -> Contents {
    look(bytes).unwrap_or_else(|error| panic!("{error}"))
}

/// The record in a log, described by `test` (TOML).
fn record(bytes: &[u8], test: &str) -> Result<RecordFile, ReadError> {
    let test = parse_test(test, Path::new("test.toml")).unwrap_or_else(|error| panic!("{error}"));
    let contents = look(bytes)?;
    let parts = tests(&contents, &test)?.parts;
    assert_eq!(parts, [0]);
    read_part(&contents, 0, Some(&test), &mut |_, _| Ok(()))
}

/// The names of all columns of a log.
fn names(contents: &Contents) -> Vec<&str> {
    let columns = contents.parts.iter().flat_map(|part| &part.columns);
    columns.filter_map(|column| column.name.as_deref()).collect()
}

/// The values of one column of a log.
fn values(contents: &Contents, name: &str) -> Vec<f64> {
    let column = contents.parts[0].column_named(name).unwrap_or_else(|| panic!("{name} in {:?}", names(contents)));
    let mut read = contents.read(0, &[column.number], &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    read.values.remove(0)
}
