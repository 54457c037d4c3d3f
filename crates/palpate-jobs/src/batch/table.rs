//! The rows of all records as one file, written whole or not at all.

use std::ffi::OsStr;
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use palpate_files::parquet_table::{Field, TableError, TableWriter};
use palpate_report::table::{CsvLocale, csv_writer, text_cell};
use serde_json::Value;

use super::answer::Tally;
use super::parameters;
use super::rows::{self, table_rows};
use super::{Batched, Entry};
use crate::JobError;
use crate::output::{Stage, check_ending, check_no_folder, unwritten_table};
use crate::store::Store;
use crate::written_by_batch::MARK;

/// How the table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Csv,
    Parquet,
}

impl Format {
    /// By the ending of the name.
    pub(super) fn of(out: &Path) -> Result<Self, JobError> {
        check_no_folder(out)?;
        let hint = "name the table FILE.parquet or FILE.csv";
        check_ending(out, &["csv", "parquet"], "a table ending in .parquet or .csv", hint)?;
        Ok(if out.extension().is_some_and(|ending| ending == "csv") { Self::Csv } else { Self::Parquet })
    }
}

/// Writes the entries at `places`, one in memory at a time, with `settings` inside.
pub(super) fn write<'a>(
    out: &Path,
    (format, locale): (Format, CsvLocale),
    store: &Store,
    places: impl Iterator<Item = &'a Range<u64>>,
    (settings, compared): (&str, bool),
) -> Result<Batched, JobError> {
    let mut batched = Batched::default();
    let mut tally = Tally::new();
    let of_parameters = of_parameters(out);
    let refused = |error: TableError| unwritten_table(out, &error);
    let mut stage = Stage::default();
    let (mut table, mut tidy) = (stage.open(out)?, stage.open(&of_parameters)?);
    let mut sink =
        Sink::new((format, locale), BufWriter::new(&mut table), rows::fields(), settings).map_err(refused)?;
    let mut parameters =
        Sink::new((format, locale), BufWriter::new(&mut tidy), parameters::fields(), settings).map_err(refused)?;
    for place in places {
        let entry: Entry = serde_json::from_slice(&store.read(place)?)?;
        tally.add(&entry);
        batched.map.add(&entry);
        batched.rows += entry.rows.len();
        batched.tests += entry.tests;
        batched.failures.extend(entry.failures);
        sink.write(&entry.rows).map_err(refused)?;
        parameters.write(&entry.parameters).map_err(refused)?;
    }
    sink.finish(settings).map_err(refused)?;
    parameters.finish(settings).map_err(refused)?;
    stage.take(table)?;
    stage.take(tidy)?;
    stage.commit()?;
    batched.answer = tally.answer(compared);
    Ok(batched)
}

/// Where the table of parameters of a table lies: `holds_parameters.csv` beside `holds.csv`.
pub(super) fn of_parameters(out: &Path) -> PathBuf {
    let part = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    out.with_file_name(format!("{}_parameters.{}", part(out.file_stem()), part(out.extension())))
}

/// A table that takes rows.
enum Sink<W: Write + Send> {
    Csv(Box<csv::Writer<W>>, CsvLocale),
    Parquet(Box<TableWriter<W>>, Vec<Field>),
}

impl<W: Write + Send> Sink<W> {
    fn new(
        (format, locale): (Format, CsvLocale),
        mut out: W,
        fields: Vec<Field>,
        settings: &str,
    ) -> Result<Self, TableError> {
        match format {
            Format::Csv => {
                // A comment, which readers of CSV can be set to pass over; palpate passes over it by itself.
                writeln!(out, "# {MARK}: {settings}")?;
                let mut writer = csv_writer(locale).from_writer(out);
                writer.write_record(fields.iter().map(|field| field.name.as_str())).map_err(io::Error::from)?;
                Ok(Self::Csv(Box::new(writer), locale))
            }
            Format::Parquet => Ok(Self::Parquet(Box::new(TableWriter::new(out, &fields)?), fields)),
        }
    }

    fn write(&mut self, lines: &[Vec<Value>]) -> Result<(), TableError> {
        match self {
            Self::Csv(writer, locale) => {
                for line in lines {
                    writer.write_record(line.iter().map(|value| cell(value, *locale))).map_err(io::Error::from)?;
                }
            }
            Self::Parquet(writer, fields) => {
                let rows = table_rows(fields, lines).ok_or(TableError::OtherColumns)?;
                writer.write(rows)?;
            }
        }
        Ok(())
    }

    fn finish(self, settings: &str) -> Result<(), TableError> {
        match self {
            Self::Csv(mut writer, _) => writer.flush()?,
            Self::Parquet(writer, _) => writer.finish(&[(MARK, settings)])?,
        }
        Ok(())
    }
}

/// A value as a cell: what is missing is empty.
fn cell(value: &Value, locale: CsvLocale) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text_cell(text).into_owned(),
        other => locale.number(other.to_string()),
    }
}
