//! One test in a file: its columns and what stands beside them.

use std::borrow::Cow;

use palpate::number::shortest;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::column_ref::ColumnRef;
use crate::{
    cell::unit,
    error::{is_plain, plain},
    naming::topic_and_field,
};

/// Significant digits of a product or quotient of numbers that were written: all but those of its rounding.
pub(crate) const EXACT_DIGITS: usize = 15;

/// A part of a file that holds one test: all of a text, one sheet of a workbook, one curve, one value of `test_id`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Part {
    /// What the file calls it; `None` where the file holds one test and gives it no name.
    pub name: Option<String>,
    /// How it is written, in one line for people.
    pub written: String,
    /// Number of rows, where it is known before they are read.
    pub rows: Option<u64>,
    /// The columns, left to right.
    pub columns: Vec<ColumnInfo>,
    /// Named values that stand beside the data, in file order.
    pub metadata: Vec<Metadata>,
    /// Stretches of rows that the file itself labels, such as the pause of a force curve; in order.
    pub labels: Vec<Label>,
    /// Where not all columns belong to one clock: which belong to which. None: every row is one instant.
    pub clocks: Vec<Clock>,
}

/// Columns whose rows are stamped by one of them, in a file of several rates: a topic of a robot's log.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Clock {
    /// Number of the column that holds the time stamps, from 1.
    pub column: usize,
    /// Number of the first column that they stamp.
    pub first: usize,
    /// Number of the last column that they stamp.
    pub last: usize,
}

/// A stretch of rows under one label.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Label {
    /// The label, as written.
    pub name: String,
    /// First row, from 0.
    pub start: usize,
    /// Row behind the last.
    pub end: usize,
}

impl Part {
    /// The column called `name`, if exactly one is. An exact match goes before one that differs in case; a name may have its
    /// unit with it as in the header (`Force (N)`), and in a log of a robot the name of a field may go without its topic
    /// (`wrench.force.z`).
    #[must_use]
    pub fn column_named(&self, name: &str) -> Option<&ColumnInfo> {
        let the_one = |same: &dyn Fn(&ColumnInfo) -> bool| {
            let mut hits = self.columns.iter().filter(|column| same(column));
            hits.next().filter(|_| hits.next().is_none())
        };
        let only = |same: &dyn Fn(&str) -> bool| the_one(&|column| column.name.as_deref().is_some_and(same));
        let with_unit = unit::split(name);
        only(&|own| own == name)
            .or_else(|| only(&|own| own.to_lowercase() == name.to_lowercase()))
            .or_else(|| the_one(&|own| own.unit.is_some() && with_unit == (own.name.clone(), own.unit.clone())))
            .or_else(|| only(&|own| topic_and_field(own).is_some_and(|(_, field)| field == name)))
    }

    /// The column with this number or name.
    #[must_use]
    pub fn column_of(&self, column: &ColumnRef) -> Option<&ColumnInfo> {
        match column {
            ColumnRef::Number(number) => self.columns.get(number.wrapping_sub(1)),
            ColumnRef::Name(name) => self.column_named(name),
            ColumnRef::First(columns) => columns.iter().find_map(|column| self.column_of(column)),
        }
    }

    /// The clock that stamps the column with this number, where the file has several clocks.
    #[must_use]
    pub fn clock_of(&self, number: usize) -> Option<&Clock> {
        self.clocks.iter().find(|clock| (clock.first..=clock.last).contains(&number))
    }

    /// Makes its words fit to be shown: a name that holds control characters is one with � in their place from here on.
    pub(crate) fn make_plain(&mut self) {
        let columns = self.columns.iter_mut().flat_map(|column| {
            let (name, unit) = (column.name.as_mut(), column.unit.as_mut());
            name.into_iter().chain(unit).chain([&mut column.sample])
        });
        let values = self.metadata.iter_mut().flat_map(|entry| {
            let unit = entry.unit.as_mut();
            [&mut entry.name, &mut entry.value].into_iter().chain(unit)
        });
        let labels = self.labels.iter_mut().map(|label| &mut label.name);
        let own = self.name.iter_mut().chain([&mut self.written]);
        own.chain(columns).chain(values).chain(labels).for_each(make_plain);
    }

    /// What messages call it.
    #[must_use]
    pub fn title(&self) -> &str {
        self.name.as_deref().unwrap_or("the file")
    }
}

fn make_plain(text: &mut String) {
    if !is_plain(text) {
        *text = plain(text);
    }
}

/// A part of a file that is no test.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct SkippedPart {
    /// What the file calls it.
    pub name: String,
    /// Why it is none.
    pub reason: String,
}

impl SkippedPart {
    pub(crate) fn new(name: impl Into<String>, reason: impl Into<String>) -> Self {
        let (name, reason) = (name.into(), reason.into());
        Self { name, reason }
    }

    /// As for a [`Part`].
    pub(crate) fn make_plain(&mut self) {
        make_plain(&mut self.name);
        make_plain(&mut self.reason);
    }
}

/// A named value that stands beside the data, such as `Diameter,"0.399",mm`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Metadata {
    /// Name, as written.
    pub name: String,
    /// Value, as written: no decimal mark is interpreted here.
    pub value: String,
    /// Unit, as written less any brackets.
    pub unit: Option<String>,
}

/// What a column mostly holds; of text, going by the rows at its beginning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ColumnKind {
    /// Numbers.
    Number,
    /// Dates with times of day, such as `2024-08-24T21:09:40.123Z`; they are read as seconds since 1970.
    DateTime,
    /// Anything else that is not a number.
    Text,
    /// Nothing.
    Empty,
}

/// One column of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ColumnInfo {
    /// Place in the row; the leftmost column is 1.
    pub number: usize,
    /// Name as written, less a unit that could be determined from it. `None`: the column has no name.
    pub name: Option<String>,
    /// Unit as written, less any brackets; not interpreted.
    pub unit: Option<String>,
    /// What the column holds.
    pub kind: ColumnKind,
    /// Its first cell that is not empty, shortened.
    pub sample: String,
}

impl ColumnInfo {
    /// Its first cell for people: a number of more digits than anybody reads has ten.
    #[must_use]
    pub fn first_value(&self) -> Cow<'_, str> {
        /// Letters up to which nothing is rounded.
        const LONG: usize = 12;
        /// Significant digits of a longer number.
        const DIGITS: usize = 10;
        let cell = self.sample.trim();
        match cell.parse() {
            Ok(number) if cell.len() > LONG => Cow::Owned(shortest(number, DIGITS)),
            _ => Cow::Borrowed(cell),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first value of a workbook was shown as 0.00000010000000000000001.
    #[test]
    fn first_values_have_no_more_digits_than_people_read() {
        let shown = |sample: &str| {
            let column = ColumnInfo {
                number: 1,
                name: None,
                unit: None,
                kind: ColumnKind::Number,
                sample: sample.to_owned(),
            };
            column.first_value().into_owned()
        };
        for (sample, expected) in [
            ("0.00000010000000000000001", "1e-07"),
            ("-0.0001459966197489494", "-0.0001459966197"),
            ("1724504945.1984644", "1724504945"),
            ("2.513400000000E+00", "2.5134"),
            ("1724504945,1984644", "1724504945,1984644"),
            (" 0.012207031", "0.012207031"),
            ("2024-08-24T21:09:40", "2024-08-24T21:09:40"),
        ] {
            assert_eq!(shown(sample), expected, "{sample}");
        }
    }
}
