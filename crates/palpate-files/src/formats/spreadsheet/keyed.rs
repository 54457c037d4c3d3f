//! Tests of a table that one of its columns tells apart.

use std::{collections::HashSet, ops::ControlFlow, sync::Arc};

use super::{
    book::Book,
    cell::{Cell, Value},
    table::Table,
};
use crate::{
    error::FileError,
    input::Input,
    naming::Quantity,
    table::{ColumnKind, Key, KeyedTest, KeyedTests, SkippedPart, candidates},
};

/// The tests that the column of this name tells apart, each with its rows.
pub(super) struct Keyed {
    pub(super) column: String,
    pub(super) tests: Vec<(KeyedTest, Table)>,
    pub(super) skipped: Option<SkippedPart>,
}

/// Cuts a table where one of its columns tells tests apart. The sheet is gone through for a table with such a column alone.
pub(super) fn cut(input: &Input, book: &dyn Book, (sheet, table): (usize, &Table)) -> Result<Option<Keyed>, FileError> {
    let usable =
        table.columns.iter().enumerate().filter(|(_, column)| {
            matches!(column.kind, ColumnKind::Text | ColumnKind::Number) && column.unit.is_none()
        });
    let Some(key) = Key::among(usable.filter_map(|(index, column)| Some((index, column.name.as_deref()?)))) else {
        return Ok(None);
    };
    let column = table.columns[key.column].name.clone().unwrap_or_default();
    let rows = rows(book, (sheet, table), key)?;
    let cells = rows.iter().map(|row| (u64::from(row.number), row.key.as_deref()));
    let mut time = |number: u64| {
        let index = rows.binary_search_by_key(&number, |row| u64::from(row.number)).ok()?;
        rows[index].time
    };
    let found = KeyedTests::among((key, &column), &cells, &mut time).map_err(|problem| input.wrong(problem))?;
    let Some(found) = found else { return Ok(None) };
    found.check_described(&column, table.columns.len()).map_err(|problem| input.wrong(problem))?;
    let skipped = found.skipped(&column);
    let alone = |test: KeyedTest| {
        let own = test.rows.iter().map(|rows| rows.start as u32..rows.end as u32).collect();
        let table = Table {
            rows: own,
            ..table.clone()
        };
        (test, table)
    };
    let tests = found.tests.into_iter().map(alone).collect();
    Ok(Some(Keyed { column, tests, skipped }))
}

/// What a row of a table says of its test.
struct Row {
    number: u32,
    key: Option<Arc<str>>,
    time: Option<f64>,
    /// Whether it is a row of numbers.
    leads: bool,
}

/// The rows of a table. One that is none of numbers, such as a remark below them, belongs to the test above.
fn rows(book: &dyn Book, (sheet, table): (usize, &Table), key: Key) -> Result<Vec<Row>, FileError> {
    let place = |index: usize| table.places[index];
    let time = candidates(&table.columns, Quantity::Time).first().map(|column| place(column.number - 1));
    let (mut rows, mut known): (Vec<Row>, HashSet<Arc<str>>) = (Vec::new(), HashSet::new());
    book.visit(sheet, &mut |cell: Cell, _, _| {
        if !table.rows.iter().any(|rows| rows.contains(&cell.row)) || table.places.binary_search(&cell.column).is_err()
        {
            return Ok(ControlFlow::Continue(()));
        }
        if rows.last().is_none_or(|row| row.number != cell.row) {
            rows.push(Row {
                number: cell.row,
                key: None,
                time: None,
                leads: false,
            });
        }
        let Some(row) = rows.last_mut() else {
            return Ok(ControlFlow::Continue(()));
        };
        if cell.column == place(key.column) {
            let text = cell.value.text();
            let text = known.get(text.as_str()).cloned().unwrap_or_else(|| text.into());
            known.insert(Arc::clone(&text));
            row.key = Some(text);
        }
        if Some(cell.column) == time
            && let Value::Number(time) | Value::Moment(time) | Value::Duration(time) = cell.value
        {
            row.time = Some(time);
        }
        row.leads |= cell.column == place(table.leading) && cell.value.class().is_numeric();
        Ok(ControlFlow::Continue(()))
    })?;
    let mut above = None;
    for row in &mut rows {
        if !row.leads {
            row.key = above.clone();
        }
        above.clone_from(&row.key);
    }
    Ok(rows)
}
