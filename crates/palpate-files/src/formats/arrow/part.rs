//! A file as one test or several, and reading their columns.

use std::{
    ops::{ControlFlow, Range},
    sync::{Mutex, PoisonError},
};

use arrow_array::RecordBatch;
use arrow_schema::Field;

use super::{
    kept::Kept,
    kind::{Kind, recognise},
    source::Source,
    tests,
    values::{self, Reading},
};
use crate::{
    cell::unit,
    error::{FileError, FileProblem, few, shorten, shown},
    input::Input,
    table::{
        ColumnInfo, ColumnKind, Columns, Found, Heard, KeyedTest, Part, ReadOptions, ReadPart, SkippedPart, share,
    },
};

/// Most columns that are named where they are skipped.
const MOST_NAMED: usize = 8;

struct Table {
    source: Source,
    /// Index in the file of every column that can be read, and how.
    columns: Vec<(usize, Reading)>,
    tests: Vec<KeyedTest>,
    kept: Mutex<Kept>,
}

/// Looks into a file of typed columns.
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let kind = recognise(input).unwrap_or(Kind::Stream);
    let source = Source::open(input, kind)?;
    let fields = source.schema.fields();
    let readings = fields.iter().enumerate();
    let columns: Vec<(usize, Reading)> =
        readings.filter_map(|(index, field)| Some((index, values::reading(field.data_type())?))).collect();
    let mut skipped: Vec<SkippedPart> = Vec::new();
    let (tests, by) = match tests::column(&source) {
        Some(column) => {
            let name = source.schema.field(column).name().clone();
            let reported = tests::reported_apart(&source, column)?;
            reported.check_described(&name, columns.len()).map_err(|problem| input.wrong(problem))?;
            skipped.extend(reported.skipped(&name));
            (reported.tests, Some(name))
        }
        None => (vec![KeyedTest::of_all()], None),
    };
    let samples = samples(&source, &columns)?;
    let described: Vec<ColumnInfo> = columns
        .iter()
        .zip(samples)
        .enumerate()
        .map(|(place, (&(index, reading), sample))| column(place + 1, source.schema.field(index), reading, sample))
        .collect();
    let passed: Vec<&str> = fields
        .iter()
        .filter(|field| values::reading(field.data_type()).is_none())
        .map(|field| field.name().as_str())
        .collect();
    let part = |test: &KeyedTest| Part {
        name: test.name.clone(),
        written: written(kind, by.as_deref(), test, &passed),
        rows: if by.is_some() { Some(test.count()) } else { source.rows },
        columns: described.clone(),
        ..Part::default()
    };
    let parts = if columns.is_empty() { Vec::new() } else { tests.iter().map(part).collect() };
    if parts.is_empty() {
        let reason = if columns.is_empty() { "no column of numbers" } else { "no rows" };
        skipped.push(SkippedPart::new("the table", reason));
    }
    let reader = Box::new(Table {
        source,
        columns,
        tests,
        kept: Mutex::default(),
    });
    Ok(Found { parts, skipped, reader })
}

fn written(kind: Kind, by: Option<&str>, test: &KeyedTest, passed: &[&str]) -> String {
    let mut written = match kind {
        Kind::Parquet => "Parquet",
        Kind::File => "Arrow file",
        Kind::Stream => "Arrow stream",
    }
    .to_owned();
    if let (Some(by), Some(name)) = (by, &test.name) {
        written.push_str(&format!(", rows with {by} {name}"));
    }
    if !passed.is_empty() {
        let passed = few(passed.iter().map(|name| shown(name)), MOST_NAMED, ", ");
        written.push_str(&format!(", skipped columns without single values: {passed}"));
    }
    written
}

fn column(number: usize, field: &Field, reading: Reading, sample: String) -> ColumnInfo {
    let stated = ["unit", "units"]
        .iter()
        .find_map(|key| field.metadata().get(*key))
        .filter(|unit| !unit.trim().is_empty());
    let (name, behind) = unit::split(field.name());
    let (name, unit) = match (reading, stated) {
        (Reading::Seconds, _) => (name, Some("s".to_owned())),
        // Where the name says another unit it stays whole, so that the contradiction is observed.
        (_, Some(stated)) => match unit::alone(stated) {
            unit if behind.is_none() || behind == unit => (name, unit),
            unit => (Some(field.name().clone()), unit),
        },
        (_, None) => (name, behind),
    };
    ColumnInfo {
        number,
        name,
        unit,
        kind: if reading == Reading::Text { ColumnKind::Text } else { ColumnKind::Number },
        sample,
    }
}

/// The first value of every column in the first rows.
fn samples(source: &Source, columns: &[(usize, Reading)]) -> Result<Vec<String>, FileError> {
    let indices: Vec<usize> = columns.iter().map(|(index, _)| *index).collect();
    let mut samples = vec![String::new(); columns.len()];
    if indices.is_empty() {
        return Ok(samples);
    }
    source.visit(&indices, 0..1, &mut |_, batch, _| {
        for (sample, (array, (_, reading))) in samples.iter_mut().zip(batch.columns().iter().zip(columns)) {
            let first = match reading {
                Reading::Text => values::texts(array).and_then(|all| all.into_iter().flatten().next()),
                _ => values::numbers(array)
                    .and_then(|all| all.into_iter().flatten().next().map(|value| value.to_string())),
            };
            *sample = first.map_or_else(String::new, |text| shorten(&text));
        }
        Ok(ControlFlow::Break(()))
    })?;
    Ok(samples)
}

impl ReadPart for Table {
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let Some(KeyedTest { rows, .. }) = self.tests.get(part) else {
            return Ok(Columns::of(columns.len()));
        };
        let fields: Vec<usize> = columns.iter().map(|number| self.columns[number - 1].0).collect();
        let mut indices = fields.clone();
        indices.sort_unstable();
        indices.dedup();
        let mut taking = Taking {
            table: self,
            // Where in a batch every chosen column is.
            places: fields.iter().filter_map(|field| indices.binary_search(field).ok()).collect(),
            fields,
            stretches: rows,
            row: vec![0.0; columns.len()],
            read: Columns::of(columns.len()),
        };
        let span = rows.first().map_or(0, |rows| rows.start)..rows.last().map_or(0, |rows| rows.end);
        let size = self.source.input.size;
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if self.tests.len() > 1 && kept.provide(&self.source, &indices, &span)? {
            let mut row = span.start;
            while let Some(stretch) = taking.stretches.first() {
                row = row.max(stretch.start);
                let Some((first, batch)) = kept.batch(row) else { break };
                progress(share(row.saturating_sub(span.start), span.end - span.start, size), size)?;
                taking.take(first, batch)?;
                row = first.saturating_add(batch.num_rows() as u64);
            }
        } else {
            self.source.visit(&indices, span.clone(), &mut |first, batch, (done, total)| {
                taking.take(first, batch)?;
                progress(share(done, total, size), size)?;
                let end = first.saturating_add(batch.num_rows() as u64);
                Ok(if end >= span.end { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
            })?;
        }
        let mut read = taking.read;
        if read.rows() == 0 {
            let name = self.tests[part].name.as_deref().unwrap_or("the table");
            return Err(self.source.input.wrong(FileProblem::NoParts(vec![(name.to_owned(), "no rows".to_owned())])));
        }
        progress(size, size)?;
        read.finish();
        Ok(read)
    }
}

/// Rows of a test that are taken out of batches.
struct Taking<'a> {
    table: &'a Table,
    /// The chosen columns: their indices in the file, and in a batch.
    fields: Vec<usize>,
    places: Vec<usize>,
    /// The stretches of rows that are not taken as a whole yet.
    stretches: &'a [Range<u64>],
    row: Vec<f64>,
    read: Columns,
}

impl Taking<'_> {
    /// Takes the rows of the test that a batch holds.
    fn take(&mut self, first: u64, batch: &RecordBatch) -> Result<(), FileError> {
        let end = first.saturating_add(batch.num_rows() as u64);
        while let Some(stretch) = self.stretches.first().filter(|stretch| stretch.start < end) {
            let (from, to) = (stretch.start.max(first), stretch.end.min(end));
            if from < to {
                self.take_rows(from, &batch.slice((from - first) as usize, (to - from) as usize))?;
            }
            if stretch.end > end {
                break;
            }
            self.stretches = &self.stretches[1..];
        }
        Ok(())
    }

    /// Takes all rows of a batch that begins with the row `first`.
    fn take_rows(&mut self, first: u64, batch: &RecordBatch) -> Result<(), FileError> {
        let arrays: Option<Vec<Vec<Option<f64>>>> = batch.columns().iter().map(values::numbers).collect();
        let arrays = arrays.ok_or_else(|| self.table.text_chosen(&self.fields))?;
        for number in first..first.saturating_add(batch.num_rows() as u64) {
            let index = (number - first) as usize;
            let value = |place: &usize| arrays[*place][index];
            if self.places.iter().all(|place| value(place).is_none_or(f64::is_nan)) {
                self.read.ignored.blank += 1;
                continue;
            }
            for (target, (place, field)) in self.row.iter_mut().zip(self.places.iter().zip(&self.fields)) {
                let found = value(place);
                let finite = found.filter(|value| value.is_finite());
                *target = finite.ok_or_else(|| self.table.missing(*field, number, found))?;
            }
            self.read.push(&self.row, number as usize + 1);
        }
        Ok(())
    }
}

impl Table {
    fn missing(&self, field: usize, row: u64, found: Option<f64>) -> FileError {
        let place = format!("column {}, row {}", self.source.schema.field(field).name(), row + 1);
        let found = found.map_or_else(|| "none".to_owned(), |value| value.to_string());
        let hint = "remove the row, or choose another column";
        self.source.input.wrong(FileProblem::bad_cell(&place, "a number", found, hint))
    }

    fn text_chosen(&self, fields: &[usize]) -> FileError {
        let is_text =
            |field: &&usize| values::reading(self.source.schema.field(**field).data_type()) == Some(Reading::Text);
        let field = fields.iter().find(is_text).map_or("", |field| self.source.schema.field(*field).name().as_str());
        let place = format!("column {field}");
        self.source.input.wrong(FileProblem::bad_cell(&place, "numbers", "texts", "choose another column"))
    }
}
