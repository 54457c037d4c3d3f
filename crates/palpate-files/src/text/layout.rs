//! What is known about how a file is written, and what a caller may fix in advance.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::encoding::Encoding;

/// What stands between two cells of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Delimiter {
    /// A tabulator.
    Tab,
    /// `;`
    Semicolon,
    /// `,`
    Comma,
    /// One or more spaces or tabulators; those at either end of a line do not count.
    Blanks,
}

impl Delimiter {
    /// Every delimiter, the least ambiguous first: where two split a file equally well, the earlier wins.
    pub const ALL: [Self; 4] = [Self::Tab, Self::Semicolon, Self::Comma, Self::Blanks];
}

impl fmt::Display for Delimiter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tab => "tab",
            Self::Semicolon => "semicolon",
            Self::Comma => "comma",
            Self::Blanks => "blanks",
        })
    }
}

/// The character between the whole and the fractional part of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DecimalMark {
    /// `1.5`
    Point,
    /// `1,5`
    Comma,
}

impl fmt::Display for DecimalMark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Point => "point",
            Self::Comma => "comma",
        })
    }
}

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
}

impl Layout {
    /// The column called `name`, if exactly one is. An exact match goes before one that differs in case.
    #[must_use]
    pub fn column_named(&self, name: &str) -> Option<&ColumnInfo> {
        let only = |same: &dyn Fn(&str) -> bool| {
            let mut hits = self.columns.iter().filter(|column| column.name.as_deref().is_some_and(same));
            hits.next().filter(|_| hits.next().is_none())
        };
        only(&|own| own == name).or_else(|| only(&|own| own.to_lowercase() == name.to_lowercase()))
    }
}

/// A named value from the lines above the data, such as `Diameter,"0.399",mm`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Metadata {
    /// Name, as written.
    pub name: String,
    /// Value, as written: no decimal mark is interpreted here.
    pub value: String,
    /// Unit, as written less any brackets.
    pub unit: Option<String>,
    /// Line it stands on.
    pub line: usize,
}

/// What a column mostly holds, going by the rows at the beginning of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ColumnKind {
    /// Numbers.
    Number,
    /// Anything that is not a number.
    Text,
    /// Nothing.
    Empty,
}

/// One column of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ColumnInfo {
    /// Place in the row; the leftmost column is 1.
    pub number: usize,
    /// Name as written, less a unit that could be told from it. `None`: the column has no name.
    pub name: Option<String>,
    /// Unit as written, less any brackets; not interpreted.
    pub unit: Option<String>,
    /// What the column holds.
    pub kind: ColumnKind,
    /// Its first cell that is not empty, shortened.
    pub sample: String,
}

/// What the caller knows about a file better than its bytes do. Everything left `None` is found out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LayoutOptions {
    /// What stands between two cells.
    pub delimiter: Option<Delimiter>,
    /// The decimal mark of the numbers.
    pub decimal: Option<DecimalMark>,
    /// Character encoding.
    pub encoding: Option<Encoding>,
    /// Lines at the top to pass over unread: neither metadata nor names are looked for in them.
    pub skip_lines: Option<usize>,
    /// `true`: the columns have a line of names, even where it looks like data.
    /// `false`: they have none, even where a line looks like it.
    pub header: Option<bool>,
}
