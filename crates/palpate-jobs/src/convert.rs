//! A record of any format as a plain table in SI.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use palpate::analysis::{corrected_watched, suspicious_signs};
use palpate::record::CorrectionOptions;
use palpate::watch::{Cancelled, Progress, Watch};
use palpate_files::parquet_table::{Field, Kind, Rows, TableError, TableWriter, Values};
use palpate_files::record::RecordFile;
use palpate_report::document::Software;
use palpate_report::table::CsvLocale;
#[cfg(feature = "xlsx")]
use palpate_report::table::{Cell, MOST_SHEET_ROWS, Table, Workbook};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[cfg(feature = "xlsx")]
use crate::ErrorKind;
use crate::input::{OpenedFile, averaged};
use crate::output::{Stage, check_ending, unwritten_table};
use crate::{JobError, Outcome};

/// Key of the provenance in the file.
const MARK: &str = "palpate_record";

/// Convert a record of any format to a plain table in SI units, with its provenance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Convert {
    /// Language of the readers of CSV: it decides decimal sign and separator.
    #[cfg_attr(feature = "clap", arg(
        long, value_name = "LANGUAGE", value_parser = crate::typed::one_of(crate::typed::CSV_LOCALES), default_value = "en",
    ))]
    pub csv_locale: CsvLocale,
}

/// A record in SI, with where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Converted {
    /// The record, corrected as its description asks.
    pub file: RecordFile,
    origin: serde_json::Value,
    csv_locale: CsvLocale,
}

impl Convert {
    /// Reads the one record of a file, and corrects it as its description asks; without any corrections requested, not even dropouts are
    /// repaired.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read or corrected, or the watch ends it.
    pub fn run(self, opened: &OpenedFile<'_>, watch: &mut dyn Watch) -> Result<Outcome<Converted>, JobError> {
        let mut file = opened.read(opened.only()?, watch)?;
        let done = |file: &RecordFile, from: usize| {
            let done = file.record.corrections()[from..].iter().map(|done| format!("done: {done}"));
            done.collect::<Vec<_>>()
        };
        let mut notes: Vec<String> = averaged(&file).into_iter().chain(done(&file, 0)).collect();
        notes.extend(
            suspicious_signs(&file.record)
                .iter()
                .map(|sign| format!("{}; {}", sign.observation(), sign.remedy())),
        );
        if file.record.displacement().is_none() {
            notes.push("the record has no displacement column: the table has time and force only".to_owned());
        }
        let options = opened.described.options();
        if options.corrections != CorrectionOptions::default() {
            let before = file.record.corrections().len();
            let place = file.path.display().to_string();
            file.record = corrected_watched(&file.record, &options, watch)
                .map_err(|error| JobError::analysis(&error, &place))?
                .record;
            notes.extend(done(&file, before));
        }
        let origin = origin(&file, opened, watch)?;
        let Self { csv_locale } = self;
        Ok(Outcome::of(Converted {
            file,
            origin,
            csv_locale,
        })
        .noted(notes))
    }
}

impl Converted {
    /// Refuses a name that says no format.
    ///
    /// # Errors
    /// [`JobError`] where it does not end in `.csv`, `.xlsx`, `.parquet` or `.json`.
    pub fn check_name(out: &Path) -> Result<(), JobError> {
        let (expected, hint) = (
            "a file ending in .csv, .xlsx, .parquet or .json",
            "name it FILE.csv, FILE.xlsx, FILE.parquet or FILE.json",
        );
        check_ending(out, &["csv", "xlsx", "parquet", "json"], expected, hint)
    }

    /// Writes the table, in the format of its name.
    ///
    /// # Errors
    /// [`JobError`] where the name says no format, the file cannot be written, or the watch ends it.
    pub fn write(&self, out: &Path, watch: &mut dyn Watch) -> Result<(), JobError> {
        Self::check_name(out)?;
        let (file, origin) = (&self.file, &self.origin);
        let workbook =
            out.extension().is_some_and(|ending| ending == "xlsx").then(|| self.workbook(out)).transpose()?;
        let mut stage = Stage::default();
        stage.file(out, |into| {
            let mut heard = HeardWriter {
                into,
                watch: &mut *watch,
                cancelled: false,
            };
            let written = match (&workbook, out.extension().and_then(|ending| ending.to_str())) {
                (Some(workbook), _) => heard.write_all(workbook).map_err(TableError::from),
                (None, Some("parquet")) => {
                    write_parquet(&mut *heard.into, file, origin, &mut || look(heard.watch, &mut heard.cancelled))
                }
                (None, Some("json")) => {
                    write_json(BufWriter::with_capacity(AT_ONCE, &mut heard), file, origin).map_err(TableError::from)
                }
                _ => {
                    let into = BufWriter::with_capacity(AT_ONCE, &mut heard);
                    write_csv(into, file, origin, self.csv_locale).map_err(TableError::from)
                }
            };
            match heard.cancelled {
                true => Err(Cancelled.into()),
                false => written.map_err(|error| unwritten_table(out, &error)),
            }
        })?;
        watch.report(Progress::open("writing", 0))?;
        stage.commit()
    }

    /// Nothing: names of workbooks are refused before.
    #[cfg(not(feature = "xlsx"))]
    fn workbook(&self, _out: &Path) -> Result<Vec<u8>, JobError> {
        Ok(Vec::new())
    }

    /// The record as a sheet of a workbook, with its provenance among the captions.
    #[cfg(feature = "xlsx")]
    fn workbook(&self, out: &Path) -> Result<Vec<u8>, JobError> {
        let rows = self.file.record.len();
        if rows > MOST_SHEET_ROWS {
            let message = format!("expected at most {MOST_SHEET_ROWS} rows for one sheet, found {rows}");
            return Err(JobError::option(message, "name it FILE.csv or FILE.parquet").of(out.display()));
        }
        let columns = columns(&self.file);
        let titled = |table: Table, (name, _): &(&str, &[f64])| match *name {
            "time_s" => table.column("Time", *name, "s"),
            "displacement_m" => table.column("Displacement", *name, "m"),
            _ => table.column("Force", *name, "N"),
        };
        let header = columns.iter().fold(Table::default(), titled);
        let about = [format!("Record in SI units; {MARK}"), self.origin.to_string()];
        let mut workbook = Workbook::default();
        let written = workbook
            .sheet("record", about, &header.columns, rows, |row, column| Cell::Number(columns[column].1[row], 6))
            .and_then(|()| workbook.finish());
        written.map_err(|error| JobError::new(ErrorKind::Report, error, None).of(out.display()))
    }
}

/// Bytes between two reports of writing.
const AT_ONCE: usize = 1 << 18;

/// A file whose writing a watch hears of, and ends.
struct HeardWriter<'a, W> {
    into: W,
    watch: &'a mut dyn Watch,
    cancelled: bool,
}

fn look(watch: &mut dyn Watch, cancelled: &mut bool) -> Result<(), Cancelled> {
    watch.report(Progress::open("writing", 0)).inspect_err(|_| *cancelled = true)
}

impl<W: Write> Write for HeardWriter<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        look(self.watch, &mut self.cancelled).map_err(io::Error::other)?;
        self.into.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.into.flush()
    }
}

/// Where the numbers come from, as one JSON object.
fn origin(file: &RecordFile, opened: &OpenedFile<'_>, watch: &mut dyn Watch) -> Result<serde_json::Value, JobError> {
    Ok(serde_json::json!({
        "schema": "palpate.record/1",
        "input": opened.input(file, None, watch)?,
        "columns": file.columns,
        "corrections": file.record.corrections(),
        "test_toml": opened.described.text,
        "software": Software::this(),
    }))
}

/// The columns that the record has, by their names.
fn columns(file: &RecordFile) -> Vec<(&'static str, &[f64])> {
    let record = &file.record;
    let mut columns = vec![("time_s", record.time())];
    columns.extend(record.displacement().map(|displacement| ("displacement_m", displacement)));
    columns.push(("force_n", record.force()));
    columns
}

fn write_csv(mut out: impl Write, file: &RecordFile, origin: &serde_json::Value, locale: CsvLocale) -> io::Result<()> {
    let columns = columns(file);
    let between = locale.separator().to_string();
    writeln!(out, "# {MARK}: {origin}")?;
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    writeln!(out, "{}", names.join(&between))?;
    for row in 0..file.record.len() {
        for (place, (_, values)) in columns.iter().enumerate() {
            let gap = if place > 0 { between.as_str() } else { "" };
            write!(out, "{gap}{}", locale.number(values[row].to_string()))?;
        }
        writeln!(out)?;
    }
    out.flush()
}

fn write_json(mut out: impl Write, file: &RecordFile, origin: &serde_json::Value) -> io::Result<()> {
    /// Written as it is gone through: as values the numbers would take four times their memory.
    #[derive(Serialize)]
    struct Document<'a> {
        #[serde(flatten)]
        origin: &'a serde_json::Value,
        #[serde(flatten)]
        columns: BTreeMap<&'static str, &'a [f64]>,
    }
    let columns = columns(file).into_iter().collect();
    serde_json::to_writer_pretty(&mut out, &Document { origin, columns })?;
    writeln!(out)?;
    out.flush()
}

fn write_parquet(
    out: impl Write + Send,
    file: &RecordFile,
    origin: &serde_json::Value,
    look: &mut dyn FnMut() -> Result<(), Cancelled>,
) -> Result<(), TableError> {
    /// Rows that are handed on together.
    const TOGETHER: usize = 1 << 16;
    let columns = columns(file);
    let fields: Vec<Field> = columns.iter().map(|(name, _)| Field::new(*name, Kind::Number)).collect();
    let mut writer = TableWriter::new(out, &fields)?;
    for start in (0..file.record.len()).step_by(TOGETHER) {
        look().map_err(io::Error::other)?;
        let rows = start..(start + TOGETHER).min(file.record.len());
        let numbers = |values: &[f64]| Values::Number(values[rows.clone()].iter().copied().map(Some).collect());
        writer.write(Rows {
            columns: columns.iter().map(|(_, values)| numbers(values)).collect(),
        })?;
    }
    writer.finish(&[(MARK, &origin.to_string())])
}
