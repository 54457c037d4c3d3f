//! What the header of a block says about its columns.

use super::scan::Block;
use crate::{
    cell::{DecimalMark, number},
    error::FileError,
    formats::afm::{
        assemble::{BENDING, Channel, Draft, Load, set_series_clock},
        curve::{Formula, Line},
    },
    input::Input,
};

/// The segments of a file, and where their time comes from, for people.
pub(super) fn drafts(input: &Input, blocks: &[Block]) -> Result<(Vec<Draft>, &'static str), FileError> {
    let draft = |(number, block)| draft(input, block, &blocks[0], number);
    let mut drafts = blocks.iter().enumerate().map(draft).collect::<Result<Vec<_>, _>>()?;
    let clock = set_clocks(blocks, &mut drafts);
    Ok((drafts, clock))
}

fn draft(input: &Input, block: &Block, first: &Block, number: usize) -> Result<Draft, FileError> {
    let units: Option<Vec<&str>> = block.value("units").map(|units| units.split_whitespace().collect());
    if let Some(units) = &units
        && block.rows > 0
        && units.len() != block.layout.columns.len()
    {
        let place = format!("segment {number}, the header above line {}", block.layout.first_line);
        let expected = format!("a unit for each of {} columns", block.layout.columns.len());
        return Err(input.damaged(place, expected, units.len().to_string()));
    }
    if let Some(count) = block.value("recorded-num-points").and_then(|count| count.parse::<usize>().ok())
        && count != block.rows
    {
        let expected = format!("{count} rows (recorded-num-points)");
        return Err(input.damaged(format!("segment {number}"), expected, block.rows.to_string()));
    }
    let unit = |index: usize| Some((*units.as_ref()?.get(index)?).to_owned());
    let channel = |(index, name): (usize, &String)| Channel {
        name: name.clone(),
        unit: unit(index),
        line: Line::of(index),
    };
    Ok(Draft {
        number,
        style: block.value("segment").unwrap_or("segment").to_owned(),
        rows: block.rows,
        channels: block.layout.columns.iter().enumerate().map(channel).collect(),
        load: load(input, (block, first), number, &unit)?,
        clock: None,
        first: numbers(block, &block.first),
    })
}

/// Force and deflection out of the one column of bending, as far as its unit and the constants lead. Constants that a
/// segment does not repeat are those above the first.
fn load(
    input: &Input,
    (block, first): (&Block, &Block),
    number: usize,
    unit: &dyn Fn(usize) -> Option<String>,
) -> Result<Load, FileError> {
    let Some(index) = block.layout.columns.iter().position(|name| name == BENDING) else {
        return Ok(Load::default());
    };
    let constant =
        |key: &str| match block.value(key).or_else(|| first.value(key)).map(|text| (text, text.parse::<f64>())) {
            None => Ok(None),
            // JPK writes NaN where it knows none.
            Some((_, Ok(value))) if value.is_nan() => Ok(None),
            Some((_, Ok(value))) if value.is_normal() => Ok(Some(value)),
            Some((text, _)) => {
                Err(input.damaged(format!("segment {number}, {key}"), "a number other than 0", text.to_owned()))
            }
        };
    let (spring, sensitivity) = (constant("springConstant")?, constant("sensitivity")?);
    let (raw, raw_unit) = (Line::of(index), unit(index));
    let deflection = match raw_unit.as_deref() {
        Some("N") => spring.map(|spring| raw.then(1.0 / spring, 0.0)),
        Some("m") => Some(raw),
        Some("V") => sensitivity.map(|sensitivity| raw.then(sensitivity, 0.0)),
        _ => None,
    };
    let force = match raw_unit.as_deref() {
        Some("N") => Some(raw),
        _ => deflection.zip(spring).map(|(deflection, spring)| deflection.then(spring, 0.0)),
    };
    Ok(Load {
        raw: Some(raw),
        raw_unit,
        force,
        deflection,
    })
}

/// Time: of the whole series where the file has it, else of each segment, put one behind the other, else of the
/// durations that were requested. Which of these is stated.
fn set_clocks(blocks: &[Block], drafts: &mut [Draft]) -> &'static str {
    const NONE: &str = "none: the file has neither a column of it nor the durations of all segments";
    if set_series_clock(drafts.iter_mut()) {
        return "seriesTime of the file";
    }
    let by_segment = drafts.iter().all(|draft| draft.rows == 0 || draft.line("time", "s").is_some());
    let mut start = 0.0;
    for (block, draft) in blocks.iter().zip(drafts).filter(|(block, _)| block.rows > 0) {
        let rows = block.rows as f64;
        if by_segment && let Some(line) = draft.line("time", "s") {
            let at = |row: &[u8]| numbers(block, row).and_then(|row| row.get(line.channel).copied());
            let (Some(first), Some(last)) = (at(&block.first), at(&block.last)) else {
                return NONE;
            };
            draft.clock = Some(Formula::Line(line.then(1.0, start)));
            // Behind its last row a segment goes on for one more step.
            let step = if rows > 1.0 { (last - first) / (rows - 1.0) } else { last };
            start += last + step;
        } else {
            // Without it for one segment, there is no time for those behind it either.
            let Some(step) = step(block) else { return NONE };
            draft.clock = Some(Formula::Even { start, step });
            start += step * rows;
        }
    }
    match by_segment {
        true => "time of the file, for consecutive segments",
        false => "computed from the requested durations and numbers of points of consecutive segments",
    }
}

/// The time between two rows, going by what was requested: a segment may have ended early.
fn step(block: &Block) -> Option<f64> {
    let number = |key: &str| block.value(key)?.parse::<f64>().ok().filter(|value| *value > 0.0 && value.is_finite());
    let index = block.value("segmentIndex")?;
    let requested = |key: &str| number(&format!("force-settings.segment.{index}.{key}"));
    if let Some(duration) = requested("duration") {
        return Some(duration / requested("num-points").unwrap_or(block.rows as f64));
    }
    let key = match block.value("segment")? {
        "extend" | "trace" => "traceScanTime",
        "retract" | "retrace" => "retraceScanTime",
        _ => return None,
    };
    Some(number(key)? / block.rows as f64)
}

/// The numbers of a row, if it holds nothing else.
fn numbers(block: &Block, row: &[u8]) -> Option<Vec<f64>> {
    block.layout.cells(row).map(|cell| number::parse(cell, DecimalMark::Point)).collect()
}
