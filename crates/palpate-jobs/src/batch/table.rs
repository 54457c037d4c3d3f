//! The rows of all records as one file, written whole or not at all.

use std::ffi::OsStr;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{Scope, ScopedJoinHandle};

use palpate_files::parquet_table::{Field, TableError, TableWriter};
use palpate_report::table::{CsvLocale, csv_writer, text_cell};
use serde_json::Value;

use super::answer::Tally;
use super::rows::{self, table_rows};
use super::{Batched, Entry, failures, parameters};
use crate::JobError;
use crate::output::{Stage, StagedFile, check_ending, check_no_folder, unwritten_table};
use crate::shard::{Manifest, Places, ShardTable};
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

/// Where the rows go.
pub(super) enum Out<'a> {
    /// To a table, and to that of the parameters beside it.
    Tables(&'a Path, (Format, CsvLocale)),
    /// To the tables of a slice, with the manifest that is finished once their digests are known.
    Slice(Places<'a>, Box<Manifest>),
    /// Nowhere: only the answer is wanted.
    Nowhere,
}

/// The tables of a slice, in the order in which they are written.
const KINDS: [ShardTable; 3] = [ShardTable::Parameters, ShardTable::Rows, ShardTable::Failures];

/// How entries are handed over: to a function, one after the other.
pub(super) type Taken<'a> = &'a mut dyn FnMut(Entry) -> Result<(), JobError>;

/// Writes the entries that `each` hands over, a few in memory at a time, with `settings` inside. A thread encodes each table, so that all
/// wait for the slowest alone.
pub(super) fn write(
    out: Out<'_>,
    settings: &str,
    compared: bool,
    each: impl FnOnce(Taken<'_>) -> Result<(), JobError>,
) -> Result<Batched, JobError> {
    let (mut batched, mut tally, mut stage) = (Batched::default(), Tally::new(), Stage::default());
    let paths = match &out {
        Out::Tables(path, _) => vec![of_parameters(path), path.to_path_buf()],
        Out::Slice(places, _) => KINDS.map(|kind| places.table(kind)).into(),
        Out::Nowhere => Vec::new(),
    };
    let how = if let Out::Tables(_, how) = &out { *how } else { (Format::Parquet, CsvLocale::default()) };
    let mut files = paths.iter().map(|path| stage.open(path)).collect::<Result<Vec<_>, _>>()?;
    let fields = [parameters::fields(), rows::fields(), failures::fields()];
    std::thread::scope(|scope| {
        let opened = files.iter_mut().zip(&paths).zip(fields);
        let mut tables: Vec<Written<'_>> = opened
            .map(|((file, path), fields)| Written::begin(scope, file, path, how, fields, settings))
            .collect();
        each(&mut |entry| {
            tally.add(&entry);
            batched.map.add(&entry);
            batched.rows += entry.rows.len();
            batched.tests += entry.tests;
            let failed = failures::rows(&entry.failures);
            for (table, rows) in tables.iter_mut().zip([entry.parameters, entry.rows, failed]) {
                table.write(rows)?;
            }
            batched.failures.extend(entry.failures);
            Ok(())
        })?;
        tables.iter_mut().try_for_each(Written::finish)
    })?;
    if let Out::Slice(places, mut manifest) = out {
        for (kind, file) in KINDS.into_iter().zip(&files) {
            manifest.tables.insert(kind, file.sha256()?);
        }
        (manifest.tests, manifest.rows, manifest.failed) = (batched.tests, batched.rows, batched.failures.len());
        stage.bytes(&places.manifest(), &serde_json::to_vec_pretty(&*manifest)?)?;
        // The table is the last to appear.
        files.swap(1, 2);
    }
    files.into_iter().try_for_each(|file| stage.take(file))?;
    stage.commit()?;
    batched.answer = tally.answer(compared);
    Ok(batched)
}

/// Rows that wait for the thread that encodes them, in pieces.
const WAITING: usize = 4;

/// A table that a thread encodes and writes.
struct Written<'a> {
    path: &'a Path,
    /// None once all rows are there.
    rows: Option<SyncSender<Vec<Vec<Value>>>>,
    /// None once it ended.
    thread: Option<ScopedJoinHandle<'a, Result<(), TableError>>>,
}

impl<'a> Written<'a> {
    fn begin<'scope>(
        scope: &'scope Scope<'scope, '_>,
        file: &'scope mut StagedFile,
        path: &'a Path,
        how: (Format, CsvLocale),
        fields: Vec<Field>,
        settings: &'scope str,
    ) -> Self
    where
        'scope: 'a,
    {
        let (rows, encoded) = sync_channel::<Vec<Vec<Value>>>(WAITING);
        let thread = scope.spawn(move || {
            let mut sink = Sink::new(how, BufWriter::new(file), fields, settings)?;
            encoded.into_iter().try_for_each(|rows| sink.write(rows))?;
            sink.finish(settings)
        });
        Self {
            path,
            rows: Some(rows),
            thread: Some(thread),
        }
    }

    fn write(&mut self, rows: Vec<Vec<Value>>) -> Result<(), JobError> {
        match &self.rows {
            Some(sender) if !rows.is_empty() && sender.send(rows).is_err() => self.finish(),
            _ => Ok(()),
        }
    }

    /// Waits for the end of the thread.
    fn finish(&mut self) -> Result<(), JobError> {
        self.rows = None;
        let ended = self.thread.take().map_or(Ok(Ok(())), ScopedJoinHandle::join);
        let ended = ended.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        ended.map_err(|error| unwritten_table(self.path, &error))
    }
}

/// Where columns stand in a table that has them.
pub(super) fn columns_of<const N: usize>(fields: &[Field], names: [&str; N]) -> [usize; N] {
    names.map(|name| fields.iter().position(|field| field.name == name).unwrap_or(usize::MAX))
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

    fn write(&mut self, lines: Vec<Vec<Value>>) -> Result<(), TableError> {
        match self {
            Self::Csv(writer, locale) => {
                for line in &lines {
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
