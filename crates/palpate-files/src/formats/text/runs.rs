//! Several tests below one line of names: a column tells them apart, or the clock begins again.

use std::{collections::HashSet, ops::Range};

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
    table::{ColumnKind, Found, Key, KeyedTest, KeyedTests, Layout, ReadOptions, candidates, titled},
};

/// Fewest rows of a test.
const FEWEST: usize = 8;

/// A clock begins again where it returns to where it began, to this share of the time since: none that passes midnight does.
const AGAIN: f64 = 0.05;

/// Name of a test, and its lines.
type Run = (String, Vec<Range<usize>>);

/// Looks for several tests below one line of names; `None` where there is one.
pub(super) fn look_into(
    input: &Input,
    (sampled, layout): (&[&str], &Layout),
    options: &ReadOptions,
) -> Result<Option<Found>, FileError> {
    let Some(first) = sampled.get(layout.first_data_line - 1..) else {
        return Ok(None);
    };
    let key = key(layout);
    let begins_again = || match clock(input, layout) {
        Some(plan) => match restarts(first.iter().copied(), &plan) {
            Some(found) if found.is_empty() => begins_again_later(input, layout, (sampled, &plan)),
            found => Ok(found.is_some()),
        },
        None => Ok(false),
    };
    if options.header.is_some() || key.is_none() && !begins_again()? {
        return Ok(None);
    }
    let text = sections::whole(input, layout.encoding)?;
    let all = sections::numbered(&text);
    let head = layout.first_data_line - 1;
    let rows = &all[head..];
    let (mut runs, mut passed): (Vec<Run>, _) = (Vec::new(), None);
    if let Some(key) = key {
        let name = layout.columns[key.column].name.as_deref().unwrap_or_default();
        let cells =
            rows.iter().enumerate().filter(|(_, (_, line))| !line.trim().is_empty()).map(|(row, (_, line))| {
                (row as u64, Some(cell(line, layout, key.column)).filter(|cell| !cell.is_empty()))
            });
        let (plan, mut read) = (clock(input, layout), [0.0]);
        let mut time = |row: u64| {
            let (_, line) = rows.get(row as usize)?;
            plan.as_ref()?.read(line.as_bytes(), &mut read).ok().map(|()| read[0])
        };
        let tests = KeyedTests::among((key, name), &cells, &mut time).map_err(|problem| input.wrong(problem))?;
        passed = tests.as_ref().and_then(|tests| tests.skipped(name));
        let ranges = |test: &KeyedTest| {
            test.rows.iter().map(|rows| head + rows.start as usize..head + rows.end as usize).collect()
        };
        let tests = tests.into_iter().flat_map(|tests| tests.tests);
        runs = tests.map(|test| (test.title(name), ranges(&test))).collect();
    }
    if runs.is_empty()
        && let Some(plan) = clock(input, layout)
    {
        let starts = restarts(rows.iter().map(|(_, line)| *line), &plan).unwrap_or_default();
        let bounds = [0].into_iter().chain(starts).chain([rows.len()]);
        let bounds: Vec<usize> = bounds.map(|row| head + row).collect();
        let ranges = bounds.windows(2).map(|pair| std::iter::once(pair[0]..pair[1]).collect());
        runs = titles(&all, &bounds, layout).into_iter().zip(ranges).collect();
    }
    if runs.len() < 2 {
        return Ok(None);
    }
    // What stands above the names belongs to the first, and so to all.
    let skip = options.skip_lines.unwrap_or(0).min(head);
    let names = layout.header_line.map_or(head, |line| line - 1);
    let places = runs.into_iter().enumerate().map(|(number, (title, lines))| Place {
        title: Some(title),
        is_step: false,
        names: if number == 0 { skip..head } else { names..head },
        lines,
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
    let (found, mut skipped) = sections::laid_out(&all, places, (layout.encoding, &options));
    skipped.extend(passed);
    Ok(Some(sections::of_sections(input, text, found, skipped, layout.encoding)))
}

/// The column that is named as one that tells tests apart.
fn key(layout: &Layout) -> Option<Key> {
    let usable =
        layout.columns.iter().enumerate().filter(|(_, column)| {
            matches!(column.kind, ColumnKind::Text | ColumnKind::Number) && column.unit.is_none()
        });
    Key::among(usable.filter_map(|(index, column)| Some((index, column.name.as_deref()?))))
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
        } else if number > from && !line.trim_ascii().is_empty() && !is_known(line) && !plan.is_comment(line) {
            return Ok(false);
        }
    }
    Ok(false)
}

/// The cell of a column.
fn cell<'t>(line: &'t str, layout: &Layout, column: usize) -> &'t str {
    cells(line, layout.delimiter).get(column).map_or("", |cell| cell.trim())
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

/// What tests between these lines are called: by a column that has one value for each, or by their number.
fn titles(all: &[Line<'_>], bounds: &[usize], layout: &Layout) -> Vec<String> {
    let of = |column: usize| -> Option<Vec<String>> {
        let name = layout.columns[column].name.as_deref()?;
        let mut known = HashSet::new();
        let title = |pair: &[usize]| {
            let [first, last] = [pair[0], pair[1] - 1].map(|line| cell(all[line].1, layout, column));
            let is_own = !first.is_empty() && (first == last || last.is_empty()) && known.insert(first.to_owned());
            is_own.then(|| titled(name, first))
        };
        bounds.windows(2).map(title).collect()
    };
    let by_column = (0..layout.columns.len()).find_map(of);
    by_column.unwrap_or_else(|| (1..bounds.len()).map(|number| format!("run {number}")).collect())
}
