//! A file of delimited text as a file that holds one test.

use super::{columns::read_columns, detect};
use crate::{
    error::FileError,
    input::Input,
    table::{Columns, Found, Heard, Layout, Part, ReadOptions, ReadPart},
};

/// A file of delimited text whose layout is known.
struct TextFile {
    input: Input,
    layout: Layout,
}

/// Finds out how a file of delimited text is written.
pub(crate) fn look_into(input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
    let layout = detect(input, options)?;
    let part = Part {
        written: layout.to_string(),
        columns: layout.columns.clone(),
        metadata: layout.metadata.clone(),
        ..Part::default()
    };
    Ok(Found {
        parts: vec![part],
        skipped: Vec::new(),
        reader: Box::new(TextFile {
            input: input.clone(),
            layout,
        }),
    })
}

impl ReadPart for TextFile {
    fn read(&self, _part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        read_columns(&self.input, &self.layout, columns, progress)
    }

    fn layout(&self) -> Option<&Layout> {
        Some(&self.layout)
    }
}
