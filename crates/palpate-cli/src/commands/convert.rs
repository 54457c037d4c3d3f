//! `palpate convert`: a record of any format as a plain table in SI.

use std::io::{self, Write};
use std::path::Path;

use palpate::analysis::{corrected, suspicious_signs};
use palpate::record::CorrectionOptions;
use palpate_files::description::TestDescription;
use palpate_files::parquet_table::{Field, Kind, Rows, TableError, TableWriter, Values};
use palpate_files::record::RecordFile;
use palpate_report::document::Software;

use super::record::{Opened, description, input, one_part, tell_skipped};
use crate::arguments::ConvertArguments;
use crate::failure::{Failure, Outcome};
use crate::files::{failure, place_file};
use crate::terminal::note;

/// Under which the file says where its numbers come from.
const MARK: &str = "palpate_record";

/// How the file is written.
#[derive(Clone, Copy)]
enum Format {
    Csv,
    Parquet,
    Json,
}

pub(crate) fn run(arguments: &ConvertArguments) -> Result<Outcome, Failure> {
    let format = format_of(&arguments.out)?;
    let test = description(arguments.test.as_deref(), arguments.part.as_deref())?;
    let opened = Opened::open(&arguments.record, test.as_ref())?;
    tell_skipped(&opened);
    let mut file = opened.read(one_part(&opened)?)?;
    for done in file.record.corrections() {
        note(&format!("done: {done}"));
    }
    for sign in suspicious_signs(&file.record) {
        note(&format!("{}; {}", sign.seen(), sign.remedy()));
    }
    if file.record.displacement().is_none() {
        note("no column of displacement was found: the table has time and force alone");
    }
    if let Some(test) = opened.test() {
        make_corrections(&mut file, test)?;
    }
    let origin = origin(&file, &opened, arguments)?;
    let out = &arguments.out;
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    place_file(out, folder, |into| {
        let into = io::BufWriter::new(into);
        match format {
            Format::Csv => write_csv(into, &file, &origin).map_err(TableError::Io),
            Format::Json => write_json(into, &file, &origin).map_err(TableError::Io),
            Format::Parquet => write_parquet(into, &file, &origin),
        }
    })
    .map_err(|error| match error {
        TableError::Io(error) => failure(out, &error),
        error => Failure::of_file(out, error, None),
    })?;
    note(&format!("{} rows written: {}", file.record.len(), out.display()));
    Ok(Outcome::Done)
}

/// Makes the corrections that a description asks for; without any, not even dropouts are mended.
fn make_corrections(file: &mut RecordFile, test: &TestDescription) -> Result<(), Failure> {
    let options = test.analysis_options();
    if options.corrections == CorrectionOptions::default() {
        return Ok(());
    }
    let before = file.record.corrections().len();
    let done =
        corrected(&file.record, &options).map_err(|error| Failure::of_file(&file.path, &error, Some(error.hint())))?;
    file.record = done.record;
    for done in &file.record.corrections()[before..] {
        note(&format!("done: {done}"));
    }
    Ok(())
}

fn format_of(out: &Path) -> Result<Format, Failure> {
    match out.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => Ok(Format::Csv),
        Some("parquet") => Ok(Format::Parquet),
        Some("json") => Ok(Format::Json),
        _ => Err(Failure::of_file(
            out,
            "expected a file ending in .csv, .parquet or .json",
            Some("name it FILE.csv, FILE.parquet or FILE.json".to_owned()),
        )),
    }
}

/// Where the numbers come from, as one JSON object.
fn origin(file: &RecordFile, opened: &Opened<'_>, arguments: &ConvertArguments) -> Result<serde_json::Value, Failure> {
    let input = input(file, None, arguments.test.as_deref(), opened.test())?;
    let said = arguments.test.as_deref().map(std::fs::read_to_string).transpose();
    Ok(serde_json::json!({
        "schema": "palpate.record/1",
        "input": input,
        "columns": file.columns,
        "corrections": file.record.corrections(),
        "test_toml": said.map_err(|error| Failure::new(error, None))?,
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

fn write_csv(mut out: impl Write, file: &RecordFile, origin: &serde_json::Value) -> io::Result<()> {
    let columns = columns(file);
    writeln!(out, "# {MARK}: {origin}")?;
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    writeln!(out, "{}", names.join(","))?;
    for row in 0..file.record.len() {
        for (place, (_, values)) in columns.iter().enumerate() {
            let gap = if place > 0 { "," } else { "" };
            write!(out, "{gap}{}", values[row])?;
        }
        writeln!(out)?;
    }
    out.flush()
}

fn write_json(mut out: impl Write, file: &RecordFile, origin: &serde_json::Value) -> io::Result<()> {
    let mut document = origin.clone();
    for (name, values) in columns(file) {
        document[name] = values.into();
    }
    serde_json::to_writer_pretty(&mut out, &document)?;
    writeln!(out)?;
    out.flush()
}

fn write_parquet(out: impl Write + Send, file: &RecordFile, origin: &serde_json::Value) -> Result<(), TableError> {
    let columns = columns(file);
    let fields: Vec<Field> = columns.iter().map(|(name, _)| Field::new(*name, Kind::Number)).collect();
    let mut writer = TableWriter::new(out, &fields)?;
    writer.write(Rows {
        columns: columns
            .iter()
            .map(|(_, values)| Values::Number(values.iter().copied().map(Some).collect()))
            .collect(),
    })?;
    writer.finish(&[(MARK, &origin.to_string())])
}
