//! Which rows belong to which test.

use std::ops::ControlFlow;

use super::{
    source::Source,
    values::{self, Reading},
};
use crate::{
    error::FileError,
    table::{Key, KeyedTests},
};

/// The index of the column that tells tests apart, if there is one: of texts or integers.
pub(super) fn column(source: &Source) -> Option<usize> {
    let fields = source.schema.fields().iter().enumerate();
    let usable = fields.filter(|(_, field)| {
        values::reading(field.data_type()) == Some(Reading::Text) || field.data_type().is_integer()
    });
    Key::among(usable.map(|(index, field)| (index, field.name().as_str()))).map(|key| key.column)
}

/// The tests that a column tells apart. Rows without a value belong to none.
pub(super) fn reported_apart(source: &Source, column: usize) -> Result<KeyedTests, FileError> {
    let mut tests = KeyedTests::default();
    let name = source.schema.field(column).name();
    source.visit(&[column], 0..u64::MAX, &mut |first, batch, _| {
        let texts = batch.columns().first().and_then(values::texts).unwrap_or_default();
        for (offset, text) in texts.into_iter().enumerate() {
            let added = tests.add(name, first.saturating_add(offset as u64), text.as_deref());
            added.map_err(|problem| source.input.wrong(problem))?;
        }
        Ok(ControlFlow::Continue(()))
    })?;
    Ok(tests)
}
