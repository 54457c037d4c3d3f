//! Which rows belong to which test.

use std::{
    collections::HashMap,
    ops::{ControlFlow, Range},
};

use arrow_schema::Field;

use super::{
    source::Source,
    values::{self, Reading},
};
use crate::error::{FileError, FileProblem};

/// Names of a column that tells tests apart.
const NAMES: [&str; 4] = ["test_id", "test", "specimen_id", "sample_id"];

/// Most tests in one file.
const MOST_TESTS: usize = 1 << 16;
/// Most stretches of rows that are remembered.
const MOST_STRETCHES: usize = 1 << 22;

/// The rows of one test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Test {
    /// What the column says; `None` where the file is one test.
    pub(super) name: Option<String>,
    /// Its rows, rising.
    pub(super) rows: Vec<Range<u64>>,
}

impl Test {
    /// Every row of a file that is one test.
    pub(super) fn of_all() -> Self {
        Self {
            name: None,
            rows: std::iter::once(0..u64::MAX).collect(),
        }
    }

    pub(super) fn count(&self) -> u64 {
        self.rows.iter().map(|rows| rows.end - rows.start).sum()
    }
}

/// The index of the column that tells tests apart, if there is one.
pub(super) fn column(source: &Source) -> Option<usize> {
    let fits = |field: &Field, name: &str| {
        let kind = values::reading(field.data_type());
        let usable = kind == Some(Reading::Text) || field.data_type().is_integer();
        usable && field.name().eq_ignore_ascii_case(name)
    };
    let fields = source.schema.fields();
    NAMES.iter().find_map(|name| fields.iter().position(|field| fits(field, name)))
}

/// The tests that a column tells apart, in the order in which they appear. Rows without a value belong to none.
///
/// The second number is how many rows have no value.
pub(super) fn reported_apart(source: &Source, column: usize) -> Result<(Vec<Test>, u64), FileError> {
    let mut tests: Vec<Test> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    let (mut stretches, mut without) = (0, 0);
    let name = source.schema.field(column).name();
    let too_many = |what: &str, most: usize| {
        let hint = "rename the column if it does not identify tests, or sort the rows by it";
        let expected = format!("at most {most} {what}");
        source.input.wrong(FileProblem::bad_cell(&format!("column {name}"), expected, "more", hint))
    };
    source.visit(&[column], 0..u64::MAX, &mut |first, batch, _| {
        let texts = batch.columns().first().and_then(values::texts).unwrap_or_default();
        for (offset, text) in texts.into_iter().enumerate() {
            let row = first.saturating_add(offset as u64);
            let Some(text) = text else {
                without += 1;
                continue;
            };
            let place = *places.entry(text).or_insert_with_key(|text| {
                tests.push(Test {
                    name: Some(text.clone()),
                    rows: Vec::new(),
                });
                tests.len() - 1
            });
            match tests[place].rows.last_mut() {
                Some(rows) if rows.end == row => rows.end += 1,
                _ => {
                    stretches += 1;
                    tests[place].rows.push(row..row.saturating_add(1));
                }
            }
            if tests.len() > MOST_TESTS {
                return Err(too_many("tests", MOST_TESTS));
            }
            if stretches > MOST_STRETCHES {
                return Err(too_many("changes from test to test", MOST_STRETCHES));
            }
        }
        Ok(ControlFlow::Continue(()))
    })?;
    Ok((tests, without))
}
