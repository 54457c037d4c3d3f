//! The rows of all records as one file, written whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::Path;

use palpate_files::parquet_table::{Field, TableError, TableWriter};
use serde_json::Value;

use super::journal::{Journal, Refused, folder_of};
use super::rows::{fields, table_rows};
use crate::failure::Failure;
use crate::files::{failure, place_file};

/// How the table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Csv,
    Parquet,
}

impl Format {
    /// By the ending of the name.
    pub(super) fn of(out: &Path) -> Result<Self, Failure> {
        match out.extension().and_then(|ending| ending.to_str()) {
            _ if out.is_dir() => Err(Failure::of_file(
                out,
                "expected a file to write the table to, found a directory",
                Some("choose another name with --out".to_owned()),
            )),
            Some("csv") => Ok(Self::Csv),
            Some("parquet") => Ok(Self::Parquet),
            _ => Err(Failure::of_file(
                out,
                "expected a table ending in .parquet or .csv",
                Some("name the table FILE.parquet or FILE.csv".to_owned()),
            )),
        }
    }
}

/// What was written.
#[derive(Debug, Default)]
pub(super) struct Written {
    pub(super) rows: usize,
    pub(super) tests: usize,
    pub(super) failures: Vec<Refused>,
}

/// Under which the table says what it depends on.
const MARK: &str = "palpate_batch";

/// Most bytes of a Parquet footer that are looked at.
const FOOTER: u64 = 1 << 20;

/// Whether a file is such a table: by its first line, or by a key at its end.
pub(super) fn is_table(path: &Path) -> bool {
    let marked = || -> io::Result<bool> {
        let mut file = File::open(path)?;
        let first = format!("# {MARK}: ");
        let mut bytes = Vec::new();
        if path.extension().is_some_and(|ending| ending == "parquet") {
            let length = file.seek(SeekFrom::End(0))?;
            file.seek(SeekFrom::Start(length.saturating_sub(FOOTER)))?;
            file.read_to_end(&mut bytes)?;
            return Ok(bytes.windows(MARK.len()).any(|window| window == MARK.as_bytes()));
        }
        file.take(first.len() as u64).read_to_end(&mut bytes)?;
        Ok(bytes == first.as_bytes())
    };
    marked().unwrap_or(false)
}

/// Writes the entries at `places`, one in memory at a time, with `settings` inside.
pub(super) fn write(
    out: &Path,
    format: Format,
    journal: &mut Journal,
    places: &[Range<u64>],
    settings: &str,
) -> Result<Written, Failure> {
    let mut written = Written::default();
    // In the folder of the journal, where the next batch clears away what a kill leaves behind.
    let placed = place_file(out, &folder_of(out), |file| {
        let mut sink = Sink::new(format, BufWriter::new(file), settings)?;
        for place in places {
            let entry = journal.read(place).map_err(WriteError::Journal)?;
            written.rows += entry.rows.len();
            written.tests += entry.tests;
            written.failures.extend(entry.failures);
            sink.write(&entry.rows)?;
        }
        sink.finish(settings)
    });
    match placed {
        Ok(()) => Ok(written),
        Err(WriteError::Journal(failure)) => Err(failure),
        Err(WriteError::Io(error)) => Err(failure(out, &error)),
        Err(WriteError::Table(error)) => Err(Failure::of_file(out, error, None)),
    }
}

/// Why the table could not be written.
enum WriteError {
    Journal(Failure),
    Io(io::Error),
    Table(TableError),
}

impl From<io::Error> for WriteError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<TableError> for WriteError {
    fn from(error: TableError) -> Self {
        match error {
            TableError::Io(error) => Self::Io(error),
            error => Self::Table(error),
        }
    }
}

impl From<csv::Error> for WriteError {
    fn from(error: csv::Error) -> Self {
        Self::Io(error.into())
    }
}

/// A table that takes rows.
enum Sink<W: Write + Send> {
    Csv(csv::Writer<W>),
    Parquet(TableWriter<W>, Vec<Field>),
}

impl<W: Write + Send> Sink<W> {
    fn new(format: Format, mut out: W, settings: &str) -> Result<Self, WriteError> {
        let fields = fields();
        match format {
            Format::Csv => {
                // A comment, which readers of CSV can be told to pass over; palpate passes over it by itself.
                writeln!(out, "# {MARK}: {settings}")?;
                let mut writer = csv::Writer::from_writer(out);
                writer.write_record(fields.iter().map(|field| field.name.as_str()))?;
                Ok(Self::Csv(writer))
            }
            Format::Parquet => Ok(Self::Parquet(TableWriter::new(out, &fields)?, fields)),
        }
    }

    fn write(&mut self, lines: &[Vec<Value>]) -> Result<(), WriteError> {
        match self {
            Self::Csv(writer) => {
                for line in lines {
                    writer.write_record(line.iter().map(cell))?;
                }
            }
            Self::Parquet(writer, fields) => {
                let rows = table_rows(fields, lines).ok_or(TableError::OtherColumns)?;
                writer.write(rows)?;
            }
        }
        Ok(())
    }

    fn finish(self, settings: &str) -> Result<(), WriteError> {
        match self {
            Self::Csv(mut writer) => writer.flush()?,
            Self::Parquet(writer, _) => writer.finish(&[(MARK, settings)])?,
        }
        Ok(())
    }
}

/// A value as a cell: what is missing is empty.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
