//! JPK's text export: blocks of header lines `# key: value`, each followed by the rows of one segment.
//!
//! The header of a block names its columns (`# columns:`), their units, what the segment does (`# segment:`), the
//! spring constant and the sensitivity. The values are separated by blanks, in SI.
//!
//! | file | what |
//! |---|---|
//! | `scan.rs` | finds the blocks |
//! | `segment.rs` | what the header of a block says about its columns |

mod scan;
mod segment;

use crate::{
    cell::{DecimalMark, number},
    error::{CellPlace, FileError, shorten},
    formats::afm::{
        assemble::{About, assemble},
        curve::Segment,
        metadata, not_finite, one_cell_a_column,
    },
    input::{Encoding, Input, LineReader},
    table::{ColumnInfo, Columns, Found, Metadata, Part, ReadOptions, ReadPart},
};
use scan::{Block, cells};

/// Whether a file begins like a text export: comment lines that name a segment and its columns.
pub(crate) fn recognise(input: &Input) -> bool {
    let text = String::from_utf8_lossy(input.beginning());
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let head = text.lines().take_while(|line| line.starts_with('#') || line.trim().is_empty());
    let (mut columns, mut segment) = (false, false);
    for line in head {
        let key = scan::entry(line.as_bytes()).map(|(key, _)| key);
        columns |= key.as_deref() == Some("columns");
        segment |= matches!(key.as_deref(), Some("segment" | "segmentIndex" | "fancyNames"));
    }
    columns && segment
}

/// A text export whose segments are known.
#[derive(Debug)]
struct JpkText {
    input: Input,
    columns: Vec<ColumnInfo>,
    segments: Vec<Segment>,
    blocks: Vec<Block>,
}

/// Looks into a text export, from end to end: its segments follow one another without a table of contents.
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let blocks = scan::blocks(input)?;
    let drafts = segment::drafts(input, &blocks)?;
    let about = About {
        name: None,
        written: format!("JPK text export, {} segments", blocks.len()),
        metadata: of_headers(&blocks, segment::clock_of(&drafts)),
    };
    let (curve, skipped) = assemble(drafts, about);
    let segments = curve.as_ref().map_or_else(Vec::new, |curve| curve.segments.clone());
    let parts: Vec<Part> = curve.into_iter().map(|curve| curve.part).collect();
    let columns = parts.first().map_or_else(Vec::new, |part| part.columns.clone());
    Ok(Found {
        parts,
        skipped,
        reader: Box::new(JpkText {
            input: input.clone(),
            columns,
            segments,
            blocks,
        }),
    })
}

/// The entries of the first header, and those of the others that say something else.
fn of_headers(blocks: &[Block], clock: &'static str) -> Vec<Metadata> {
    let mut seen = std::collections::HashSet::new();
    let mut all = Vec::new();
    for (key, value) in blocks.iter().flat_map(|block| &block.header) {
        let layout = matches!(key.as_str(), "columns" | "units" | "fancyNames" | "calibrationSlots" | "segment");
        if !layout && !value.is_empty() && seen.insert((key, value)) {
            all.push(metadata(key, value));
        }
    }
    all.push(metadata("time", clock));
    all
}

impl ReadPart for JpkText {
    fn read(&self, _part: usize, columns: &[usize], progress: &mut dyn FnMut(u64, u64)) -> Result<Columns, FileError> {
        let mut read = Columns::of(columns.len());
        let mut lines = LineReader::open(&self.input, Encoding::Utf8)?;
        let mut row = vec![0.0; columns.len()];
        for segment in &self.segments {
            let block = &self.blocks[segment.number];
            let chosen = segment.choose(columns);
            let mut plan = Plan {
                input: &self.input,
                block,
                channels: chosen.channels(),
                stored: vec![0.0; block.columns.len()],
            };
            let mut done = 0;
            while done < segment.rows {
                let number = lines.line() + 1;
                let Some(line) = lines.next_line()? else { break };
                if number < block.first_line || line.trim_ascii().is_empty() {
                    continue;
                }
                plan.read(line, number)?;
                chosen
                    .fill(done, &plan.stored, &mut row)
                    .map_err(|place| not_finite(&self.input, &self.columns, number, columns[place]))?;
                read.push(&row, number);
                done += 1;
            }
            let (bytes, total) = lines.progress();
            progress(bytes, total);
        }
        read.finish();
        Ok(read)
    }
}

/// How the rows of a block are read.
struct Plan<'a> {
    input: &'a Input,
    block: &'a Block,
    channels: Vec<usize>,
    stored: Vec<f64>,
}

impl Plan<'_> {
    /// Takes the wanted channels out of a row, which has one cell a channel.
    fn read(&mut self, line: &[u8], number: usize) -> Result<(), FileError> {
        let mut wanted = self.channels.iter().copied().peekable();
        let mut found = 0;
        for (index, cell) in cells(line).enumerate() {
            found += 1;
            if wanted.next_if_eq(&index).is_some() {
                let value = number::parse(cell, DecimalMark::Point);
                self.stored[index] = value.ok_or_else(|| self.no_number(cell, number, index))?;
            }
        }
        one_cell_a_column(self.input, number, self.block.columns.len(), found)
    }

    fn no_number(&self, cell: &[u8], line: usize, index: usize) -> FileError {
        let place = CellPlace {
            path: self.input.name().to_owned(),
            line,
            column: index + 1,
            name: self.block.columns.get(index).cloned(),
        };
        let found = shorten(&String::from_utf8_lossy(cell));
        match number::is_not_finite(cell) {
            true => FileError::NotFinite { place, found },
            false => FileError::TextInNumbers {
                place,
                found,
                decimal: DecimalMark::Point,
            },
        }
    }
}
