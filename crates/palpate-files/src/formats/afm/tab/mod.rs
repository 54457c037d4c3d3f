//! The text format of afmformats (`.tab`): metadata as JSON in comment lines, a comment line of names, rows.
//!
//! The names are fixed and stand for quantities in SI. Forces push when positive, heights count from the sample
//! upwards. The column `segment` counts the segments from 0.
//!
//! | file | what |
//! |---|---|
//! | `header.rs` | the comment lines |
//! | `scan.rs` | how many rows there are, and where the number of the segment changes |

mod header;
mod scan;

use serde_json::Value;

use crate::{
    error::FileError,
    formats::afm::{
        afmformats::{draft, labels},
        assemble::assemble,
        metadata, rows,
    },
    input::Input,
    table::{Found, Part, ReadOptions},
};
use header::BEGIN;
use scan::scan;

/// Whether a file begins like one of afmformats: its name in the first line, or marked metadata.
pub(crate) fn recognise(input: &Input) -> bool {
    let text = String::from_utf8_lossy(&input.beginning);
    let text = text.trim_start_matches('\u{feff}');
    let mut head = text.lines().take_while(|line| line.starts_with('#') || line.trim().is_empty());
    let named = |line: &str| line.starts_with("# afmformats ") || line.trim_end() == BEGIN;
    head.any(named)
}

/// Looks into a file, from end to end, for its segments.
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let header = header::read(input)?;
    let scan = scan(input, &header)?;
    let part = Part {
        written: "text of afmformats".to_owned(),
        metadata: header.metadata.iter().map(|(name, value)| metadata(name, &plain(value))).collect(),
        ..Part::default()
    };
    let stated = |name: &str| header.metadata.get(name);
    let spring = stated("spring constant").and_then(Value::as_f64);
    let draft = draft(&header.rows.columns, spring, scan.rows, scan.first);
    let (mut curve, skipped) = assemble(vec![draft], part);
    if let Some(curve) = &mut curve {
        curve.part.labels = labels(stated("imaging mode").and_then(Value::as_str), &scan.starts, scan.rows);
    }
    Ok(rows::found(input, vec![header.rows], (curve, skipped)))
}

/// A value of the metadata as text.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
