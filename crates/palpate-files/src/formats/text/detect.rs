//! Finding out how a file is written.

use std::path::Path;

use super::sample::Sample;
use crate::{
    cell::{Delimiter, cells, date},
    error::{FileError, shorten},
    input::Input,
    table::{Block, ColumnInfo, ColumnKind, Header, Layout, LayoutOptions, Metadata, block, decimal, header, metadata},
};

/// Finds out how a file of delimited text is written, from at most its first 256 KiB.
///
/// What `options` fix is taken as given; the rest is judged by content, never by the name of the file.
///
/// # Errors
///
/// Where the file cannot be opened, is empty, is no delimited text ([`FileError::Foreign`]), has a
/// single column, no rows of numbers, or numbers that can be read in two ways ([`FileError::AmbiguousDecimal`]).
pub fn detect(input: &Input, options: &LayoutOptions) -> Result<Layout, FileError> {
    let path = input.name();
    let sample = Sample::take(input, options.encoding)?;
    let lines = sample.lines();
    let skip = options.skip_lines.unwrap_or(0).min(lines.len());
    let mut block = find_block(path, &lines, skip, options)?;
    let decimal = decimal::decide(&lines, &block, options.decimal).map_err(|doubt| FileError::AmbiguousDecimal {
        path: path.to_owned(),
        line: doubt.line + 1,
        found: shorten(&doubt.found),
        doubt: doubt.doubt,
    })?;
    let undecided = options.decimal.is_none() && decimal::is_unseen(&block);
    let header = header::find(&lines, skip, &mut block, options.header);
    let columns = columns(&lines, &block, &header);
    Ok(Layout {
        encoding: sample.encoding,
        delimiter: block.delimiter,
        decimal,
        header_line: header.names_line.map(|index| index + 1),
        units_line: header.units_line.map(|index| index + 1),
        first_data_line: block.first + 1,
        metadata: named_values(&lines, skip, &block, &header),
        columns,
        undecided,
    })
}

fn find_block(path: &Path, lines: &[&str], skip: usize, options: &LayoutOptions) -> Result<Block, FileError> {
    let fixed = options.delimiter.as_slice();
    let delimiters = if fixed.is_empty() { &Delimiter::ALL } else { fixed };
    let Some(block) = block::find(lines, skip, delimiters) else {
        return Err(without_numbers(path, lines, skip, options.delimiter));
    };
    if block.kinds.len() < 2 {
        return Err(FileError::OneColumn {
            path: path.to_owned(),
            line: block.first + 1,
            found: shorten(lines[block.first]),
            delimiter: options.delimiter,
        });
    }
    Ok(block)
}

/// Why no line holds a number: the delimiter does not cut the rows, or there are no rows.
fn without_numbers(path: &Path, lines: &[&str], skip: usize, fixed: Option<Delimiter>) -> FileError {
    if let Some(elsewise) = fixed.and_then(|_| block::find(lines, skip, &Delimiter::ALL)) {
        return FileError::OneColumn {
            path: path.to_owned(),
            line: elsewise.first + 1,
            found: shorten(lines[elsewise.first]),
            delimiter: fixed,
        };
    }
    let separated = |line: &&str| {
        [Delimiter::Tab, Delimiter::Semicolon, Delimiter::Comma].iter().any(|&delimiter| {
            let row = cells(line, delimiter);
            row.len() > 1 && row.iter().all(|cell| cell.len() <= 60)
        })
    };
    FileError::NoDataRows {
        path: path.to_owned(),
        lines: lines.len(),
        header_line: lines.iter().skip(skip).position(separated).map(|index| skip + index + 1),
    }
}

fn columns(lines: &[&str], block: &Block, header: &Header) -> Vec<ColumnInfo> {
    let mut columns: Vec<ColumnInfo> = header
        .labels
        .iter()
        .zip(&block.kinds)
        .enumerate()
        .map(|(index, ((name, unit), &kind))| ColumnInfo {
            number: index + 1,
            name: name.clone(),
            unit: unit.clone(),
            kind: if kind == ColumnKind::Text && holds_dates(lines, block, index) {
                ColumnKind::DateTime
            } else {
                kind
            },
            sample: match kind {
                ColumnKind::Text => first_text(lines, block, index),
                _ => first_filled(lines, block, index),
            },
        })
        .collect();
    // What a delimiter at the end of every row leaves behind is no column.
    while columns.last().is_some_and(|last| last.kind == ColumnKind::Empty && last.name.is_none()) {
        columns.pop();
    }
    columns
}

/// Whether every cell of a column of text is a date with a time of day.
fn holds_dates(lines: &[&str], block: &Block, column: usize) -> bool {
    let is_date = |(line, _): (usize, _)| {
        let line: &str = lines[line];
        cells(line, block.delimiter).get(column).is_some_and(|cell| date::parse(cell.as_bytes()).is_some())
    };
    block.rows().all(is_date)
}

/// The first cell that keeps a column from being one of numbers.
fn first_text(lines: &[&str], block: &Block, column: usize) -> String {
    let texts = block.rows().filter(|(_, row)| row.get(column).is_some_and(|cell| !cell.is_numeric()));
    let cell = |line: usize| -> Option<&str> {
        let line: &str = lines[line];
        cells(line, block.delimiter).get(column).copied()
    };
    let first = texts.filter_map(|(line, _)| cell(line)).find(|cell| !cell.is_empty());
    first.map_or_else(|| first_filled(lines, block, column), shorten)
}

fn first_filled(lines: &[&str], block: &Block, column: usize) -> String {
    let cell = |(line, _)| -> Option<&str> {
        let line: &str = lines[line];
        cells(line, block.delimiter).get(column).copied()
    };
    block
        .rows()
        .filter_map(|(line, row)| cell((line, row)))
        .find(|cell| !cell.is_empty())
        .map_or_else(String::new, shorten)
}

fn named_values(lines: &[&str], skip: usize, block: &Block, header: &Header) -> Vec<Metadata> {
    (skip..block.first)
        .filter(|&index| header.names_line != Some(index) && header.units_line != Some(index))
        .flat_map(|index| metadata::in_line(lines[index], block.delimiter))
        .collect()
}
