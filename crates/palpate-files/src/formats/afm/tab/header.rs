//! The comment lines above the rows: metadata as JSON, and the names of the columns.

use serde_json::{Map, Value};

use crate::{
    cell::{DecimalMark, number},
    error::{FileError, shorten},
    formats::afm::rows::Rows,
    input::{Encoding, Idle, Input, LineReader},
};

/// What stands before and behind the metadata.
pub(super) const BEGIN: &str = "# BEGIN METADATA";
const END: &str = "# END METADATA";

/// Most bytes of comment lines.
const MOST_HEADER: usize = 16 << 20;

/// Most columns.
const MOST_COLUMNS: usize = 256;

/// The lines above the rows.
pub(super) struct Header {
    pub(super) metadata: Map<String, Value>,
    /// What the last of them says about the rows.
    pub(super) rows: Rows,
}

/// The comment lines: metadata, and the names of the columns in the last of them.
pub(super) fn read(input: &Input) -> Result<Header, FileError> {
    let mut lines = LineReader::open(input, Encoding::Utf8)?;
    let (mut json, mut names, mut bytes) = (None::<String>, (Vec::new(), 0), 0);
    let mut inside = false;
    let mut idle = Idle::of(input);
    loop {
        let number = lines.line() + 1;
        let Some(line) = lines.next_line()? else { break };
        let Some(comment) = line.strip_prefix(b"#") else {
            if line.trim_ascii().is_empty() {
                idle.pass(line.len(), number, 0)?;
                continue;
            }
            break;
        };
        bytes += line.len();
        if bytes > MOST_HEADER {
            return Err(input.too_large("the header", MOST_HEADER as u64));
        }
        let text = String::from_utf8_lossy(line);
        match text.trim_end() {
            BEGIN => (json, inside) = (Some(String::new()), true),
            END => inside = false,
            _ if inside => {
                if let Some(json) = &mut json {
                    json.push_str(&String::from_utf8_lossy(comment));
                    json.push('\n');
                }
            }
            _ => names = (comment.to_vec(), number),
        }
    }
    if inside {
        return Err(input.damaged("metadata", format!("a line `{END}`"), "none"));
    }
    let metadata = match json {
        None => Map::new(),
        Some(json) => serde_json::from_str(&json)
            .map_err(|error| input.damaged("metadata", "an object in JSON", error.to_string()))?,
    };
    let (names, line) = names;
    let delimiter = if names.contains(&b'\t') { b'\t' } else { b',' };
    let names = String::from_utf8_lossy(&names).into_owned();
    let columns: Vec<String> = names
        .split(char::from(delimiter))
        .map(|name| name.trim().to_owned())
        .take(MOST_COLUMNS + 1)
        .collect();
    if columns.len() > MOST_COLUMNS || columns.iter().any(String::is_empty) {
        let expected = format!("a line of 1 to {MOST_COLUMNS} names above the rows");
        return Err(input.damaged("header", expected, shorten(&names)));
    }
    let (columns, behind) = without_row(columns);
    let row = |cells: Vec<String>| (cells.join(&char::from(delimiter).to_string()).into_bytes(), line);
    let rows = Rows {
        first_line: 0,
        columns,
        delimiter: Some(delimiter),
        behind_names: behind.map(row),
    };
    Ok(Header { metadata, rows })
}

/// Names, and the cells of a first row where the line of the names lacks its end: of k columns it then has 2k − 1 cells, and in the middle
/// one the last name and the first number stand together. Versions of afmformats wrote it so.
fn without_row(mut cells: Vec<String>) -> (Vec<String>, Option<Vec<String>>) {
    let is_number =
        |cell: &str| matches!(cell, "True" | "False") || number::parse(cell.as_bytes(), DecimalMark::Point).is_some();
    let (last, names) = (cells.len() / 2, cells.len().div_ceil(2));
    let is_so = last > 0
        && cells.len() % 2 == 1
        && !cells[..names].iter().any(|cell| is_number(cell))
        && cells[names..].iter().all(|cell| is_number(cell));
    let split = || cells[last].char_indices().skip(1).map(|(at, _)| at).find(|at| is_number(&cells[last][*at..]));
    let Some(at) = is_so.then(split).flatten() else {
        return (cells, None);
    };
    let mut row = vec![cells[last].split_off(at)];
    row.extend(cells.drain(names..));
    (cells, Some(row))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_behind_the_names_is_no_name() {
        let cells = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
        for (text, names, row) in [
            ("force segment time-6.7e-10 False 1.12", "force segment time", Some("-6.7e-10 False 1.12")),
            ("force segmentTrue 1.12", "force segment", Some("True 1.12")),
            ("force segment time", "force segment time", None),
            ("force time2 height", "force time2 height", None),
            ("force1.5", "force1.5", None),
        ] {
            let found = without_row(cells(text));
            assert_eq!(found, (cells(names), row.map(cells)), "{text}");
        }
    }
}
