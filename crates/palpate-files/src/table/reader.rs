//! What every format can do: look into a file, and read columns of the tests in it.

use std::fmt;

use palpate::watch::Cancelled;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    columns::Columns,
    layout::Layout,
    part::{Part, SkippedPart},
};
use crate::{
    cell::{DecimalMark, Delimiter},
    error::{FileError, FileProblem},
    input::{Encoding, Input},
};

/// How the file is written, where it should not be found out, and which of its tests is meant.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "File")]
pub struct ReadOptions {
    /// The one test of a file that holds several: its name (a sheet, a curve, a test_id), or its number from 1.
    pub part: Option<String>,
    /// Of delimited text: what stands between two cells.
    pub delimiter: Option<Delimiter>,
    /// Of delimited text: the decimal mark of the numbers.
    pub decimal: Option<DecimalMark>,
    /// Of delimited text: its character encoding.
    pub encoding: Option<Encoding>,
    /// Of delimited text: lines at the top to pass over unread. Neither metadata nor names are looked for in them.
    pub skip_lines: Option<usize>,
    /// true: the columns have a line of names, even where it looks like data. false: they have none, even where a
    /// line looks like it.
    pub header: Option<bool>,
}

/// What a format found in a file.
#[derive(Debug)]
pub(crate) struct Found {
    pub(crate) parts: Vec<Part>,
    pub(crate) skipped: Vec<SkippedPart>,
    pub(crate) reader: Box<dyn ReadPart>,
}

/// Hears of the bytes done and of those there are while a file is read, and may end it.
pub type Heard<'a> = dyn FnMut(u64, u64) -> Result<(), Cancelled> + 'a;

/// The share `done` of `total` in the bytes of a file of this size.
pub(crate) fn share(done: u64, total: u64, size: u64) -> u64 {
    (done as f64 / total.max(1) as f64 * size as f64) as u64
}

/// A number that is none or infinite, in a format whose rows (from 0) and columns (from 1) have numbers.
pub(crate) fn not_finite(input: &Input, row: usize, column: usize) -> FileError {
    let place = format!("row {}, column {column}", row + 1);
    let hint = "export the record again, or choose another column";
    input.wrong(FileProblem::bad_cell(&place, "a finite number", "none, or an infinite one", hint))
}

/// What a format can do once it has looked into a file.
pub(crate) trait ReadPart: Send + Sync {
    /// Reads the columns with these numbers (from 1, in any order, perhaps one twice) of the part with this index.
    ///
    /// Both the index and the numbers are those of [`Contents::parts`]. Columns of one clock have the same length.
    fn read(&self, part: usize, columns: &[usize], progress: &mut Heard<'_>) -> Result<Columns, FileError>;

    /// How delimited text is written; `None` in other formats.
    fn layout(&self) -> Option<&Layout> {
        None
    }
}

impl fmt::Debug for dyn ReadPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ReadPart")
    }
}
