//! Force curves: JPK's archives and text export, Igor waves, the formats of afmformats, damage to each, and real records.

mod archives;
mod exports;
mod h5;
mod igor;
mod maps;
mod records;
mod tabs;

use palpate_files::{
    FileError,
    input::Input,
    open::Contents,
    table::{Part, ReadOptions},
};

/// Looks into `bytes`.
fn open(bytes: &[u8]) -> Result<Contents, FileError> {
    Contents::of(Input::from_bytes("curve", bytes)?, &ReadOptions::default())
}

fn opened(bytes: &[u8]) -> Contents {
    open(bytes).unwrap_or_else(|error| panic!("{error}"))
}

/// The values of the column called `name` in a part.
fn column_of(contents: &Contents, part: usize, name: &str) -> Vec<f64> {
    let number = contents.parts[part].column_named(name).unwrap_or_else(|| panic!("no column {name}")).number;
    let read = contents.read(part, &[number], &mut |_, _| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    read.values.into_iter().next().expect("one column")
}

fn column(contents: &Contents, name: &str) -> Vec<f64> {
    column_of(contents, 0, name)
}

/// Everything that can be read of a file, or the first error.
fn read_all(bytes: &[u8]) -> Result<usize, FileError> {
    let contents = open(bytes)?;
    let mut rows = 0;
    for (index, part) in contents.parts.iter().enumerate() {
        let all: Vec<usize> = (1..=part.columns.len()).collect();
        let read = contents.read(index, &all, &mut |_, _| Ok(()))?;
        assert!(read.values.iter().flatten().all(|value| value.is_finite()));
        rows += read.rows();
    }
    Ok(rows)
}

/// What reading everything says is wrong.
fn refusal(bytes: &[u8]) -> String {
    read_all(bytes).expect_err("an error").to_string()
}

fn names(part: &Part) -> Vec<&str> {
    part.columns.iter().map(|column| column.name.as_deref().expect("a name")).collect()
}

fn labels(part: &Part) -> Vec<(&str, usize, usize)> {
    part.labels.iter().map(|label| (label.name.as_str(), label.start, label.end)).collect()
}

fn metadata<'a>(part: &'a Part, name: &str) -> Option<&'a str> {
    part.metadata.iter().find(|entry| entry.name == name).map(|entry| entry.value.as_str())
}

/// Two numbers that differ by rounding alone.
fn near(left: f64, right: f64) -> bool {
    (left - right).abs() <= 1e-12 * left.abs().max(right.abs())
}

/// Cuts a file off behind every byte, and changes every byte: nothing may panic, hang, or give a number that is none.
fn damage(bytes: &[u8]) {
    for length in 0..bytes.len() {
        let _either = read_all(&bytes[..length]);
    }
    for place in 0..bytes.len() {
        let mut other = bytes.to_vec();
        other[place] ^= [0xFF, 0x01, b'9' ^ b'1'][place % 3];
        let _either = read_all(&other);
    }
}
