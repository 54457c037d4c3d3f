//! A wave as a force curve, where it is one of Asylum Research, or else as a table.

use super::wave::Wave;
use crate::{
    formats::afm::{
        assemble::{Channel, Draft, Load},
        curve::{Formula, Line},
        metadata,
    },
    table::{Metadata, Part},
};

/// Most lines of a note that are taken.
const MOST_LINES: usize = 4096;

/// Columns of Asylum Research that count towards the sample, and the height that the negative of each is.
const HEIGHTS: [(&str, &str); 4] = [
    ("ZSnsr", "height (measured)"),
    ("ZSensor", "height (measured)"),
    ("Raw", "height (piezo)"),
    ("Height", "height (piezo)"),
];

/// Columns of Asylum Research that hold the deflection of the cantilever.
const DEFLECTIONS: [&str; 2] = ["Defl", "Deflection"];

/// What is known of a wave beside its numbers.
pub(super) fn about(wave: &Wave) -> Part {
    let (start, step, unit) = &wave.scale;
    let scale = (*start, *step) != (0.0, 1.0) || !unit.is_empty();
    let scale = scale.then(|| metadata("scale of the rows", format!("{start} + {step} · row {unit}").trim_end()));
    Part {
        name: None,
        written: format!("Igor binary wave {}, version {}", wave.name, wave.version),
        metadata: scale.into_iter().chain(note(wave)).collect(),
        ..Part::default()
    }
}

/// The lines `key: value` of the note, with the units that Asylum Research has them in.
fn note(wave: &Wave) -> impl Iterator<Item = Metadata> {
    let entry = |line: &str| {
        let (name, value) = line.split_once(':')?;
        let (name, value) = (name.trim(), value.trim());
        let unit = match name {
            "SpringConstant" => Some("N/m"),
            "InvOLS" => Some("m/V"),
            _ => None,
        };
        (!name.is_empty() && !value.is_empty()).then(|| Metadata {
            unit: unit.map(str::to_owned),
            ..metadata(name, value)
        })
    };
    wave.note.split(['\r', '\n']).take(MOST_LINES).filter_map(entry)
}

fn stated(wave: &Wave, name: &str) -> Option<String> {
    note(wave).find(|entry| entry.name == name).map(|entry| entry.value)
}

/// The segments of a wave: one, or those that the note of a force curve marks.
pub(super) fn drafts(wave: &Wave, bytes: &[u8]) -> Vec<Draft> {
    let unit = (!wave.unit.is_empty()).then(|| wave.unit.clone());
    let stored = |(index, label): (usize, &String)| Channel {
        name: match (label.is_empty(), wave.labels.len()) {
            (false, _) => label.clone(),
            (true, 1) => wave.name.clone(),
            (true, _) => format!("{} {}", wave.name, index + 1),
        },
        unit: unit.clone(),
        line: Line::of(index),
    };
    let stored: Vec<Channel> = wave.labels.iter().enumerate().map(stored).collect();
    let in_metres = unit.as_deref() == Some("m");
    let named = |name: &str| stored.iter().find(|channel| in_metres && channel.name == name).map(|found| found.line);
    let deflection = DEFLECTIONS.iter().find_map(|name| named(name));
    let spring = stated(wave, "SpringConstant")
        .and_then(|text| text.parse::<f64>().ok())
        .filter(|value| value.is_normal());
    let heights = HEIGHTS.iter().filter(|_| deflection.is_some()).filter_map(|(own, height)| {
        let (name, unit, line) = ((*height).to_owned(), unit.clone(), named(own)?.then(-1.0, 0.0));
        Some(Channel { name, unit, line })
    });
    let channels: Vec<Channel> = heights.chain(stored.iter().cloned()).collect();
    let load = Load {
        raw: deflection,
        raw_unit: deflection.and(unit.clone()),
        force: deflection.zip(spring).map(|(deflection, spring)| deflection.then(spring, 0.0)),
        deflection,
    };
    let value = |row: usize, column: usize| {
        let at = wave.data + (column * wave.rows + row) * wave.number.size();
        wave.number.read(&bytes[at..at + wave.number.size()], wave.lowest_first)
    };
    let (start, step, _) = wave.scale;
    let is_time = wave.scale.2 == "s" && step > 0.0 && start.is_finite() && step.is_finite();
    let segments = segments(wave);
    segments
        .windows(2)
        .enumerate()
        .map(|(number, pair)| {
            let ((_, from), (style, until)) = (pair[0], pair[1]);
            Draft {
                number,
                style: style.to_owned(),
                rows: until - from,
                channels: channels.clone(),
                load: load.clone(),
                clock: is_time.then_some(Formula::Even {
                    start: start + step * from as f64,
                    step,
                }),
                first: (from < wave.rows).then(|| (0..wave.labels.len()).map(|column| value(from, column)).collect()),
            }
        })
        .collect()
}

/// The rows at which segments end, each with what the cantilever does up to there; the first is where the first begins. The note has them as
/// `Indexes: 0,1008,2015` and `Direction: NaN,1,-1`.
fn segments(wave: &Wave) -> Vec<(&'static str, usize)> {
    let list = |name: &str| {
        stated(wave, name).map(|text| text.split(',').map(|one| one.trim().to_owned()).collect::<Vec<_>>())
    };
    let marked = || {
        let (indexes, directions) = (list("Indexes")?, list("Direction")?);
        let mut ends = vec![("", 0)];
        for (index, direction) in indexes.iter().zip(&directions).skip(1).filter(|(index, _)| !index.is_empty()) {
            let style = match direction.as_str() {
                "1" => "extend",
                "0" => "pause",
                "-1" => "retract",
                _ => return None,
            };
            ends.push((style, index.parse::<usize>().ok()?.checked_add(1)?));
        }
        let rises = ends.windows(2).all(|pair| pair[0].1 < pair[1].1);
        let starts = indexes.first().is_some_and(|first| first == "0");
        (rises && starts && ends.len() > 1 && ends.last()?.1 == wave.rows).then_some(ends)
    };
    marked().unwrap_or_else(|| vec![("", 0), ("curve", wave.rows)])
}
