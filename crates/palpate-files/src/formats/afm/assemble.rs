//! Which columns the segments of a curve make together.

use std::collections::{HashMap, HashSet};

use super::curve::{Curve, Formula, Line, Segment};
use crate::{
    error::{few, shorten},
    formats::afm::metadata,
    naming::UNCALIBRATED,
    table::{ColumnInfo, ColumnKind, Label, Metadata, Part, SkippedPart},
};

/// Names of heights, the best first: what a sensor measured before what the piezo was given, as it was before smoothed.
const HEIGHTS: [&str; 11] = [
    "measuredHeight",
    "capacitiveSensorHeight",
    "strainGaugeHeight",
    "height (measured)",
    "smoothedMeasuredHeight",
    "smoothedCapacitiveSensorHeight",
    "smoothedStrainGaugeHeight",
    "height",
    "head-height",
    "cellhesion-height",
    "height (piezo)",
];

/// Names of height + deflection, where a program has added them up already.
const TIPS: [&str; 2] = ["verticalTipPosition", "tip position"];

/// The channel that JPK's programs write the cantilever's bending to.
pub(super) const BENDING: &str = "vDeflection";

/// Most channels that are named where they are left out.
const MOST_NAMED: usize = 8;

/// A channel of a segment.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Channel {
    pub(super) name: String,
    pub(super) unit: Option<String>,
    pub(super) line: Line,
}

/// The bending of the cantilever, as far as the file is calibrated.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Load {
    /// As the file has it.
    pub(super) raw: Option<Line>,
    pub(super) raw_unit: Option<String>,
    /// In N.
    pub(super) force: Option<Line>,
    /// In m.
    pub(super) deflection: Option<Line>,
}

/// A segment as the file has it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Draft {
    /// Its number in the file, from 0.
    pub(super) number: usize,
    /// What the cantilever does: `extend`, `pause`, `retract`.
    pub(super) style: String,
    pub(super) rows: usize,
    pub(super) channels: Vec<Channel>,
    pub(super) load: Load,
    pub(super) clock: Option<Formula>,
    /// What the channels hold in the first row, where that was looked at.
    pub(super) first: Option<Vec<f64>>,
}

/// A column, with its formula in every segment.
struct Column {
    name: String,
    unit: Option<String>,
    formulas: Vec<Formula>,
}

impl Draft {
    fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }

    /// The line of a channel that is in `unit`.
    pub(super) fn line(&self, name: &str, unit: &str) -> Option<Line> {
        self.channel(name)
            .filter(|channel| channel.unit.as_deref() == Some(unit))
            .map(|channel| channel.line)
    }
}

/// Sets the clocks of all segments where each with rows has the time of the whole series; else says that it has not.
pub(super) fn set_series_clock<'a>(drafts: impl Iterator<Item = &'a mut Draft>) -> bool {
    let mut drafts: Vec<&mut Draft> = drafts.collect();
    let time = |draft: &Draft| draft.line("seriesTime", "s").map(Formula::Line);
    let known = drafts.iter().all(|draft| draft.rows == 0 || time(draft).is_some());
    if known {
        drafts.iter_mut().for_each(|draft| draft.clock = time(draft));
    }
    known
}

/// Puts the segments of a curve together; what had to be left out is stated, with why.
///
/// `part` says what is known of the curve beside its segments. Nothing comes back where no segment has rows.
pub(super) fn assemble(drafts: Vec<Draft>, mut part: Part) -> (Option<Curve>, Vec<SkippedPart>) {
    let labels = titles(&drafts);
    let (kept, skipped) = sort_out(drafts, &labels);
    let Some((_, first)) = kept.first() else {
        return (None, skipped);
    };
    let segments: Vec<&Draft> = kept.iter().map(|(_, draft)| draft).collect();
    let mut columns = derived(&segments, &mut part.metadata);
    let left_out = add_channels(&segments, &mut columns);
    if !left_out.is_empty() {
        let value = format!("{} (not in every segment)", few(left_out.into_iter(), MOST_NAMED, ", "));
        part.metadata.push(metadata("channels left out", &value));
    }
    let sample = |column: &Column| match (&first.first, column.formulas.first()) {
        (Some(stored), Some(formula)) => shorten(&format!("{:?}", formula.at(0, stored))),
        _ => "…".to_owned(),
    };
    let info = |(index, column): (usize, &Column)| ColumnInfo {
        number: index + 1,
        name: Some(column.name.clone()),
        unit: column.unit.clone(),
        kind: ColumnKind::Number,
        sample: sample(column),
    };
    part.rows = Some(segments.iter().map(|draft| draft.rows as u64).sum());
    part.columns = columns.iter().enumerate().map(info).collect();
    part.labels = in_rows(&kept);
    let segment = |(place, draft): (usize, &&Draft)| Segment {
        number: draft.number,
        rows: draft.rows,
        formulas: columns.iter().map(|column| column.formulas[place]).collect(),
    };
    let segments = segments.iter().enumerate().map(segment).collect();
    (Some(Curve { part, segments }), skipped)
}

/// What the segments are called: their style, and its how many-th where there are several of that style.
fn titles(drafts: &[Draft]) -> Vec<String> {
    let mut of_style: HashMap<&str, usize> = HashMap::new();
    drafts.iter().for_each(|draft| *of_style.entry(draft.style.as_str()).or_default() += 1);
    let mut before: HashMap<&str, usize> = HashMap::new();
    let title = |draft: &Draft, nth: usize| match of_style.get(draft.style.as_str()) {
        Some(1) => draft.style.clone(),
        _ => format!("{} ({nth})", draft.style),
    };
    let mut titles = Vec::new();
    for draft in drafts {
        let nth = before.entry(draft.style.as_str()).or_default();
        *nth += 1;
        titles.push(title(draft, *nth));
    }
    titles
}

/// Takes out segments that hold nothing, or lack what makes a test of the others.
fn sort_out(drafts: Vec<Draft>, titles: &[String]) -> (Vec<(String, Draft)>, Vec<SkippedPart>) {
    let bends = drafts.iter().any(|draft| draft.rows > 0 && draft.load.raw.is_some());
    let usable = |draft: &&Draft| draft.rows > 0 && (draft.load.raw.is_some() || !bends);
    let height = height_of(&drafts.iter().filter(usable).collect::<Vec<_>>());
    let mut skipped = Vec::new();
    let mut kept = Vec::new();
    for (draft, title) in drafts.into_iter().zip(titles) {
        let reason = if draft.rows == 0 {
            Some("it has no rows".to_owned())
        } else if bends && draft.load.raw.is_none() {
            Some("it lacks the deflection of the cantilever".to_owned())
        } else {
            height.filter(|name| draft.line(name, "m").is_none()).map(|name| format!("it lacks {name}"))
        };
        match reason {
            None => kept.push((title.clone(), draft)),
            Some(reason) => skipped.push(SkippedPart::new(format!("segment {} ({title})", draft.number), reason)),
        }
    }
    (kept, skipped)
}

/// The best height that all segments have, or else that any has.
fn height_of(drafts: &[&Draft]) -> Option<&'static str> {
    let has = |draft: &Draft, name: &str| draft.line(name, "m").is_some();
    let in_all = |name: &&&str| !drafts.is_empty() && drafts.iter().all(|draft| has(draft, name));
    let in_any = |name: &&&str| drafts.iter().any(|draft| has(draft, name));
    HEIGHTS.iter().find(in_all).or_else(|| HEIGHTS.iter().find(in_any)).copied()
}

/// Where the segments lie among the rows.
fn in_rows(kept: &[(String, Draft)]) -> Vec<Label> {
    let mut start = 0;
    let label = |(title, draft): &(String, Draft)| {
        let end = start + draft.rows;
        Label {
            name: title.clone(),
            start: std::mem::replace(&mut start, end),
            end,
        }
    };
    kept.iter().map(label).collect()
}

/// Time, force, indentation and deflection, as far as every segment gives them.
fn derived(segments: &[&Draft], about: &mut Vec<Metadata>) -> Vec<Column> {
    let mut columns = Vec::new();
    let mut add = |name: &str, unit: Option<&str>, formulas: Option<Vec<Formula>>| {
        let (name, unit, is_there) = (name.to_owned(), unit.map(str::to_owned), formulas.is_some());
        columns.extend(formulas.map(|formulas| Column { name, unit, formulas }));
        is_there
    };
    let lines = |pick: &dyn Fn(&Draft) -> Option<Line>| -> Option<Vec<Formula>> {
        segments.iter().map(|draft| pick(draft).map(Formula::Line)).collect()
    };
    add("time", Some("s"), segments.iter().map(|draft| draft.clock).collect());
    if !add("force", Some("N"), lines(&|draft| draft.load.force)) {
        let unit = segments.first().and_then(|draft| draft.load.raw_unit.as_deref());
        let same = segments.iter().all(|draft| draft.load.raw_unit.as_deref() == unit);
        if add(UNCALIBRATED, unit.filter(|_| same), lines(&|draft| draft.load.raw)) {
            about.push(metadata("force", "not calibrated: the file lacks a sensitivity or a spring constant"));
        }
    }
    let (formulas, how) = indentation(segments);
    let is_curve = height_of(segments).is_some() || segments.iter().any(|draft| draft.load.raw.is_some());
    if add("indentation", Some("m"), formulas) || is_curve {
        about.push(metadata("indentation", &how));
    }
    add("cantilever deflection", Some("m"), lines(&|draft| draft.load.deflection));
    columns
}

/// −(height + deflection) in every segment, and how it was had, or why not.
fn indentation(segments: &[&Draft]) -> (Option<Vec<Formula>>, String) {
    let with = |name: &str, deflected: bool| -> Option<Vec<Formula>> {
        let formula = |draft: &&Draft| {
            let height = draft.line(name, "m")?;
            let deflection = if deflected { Some(draft.load.deflection?) } else { None };
            Some(Formula::Indentation { height, deflection })
        };
        segments.iter().map(formula).collect()
    };
    let from_height = height_of(segments).and_then(|name| Some((with(name, true)?, format!("−({name} + deflection)"))));
    let from_tip = || TIPS.iter().find_map(|name| Some((with(name, false)?, format!("−{name}"))));
    match from_height.or_else(from_tip) {
        Some((formulas, how)) => (Some(formulas), how),
        None => (None, "none: it needs a height and a deflection in m".to_owned()),
    }
}

/// Adds the channels that every segment has; the others come back by name.
fn add_channels(segments: &[&Draft], columns: &mut Vec<Column>) -> Vec<String> {
    let mut left_out: Vec<String> = Vec::new();
    let names = segments.iter().flat_map(|draft| &draft.channels);
    let mut done = HashSet::new();
    for Channel { name, unit, .. } in names {
        if !done.insert(name) {
            continue;
        }
        let line = |draft: &&Draft| {
            let channel = draft.channel(name).filter(|channel| channel.unit == *unit)?;
            Some(Formula::Line(channel.line))
        };
        let lines: Option<Vec<Formula>> = segments.iter().map(line).collect();
        let Some(formulas) = lines else {
            left_out.push(name.clone());
            continue;
        };
        let taken = columns.iter().find(|column| column.name == *name);
        if taken.is_some_and(|column| column.formulas == formulas && column.unit == *unit) {
            continue;
        }
        let name = if taken.is_some() { format!("{name} (as in the file)") } else { name.clone() };
        columns.push(Column {
            name,
            unit: unit.clone(),
            formulas,
        });
    }
    left_out
}
