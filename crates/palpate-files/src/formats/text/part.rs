//! A file of delimited text as a file that holds one test, or several.

use super::{
    beside,
    channels::{self, Scale},
    columns::read_columns,
    detect, runs,
    sample::Sample,
    sections,
};
use crate::{
    error::FileError,
    input::Input,
    table::{Columns, Found, Heard, Layout, Part, ReadOptions, ReadPart},
};

/// A file of delimited text whose layout is known.
struct TextFile {
    input: Input,
    layout: Layout,
    /// Of the columns that are channels in volts.
    scales: Vec<Option<Scale>>,
}

/// Finds out how a file of delimited text is written.
pub(crate) fn look_into(input: &Input, options: &ReadOptions) -> Result<Found, FileError> {
    let sample = Sample::take(input, options.encoding)?;
    let lines = sample.lines();
    let block = detect::rows(&lines, options).map_err(|problem| input.wrong(problem))?;
    if let Some(found) = sections::look_into(input, (&lines, &block, sample.encoding), options)? {
        return Ok(found);
    }
    let mut layout =
        detect::of_rows(&lines, block, sample.encoding, options).map_err(|problem| input.wrong(problem))?;
    if let Some(found) = beside::look_into(input, (&lines, &layout), options)? {
        return Ok(found);
    }
    if let Some(found) = runs::look_into(input, (&lines, &layout), options)? {
        return Ok(found);
    }
    let scales = channels::scaled(&lines, &mut layout);
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
            scales,
        }),
    })
}

impl ReadPart for TextFile {
    fn read(&self, _part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let mut read = read_columns(&self.input, &self.layout, columns, progress)?;
        channels::apply(&self.scales, columns, &mut read).map_err(|problem| self.input.wrong(problem))?;
        Ok(read)
    }

    fn layout(&self) -> Option<&Layout> {
        Some(&self.layout)
    }
}
