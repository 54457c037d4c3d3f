//! Curves in lines of text: rows of one cell a column, below comment lines that say what the columns are.

use super::curve::Curve;
use crate::{
    cell::{DecimalMark, number},
    error::{CellPosition, FileError, FileProblem, shorten},
    input::{Encoding, Input, LineReader},
    table::{Columns, Found, Heard, ReadPart, SkippedPart},
};

/// How the rows of a segment are written.
#[derive(Default)]
pub(super) struct Rows {
    /// Line of the first row, from 1; 0: the first one that is no comment.
    pub(super) first_line: usize,
    /// Names of the columns.
    pub(super) columns: Vec<String>,
    /// What separates the cells, where it is not blanks. Numbers may be truths there: old versions of afmformats wrote
    /// approach and retract so.
    pub(super) delimiter: Option<u8>,
    /// A first row that stands in the line of the names, right behind them, and the number of that line.
    pub(super) behind_names: Option<(Vec<u8>, usize)>,
}

impl Rows {
    pub(super) fn cells<'l>(&self, line: &'l [u8]) -> impl Iterator<Item = &'l [u8]> + use<'l> {
        let delimiter = self.delimiter;
        line.split(move |byte| delimiter.map_or(byte.is_ascii_whitespace(), |delimiter| *byte == delimiter))
            .map(<[u8]>::trim_ascii)
            .filter(move |cell| delimiter.is_some() || !cell.is_empty())
    }

    /// Takes the wanted channels (in rising order) out of a row, which has one cell a column.
    pub(super) fn read(
        &self,
        input: &Input,
        (line, number): (&[u8], usize),
        wanted: &[usize],
        stored: &mut [f64],
    ) -> Result<(), FileError> {
        let mut wanted = wanted.iter().copied().peekable();
        let mut found = 0;
        for (index, cell) in self.cells(line).enumerate() {
            found += 1;
            if wanted.next_if_eq(&index).is_some() {
                stored[index] = match cell {
                    b"False" if self.delimiter.is_some() => 0.0,
                    b"True" if self.delimiter.is_some() => 1.0,
                    _ => number::parse(cell, DecimalMark::Point)
                        .ok_or_else(|| input.wrong(no_number(cell, place(number, index, self.columns.get(index)))))?,
                };
            }
        }
        let (line, expected) = (number, self.columns.len());
        if found == expected {
            return Ok(());
        }
        Err(input.wrong(FileProblem::CellCount { line, expected, found }))
    }
}

fn place(line: usize, index: usize, name: Option<&String>) -> CellPosition {
    CellPosition {
        line,
        column: index + 1,
        name: name.cloned(),
    }
}

fn no_number(cell: &[u8], place: CellPosition) -> FileProblem {
    let found = shorten(&String::from_utf8_lossy(cell));
    let decimal = DecimalMark::Point;
    match number::is_not_finite(cell) {
        true => FileProblem::NotFinite { place, found },
        false => FileProblem::TextInNumbers { place, found, decimal },
    }
}

/// Whether a line is neither blank nor a comment.
pub(super) fn is_row(line: &[u8]) -> bool {
    !line.starts_with(b"#") && !line.trim_ascii().is_empty()
}

/// A curve in lines of text.
struct Lines {
    input: Input,
    curve: Curve,
    /// One a segment of the file.
    rows: Vec<Rows>,
}

/// What was found in a file of lines: a curve, where there is one, and what was left out of it.
pub(super) fn found(input: &Input, rows: Vec<Rows>, (curve, skipped): (Option<Curve>, Vec<SkippedPart>)) -> Found {
    let parts = curve.iter().map(|curve| curve.part.clone()).collect();
    let (input, curve) = (input.clone(), curve.unwrap_or_default());
    let reader = Box::new(Lines { input, curve, rows });
    Found { parts, skipped, reader }
}

impl ReadPart for Lines {
    fn read(&self, _part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError> {
        let mut read = Columns::of(columns.len());
        let mut lines = LineReader::open(&self.input, Encoding::Utf8)?;
        let mut values = vec![0.0; columns.len()];
        let mut reported = 0;
        for segment in &self.curve.segments {
            let rows = &self.rows[segment.number];
            let chosen = segment.choose(columns);
            let channels = chosen.channels();
            let mut stored = vec![0.0; rows.columns.len()];
            let mut index = 0;
            while index < segment.rows {
                let (line, number) = match rows.behind_names.as_ref().filter(|_| index == 0) {
                    Some((line, number)) => (&line[..], *number),
                    None => {
                        let number = lines.line() + 1;
                        let Some(line) = lines.next_line()? else { break };
                        (line, number)
                    }
                };
                if number < rows.first_line || !is_row(line) {
                    continue;
                }
                rows.read(&self.input, (line, number), &channels, &mut stored)?;
                chosen.fill(index, &stored, &mut values).map_err(|chosen| {
                    let index = columns[chosen] - 1;
                    let name = self.curve.part.columns.get(index).and_then(|column| column.name.as_ref());
                    // A number that is infinite once it is scaled.
                    let (place, found) = (place(number, index, name), "an infinite value".to_owned());
                    self.input.wrong(FileProblem::NotFinite { place, found })
                })?;
                read.push(&values, number);
                index += 1;
                let (done, total) = lines.progress();
                if done != reported {
                    progress(done, total)?;
                    reported = done;
                }
            }
        }
        read.finish();
        Ok(read)
    }
}
