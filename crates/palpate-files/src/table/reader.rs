//! What every format can do: look into a file, and read columns of the tests in it.

use std::fmt;

use super::{
    columns::Columns,
    layout::{Layout, LayoutOptions},
    part::{Part, SkippedPart},
};
use crate::error::FileError;

/// What a caller knows about a file better than its bytes do. Everything left out is found out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReadOptions {
    /// How delimited text is written.
    pub layout: LayoutOptions,
    /// The one part wanted: its name, or its number from 1.
    pub part: Option<String>,
}

/// What a format found in a file.
#[derive(Debug)]
pub(crate) struct Found {
    pub(crate) parts: Vec<Part>,
    pub(crate) skipped: Vec<SkippedPart>,
    pub(crate) reader: Box<dyn ReadPart>,
}

/// What a format can do once it has looked into a file.
pub(crate) trait ReadPart: Send + Sync {
    /// Reads the columns with these numbers (from 1, in any order, perhaps one twice) of the part with this index.
    ///
    /// Both the index and the numbers are those of [`Contents::parts`]. Columns of one clock have the same length.
    fn read(&self, part: usize, columns: &[usize], progress: &mut dyn FnMut(u64, u64)) -> Result<Columns, FileError>;

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
