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
        assemble::{Channel, Draft, Load, assemble},
        curve::{Formula, Line},
        metadata, rows,
    },
    input::Input,
    table::{Found, Label, Part, ReadOptions},
};
use header::{BEGIN, Header};
use scan::{MOST_SEGMENTS, Scan, scan};

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
    let (mut curve, skipped) = assemble(vec![draft(&header, &scan)], part);
    if let Some(curve) = &mut curve {
        curve.part.labels = labels(&header, &scan);
    }
    Ok(rows::found(input, vec![header.rows], (curve, skipped)))
}

/// A value of the metadata as text.
fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The unit of a column of afmformats.
fn unit(name: &str) -> Option<&'static str> {
    match name {
        "force" => Some("N"),
        "height (measured)" | "height (piezo)" | "tip position" => Some("m"),
        "time" => Some("s"),
        _ => None,
    }
}

/// The whole table as one segment: its columns are the same from end to end.
fn draft(header: &Header, scan: &Scan) -> Draft {
    let channel = |(index, name): (usize, &String)| Channel {
        name: name.clone(),
        unit: unit(name).map(str::to_owned),
        line: Line::of(index),
    };
    let line = |name: &str| header.rows.columns.iter().position(|own| own == name).map(Line::of);
    let spring = header.metadata.get("spring constant").and_then(Value::as_f64).filter(|value| value.is_normal());
    let force = line("force");
    Draft {
        number: 0,
        style: "curve".to_owned(),
        rows: scan.rows,
        channels: header.rows.columns.iter().enumerate().map(channel).collect(),
        load: Load {
            raw: force,
            raw_unit: force.and(Some("N".to_owned())),
            force,
            deflection: force.zip(spring).map(|(force, spring)| force.then(1.0 / spring, 0.0)),
        },
        clock: line("time").map(Formula::Line),
        first: scan.first.clone(),
    }
}

/// The segments by name: approach and retract, with what is between them where they are three.
fn labels(header: &Header, scan: &Scan) -> Vec<Label> {
    let count = scan.starts.len();
    if count > MOST_SEGMENTS {
        return Vec::new();
    }
    let counted = scan.starts.iter().enumerate().all(|(index, (number, _))| *number == index as f64);
    let mode = header.metadata.get("imaging mode").and_then(Value::as_str);
    let names: &[&str] = match (counted, count, mode) {
        (true, 2, Some("force-distance")) => &["approach", "retract"],
        (true, 3, Some(_)) => &["approach", "intermediate", "retract"],
        _ => &[],
    };
    let label = |(index, (number, start)): (usize, &(f64, usize))| Label {
        name: names.get(index).map_or_else(|| format!("segment {number}"), |name| (*name).to_owned()),
        start: *start,
        end: scan.starts.get(index + 1).map_or(scan.rows, |(_, start)| *start),
    };
    scan.starts.iter().enumerate().map(label).collect()
}
