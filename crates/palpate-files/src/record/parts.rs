//! Which parts of a file are tests.

use super::{
    choose,
    error::{ColumnError, ReadError},
    lever,
};
use crate::{description::TestDescription, open::Contents, table::SkippedPart};

/// The tests in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tests {
    /// Their indices in [`Contents::parts`]; at least one.
    pub parts: Vec<usize>,
    /// Skipped parts with reasons: those that are no tests of the format, then those that lack a column.
    pub skipped: Vec<SkippedPart>,
}

/// The tests in a file: all of them, or the one that the description chooses.
///
/// Where there are several parts, those without a force or without a time are no tests and are listed as skipped. In
/// everything else that is unclear the file is taken at its word, so that reading it says what is unclear.
///
/// # Errors
/// [`ReadError::NoSuchPart`] where the description chooses a part that is not there; where no part of several is a test,
/// what is wrong with the first.
pub fn tests(contents: &Contents, description: &TestDescription) -> Result<Tests, ReadError> {
    if let Some(wanted) = &description.reading.part {
        let part = named(contents, wanted)?;
        return Ok(Tests {
            parts: vec![part],
            skipped: Vec::new(),
        });
    }
    let mut tests = Tests {
        parts: Vec::new(),
        skipped: contents.skipped.to_vec(),
    };
    let several = contents.parts.len() > 1;
    let mut first = None;
    for (index, part) in contents.parts.iter().enumerate() {
        match choose::choose(part, description) {
            Err(
                error @ (ColumnError::Missing(..) | ColumnError::NoSuchColumn { .. } | ColumnError::Oscillation(_)),
            ) if several => {
                tests.skipped.push(SkippedPart::new(part.title(), reason(&error)));
                first.get_or_insert(error);
            }
            _ => tests.parts.push(index),
        }
    }
    match first {
        Some(source) if tests.parts.is_empty() => Err(ReadError::Column {
            path: contents.input.name.clone(),
            source,
        }),
        _ => Ok(tests),
    }
}

fn reason(error: &ColumnError) -> String {
    match error {
        ColumnError::Missing(quantity, columns) if columns.iter().any(lever::turns) => {
            format!("no column of {quantity}; a torque needs the sizes of the sample in [specimen]")
        }
        ColumnError::Missing(quantity, _) => format!("no column of {quantity}"),
        ColumnError::NoSuchColumn { key, found, .. } => format!("{key}: no column {found}"),
        other => other.to_string(),
    }
}

/// The part of a name, or else of a number.
fn named(contents: &Contents, wanted: &str) -> Result<usize, ReadError> {
    let parts = &contents.parts;
    let by_name = parts.iter().position(|part| part.name.as_deref() == Some(wanted));
    let by_number = || wanted.parse::<usize>().ok()?.checked_sub(1).filter(|index| *index < parts.len());
    by_name.or_else(by_number).ok_or_else(|| ReadError::NoSuchPart {
        path: contents.input.name.clone(),
        found: wanted.to_owned(),
        parts: parts.iter().map(|part| part.title().to_owned()).collect(),
    })
}
