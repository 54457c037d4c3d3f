//! What can be wrong with a file.

use std::{
    fmt, io,
    path::{Path, PathBuf},
};

use super::{
    foreign::Foreign,
    shown::{bytes, files, shown, skipped},
};
use crate::cell::{DecimalMark, Delimiter};

/// Where in a file a cell stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellPlace {
    /// The file.
    pub path: PathBuf,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// Name of the column, if it has one.
    pub name: Option<String>,
}

impl fmt::Display for CellPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (path, line, column) = (self.path.display(), self.line, self.column);
        write!(f, "{path}, line {line}, column {column}")?;
        match &self.name {
            Some(name) => write!(f, " ({})", shown(name)),
            None => Ok(()),
        }
    }
}

/// Why it is uncertain which character marks decimals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum DecimalDoubt {
    /// Commas seem to stand both between cells and inside numbers.
    #[error("expected commas either between cells or inside numbers, they seem to be both")]
    CommaSplitsNumbers,
    /// Every comma is followed by three digits, as between thousands.
    #[error("expected a decimal comma, but every comma could also set off thousands")]
    Thousands,
    /// Every point is followed by three digits, as between thousands, beside whole numbers or semicolons.
    #[error("expected a decimal point, but every point could also set off thousands")]
    PointThousands,
    /// Some numbers have a decimal point, others a decimal comma.
    #[error("expected one decimal mark, found both points and commas")]
    Mixed,
}

/// Why a file cannot be read.
///
/// [`FileError::hint`] says what would help, where that is known.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// There is no such file.
    #[error("{}: no such file", path.display())]
    NotFound {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The path leads to a directory.
    #[error("{}: expected a file, found a directory", path.display())]
    Directory {
        /// The directory.
        path: PathBuf,
    },
    /// The path leads to a pipe or a device, which cannot be gone through twice.
    #[error("{}: expected a file, found a pipe or a device", path.display())]
    NoFile {
        /// The pipe or device.
        path: PathBuf,
    },
    /// The operating system does not hand the file out.
    #[error("{}: cannot be read ({})", path.display(), reason(source))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The file holds nothing, or blanks only.
    #[error("{}: the file is empty", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file holds no record in any format that is known here.
    #[error("{}: expected a record, found {looks_like}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What it looks like.
        looks_like: Foreign,
    },
    /// An archive that holds no file, or several.
    #[error("{}: expected a zip archive of one file, found {}", path.display(), files(members))]
    Archive {
        /// The archive.
        path: PathBuf,
        /// The files in it.
        members: Vec<String>,
    },
    /// A part of the file is not as its format has it: cut off, overwritten, or written by another rule.
    #[error("{}: {}: expected {}, found {}", path.display(), shown(place), shown(expected), shown(found))]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        place: String,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The file is whole, and is not of a kind that is read.
    #[error("{}: {}: expected {}, found {}", path.display(), shown(place), shown(expected), shown(found))]
    Unfit {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        place: String,
        /// What is read.
        expected: &'static str,
        /// What is there.
        found: String,
        /// What would help.
        hint: &'static str,
    },
    /// A cell does not hold the number that was asked for, in a format where cells have names.
    #[error("{}, {}: expected {}, found {}", path.display(), shown(place), shown(expected), shown(found))]
    BadCell {
        /// The file.
        path: PathBuf,
        /// The cell, in words.
        place: String,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
        /// What would help.
        hint: &'static str,
    },
    /// The file can be read with a password only.
    #[error("{}: expected a file without a password, found an encrypted one", path.display())]
    Encrypted {
        /// The file.
        path: PathBuf,
    },
    /// More than is read of any file.
    #[error("{}: {what} has more than {}, which is the most that is read", path.display(), bytes(*most_bytes))]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// What is too large.
        what: &'static str,
        /// The limit.
        most_bytes: u64,
    },
    /// A small file that unpacks to a large one.
    #[error("{}: expected a file that unpacks to at most {most_times} times its size, found one of more", path.display())]
    Swells {
        /// The file.
        path: PathBuf,
        /// The limit.
        most_times: u64,
    },
    /// No part of the file is a table of numbers.
    #[error("{}: expected a test, found none{}", path.display(), skipped(parts))]
    NoParts {
        /// The file.
        path: PathBuf,
        /// The parts that were looked at, with why they are none.
        parts: Vec<(String, String)>,
    },
    /// A line is longer than any row of a table would be.
    #[error("{}, line {line}: expected lines of at most {limit} bytes, this one is longer", path.display())]
    LineTooLong {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Longest line that is read, in bytes.
        limit: usize,
    },
    /// The rows of numbers do not fall into columns.
    #[error("{}, line {line}: expected two or more columns, found one: `{}`", path.display(), shown(found))]
    OneColumn {
        /// The file.
        path: PathBuf,
        /// First line of numbers, from 1.
        line: usize,
        /// That line, shortened.
        found: String,
        /// The delimiter the caller asked for.
        delimiter: Option<Delimiter>,
    },
    /// There are no rows of numbers, though there may be names of columns.
    #[error("{}: expected rows of numbers, found none in the first {lines} lines", path.display())]
    NoDataRows {
        /// The file.
        path: PathBuf,
        /// How many lines were looked at.
        lines: usize,
        /// A line that looks like names of columns, from 1.
        header_line: Option<usize>,
    },
    /// It is uncertain which character marks decimals.
    #[error("{}, line {line}: {doubt}: `{}`", path.display(), shown(found))]
    AmbiguousDecimal {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Text in doubt, shortened.
        found: String,
        /// What the doubt is.
        doubt: DecimalDoubt,
    },
    /// A column was chosen that the file does not have.
    #[error("{}: expected a column from 1 to {columns}, found {column}", path.display())]
    NoSuchColumn {
        /// The file.
        path: PathBuf,
        /// The column chosen.
        column: usize,
        /// How many columns there are.
        columns: usize,
    },
    /// A cell in a column of numbers holds something else.
    #[error("{place}: expected a number with a decimal {decimal}, found `{}`", shown(found))]
    TextInNumbers {
        /// The cell.
        place: CellPlace,
        /// What it holds, shortened.
        found: String,
        /// The decimal mark in force.
        decimal: DecimalMark,
    },
    /// A cell in a column of numbers holds a word for "no number" or for infinity.
    #[error("{place}: expected a finite number, found `{}`", shown(found))]
    NotFinite {
        /// The cell.
        place: CellPlace,
        /// What it holds.
        found: String,
    },
    /// A cell in a column of numbers holds nothing.
    #[error("{place}: expected a number, found an empty cell")]
    EmptyCell {
        /// The cell.
        place: CellPlace,
    },
    /// A row ends early.
    #[error("{}, line {line}: expected {expected} cells, found {found}", path.display())]
    TooFewCells {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Fewest cells a row must have.
        expected: usize,
        /// Cells this row has.
        found: usize,
    },
    /// A row has cells beyond the last column.
    #[error("{}, line {line}: expected {expected} cells, found {found}", path.display())]
    TooManyCells {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Columns the file has.
        expected: usize,
        /// Cells this row has.
        found: usize,
    },
    /// Something that is no data stands between rows of data.
    #[error("{}, line {line}: expected a row of data, found `{}` with more data from line {resumes}", path.display(), shown(found))]
    Interrupted {
        /// The file.
        path: PathBuf,
        /// First line that is no data, from 1.
        line: usize,
        /// That line, shortened.
        found: String,
        /// Line the data goes on at.
        resumes: usize,
        /// What is wrong with the line, taken as data.
        source: Box<FileError>,
    },
}

impl FileError {
    /// A part of the file at `path` is not as its format has it.
    pub(crate) fn damaged(
        path: &Path,
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        Self::Damaged {
            path: path.to_owned(),
            place: place.into(),
            expected: expected.into(),
            found: found.into(),
        }
    }

    /// A cell of the file at `path` does not hold the number that was asked for.
    pub(crate) fn bad_cell(
        path: &Path,
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
        hint: &'static str,
    ) -> Self {
        Self::BadCell {
            path: path.to_owned(),
            place: place.into(),
            expected: expected.into(),
            found: found.into(),
            hint,
        }
    }

    /// What kind of refusal of the operating system it is, if it is one.
    #[must_use]
    pub fn io_kind(&self) -> Option<io::ErrorKind> {
        match self {
            Self::NotFound { source, .. } | Self::Unreadable { source, .. } => Some(source.kind()),
            Self::Directory { .. } => Some(io::ErrorKind::IsADirectory),
            _ => None,
        }
    }

    /// Sorts what the operating system says about `path` into causes.
    #[must_use]
    pub fn from_io(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path, source },
            io::ErrorKind::IsADirectory => Self::Directory { path },
            _ => Self::Unreadable { path, source },
        }
    }
}

/// Why the operating system does not hand a file out, in words.
fn reason(source: &io::Error) -> String {
    match source.kind() {
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => shown(&source.to_string()),
    }
}

/// `text` cut to a length that fits into a message.
pub(crate) fn shorten(text: &str) -> String {
    const MOST: usize = 40;
    let text = text.trim();
    if text.chars().count() <= MOST {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(MOST - 1).collect();
    short.push('…');
    short
}
