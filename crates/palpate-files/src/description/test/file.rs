//! The table `[file]` of a test: how its file is written.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::{
    cell::{DecimalMark, Delimiter},
    input::Encoding,
    table::{LayoutOptions, ReadOptions},
};

/// How the file is written, where it should not be found out, and which of its tests is meant.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "File")]
pub(crate) struct FileTable {
    /// The one test of a file that holds several: its name (a sheet, a curve, a test_id), or its number from 1.
    part: Option<String>,
    /// Of delimited text: what stands between two cells.
    delimiter: Option<Delimiter>,
    /// Of delimited text: the decimal mark of the numbers.
    decimal: Option<DecimalMark>,
    /// Of delimited text: its character encoding.
    encoding: Option<Encoding>,
    /// Of delimited text: lines at the top to pass over unread. Neither metadata nor names are looked for in them.
    skip_lines: Option<usize>,
    /// true: the columns have a line of names, even where it looks like data. false: they have none, even where a
    /// line looks like it.
    header: Option<bool>,
}

impl FileTable {
    pub(super) fn checked(self) -> ReadOptions {
        ReadOptions {
            part: self.part,
            layout: LayoutOptions {
                delimiter: self.delimiter,
                decimal: self.decimal,
                encoding: self.encoding,
                skip_lines: self.skip_lines,
                header: self.header,
            },
        }
    }
}
