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
    error::FileError,
    formats::afm::{assemble::assemble, metadata, rows},
    input::Input,
    table::{Found, Metadata, Part, ReadOptions},
};
use scan::Block;

/// Whether a file begins like a text export: comment lines that name a segment and its columns.
pub(crate) fn recognise(input: &Input) -> bool {
    let text = String::from_utf8_lossy(&input.beginning);
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

/// Looks into a text export, from end to end: its segments follow one another without a table of contents.
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let blocks = scan::blocks(input)?;
    let (drafts, clock) = segment::drafts(input, &blocks)?;
    let part = Part {
        written: format!("JPK text export, {} segments", blocks.len()),
        metadata: of_headers(&blocks, clock),
        ..Part::default()
    };
    let assembled = assemble(drafts, part);
    Ok(rows::found(input, blocks.into_iter().map(|block| block.layout).collect(), assembled))
}

/// The entries of the first header, and those of the others that say something else.
fn of_headers(blocks: &[Block], clock: &'static str) -> Vec<Metadata> {
    let mut observed = std::collections::HashSet::new();
    let mut all = Vec::new();
    for (key, value) in blocks.iter().flat_map(Block::header) {
        let layout = matches!(key.as_str(), "columns" | "units" | "fancyNames" | "calibrationSlots" | "segment");
        if !layout && !value.is_empty() && observed.insert((key, value)) {
            all.push(metadata(key, value));
        }
    }
    all.push(metadata("time", clock));
    all
}
