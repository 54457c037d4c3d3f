//! All slices of a batch as one table.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Instant;

use palpate::watch::{Progress, Watch};
use palpate_files::parquet_table::{Field, Rows, TableError, TableReader, Values};
use palpate_report::table::CsvLocale;
use serde_json::Value;

use super::table::{self, Format, Out, Taken, columns_of, of_parameters};
use super::{Batched, Entry, failures, map, parameters, rows};
use crate::output::{keep_apart, unwritten_table};
use crate::shard::{Manifest, Places, ShardTable};
use crate::{JobError, Outcome};

/// About how many rows are in memory at a time.
const AT_ONCE: usize = 1024;

/// Writes the tables of all slices, in order and each whole, as one table: the bytes of a batch of all their files.
pub(crate) fn merge(
    parts: &[(Places<'_>, Manifest)],
    out: &Path,
    maps: &[String],
    locale: CsvLocale,
    watch: &mut dyn Watch,
) -> Result<Outcome<Batched>, JobError> {
    let started = Instant::now();
    let maps: Vec<(&str, PathBuf)> = maps.iter().map(|map| map::named(out, map)).collect::<Result<_, JobError>>()?;
    let tables = [ShardTable::Rows, ShardTable::Parameters, ShardTable::Failures];
    let read = parts.iter().flat_map(|(places, _)| tables.map(|table| places.table(table)));
    let of_parameters = of_parameters(out);
    let drawn = maps.iter().map(|(_, path)| path.as_path());
    keep_apart(read, [out, &of_parameters].into_iter().chain(drawn))?;
    let Some((_, first)) = parts.first() else {
        return Err(JobError::option("expected shards, found none", "name the folder of the shards"));
    };
    let written = Out::Tables(out, (Format::of(out)?, locale));
    let mut batched = table::write(written, &first.settings, first.compared, |take| {
        for (index, (places, _)) in parts.iter().enumerate() {
            watch.report(Progress::counted("merging", index, parts.len()))?;
            each(*places, take)?;
        }
        Ok(())
    })?;
    batched.tests = parts.iter().map(|(_, manifest)| manifest.tests).sum();
    batched.draw(&maps)?;
    let files = usize::try_from(first.total).unwrap_or(usize::MAX);
    let (all, notes) = (batched.failures.is_empty(), batched.notes(out, files, 0, started));
    Ok(Outcome::of(batched).answered(all).noted(notes))
}

/// Hands over the rows of a slice, with their parameters, and its failures; a test is never divided.
pub(super) fn each(places: Places<'_>, take: Taken<'_>) -> Result<(), JobError> {
    let mut parameters = Lines::open(places.table(ShardTable::Parameters), parameters::fields())?;
    let mut lines = Lines::open(places.table(ShardTable::Rows), rows::fields())?;
    let [record, part] = columns_of(&lines.fields, ["record", "part"]);
    let of = columns_of(&parameters.fields, ["record", "part"]);
    let mut entry = Entry::default();
    while let Some(row) = lines.next()? {
        let same = |last: &Vec<Value>| (&last[record], &last[part]) == (&row[record], &row[part]);
        if !entry.rows.last().is_some_and(same) {
            if entry.rows.len() >= AT_ONCE {
                take(std::mem::take(&mut entry))?;
            }
            let test = [&row[record], &row[part]];
            while parameters.peek()?.is_some_and(|line| of.map(|column| &line[column]) == test) {
                entry.parameters.extend(parameters.next()?);
            }
        }
        entry.rows.push(row);
    }
    // Parameters of no test in the table: other files than those that belong together.
    if parameters.next()?.is_some() {
        return Err(unwritten_table(&parameters.path, &TableError::OtherColumns));
    }
    let mut refused = Lines::open(places.table(ShardTable::Failures), failures::fields())?;
    while let Some(row) = refused.next()? {
        let failure =
            failures::failure(&row).ok_or_else(|| unwritten_table(&refused.path, &TableError::OtherColumns))?;
        entry.failures.push(failure);
    }
    take(entry)
}

/// The rows of a table, one after the other.
struct Lines {
    path: PathBuf,
    table: TableReader,
    fields: Vec<Field>,
    group: usize,
    rows: Option<(Rows, usize)>,
    next: Option<Vec<Value>>,
}

impl Lines {
    fn open(path: PathBuf, fields: Vec<Field>) -> Result<Self, JobError> {
        let refused = |error: &TableError| unwritten_table(&path, error);
        let file = File::open(&path).map_err(|error| JobError::unread(&path, &error))?;
        let table = TableReader::new(file).map_err(|error| refused(&error))?;
        if table.fields() != fields {
            return Err(refused(&TableError::OtherColumns));
        }
        Ok(Self {
            path,
            table,
            fields,
            group: 0,
            rows: None,
            next: None,
        })
    }

    fn peek(&mut self) -> Result<Option<&Vec<Value>>, JobError> {
        if self.next.is_none() {
            self.next = self.next()?;
        }
        Ok(self.next.as_ref())
    }

    fn next(&mut self) -> Result<Option<Vec<Value>>, JobError> {
        if let Some(row) = self.next.take() {
            return Ok(Some(row));
        }
        loop {
            if let Some((rows, index)) = &mut self.rows
                && *index < rows.len()
            {
                *index += 1;
                return Ok(Some(rows.columns.iter_mut().map(|column| taken(column, *index - 1)).collect()));
            }
            if self.group == self.table.groups() {
                return Ok(None);
            }
            let rows = self.table.read(self.group).map_err(|error| unwritten_table(&self.path, &error))?;
            (self.rows, self.group) = (Some((rows, 0)), self.group + 1);
        }
    }
}

/// A value out of a column, which is read once.
fn taken(column: &mut Values, row: usize) -> Value {
    match column {
        Values::Count(column) => column[row].into(),
        Values::OptionalCount(column) => column[row].into(),
        Values::Number(column) => column[row].into(),
        Values::Text(column) => column[row].take().into(),
    }
}
