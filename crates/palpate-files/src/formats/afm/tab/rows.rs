//! The rows below the header, and the segments they belong to.

use super::header::Header;
use crate::{
    cell::{DecimalMark, number},
    error::{CellPlace, FileError, shorten},
    formats::afm::one_cell_a_column,
    input::{Encoding, Input, LineReader},
};

/// Most segments that are told apart; more are no segments.
pub(super) const MOST_SEGMENTS: usize = 4096;

/// Rows, and where the number of the segment changes.
#[derive(Debug, Default)]
pub(super) struct Scan {
    pub(super) rows: usize,
    pub(super) first: Option<Vec<f64>>,
    /// Number of a segment and its first row.
    pub(super) starts: Vec<(f64, usize)>,
}

pub(super) fn scan(input: &Input, header: &Header) -> Result<Scan, FileError> {
    let segment = header.columns.iter().position(|name| name == "segment");
    let channels: Vec<usize> = segment.into_iter().collect();
    let mut stored = vec![0.0; header.columns.len()];
    let mut scan = Scan::default();
    let mut rows = Rows::open(input)?;
    while let Some((line, number)) = rows.next()? {
        if scan.rows == 0 {
            let all: Vec<usize> = (0..header.columns.len()).collect();
            row(input, header, &line, number, &all, &mut stored)?;
            scan.first = Some(stored.clone());
        } else {
            row(input, header, &line, number, &channels, &mut stored)?;
        }
        if let Some(segment) = segment {
            let changes = scan.starts.last().is_none_or(|(last, _)| *last != stored[segment]);
            if changes && scan.starts.len() <= MOST_SEGMENTS {
                scan.starts.push((stored[segment], scan.rows));
            }
        }
        scan.rows += 1;
    }
    Ok(scan)
}

/// The rows of a file, line by line.
pub(super) struct Rows<'a> {
    pub(super) lines: LineReader<'a>,
}

impl<'a> Rows<'a> {
    pub(super) fn open(input: &'a Input) -> Result<Self, FileError> {
        Ok(Self {
            lines: LineReader::open(input, Encoding::Utf8)?,
        })
    }

    /// The next line that is neither blank nor a comment, with its number.
    pub(super) fn next(&mut self) -> Result<Option<(Vec<u8>, usize)>, FileError> {
        loop {
            let number = self.lines.line() + 1;
            match self.lines.next_line()? {
                None => return Ok(None),
                Some(line) if line.starts_with(b"#") || line.trim_ascii().is_empty() => {}
                Some(line) => return Ok(Some((line.to_vec(), number))),
            }
        }
    }
}

/// Takes the wanted channels (in rising order) out of a row, which has one cell a column.
pub(super) fn row(
    input: &Input,
    header: &Header,
    line: &[u8],
    number: usize,
    wanted: &[usize],
    stored: &mut [f64],
) -> Result<(), FileError> {
    let mut wanted = wanted.iter().copied().peekable();
    let mut found = 0;
    for (index, cell) in line.split(|byte| *byte == header.delimiter).enumerate() {
        found += 1;
        if wanted.next_if_eq(&index).is_some() {
            stored[index] = cell_number(input, header, cell.trim_ascii(), (number, index))?;
        }
    }
    one_cell_a_column(input, number, header.columns.len(), found)
}

fn cell_number(input: &Input, header: &Header, cell: &[u8], at: (usize, usize)) -> Result<f64, FileError> {
    // Old versions wrote approach and retract as truths.
    match cell {
        b"False" => return Ok(0.0),
        b"True" => return Ok(1.0),
        _ => {}
    }
    let decimal = DecimalMark::Point;
    number::parse(cell, decimal).ok_or_else(|| {
        let place = CellPlace {
            path: input.name().to_owned(),
            line: at.0,
            column: at.1 + 1,
            name: header.columns.get(at.1).cloned(),
        };
        let found = shorten(&String::from_utf8_lossy(cell));
        match number::is_not_finite(cell) {
            true => FileError::NotFinite { place, found },
            false => FileError::TextInNumbers { place, found, decimal },
        }
    })
}
