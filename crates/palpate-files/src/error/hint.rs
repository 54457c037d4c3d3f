//! What would help against an error, in words that go with any front end.

use std::io;

use super::{
    file_error::{DecimalDoubt, FileError, FileProblem},
    foreign::Foreign,
};
use crate::cell::{Cell, DecimalMark, number};

impl FileError {
    /// What would help, if that is known.
    #[must_use]
    pub fn hint(&self) -> Option<String> {
        let help = match &self.problem {
            FileProblem::Cancelled => return None,
            FileProblem::NotFound(_) if self.path.is_symlink() => {
                "it is a link to a file that is missing: renew or remove it"
            }
            FileProblem::NotFound(_) => "check the spelling of the path",
            FileProblem::Directory => "name one file inside it",
            FileProblem::NoFile("a terminal") => "send the file through a pipe: `palpate watch - < log.csv`",
            FileProblem::NoFile(_) => "name standard input `-`, or write the output of the pipe to a file first",
            FileProblem::Changed => "read it again when the machine has finished writing",
            FileProblem::Unreadable(source) if source.kind() == io::ErrorKind::PermissionDenied => {
                "check the owner of the file and its read permission"
            }
            FileProblem::Unreadable(_) => return None,
            FileProblem::Empty => "export the record again",
            FileProblem::Foreign(looks_like) => foreign(*looks_like),
            FileProblem::EmptyArchive => "pack the record again",
            FileProblem::Unlike { hint, .. } => hint,
            FileProblem::Encrypted => "open it in its program and save it without a password",
            FileProblem::TooLarge { .. } => "split the file, or export a part of it",
            FileProblem::DecompressionLimit(_) => {
                "copy or export it again; if you trust it, unpack it, or write it without compression"
            }
            FileProblem::NoParts(_) => "a test needs a table of numbers with time and force side by side",
            FileProblem::Idle { .. } => {
                "remove the blank lines and those without numbers; if you trust the file, unpack it"
            }
            FileProblem::LineTooLong { .. } => "check line ends and encoding of the file",
            FileProblem::OneColumn { delimiter, .. } => match delimiter {
                Some(by) => return Some(format!("the delimiter is fixed to {by}: omit it to have it detected")),
                None => "a record needs a time and a force side by side, separated by tab, semicolon, comma or blanks",
            },
            FileProblem::NoDataRows {
                header_line: Some(line),
                ..
            } => {
                return Some(format!("line {line} looks like column names, but no numbers follow"));
            }
            FileProblem::NoDataRows { .. } => "check that this file is the record, or skip the lines before the table",
            FileProblem::AmbiguousDecimal { doubt, .. } => doubtful(*doubt),
            FileProblem::NoSuchColumn { .. } => "columns count from 1 at the left",
            FileProblem::TextInNumbers { found, decimal, .. } => hint_of_text(found, *decimal),
            FileProblem::NotFinite { .. } | FileProblem::EmptyCell(_) => "remove the row, or choose another column",
            FileProblem::ManyLacking { .. } => "fill the cells or remove their rows, or choose another column",
            FileProblem::CellCount { expected, found, .. } if found < expected => {
                "the row is cut off or lacks a cell: complete it or remove it"
            }
            FileProblem::CellCount { .. } => "quote cells that contain the delimiter, such as a decimal comma",
            FileProblem::Interrupted { .. } => "if the file holds several records, split it into one file each",
        };
        Some(help.to_owned())
    }
}

fn foreign(looks_like: Foreign) -> &'static str {
    match looks_like {
        Foreign::Markup => "open it in a spreadsheet program and save the sheet as CSV",
        Foreign::OpenDocument => "save it as an Excel workbook (.xlsx), or the sheet as CSV",
        Foreign::Sqlite => "export the record as delimited text; `ros2 bag convert` turns a bag of ROS 2 into MCAP",
        Foreign::Zip | Foreign::Compressed => "unpack it first, or export the record as text",
        Foreign::Picture | Foreign::Pdf => "give a record of numbers, not a document",
        Foreign::Binary => "export the record as text, or fix its encoding if it is text",
        _ => "export the record as delimited text",
    }
}

fn doubtful(doubt: DecimalDoubt) -> &'static str {
    match doubt {
        DecimalDoubt::CommaSplitsNumbers => {
            "export with semicolons or tabs between cells; if the commas only separate whole numbers, fix the decimal mark to point"
        }
        DecimalDoubt::Thousands => {
            "state the decimal mark in a test description: of 1,234 comma makes 1.234, and point 1234\n[file]\ndecimal = \"comma\""
        }
        DecimalDoubt::PointThousands => {
            "state the decimal mark in a test description: of 1.234 point makes 1.234, and comma 1234\n[file]\ndecimal = \"point\""
        }
        DecimalDoubt::Mixed => {
            "state the decimal mark in a test description: the other one then sets off thousands\n[file]\ndecimal = \"comma\""
        }
    }
}

/// What would help against a text where a number should stand.
pub(crate) fn hint_of_text(found: &str, decimal: DecimalMark) -> &'static str {
    let cell = found.as_bytes();
    let gaps = |letter: char| matches!(letter, '\u{a0}' | '\u{202f}' | '\u{2009}' | '\'' | '\u{2019}' | ' ');
    match (number::classify(cell), decimal) {
        _ if found.contains('\u{2212}') => "the minus sign is U+2212: replace it with a hyphen",
        (Cell::Comma | Cell::Point, _) if number::has_thousands(cell) => {
            "export without thousands separators; if the mark is decimal, fix the decimal mark to it"
        }
        (Cell::Comma, DecimalMark::Point) => "fix the decimal mark to comma",
        (Cell::Point, DecimalMark::Comma) => "fix the decimal mark to point",
        _ if number::has_thousands(cell) || number::looks_numeric(found) && found.contains(gaps) => {
            "export without thousands separators"
        }
        _ if number::looks_numeric(found) => "these numbers are stored as texts: export them as numbers",
        _ => "repair or remove the line; if the data begin further down, set skip_lines",
    }
}
