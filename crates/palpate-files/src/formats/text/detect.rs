//! Finding out how a file is written.

use super::sample::Sample;
use crate::{
    cell::{Cell, Delimiter, cells, date},
    error::{FileError, FileProblem, shorten},
    input::{Encoding, Input},
    table::{
        Block, ColumnInfo, ColumnKind, Day, Header, Layout, MOST_RESULTS, Metadata, ReadOptions, RowKind, block,
        decimal, epoch, header, metadata, names_time,
    },
};

/// Finds out how a file of delimited text is written, from at most its first 256 KiB.
///
/// What `options` fix is taken as given; the rest is judged by content, never by the name of the file.
///
/// # Errors
///
/// Where the file cannot be opened, is empty, is no delimited text ([`FileProblem::Foreign`]), has a
/// single column, no rows of numbers, or numbers that can be read in two ways ([`FileProblem::AmbiguousDecimal`]).
pub fn detect(input: &Input, options: &ReadOptions) -> Result<Layout, FileError> {
    let sample = Sample::take(input, options.encoding)?;
    let lines = sample.lines();
    let layout = rows(&lines, options).and_then(|block| of_rows(&lines, block, sample.encoding, options));
    layout.map_err(|problem| input.wrong(problem))
}

/// The rows of numbers among the lines at the beginning of a file, or of a part of one.
pub(super) fn rows(lines: &[&str], options: &ReadOptions) -> Result<Block, FileProblem> {
    let skip = options.skip_lines.unwrap_or(0).min(lines.len());
    let found = find_block(lines, behind_header(lines, skip), options);
    found.or_else(|problem| find_block(lines, skip, options).map_err(|_| problem))
}

/// The layout of lines with these rows of numbers; or of those of a table below them, if that one names a time and they do not: results, such
/// as a hardness, stand above the values that were measured.
pub(super) fn of_rows(
    lines: &[&str],
    block: Block,
    encoding: Encoding,
    options: &ReadOptions,
) -> Result<Layout, FileProblem> {
    let first = block.first;
    let headings: Vec<usize> = match options.header {
        None => (first..lines.len())
            .filter(|line| RowKind::is_heading(&block.cells[*line]))
            .take(MOST_RESULTS)
            .collect(),
        Some(_) => Vec::new(),
    };
    let layout = layout_of(lines, block, encoding, options)?;
    if names_time(&layout.columns) {
        return Ok(layout);
    }
    let below = headings.into_iter().find_map(|heading| {
        let block = find_block(lines, heading, options).ok()?;
        layout_of(lines, block, encoding, options).ok().filter(|layout| names_time(&layout.columns))
    });
    Ok(below.unwrap_or(layout))
}

fn layout_of(
    lines: &[&str],
    mut block: Block,
    encoding: Encoding,
    options: &ReadOptions,
) -> Result<Layout, FileProblem> {
    let skip = options.skip_lines.unwrap_or(0).min(lines.len());
    let decimal = decimal::decide(lines, &block, options.decimal).map_err(|doubt| FileProblem::AmbiguousDecimal {
        line: doubt.line + 1,
        found: shorten(&doubt.found),
        doubt: doubt.doubt,
    })?;
    let undecided = options.decimal.is_none() && decimal::is_unseen(&block);
    let header = header::find(lines, skip, &mut block, options.header);
    let (columns, day) = columns(lines, &block, &header);
    Ok(Layout {
        encoding,
        delimiter: block.delimiter,
        decimal,
        header_line: header.names_line.map(|index| index + 1),
        units_line: header.units_line.map(|index| index + 1),
        first_data_line: block.first + 1,
        metadata: named_values(lines, skip, &block, &header),
        thousands: decimal::thousands(lines, &block, decimal, options.decimal.is_some()),
        columns,
        day,
        undecided,
    })
}

/// Index of the line from which rows of numbers are looked for: behind the mark of the header's end, where there is one.
fn behind_header(lines: &[&str], skip: usize) -> usize {
    let ends = |line: &&str| header::ends_header(std::iter::once(metadata::without_comment_mark(line).trim()));
    lines[skip..].iter().rposition(ends).map_or(skip, |mark| skip + mark + 1)
}

fn find_block(lines: &[&str], skip: usize, options: &ReadOptions) -> Result<Block, FileProblem> {
    let fixed = options.delimiter.as_slice();
    let delimiters = if fixed.is_empty() { &Delimiter::ALL } else { fixed };
    let one_column = |block: &Block| FileProblem::OneColumn {
        line: block.first + 1,
        found: shorten(lines[block.first]),
        delimiter: options.delimiter,
    };
    match block::find(lines, skip, delimiters) {
        Some(block) if block.kinds.len() < 2 => Err(one_column(&block)),
        Some(block) => Ok(block),
        // The delimiter does not cut the rows, or there are no rows.
        None => {
            let elsewise = options.delimiter.and_then(|_| block::find(lines, skip, &Delimiter::ALL));
            Err(elsewise.map_or_else(|| without_numbers(lines, skip), |block| one_column(&block)))
        }
    }
}

/// No line holds a number; perhaps one holds names.
fn without_numbers(lines: &[&str], skip: usize) -> FileProblem {
    let separated = |line: &&str| {
        [Delimiter::Tab, Delimiter::Semicolon, Delimiter::Comma].iter().any(|&delimiter| {
            let row = cells(line, delimiter);
            row.len() > 1 && row.iter().all(|cell| cell.len() <= 60)
        })
    };
    FileProblem::NoDataRows {
        lines: lines.len(),
        header_line: lines.iter().skip(skip).position(separated).map(|index| skip + index + 1),
    }
}

fn columns(lines: &[&str], block: &Block, header: &Header) -> (Vec<ColumnInfo>, Option<Day>) {
    let rows: Vec<SplitRow<'_>> = block.rows().map(|(line, row)| (cells(lines[line], block.delimiter), row)).collect();
    let mut columns: Vec<ColumnInfo> = header
        .labels
        .iter()
        .zip(&block.kinds)
        .enumerate()
        .map(|(index, ((name, unit), &kind))| ColumnInfo {
            number: index + 1,
            name: name.clone(),
            unit: unit.clone(),
            kind: match kind {
                ColumnKind::Text if held(&rows, index).all(|(cell, _)| is_date(cell)) => ColumnKind::DateTime,
                other => other,
            },
            sample: sample(&rows, index, kind),
        })
        .collect();
    // What a delimiter at the end of every row leaves behind is no column.
    while columns.last().is_some_and(|last| last.kind == ColumnKind::Empty && last.name.is_none()) {
        columns.pop();
    }
    let day = day(&rows, &columns);
    if let Some(day) = day {
        let time = &mut columns[day.time - 1];
        time.sample = format!("{} {}", held(&rows, day.date - 1).next().map_or("", |(cell, _)| cell), time.sample);
    }
    (columns, day)
}

/// The one column of times of day and the one of dates, where there is one of each.
fn day(rows: &[SplitRow<'_>], columns: &[ColumnInfo]) -> Option<Day> {
    let only = |kind: ColumnKind, holds: &dyn Fn(&[u8]) -> bool| {
        let all = |column: &&ColumnInfo| {
            column.kind == kind && held(rows, column.number - 1).all(|(cell, _)| holds(cell.as_bytes()))
        };
        let mut found = columns.iter().filter(all);
        found.next().filter(|_| found.next().is_none()).map(|column| column.number)
    };
    let date = only(ColumnKind::Text, &|cell| date::day(cell).is_some())?;
    let time = only(ColumnKind::DateTime, &date::is_time_of_day)?;
    // Before one o'clock it is the time since the start of a test.
    epoch::is_late(&columns[time - 1].sample).then_some(Day { date, time })
}

/// Whether a cell is a date with a time of day.
fn is_date(cell: &str) -> bool {
    date::parse(cell.as_bytes()).is_some()
}

/// The cells of a row of the block, and what they are.
type SplitRow<'a> = (Vec<&'a str>, &'a [Cell]);

/// The cells of a column in the rows of the block, and what they are.
fn held<'a>(rows: &'a [SplitRow<'a>], column: usize) -> impl Iterator<Item = (&'a str, Cell)> {
    rows.iter().map(move |(texts, row)| (texts.get(column).copied().unwrap_or_default(), row[column]))
}

/// The first cell that holds anything; of texts, that keeps the column from being one of numbers.
fn sample(rows: &[SplitRow<'_>], column: usize, kind: ColumnKind) -> String {
    let mut filled = held(rows, column).filter(|(cell, _)| !cell.is_empty()).peekable();
    let first = filled.peek().copied();
    let text = match kind {
        ColumnKind::Text => filled.find(|(_, cell)| !cell.is_numeric()),
        _ => None,
    };
    text.or(first).map_or_else(String::new, |(cell, _)| shorten(cell))
}

fn named_values(lines: &[&str], skip: usize, block: &Block, header: &Header) -> Vec<Metadata> {
    (skip..block.first)
        .filter(|&index| !header.holds(index))
        .flat_map(|index| metadata::in_line(lines[index], block.delimiter))
        .collect()
}
