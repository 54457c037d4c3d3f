//! Cells of a sheet and what they hold.

use super::moment;
use crate::cell::number;

/// What a cell holds. A formula holds the value it had when the workbook was saved.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Number(f64),
    Text(String),
    /// A date, a time of day or both, in days as the workbook counts them.
    Moment(f64),
    /// A duration in days.
    Duration(f64),
    Truth(bool),
    /// An error such as `#DIV/0!`.
    Fault(String),
}

/// Most bytes of a text that are kept: more than Excel writes into a cell. One text can stand in any number of cells.
const MOST_OF_TEXT: usize = 1 << 15;

/// Bytes of a text that take as much as a cell.
const TEXT: usize = 64;

/// A text as it is kept, with … in place of what is too much.
fn kept(text: &str) -> String {
    let mut end = MOST_OF_TEXT;
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    format!("{}…", &text[..end])
}

impl Value {
    /// What `calamine` refers to; `None` where this is nothing, or only white space.
    pub(super) fn of_ref(data: &calamine::DataRef<'_>, days_to_epoch: f64) -> Option<Self> {
        match data {
            calamine::DataRef::SharedString(text) if text.len() > MOST_OF_TEXT => Some(Self::Text(kept(text))),
            other => Self::of(other.clone().into(), days_to_epoch),
        }
    }

    /// What `calamine` has kept; `None` where this is nothing, or only white space.
    pub(super) fn of_kept(data: &calamine::Data, days_to_epoch: f64) -> Option<Self> {
        match data {
            calamine::Data::String(text) if text.len() > MOST_OF_TEXT => Some(Self::Text(kept(text))),
            other => Self::of(other.clone(), days_to_epoch),
        }
    }

    /// What `calamine` has read; `None` where this is nothing, or only white space.
    fn of(data: calamine::Data, days_to_epoch: f64) -> Option<Self> {
        use calamine::Data;
        Some(match data {
            Data::Empty => return None,
            // A number that is none: nobody can write one, but a damaged file can have it.
            Data::Float(number) if !number.is_finite() => Self::Fault(number.to_string()),
            Data::DateTime(moment) if !moment.as_f64().is_finite() => Self::Fault(moment.as_f64().to_string()),
            Data::Int(number) => Self::Number(number as f64),
            Data::Float(number) => Self::Number(number),
            Data::DateTime(moment) if moment.is_duration() => Self::Duration(moment.as_f64()),
            Data::DateTime(moment) => Self::Moment(moment.as_f64()),
            Data::DateTimeIso(text) => match moment::of_iso(&text) {
                Some(days) => Self::Moment(days + days_to_epoch),
                None => Self::Text(text),
            },
            Data::String(text) | Data::DurationIso(text) if text.trim().is_empty() => return None,
            Data::String(text) if text.len() > MOST_OF_TEXT => Self::Text(kept(&text)),
            Data::String(text) | Data::DurationIso(text) => Self::Text(text),
            Data::Bool(truth) => Self::Truth(truth),
            Data::Error(fault) => Self::Fault(fault.to_string()),
        })
    }

    /// What it takes of a number of cells that is limited: a long text counts as several.
    pub(super) fn weight(&self) -> usize {
        match self {
            Self::Text(text) => 1 + text.len() / TEXT,
            _ => 1,
        }
    }

    /// What it is to somebody who looks for columns of numbers.
    pub(super) fn class(&self) -> number::Cell {
        match self {
            Self::Number(_) | Self::Moment(_) | Self::Duration(_) => number::Cell::Whole,
            Self::Text(text) => number::classify(text.trim().as_bytes()),
            Self::Truth(_) => number::Cell::Text,
            Self::Fault(_) => number::Cell::NotFinite,
        }
    }

    /// Its text, as a header or a message has it.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => text.split_whitespace().collect::<Vec<_>>().join(" "),
            Self::Moment(days) | Self::Duration(days) => format!("{days} d"),
            Self::Truth(truth) => if *truth { "TRUE" } else { "FALSE" }.to_owned(),
            Self::Fault(fault) => fault.clone(),
        }
    }
}

/// A cell that is not empty.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    /// Row, from 0.
    pub(super) row: u32,
    /// Column, from 0.
    pub(super) column: u32,
    pub(super) value: Value,
}

/// Most rows and columns of any sheet.
pub(super) const MOST_ROWS: u32 = 1 << 20;
/// See [`MOST_ROWS`].
pub(super) const MOST_COLUMNS: u32 = 1 << 14;

/// The letters of a column, from 0: A, B, … Z, AA.
pub(super) fn letters(column: u32) -> String {
    let before = column.checked_sub(26).map_or_else(String::new, |beyond| letters(beyond / 26));
    format!("{before}{}", char::from(b'A' + (column % 26) as u8))
}

/// Row and column, from 0, of a reference such as `B12`; `None` where it is none, or lies outside of any sheet.
pub(super) fn reference(text: &str) -> Option<(u32, u32)> {
    let digits = text.find(|letter: char| letter.is_ascii_digit())?;
    let (letters, digits) = text.split_at(digits);
    let row: u32 = digits.parse().ok()?;
    if letters.is_empty() || letters.len() > 3 {
        return None;
    }
    let place = |sum: Option<u32>, letter: u8| {
        let digit = letter.to_ascii_uppercase().checked_sub(b'A').filter(|digit| *digit < 26)?;
        Some(sum? * 26 + u32::from(digit) + 1)
    };
    let column = letters.bytes().fold(Some(0), place)?;
    ((1..=MOST_ROWS).contains(&row) && (1..=MOST_COLUMNS).contains(&column)).then(|| (row - 1, column - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references() {
        assert_eq!(reference("A1"), Some((0, 0)));
        assert_eq!(reference("XFD1048576"), Some((MOST_ROWS - 1, MOST_COLUMNS - 1)));
        for text in ["", "A", "1", "A0", "XFE1", "A1048577", "ABCD1", "A-1", "Ä1", "A99999999999"] {
            assert_eq!(reference(text), None, "{text}");
        }
        for column in [0, 25, 26, 701, 702, MOST_COLUMNS - 1] {
            assert_eq!(reference(&format!("{}7", letters(column))), Some((6, column)));
        }
    }
}
