//! A file as one test or several, and reading their columns.

use std::ops::ControlFlow;

use arrow_schema::Field;

use super::{
    kind::{Kind, recognise},
    source::Source,
    tests::{self, Test},
    values::{self, Reading},
};
use crate::{
    cell::unit,
    error::{FileError, FileProblem, shorten},
    input::Input,
    table::{ColumnInfo, ColumnKind, Columns, Found, Part, ReadOptions, ReadPart, SkippedPart},
};

struct Table {
    source: Source,
    /// Index in the file of every column that can be read, and how.
    columns: Vec<(usize, Reading)>,
    tests: Vec<Test>,
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
            let (tests, without) = tests::reported_apart(&source, column)?;
            if without > 0 {
                skipped.push(SkippedPart::new(format!("{without} rows"), format!("nothing in column {name}")));
            }
            (tests, Some(name))
        }
        None => (vec![Test::of_all()], None),
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
    let part = |test: &Test| Part {
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
    let reader = Box::new(Table { source, columns, tests });
    Ok(Found { parts, skipped, reader })
}

fn written(kind: Kind, by: Option<&str>, test: &Test, passed: &[&str]) -> String {
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
        written.push_str(&format!(", skipped columns without single values: {}", passed.join(", ")));
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
    fn read(&self, part: usize, columns: &[usize], progress: &mut dyn FnMut(u64, u64)) -> Result<Columns, FileError> {
        let mut read = Columns::of(columns.len());
        let Some(Test { rows, .. }) = self.tests.get(part) else {
            return Ok(read);
        };
        let fields: Vec<usize> = columns.iter().map(|number| self.columns[number - 1].0).collect();
        let mut indices = fields.clone();
        indices.sort_unstable();
        indices.dedup();
        // Where in a batch every chosen column is.
        let places: Vec<usize> = fields.iter().filter_map(|field| indices.binary_search(field).ok()).collect();
        let span = rows.first().map_or(0, |rows| rows.start)..rows.last().map_or(0, |rows| rows.end);
        let size = self.source.input.size;
        let (mut next, mut row) = (0, vec![0.0; columns.len()]);
        self.source.visit(&indices, span.clone(), &mut |first, batch, (done, total)| {
            let end = first.saturating_add(batch.num_rows() as u64);
            let arrays: Option<Vec<Vec<Option<f64>>>> = batch.columns().iter().map(values::numbers).collect();
            let Some(arrays) = arrays else {
                return Err(self.text_chosen(&fields));
            };
            while let Some(stretch) = rows.get(next).filter(|stretch| stretch.start < end) {
                for number in stretch.start.max(first)..stretch.end.min(end) {
                    let index = (number - first) as usize;
                    let value = |place: &usize| arrays[*place][index];
                    if places.iter().all(|place| value(place).is_none_or(f64::is_nan)) {
                        read.ignored.blank += 1;
                        continue;
                    }
                    for (target, (place, field)) in row.iter_mut().zip(places.iter().zip(&fields)) {
                        let found = value(place);
                        let finite = found.filter(|value| value.is_finite());
                        *target = finite.ok_or_else(|| self.missing(*field, number, found))?;
                    }
                    read.push(&row, number as usize + 1);
                }
                if stretch.end > end {
                    break;
                }
                next += 1;
            }
            progress((done as f64 / total.max(1) as f64 * size as f64) as u64, size);
            Ok(if end >= span.end { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        })?;
        if read.rows() == 0 {
            let name = self.tests[part].name.as_deref().unwrap_or("the table");
            return Err(self.source.input.wrong(FileProblem::NoParts(vec![(name.to_owned(), "no rows".to_owned())])));
        }
        progress(size, size);
        read.finish();
        Ok(read)
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
