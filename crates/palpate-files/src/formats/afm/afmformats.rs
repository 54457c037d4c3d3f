//! What afmformats means by its columns, in whichever of its files they are.

use super::{
    assemble::{Channel, Draft, Load},
    curve::{Formula, Line},
};
use crate::table::Label;

/// Most segments that are distinguished; more are no segments.
pub(super) const MOST_SEGMENTS: usize = 4096;

/// The whole table as one segment: its columns are the same from end to end. `spring` is the spring constant in N/m.
pub(super) fn draft(columns: &[String], spring: Option<f64>, rows: usize, first: Option<Vec<f64>>) -> Draft {
    let channel = |(index, name): (usize, &String)| Channel {
        name: name.clone(),
        unit: unit(name).map(str::to_owned),
        line: Line::of(index),
    };
    let line = |name: &str| columns.iter().position(|own| own == name).map(Line::of);
    let spring = spring.filter(|value| value.is_normal());
    let force = line("force");
    Draft {
        number: 0,
        style: "curve".to_owned(),
        rows,
        channels: columns.iter().enumerate().map(channel).collect(),
        load: Load {
            raw: force,
            raw_unit: force.and(Some("N".to_owned())),
            force,
            deflection: force.zip(spring).map(|(force, spring)| force.then(1.0 / spring, 0.0)),
        },
        clock: line("time").map(Formula::Line),
        first,
    }
}

/// The unit of a column.
fn unit(name: &str) -> Option<&'static str> {
    match name {
        "force" => Some("N"),
        "height (measured)" | "height (piezo)" | "tip position" => Some("m"),
        "time" => Some("s"),
        _ => None,
    }
}

/// The segments by name: approach and retract, with what is between them where they are three. `starts` has the number of each and its first row.
pub(super) fn labels(mode: Option<&str>, starts: &[(f64, usize)], rows: usize) -> Vec<Label> {
    let count = starts.len();
    if count > MOST_SEGMENTS {
        return Vec::new();
    }
    let counted = starts.iter().enumerate().all(|(index, (number, _))| *number == index as f64);
    let names: &[&str] = match (counted, count, mode) {
        (true, 2, Some("force-distance")) => &["approach", "retract"],
        (true, 3, Some(_)) => &["approach", "intermediate", "retract"],
        _ => &[],
    };
    let label = |(index, (number, start)): (usize, &(f64, usize))| Label {
        name: names.get(index).map_or_else(|| format!("segment {number}"), |name| (*name).to_owned()),
        start: *start,
        end: starts.get(index + 1).map_or(rows, |(_, start)| *start),
    };
    starts.iter().enumerate().map(label).collect()
}
