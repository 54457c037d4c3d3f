//! Going through the rows for the segments they belong to.

use super::header::Header;
use crate::{
    error::FileError,
    formats::afm::{afmformats::MOST_SEGMENTS, rows::is_row},
    input::{Encoding, Idle, Input, LineReader},
};

/// Rows, and where the number of the segment changes.
#[derive(Default)]
pub(super) struct Scan {
    pub(super) rows: usize,
    pub(super) first: Option<Vec<f64>>,
    /// Number of a segment and its first row.
    pub(super) starts: Vec<(f64, usize)>,
}

pub(super) fn scan(input: &Input, Header { rows, .. }: &Header) -> Result<Scan, FileError> {
    let segment = rows.columns.iter().position(|name| name == "segment");
    let mut channels: Vec<usize> = (0..rows.columns.len()).collect();
    let mut stored = vec![0.0; rows.columns.len()];
    let mut scan = Scan::default();
    let mut take = |scan: &mut Scan, line: &[u8], number: usize| -> Result<(), FileError> {
        rows.read(input, (line, number), &channels, &mut stored)?;
        if scan.rows == 0 {
            scan.first = Some(stored.clone());
            channels = segment.into_iter().collect();
        }
        if let Some(segment) = segment {
            let changes = scan.starts.last().is_none_or(|(last, _)| *last != stored[segment]);
            if changes && scan.starts.len() <= MOST_SEGMENTS {
                scan.starts.push((stored[segment], scan.rows));
            }
        }
        scan.rows += 1;
        Ok(())
    };
    if let Some((line, number)) = &rows.behind_names {
        take(&mut scan, line, *number)?;
    }
    let mut idle = Idle::of(input);
    let mut lines = LineReader::open(input, Encoding::Utf8)?;
    loop {
        let number = lines.line() + 1;
        let Some(line) = lines.next_line()? else {
            return Ok(scan);
        };
        match is_row(line) {
            true => take(&mut scan, line, number)?,
            false => idle.pass(line.len(), number, scan.rows)?,
        }
    }
}
