//! What is known about how a file is written.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use super::part::{ColumnInfo, Metadata};
use crate::{
    cell::{DecimalMark, Delimiter},
    input::Encoding,
};

/// What the beginning of a file says about all of it.
///
/// Line numbers start at 1 and count every line of the file, blank ones included.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Layout {
    /// Character encoding.
    pub encoding: Encoding,
    /// What stands between two cells.
    pub delimiter: Delimiter,
    /// The decimal mark of the numbers.
    pub decimal: DecimalMark,
    /// Line with the names of the columns, if there is one.
    pub header_line: Option<usize>,
    /// Line with the units of the columns, if they have a line of their own.
    pub units_line: Option<usize>,
    /// First line with data.
    pub first_data_line: usize,
    /// Named values found above the data, in file order.
    pub metadata: Vec<Metadata>,
    /// The columns, left to right.
    pub columns: Vec<ColumnInfo>,
    /// No number observed so far had a mark, and nobody stated which it is: a point further down could set off thousands.
    #[serde(skip)]
    pub undecided: bool,
    /// For each column, whether marks between thousands were observed in it.
    #[serde(skip)]
    pub thousands: Vec<bool>,
    /// A column of dates beside one of times of day, which count from there.
    #[serde(skip)]
    pub day: Option<Day>,
}

/// Date and time of day in two columns, by their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Day {
    /// The column of the dates.
    pub date: usize,
    /// The column of the times of day.
    pub time: usize,
}

impl fmt::Display for Layout {
    /// One line for people: `utf-8 encoding, fields separated by comma, decimal point, data from line 3`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let thousands = if self.thousands.contains(&true) { ", thousands set off" } else { "" };
        write!(
            f,
            "{} encoding, fields separated by {}, decimal {}{thousands}, data from line {}",
            self.encoding, self.delimiter, self.decimal, self.first_data_line
        )
    }
}
