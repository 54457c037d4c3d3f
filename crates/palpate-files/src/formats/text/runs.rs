//! Several tests below one line of names: a column tells them apart, or the clock begins again.

use std::collections::HashSet;

use super::{
    row::RowPlan,
    sample::MOST_LINES,
    sections::{self, Line, Place},
};
use crate::{
    cell::cells,
    error::FileError,
    input::{Input, LONGEST_LINE, LineReader, Packing},
    naming::Quantity,
    table::{ColumnKind, Found, Layout, ReadOptions, candidates},
};

/// Names of columns that tell tests apart, in small letters without blanks and marks; a number may stand behind each.
const NAMES: [&str; 22] = [
    "testid",
    "test",
    "testno",
    "testnumber",
    "specimen",
    "specimenid",
    "specimenno",
    "specimennumber",
    "sampleid",
    "samplename",
    "runid",
    "curveid",
    "prüfling",
    "probe",
    "probennr",
    "probennummer",
    "probenid",
    "éprouvette",
    "essai",
    "provino",
    "probeta",
    "ensayo",
];

/// Fewest rows of a test.
const FEWEST: usize = 8;

/// A clock begins again where it returns to where it began, to this share of the time since: none that passes midnight does.
const AGAIN: f64 = 0.05;

/// Looks for several tests below one line of names; `None` where there is one.
pub(super) fn look_into(
    input: &Input,
    (sampled, layout): (&[&str], &Layout),
    options: &ReadOptions,
) -> Result<Option<Found>, FileError> {
    let Some(first) = sampled.get(layout.first_data_line - 1..) else {
        return Ok(None);
    };
    let named = named(layout);
    let begins_again = || match clock(input, layout) {
        Some(plan) => match restarts(first.iter().copied(), &plan) {
            Some(found) if found.is_empty() => begins_again_later(input, layout, (sampled, &plan)),
            found => Ok(found.is_some()),
        },
        None => Ok(false),
    };
    if options.header.is_some() || named.is_none() && !begins_again()? {
        return Ok(None);
    }
    let text = sections::whole(input, layout.encoding)?;
    let all = sections::numbered(&text);
    let head = layout.first_data_line - 1;
    let rows = || all[head..].iter().map(|(_, line)| *line);
    let starts = match named.and_then(|column| changes(rows(), layout, column)) {
        Some(starts) => starts,
        None => clock(input, layout).and_then(|plan| restarts(rows(), &plan)).unwrap_or_default(),
    };
    let goes_on =
        clock(input, layout).is_some_and(|plan| starts.iter().all(|start| goes_on(&all[..head + start + 1], &plan)));
    if starts.is_empty() || goes_on {
        return Ok(None);
    }
    let bounds: Vec<usize> = [0].into_iter().chain(starts).chain([all.len() - head]).map(|row| head + row).collect();
    // What stands above the names belongs to the first, and so to all.
    let skip = options.skip_lines.unwrap_or(0).min(head);
    let names = layout.header_line.map_or(head, |line| line - 1);
    let places = bounds.windows(2).zip(titles(&all, &bounds, layout, named)).map(|(pair, title)| Place {
        title: Some(title),
        is_step: false,
        names: if pair[0] == head { skip..head } else { names..head },
        lines: pair[0]..pair[1],
    });
    let options = ReadOptions {
        delimiter: Some(layout.delimiter),
        decimal: Some(layout.decimal),
        skip_lines: None,
        part: None,
        ..options.clone()
    };
    let places: Vec<Place> = places.collect();
    sections::check_number(input, &places)?;
    let (found, skipped) = sections::laid_out(&all, places, (layout.encoding, &options));
    Ok(Some(sections::of_sections(input, text, found, skipped, layout.encoding)))
}

/// Index of the column that is named as one that tells tests apart.
fn named(layout: &Layout) -> Option<usize> {
    let tells = |name: &str| {
        let letters: String = name.to_lowercase().chars().filter(|letter| letter.is_alphabetic()).collect();
        NAMES.contains(&letters.as_str())
    };
    let usable = |kind| matches!(kind, ColumnKind::Text | ColumnKind::Number);
    layout
        .columns
        .iter()
        .position(|column| usable(column.kind) && column.unit.is_none() && column.name.as_deref().is_some_and(tells))
}

/// What reads the column of time, where one is named so.
fn clock<'l>(input: &'l Input, layout: &'l Layout) -> Option<RowPlan<'l>> {
    let times = candidates(&layout.columns, Quantity::Time);
    let time = times.iter().find(|column| column.kind == ColumnKind::Number)?;
    RowPlan::new(&input.name, layout, &[time.number]).ok()
}

/// Whether the clock steps back behind the lines looked at so far, with nothing between rows but the lines above the first of them:
/// other names would be another table.
fn begins_again_later(
    input: &Input,
    layout: &Layout,
    (sampled, plan): (&[&str], &RowPlan<'_>),
) -> Result<bool, FileError> {
    /// Largest file that is gone through for this alone (16 MiB).
    const MOST: u64 = 16 << 20;
    let from = sampled.len();
    let was_whole = from < MOST_LINES && input.size <= LONGEST_LINE as u64;
    if was_whole || input.size > MOST || input.packing != Packing::None {
        return Ok(false);
    }
    let head = &sampled[..layout.first_data_line - 1];
    let is_known = |line: &[u8]| head.iter().any(|known| known.trim().as_bytes() == line.trim_ascii());
    let mut reader = LineReader::open(input, layout.encoding)?;
    let (mut read, mut last, mut number) = ([0.0], f64::NEG_INFINITY, 0);
    while let Some(line) = reader.next_line()? {
        number += 1;
        if plan.read(line, &mut read).is_ok() {
            if read[0] < last {
                return Ok(number > from);
            }
            last = read[0];
        } else if number > from && !line.trim_ascii().is_empty() && !is_known(line) {
            return Ok(false);
        }
    }
    Ok(false)
}

/// The cell of a column.
fn cell<'t>(line: &'t str, layout: &Layout, column: usize) -> &'t str {
    cells(line, layout.delimiter).get(column).map_or("", |cell| cell.trim())
}

/// Rows at which a column changes; `None` where it tells no tests apart: some are too short, or one comes back.
fn changes<'t>(rows: impl Iterator<Item = &'t str>, layout: &Layout, column: usize) -> Option<Vec<usize>> {
    let (mut starts, mut known, mut begun, mut last) = (Vec::new(), HashSet::new(), 0, None);
    for (row, line) in rows.enumerate() {
        let found = cell(line, layout, column);
        if found.is_empty() || last == Some(found) {
            continue;
        }
        if !known.insert(found) || last.is_some() && row - begun < FEWEST {
            return None;
        }
        if last.is_some() {
            starts.push(row);
            begun = row;
        }
        last = Some(found);
    }
    (!starts.is_empty()).then_some(starts)
}

/// Whether the clock goes on to the last of these lines as it went before: parts of one test have names, too.
fn goes_on(lines: &[Line<'_>], plan: &RowPlan<'_>) -> bool {
    /// How many times the step before.
    const LONGEST: f64 = 3.0;
    let mut read = [0.0];
    let mut time = |line: &Line<'_>| plan.read(line.1.as_bytes(), &mut read).ok().map(|()| read[0]);
    let mut last = lines.iter().rev();
    let mut next = || last.next().and_then(&mut time);
    match (next(), next(), next()) {
        (Some(here), Some(before), Some(first)) => (0.0..=LONGEST * (before - first)).contains(&(here - before)),
        _ => false,
    }
}

/// Rows at which the clock begins again; `None` where it steps back elsewhere.
fn restarts<'t>(rows: impl Iterator<Item = &'t str>, plan: &RowPlan<'_>) -> Option<Vec<usize>> {
    /// Share of the time before by which the second row of a test follows the first at most: a single stamp that is wrong is no test.
    const SECOND: f64 = 0.5;
    let (mut starts, mut begun) = (Vec::new(), 0);
    let mut known: Option<(f64, f64)> = None;
    let mut latest = f64::INFINITY;
    let mut read = [0.0];
    for (row, line) in rows.enumerate() {
        if plan.read(line.as_bytes(), &mut read).is_err() {
            continue;
        }
        let [time] = read;
        known = match known {
            Some((first, last)) if time < last => {
                if row - begun < FEWEST || (time - first).abs() > AGAIN * (last - first) {
                    return None;
                }
                starts.push(row);
                begun = row;
                latest = time + SECOND * (last - first);
                Some((time, time))
            }
            Some(_) if time > latest => return None,
            Some((first, _)) => {
                latest = f64::INFINITY;
                Some((first, time))
            }
            None => Some((time, time)),
        };
    }
    Some(starts)
}

/// What tests are called: by the column that tells them apart, or by their number.
fn titles(all: &[Line<'_>], bounds: &[usize], layout: &Layout, named: Option<usize>) -> Vec<String> {
    let of = |column: usize| -> Option<Vec<String>> {
        let name = layout.columns[column].name.as_deref()?;
        let mut known = HashSet::new();
        let title = |pair: &[usize]| {
            let [first, last] = [pair[0], pair[1] - 1].map(|line| cell(all[line].1, layout, column));
            let is_own = !first.is_empty() && (first == last || last.is_empty()) && known.insert(first.to_owned());
            let is_number = first.bytes().all(|byte| byte.is_ascii_digit());
            is_own.then(|| if is_number { format!("{name} {first}") } else { first.to_owned() })
        };
        bounds.windows(2).map(title).collect()
    };
    let by_column = named.into_iter().chain(0..layout.columns.len()).find_map(of);
    by_column.unwrap_or_else(|| (1..bounds.len()).map(|number| format!("run {number}")).collect())
}
