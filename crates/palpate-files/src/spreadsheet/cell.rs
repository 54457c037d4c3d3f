//! Cells of a sheet and what they hold.

use super::moment;
use crate::text::number;

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

impl Value {
    /// What `calamine` has read; `None` where this is nothing, or only white space.
    pub(super) fn of(data: calamine::Data, days_to_epoch: f64) -> Option<Self> {
        use calamine::Data;
        Some(match data {
            Data::Empty => return None,
            Data::Int(number) => Self::Number(number as f64),
            Data::Float(number) => Self::Number(number),
            Data::DateTime(moment) if moment.is_duration() => Self::Duration(moment.as_f64()),
            Data::DateTime(moment) => Self::Moment(moment.as_f64()),
            Data::DateTimeIso(text) => match moment::of_iso(&text) {
                Some(days) => Self::Moment(days + days_to_epoch),
                None => Self::Text(text),
            },
            Data::String(text) | Data::DurationIso(text) if text.trim().is_empty() => return None,
            Data::String(text) | Data::DurationIso(text) => Self::Text(text),
            Data::Bool(truth) => Self::Truth(truth),
            Data::Error(fault) => Self::Fault(fault.to_string()),
        })
    }

    /// A number under a number format.
    pub(super) fn formatted(number: f64, format: NumberFormat) -> Self {
        match format {
            NumberFormat::Plain => Self::Number(number),
            NumberFormat::Moment => Self::Moment(number),
            NumberFormat::Duration => Self::Duration(number),
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

/// What a number format makes of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum NumberFormat {
    #[default]
    Plain,
    Moment,
    Duration,
}

impl NumberFormat {
    /// The format that every workbook has under this number, if it is one of those that show times.
    pub(super) fn built_in(number: u32) -> Self {
        match number {
            14..=22 | 27..=36 | 45 | 47 | 50..=58 => Self::Moment,
            46 => Self::Duration,
            _ => Self::Plain,
        }
    }

    /// The format of a code such as `yyyy-mm-dd hh:mm:ss.000`, `[h]:mm:ss` or `0.00" s"`; its first section counts.
    pub(super) fn of_code(code: &str) -> Self {
        let mut letters = code.chars();
        let mut found = Self::Plain;
        while let Some(letter) = letters.next() {
            match letter {
                ';' => break,
                '\\' | '_' | '*' => {
                    letters.next();
                }
                '"' => {
                    letters.by_ref().find(|next| *next == '"');
                }
                '[' => {
                    let inside: String = letters.by_ref().take_while(|next| *next != ']').collect();
                    let clock = |of: char| inside.chars().all(|next| next.eq_ignore_ascii_case(&of));
                    if !inside.is_empty() && ['h', 'm', 's'].into_iter().any(clock) {
                        return Self::Duration;
                    }
                }
                _ if "dmyhsDMYHS".contains(letter) => found = Self::Moment,
                _ => {}
            }
        }
        found
    }
}

/// The letters of a column, from 0: A, B, … Z, AA.
pub(super) fn letters(column: u32) -> String {
    let mut left = u64::from(column) + 1;
    let mut reversed = Vec::new();
    while left > 0 {
        left -= 1;
        reversed.push(char::from(b'A' + (left % 26) as u8));
        left /= 26;
    }
    reversed.into_iter().rev().collect()
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

    #[test]
    fn number_formats() {
        for (code, format) in [
            ("General", NumberFormat::Plain),
            ("0.00\" s\"", NumberFormat::Plain),
            ("0.00E+00", NumberFormat::Plain),
            ("[Red]0.0", NumberFormat::Plain),
            ("0\\m", NumberFormat::Plain),
            ("0;yyyy", NumberFormat::Plain),
            ("yyyy-mm-dd hh:mm:ss.000", NumberFormat::Moment),
            ("[$-409]h:mm AM/PM", NumberFormat::Moment),
            ("[h]:mm:ss", NumberFormat::Duration),
            ("[ss].00", NumberFormat::Duration),
        ] {
            assert_eq!(NumberFormat::of_code(code), format, "{code}");
        }
    }
}
