//! Bytes taken for a file and read to its end: shared by the tests of bad files and the fuzz targets `read_*`.
//!
//! | file | what |
//! |---|---|
//! | `pack.rs` | bytes put into the container of a format, so that what is inside of it is reached |
//! | `description.rs` | bytes taken for a description |

mod description;
mod pack;

use std::{collections::HashMap, io::Write};

use palpate_files::{
    description::{TestDescription, parse_test},
    input::Input,
    open::{Contents, Format},
    parquet_table::{TableError, TableReader},
    record::{ReadError, describe, read_part, tests},
    table::{Clock, ColumnKind, Columns, Part, ReadOptions},
};

pub(crate) use description::{DescriptionKind, describe_any, read_description};
pub(crate) use pack::{Kind, packed};

/// Most parts of a file that are read.
const MOST_PARTS: usize = 8;

/// Most columns of a part that are read one by one.
const MOST_COLUMNS: usize = 3;

/// What is stated of a file that is refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Complaint {
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
}

impl Complaint {
    /// What people are shown; whatever is in the file, it is text of a length that can be read.
    pub(crate) fn of(name: &str, message: String, hint: Option<String>) -> Self {
        for text in [Some(&message), hint.as_ref()].into_iter().flatten() {
            assert!(!text.trim().is_empty() && text.len() < 8192, "{} bytes: {text}", text.len());
            assert!(text.chars().all(|letter| letter == '\n' || !letter.is_control()), "{text:?}");
        }
        assert!(message.contains(name), "{message}");
        Self { message, hint }
    }
}

/// The fuzz target of a format: nothing may panic, hang, fill the memory, or break what is promised of what is read.
pub(crate) fn read_any(kind: Kind, bytes: &[u8]) {
    let file = packed(kind, bytes);
    if kind == Kind::Parquet {
        let _either = read_table(&file);
    }
    let _either = read_all("fuzzed", &file);
}

/// Everything in a table as palpate writes it.
fn read_table(bytes: &[u8]) -> Result<(), TableError> {
    let mut file = tempfile::tempfile().expect("a file");
    file.write_all(bytes).expect("a file");
    let table = TableReader::new(file)?;
    for group in 0..table.groups().min(MOST_PARTS) {
        let rows = table.read(group)?;
        assert_eq!(rows.columns.len(), table.fields().len());
    }
    Ok(())
}

/// Everything in a file: how many rows, or what `palpate analyze` says is wrong.
pub(crate) fn read_all(name: &str, bytes: &[u8]) -> Result<usize, Complaint> {
    let file = |error: &palpate_files::FileError| Complaint::of(name, error.to_string(), error.hint());
    let input = Input::from_bytes(name, bytes).map_err(|error| file(&error))?;
    let contents = Contents::of(input, &ReadOptions::default()).map_err(|error| file(&error))?;
    assert!(!contents.parts.is_empty() && contents.input.size == bytes.len() as u64);
    let mut doubt = None;
    match records(name, &contents) {
        Err((complaint, true)) => return Err(complaint),
        Err((complaint, false)) => doubt = Some(complaint),
        Ok(()) => {}
    }
    let mut rows = 0;
    for (index, part) in contents.parts.iter().enumerate().take(MOST_PARTS) {
        check(part);
        for columns in choices(part) {
            let read = contents.read(index, &columns, &mut |_, _| Ok(())).map_err(|error| file(&error))?;
            check_columns(contents.format, part, &columns, &read);
            rows += read.rows();
        }
    }
    doubt.map_or(Ok(rows), Err)
}

/// Reads every test as a record. `true`: the numbers are to blame; `false`: it is not clear which column holds what.
fn records(name: &str, contents: &Contents) -> Result<(), (Complaint, bool)> {
    let complaint = |error: &ReadError| {
        let numbers = matches!(error, ReadError::File(_) | ReadError::Record { .. } | ReadError::Strain { .. });
        (Complaint::of(name, error.to_string(), error.hint()), numbers)
    };
    let tests = tests(contents, &TestDescription::default()).map_err(|error| complaint(&error))?;
    let mut first = None;
    for &part in tests.parts.iter().take(MOST_PARTS) {
        let file = read_part(contents, part, None, &mut |_, _| Ok(()));
        let text = describe(contents, part, file.as_ref().ok(), None);
        let described = parse_test(&text, "described.toml".as_ref());
        match (file, described) {
            (Ok(file), Ok(test)) => {
                let again = read_part(contents, part, Some(&test), &mut |_, _| Ok(()));
                let again = again.unwrap_or_else(|error| panic!("{error}\n{text}"));
                assert_eq!(again.record, file.record, "{text}");
            }
            (Ok(_), Err(error)) => panic!("{error}\n{text}"),
            (Err(error), _) => first = first.or(Some(complaint(&error))),
        }
    }
    first.map_or(Ok(()), Err)
}

/// What is promised of a part before its numbers are read.
fn check(part: &Part) {
    let numbers: Vec<usize> = part.columns.iter().map(|column| column.number).collect();
    assert!(numbers.iter().copied().eq(1..=part.columns.len()), "{numbers:?}");
    for label in &part.labels {
        assert!(label.start <= label.end, "{label:?}");
    }
    for clock in &part.clocks {
        assert!(
            clock.column < clock.first && clock.first <= clock.last && clock.last <= part.columns.len(),
            "{clock:?}"
        );
    }
}

/// The columns to read: each alone, and all that hold numbers at once.
fn choices(part: &Part) -> Vec<Vec<usize>> {
    let readable = part.columns.iter().filter(|column| !matches!(column.kind, ColumnKind::Text | ColumnKind::Empty));
    let all: Vec<usize> = readable.map(|column| column.number).take(64).collect();
    let one = all.iter().take(MOST_COLUMNS).map(|column| vec![*column]);
    std::iter::once(all.clone()).filter(|all| !all.is_empty()).chain(one).collect()
}

/// What is promised of columns: as many as requested, of one length a clock, and finite.
fn check_columns(format: Format, part: &Part, columns: &[usize], read: &Columns) {
    assert_eq!(read.values.len(), columns.len());
    assert!(
        part.rows.is_none_or(|rows| read.rows() as u64 <= rows),
        "{:?} rows, {} read",
        part.rows,
        read.rows()
    );
    // What a column is one length with: the columns of its clock, else all of them.
    let clock_of = |column: usize| {
        let stamps = |clock: &Clock| clock.column == column || (clock.first..=clock.last).contains(&column);
        match part.clocks.iter().position(stamps) {
            Some(clock) => clock,
            None if part.clocks.is_empty() => 0,
            None => part.clocks.len() + column,
        }
    };
    let mut lengths: HashMap<usize, usize> = HashMap::new();
    for (column, values) in columns.iter().zip(&read.values) {
        assert!(values.len() <= read.rows());
        assert_eq!(*lengths.entry(clock_of(*column)).or_insert(values.len()), values.len());
        assert!(format == Format::RobotLog || values.iter().all(|value| value.is_finite()));
    }
    if let Some(last) = read.rows().checked_sub(1) {
        assert!(read.averaged > 1 || read.line_of(last).is_none_or(|line| line > last));
    }
}
