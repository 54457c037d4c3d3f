//! What can be wrong with a file.

use std::{
    error::Error,
    fmt, io,
    path::{Path, PathBuf},
};

use palpate::watch::Cancelled;

use super::{
    foreign::Foreign,
    shown::{bytes, shown, skipped},
};
use crate::cell::{DecimalMark, Delimiter};

/// Where in a file a cell stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CellPosition {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// Name of the column, if it has one.
    pub name: Option<String>,
}

impl fmt::Display for CellPosition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.name.as_ref().map_or_else(String::new, |name| format!(" ({})", shown(name)));
        write!(f, "line {}, column {}{name}", self.line, self.column)
    }
}

/// Numbers in a sentence.
fn listed(numbers: &[usize]) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// Why it is uncertain which character marks decimals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
pub enum DecimalDoubt {
    /// Commas seem to stand both between cells and inside numbers.
    #[error("expected commas either between cells or within numbers, found both")]
    CommaSplitsNumbers,
    /// Every comma is followed by three digits, as between thousands.
    #[error("expected a decimal comma, but every comma could also separate thousands")]
    Thousands,
    /// Every point is followed by three digits, as between thousands, beside whole numbers or semicolons.
    #[error("expected a decimal point, but every point could also separate thousands")]
    PointThousands,
    /// Some numbers have a decimal point, others a decimal comma.
    #[error("expected one decimal mark, found both points and commas")]
    Mixed,
}

/// Why a file cannot be read.
///
/// [`FileError::hint`] says what would help, where that is known.
#[derive(Debug)]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: FileProblem,
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.path.display(), self.problem)
    }
}

impl Error for FileError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.problem.source()
    }
}

impl From<Cancelled> for FileError {
    fn from(_: Cancelled) -> Self {
        Self {
            path: PathBuf::new(),
            problem: FileProblem::Cancelled,
        }
    }
}

/// What can be wrong with a file, as it is written behind its path.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileProblem {
    /// Who heard of the reading ended it.
    #[error(": cancelled")]
    Cancelled,
    /// There is no such file; what the operating system says.
    #[error(": no such file")]
    NotFound(#[source] io::Error),
    /// The path leads to a directory.
    #[error(": expected a file, found a directory")]
    Directory,
    /// The path leads to a pipe, a socket or a device, which cannot be gone through twice.
    #[error(": expected a file, found {0}")]
    NoFile(&'static str),
    /// The file is not the one any more that was opened.
    #[error(": changed while it was read")]
    Changed,
    /// The operating system does not hand the file out; what it says.
    #[error(": cannot be read ({})", reason(.0))]
    Unreadable(#[source] io::Error),
    /// The file holds nothing, or blanks only.
    #[error(": the file is empty")]
    Empty,
    /// The file holds no record in any format that is known here, but looks like this.
    #[error(": expected a record, found {0}")]
    Foreign(Foreign),
    /// An archive that holds no file.
    #[error(": expected a zip archive with a record, found one without files")]
    EmptyArchive,
    /// Something in the file is not as its format has it, is of a kind that is not read, or is not the number that was
    /// requested.
    #[error("{place}: expected {}, found {}", shown(expected), shown(found))]
    Unlike {
        /// Where in the file, as it is written behind its path.
        place: String,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
        /// What would help.
        hint: &'static str,
    },
    /// The file can be read with a password only.
    #[error(": expected a file without a password, found an encrypted one")]
    Encrypted,
    /// More than is read of any file.
    #[error(": {what} exceeds the limit of {}", bytes(*most_bytes))]
    TooLarge {
        /// What is too large.
        what: &'static str,
        /// The limit.
        most_bytes: u64,
    },
    /// A small file that unpacks to more than this many times its size.
    #[error(": expected a file that unpacks to at most {0} times its size, found more")]
    DecompressionLimit(u64),
    /// No part of the file is a table of numbers: the parts that were looked at, with why they are none.
    #[error(": expected a test, found none{}", skipped(.0))]
    NoParts(Vec<(String, String)>),
    /// A line is longer than any row of a table would be.
    #[error(", line {line}: expected lines of at most {limit} bytes, found a longer line")]
    LineTooLong {
        /// Line, from 1.
        line: usize,
        /// Longest line that is read, in bytes.
        limit: usize,
    },
    /// A packed file unpacks to lines that hold no row.
    #[error(", line {line}: expected rows of numbers, found more than {} of packed lines without any", bytes(*most_bytes))]
    Idle {
        /// Line, from 1, up to which there were so many.
        line: usize,
        /// Most bytes of such lines.
        most_bytes: u64,
    },
    /// The rows of numbers do not fall into columns.
    #[error(", line {line}: expected two or more columns, found one: `{}`", shown(found))]
    OneColumn {
        /// First line of numbers, from 1.
        line: usize,
        /// That line, shortened.
        found: String,
        /// The delimiter the caller requested.
        delimiter: Option<Delimiter>,
    },
    /// There are no rows of numbers, though there may be names of columns.
    #[error(": expected rows of numbers, found none in the first {lines} lines")]
    NoDataRows {
        /// How many lines were looked at.
        lines: usize,
        /// A line that looks like names of columns, from 1.
        header_line: Option<usize>,
    },
    /// It is uncertain which character marks decimals.
    #[error(", line {line}: {doubt}: `{}`", shown(found))]
    AmbiguousDecimal {
        /// Line, from 1.
        line: usize,
        /// Text in doubt, shortened.
        found: String,
        /// What the doubt is.
        doubt: DecimalDoubt,
    },
    /// A column was chosen that the file does not have.
    #[error(": expected a column from 1 to {columns}, found {column}")]
    NoSuchColumn {
        /// The column chosen.
        column: usize,
        /// How many columns there are.
        columns: usize,
    },
    /// A cell in a column of numbers holds something else.
    #[error(", {place}: expected a number with a decimal {decimal}, found `{}`", shown(found))]
    TextInNumbers {
        /// The cell.
        place: CellPosition,
        /// What it holds, shortened.
        found: String,
        /// The decimal mark in force.
        decimal: DecimalMark,
    },
    /// A cell in a column of numbers holds a word for "no number" or for infinity.
    #[error(", {place}: expected a finite number, found `{}`", shown(found))]
    NotFinite {
        /// The cell.
        place: CellPosition,
        /// What it holds.
        found: String,
    },
    /// This cell in a column of numbers holds nothing.
    #[error(", {0}: expected a number, found an empty cell")]
    EmptyCell(CellPosition),
    /// More than a few cells of a column hold no number.
    #[error(", {place}: expected a number in every row, found none in {lacking} of {rows} (first lines: {})", listed(.lines))]
    ManyLacking {
        /// The first such cell of the column with the most of them.
        place: CellPosition,
        /// How many there are.
        lacking: usize,
        /// Rows of data.
        rows: usize,
        /// The first of their lines, from 1.
        lines: Vec<usize>,
    },
    /// A row ends early, or has cells beyond the last column.
    #[error(", line {line}: expected {expected} cells, found {found}")]
    CellCount {
        /// Line, from 1.
        line: usize,
        /// Fewest cells a row must have, or all that it may have.
        expected: usize,
        /// Cells this row has.
        found: usize,
    },
    /// Something that is no data stands between rows of data.
    #[error(
        ", line {line}: expected a row of data, found `{}` with more data from line {resumes}",
        shown(found)
    )]
    Interrupted {
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

impl FileProblem {
    /// A part of the file is not as its format has it: cut off, overwritten, or written by another rule.
    pub(crate) fn damaged(place: impl Into<String>, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::unfit(place, expected, found, "copy or export the file again; it may be cut off")
    }

    /// The file is whole, and is not of a kind that is read.
    pub(crate) fn unfit(
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
        hint: &'static str,
    ) -> Self {
        let (expected, found) = (expected.into(), found.into());
        let place = format!(": {}", shown(&place.into()));
        Self::Unlike {
            place,
            expected,
            found,
            hint,
        }
    }

    /// A cell does not hold the number that was requested, in a format where cells have names.
    pub(crate) fn bad_cell(
        place: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
        hint: &'static str,
    ) -> Self {
        let (expected, found) = (expected.into(), found.into());
        let place = format!(", {}", shown(place));
        Self::Unlike {
            place,
            expected,
            found,
            hint,
        }
    }
}

impl FileError {
    /// Its message less the file it is about.
    pub(crate) fn without_path(&self) -> String {
        let problem = self.problem.to_string();
        let bare = [": ", ", "].iter().find_map(|mark| problem.strip_prefix(mark));
        bare.map_or_else(|| self.to_string(), str::to_owned)
    }

    /// Something is wrong with the file at `path`.
    pub(crate) fn of(path: &Path, problem: FileProblem) -> Self {
        let path = path.to_owned();
        Self { path, problem }
    }

    /// The same, of an excerpt of the file: `line_of` gives the line of the file that a line of the excerpt is.
    pub(crate) fn on_lines(mut self, line_of: &dyn Fn(usize) -> usize) -> Self {
        match &mut self.problem {
            FileProblem::LineTooLong { line, .. }
            | FileProblem::Idle { line, .. }
            | FileProblem::OneColumn { line, .. }
            | FileProblem::AmbiguousDecimal { line, .. }
            | FileProblem::CellCount { line, .. } => *line = line_of(*line),
            FileProblem::TextInNumbers { place, .. }
            | FileProblem::NotFinite { place, .. }
            | FileProblem::EmptyCell(place) => place.line = line_of(place.line),
            FileProblem::ManyLacking {
                place, lines: found, ..
            } => {
                place.line = line_of(place.line);
                found.iter_mut().for_each(|line| *line = line_of(*line));
            }
            FileProblem::Interrupted {
                line, resumes, source, ..
            } => {
                (*line, *resumes) = (line_of(*line), line_of(*resumes));
                let below = std::mem::replace(&mut **source, Self::from(Cancelled));
                **source = below.on_lines(line_of);
            }
            _ => {}
        }
        self
    }

    /// What kind of refusal of the operating system it is, if it is one.
    #[must_use]
    pub fn io_kind(&self) -> Option<io::ErrorKind> {
        match &self.problem {
            FileProblem::NotFound(source) | FileProblem::Unreadable(source) => Some(source.kind()),
            FileProblem::Directory => Some(io::ErrorKind::IsADirectory),
            _ => None,
        }
    }

    /// Sorts what the operating system says about `path` into causes.
    #[must_use]
    pub fn from_io(path: &Path, source: io::Error) -> Self {
        let problem = match source.kind() {
            io::ErrorKind::NotFound => FileProblem::NotFound(source),
            io::ErrorKind::IsADirectory => FileProblem::Directory,
            _ => FileProblem::Unreadable(source),
        };
        Self::of(path, problem)
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
