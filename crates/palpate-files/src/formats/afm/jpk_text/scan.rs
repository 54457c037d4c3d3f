//! Finding the blocks of a text export: a header of comment lines, then rows.

use std::collections::HashMap;

use crate::{
    error::FileError,
    formats::afm::rows::Rows,
    input::{Encoding, Idle, Input, LineReader},
};

/// Most blocks of a file. A program of segments has a few, a thousand at most.
const MOST_BLOCKS: usize = 4096;

/// Most columns of a block.
const MOST_COLUMNS: usize = 256;

/// Most bytes of headers in a file.
const MOST_HEADER: usize = 64 << 20;

/// A header and the rows below it.
#[derive(Default)]
pub(super) struct Block {
    /// Every `key: value`, in order.
    header: Vec<(String, String)>,
    /// Where in them every key has its first value that is not empty.
    places: HashMap<String, usize>,
    pub(super) layout: Rows,
    pub(super) rows: usize,
    /// The first row as it stands there, and the last.
    pub(super) first: Vec<u8>,
    pub(super) last: Vec<u8>,
}

impl Block {
    /// The value under a key that is not empty.
    pub(super) fn value(&self, key: &str) -> Option<&str> {
        self.header.get(*self.places.get(key)?).map(|(_, value)| value.as_str())
    }

    pub(super) fn header(&self) -> &[(String, String)] {
        &self.header
    }

    fn add(&mut self, (key, value): (String, String)) {
        if !value.is_empty() {
            self.places.entry(key.clone()).or_insert(self.header.len());
        }
        self.header.push((key, value));
    }
}

/// The key and the value of a header line.
pub(super) fn entry(line: &[u8]) -> Option<(String, String)> {
    let text = String::from_utf8_lossy(line.strip_prefix(b"#")?);
    let (key, value) = text.split_once(':')?;
    Some((key.trim().to_owned(), value.trim().to_owned()))
}

/// The blocks of a file, in order.
pub(super) fn blocks(input: &Input) -> Result<Vec<Block>, FileError> {
    let mut lines = LineReader::open(input, Encoding::Utf8)?;
    let mut blocks: Vec<Block> = Vec::new();
    let mut open = Block::default();
    let mut in_header = 0;
    let (mut idle, mut rows) = (Idle::of(input), 0);
    loop {
        let number = lines.line() + 1;
        let Some(line) = lines.next_line()? else { break };
        let whole = line.len();
        let line = line.trim_ascii_end();
        if line.is_empty() {
            idle.pass(whole, number, rows)?;
            continue;
        }
        if !line.starts_with(b"#") {
            add_row(input, &mut open, line, number)?;
            rows += 1;
            continue;
        }
        in_header += line.len();
        if in_header > MOST_HEADER {
            return Err(input.too_large("the headers of all segments", MOST_HEADER as u64));
        }
        let entry = entry(line);
        // Keys that every header has once.
        let once = |key: &str| matches!(key, "segmentIndex" | "segment" | "columns");
        let again = entry.as_ref().is_some_and(|(key, _)| once(key) && open.value(key).is_some());
        if open.rows > 0 || again {
            blocks.push(std::mem::take(&mut open));
            if blocks.len() > MOST_BLOCKS {
                let found = format!("more, at line {number}");
                return Err(input.damaged("segments", format!("at most {MOST_BLOCKS}"), found));
            }
        }
        entry.into_iter().for_each(|entry| open.add(entry));
    }
    if open.rows > 0 || open.value("columns").is_some() {
        blocks.push(open);
    }
    Ok(blocks)
}

fn add_row(input: &Input, block: &mut Block, line: &[u8], number: usize) -> Result<(), FileError> {
    if block.rows == 0 {
        let columns = block.value("columns").unwrap_or_default().split_whitespace();
        let columns: Vec<String> = columns.take(MOST_COLUMNS + 1).map(str::to_owned).collect();
        if columns.is_empty() || columns.len() > MOST_COLUMNS {
            let expected = format!("a line `# columns:` above with 1 to {MOST_COLUMNS} names");
            let found = format!("{} names", columns.len());
            return Err(input.damaged(format!("line {number}"), expected, found));
        }
        block.layout = Rows {
            first_line: number,
            columns,
            ..Rows::default()
        };
        block.first = line.to_vec();
    }
    block.rows += 1;
    block.last.clear();
    block.last.extend_from_slice(line);
    Ok(())
}
