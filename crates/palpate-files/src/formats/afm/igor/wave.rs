//! The bytes of a wave: header, numbers, and what stands behind them. After Technical Note 3 of WaveMetrics.

use crate::{
    error::{FileError, FileProblem},
    input::{Input, Number},
};

/// Most columns of a wave.
const MOST_COLUMNS: usize = 256;

/// Bytes of a label.
const LABEL: usize = 32;

/// A wave as it is stored.
pub(super) struct Wave {
    pub(super) version: u8,
    pub(super) name: String,
    /// Of all numbers; empty: none.
    pub(super) unit: String,
    pub(super) rows: usize,
    /// What the columns are called; empty: nothing. One a column.
    pub(super) labels: Vec<String>,
    /// Scale of the rows: the first value, the step and the unit.
    pub(super) scale: (f64, f64, String),
    pub(super) note: String,
    pub(super) number: Number,
    pub(super) lowest_first: bool,
    /// Where the first number begins.
    pub(super) data: usize,
}

/// Where the parts of a header are, by its version.
struct Layout {
    version: u8,
    /// Where the header of the wave begins.
    wave: usize,
    /// Where its numbers begin.
    data: usize,
}

/// The version of the wave that bytes begin with, if they do, and whether its numbers have the lowest byte first.
pub(super) fn begins(bytes: &[u8]) -> Option<(u8, bool)> {
    let (lowest_first, version) = match *bytes.first_chunk()? {
        [version, 0] => (true, version),
        [0, version] => (false, version),
        _ => return None,
    };
    let header = bytes.get(..layout(version)?.data)?;
    let short = |pair: &[u8]| {
        if lowest_first {
            u16::from_le_bytes([pair[0], pair[1]])
        } else {
            u16::from_be_bytes([pair[0], pair[1]])
        }
    };
    // All shorts of the header add up to nothing: one of them is there to make it so.
    let sum = header.chunks_exact(2).fold(0_u16, |sum, pair| sum.wrapping_add(short(pair)));
    (sum == 0).then_some((version, lowest_first))
}

fn layout(version: u8) -> Option<Layout> {
    let (wave, data) = match version {
        1 => (8, 118),
        2 => (16, 126),
        3 => (20, 130),
        5 => (64, 384),
        _ => return None,
    };
    Some(Layout { version, wave, data })
}

/// The fields of a header, which is whole.
struct Fields<'a> {
    input: &'a Input,
    bytes: &'a [u8],
    lowest_first: bool,
}

impl Fields<'_> {
    fn number(&self, number: Number, at: usize) -> f64 {
        number.read(&self.bytes[at..at + number.size()], self.lowest_first)
    }

    /// A count or a size, which is not negative.
    fn count(&self, what: &str, at: usize) -> Result<usize, FileError> {
        let count = self.number(Number::I32, at);
        if count < 0.0 {
            return Err(self.input.damaged(format!("header, {what}"), "a number from 0 on", count.to_string()));
        }
        Ok(count as usize)
    }

    fn text(&self, at: usize, most: usize) -> String {
        text(&self.bytes[at..at + most])
    }
}

/// Reads a wave that `begins`.
pub(super) fn read(input: &Input, bytes: &[u8]) -> Result<Wave, FileError> {
    let missing = || input.damaged("header", "that of a wave of version 1, 2, 3 or 5", "another one");
    let (version, lowest_first) = begins(bytes).ok_or_else(missing)?;
    let layout = layout(version).ok_or_else(missing)?;
    let fields = Fields {
        input,
        bytes,
        lowest_first,
    };
    match version {
        5 => of_version_5(&fields, &layout),
        _ => of_earlier_versions(&fields, &layout),
    }
}

fn of_version_5(fields: &Fields<'_>, layout: &Layout) -> Result<Wave, FileError> {
    let at = |offset: usize| layout.wave + offset;
    let dimension = |index: usize| fields.count(&format!("size of dimension {}", index + 1), at(68 + 4 * index));
    let [rows, columns, layers, chunks] = [dimension(0)?, dimension(1)?, dimension(2)?, dimension(3)?];
    if layers > 0 || chunks > 0 {
        let found = format!("{rows} × {columns} × {layers}{}", if chunks > 0 { " × …" } else { "" });
        return Err(unfit(fields.input, "an array of one or two dimensions", found));
    }
    let (number, end) = numbers(fields, layout, at(16), (rows, columns.max(1)), at(12))?;
    // Behind the numbers: formula, note, units that are long, labels.
    let size = |index: usize| fields.count(&format!("size of part {} behind the numbers", index + 1), 8 + 4 * index);
    let mut rest = fields.bytes.get(end..).unwrap_or_default();
    let mut behind = Vec::new();
    for index in 0..11 {
        let size = size(index)?;
        let (part, left) = rest.split_at_checked(size).ok_or_else(|| {
            let expected = format!("{size} bytes behind the numbers");
            fields.input.damaged("wave", expected, format!("{} bytes", rest.len()))
        })?;
        behind.push(part);
        rest = left;
    }
    let long = |part: &[u8], short: String| if part.is_empty() { short } else { text(part) };
    let mut labels: Vec<String> = behind[8].chunks(LABEL).skip(1).map(text).collect();
    labels.resize(columns.max(1), String::new());
    Ok(Wave {
        version: layout.version,
        name: fields.text(at(28), 32),
        unit: long(behind[2], fields.text(at(148), 4)),
        rows,
        labels,
        scale: (
            fields.number(Number::F64, at(116)),
            fields.number(Number::F64, at(84)),
            long(behind[3], fields.text(at(152), 4)),
        ),
        note: text(behind[1]),
        number,
        lowest_first: fields.lowest_first,
        data: layout.data,
    })
}

fn of_earlier_versions(fields: &Fields<'_>, layout: &Layout) -> Result<Wave, FileError> {
    let at = |offset: usize| layout.wave + offset;
    let rows = fields.count("number of points", at(42))?;
    let (number, end) = numbers(fields, layout, at(0), (rows, 1), at(42))?;
    let note = match layout.version {
        1 => 0,
        _ => fields.count("size of the note", 6)?,
    };
    // 16 bytes lie between the numbers and the note.
    let rest = fields.bytes.get(end + 16..).unwrap_or_default();
    let note = rest.get(..note).ok_or_else(|| {
        let expected = format!("{note} bytes of the note");
        fields.input.damaged("wave", expected, format!("{} bytes", rest.len()))
    })?;
    Ok(Wave {
        version: layout.version,
        name: fields.text(at(6), 20),
        unit: fields.text(at(34), 4),
        rows,
        labels: vec![String::new()],
        scale: (fields.number(Number::F64, at(56)), fields.number(Number::F64, at(48)), fields.text(at(38), 4)),
        note: text(note),
        number,
        lowest_first: fields.lowest_first,
        data: layout.data,
    })
}

/// The kind of the numbers, and where they end: there are as many as rows and columns take.
fn numbers(
    fields: &Fields<'_>,
    layout: &Layout,
    kind_at: usize,
    (rows, columns): (usize, usize),
    points_at: usize,
) -> Result<(Number, usize), FileError> {
    let input = fields.input;
    let kind = fields.number(Number::U16, kind_at) as u16;
    let number = match kind {
        0x02 => Number::F32,
        0x04 => Number::F64,
        0x08 => Number::I8,
        0x10 => Number::I16,
        0x20 => Number::I32,
        0x80 => Number::I64,
        0x48 => Number::U8,
        0x50 => Number::U16,
        0x60 => Number::U32,
        0xC0 => Number::U64,
        _ => {
            let found = match kind {
                0 => "texts".to_owned(),
                _ if kind & 1 == 1 => "complex numbers".to_owned(),
                _ => format!("kind {kind}"),
            };
            return Err(unfit(input, "real numbers", found));
        }
    };
    if columns > MOST_COLUMNS {
        return Err(unfit(input, format!("at most {MOST_COLUMNS} columns"), columns.to_string()));
    }
    let points = fields.count("number of points", points_at)?;
    if points != rows * columns {
        let expected = format!("{} points of {rows} rows and {columns} columns", rows * columns);
        return Err(input.damaged("header", expected, points.to_string()));
    }
    let (length, held) = (points * number.size(), fields.bytes.len() - layout.data);
    if length > held {
        let expected = format!("{length} bytes for {points} numbers of {} bytes", number.size());
        return Err(input.damaged("wave", expected, format!("{held} bytes")));
    }
    Ok((number, layout.data + length))
}

/// A wave that is whole, but no table.
fn unfit(input: &Input, expected: impl Into<String>, found: String) -> FileError {
    let hint = "save the columns of the test as a wave of real numbers with one or two dimensions";
    input.wrong(FileProblem::unfit("wave", expected, found, hint))
}

/// Text up to its first byte of zero, in UTF-8 or else as Windows writes it.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    let bytes = &bytes[..end];
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => encoding_rs::WINDOWS_1252.decode_without_bom_handling(bytes).0.into_owned(),
    }
}
