//! Lines behind the data: a footer, unless more data come.

use std::path::Path;

use super::columns::{Columns, Footer};
use crate::error::{FileError, FileProblem};

/// Most lines behind the data that pass for a footer. More are a part of the record that cannot be read.
const LONGEST_FOOTER: usize = 50;

/// Faulty lines that may turn out to be a footer.
pub(crate) struct Suspect {
    footer: Footer,
    /// What is wrong with the first of them, taken as data.
    error: FileError,
}

impl Suspect {
    /// These lines and one more, which the fault is of if there are none before.
    pub(crate) fn with(
        before: Option<Self>,
        line: usize,
        fault: impl FnOnce() -> (String, FileError),
    ) -> Result<Self, FileError> {
        let mut suspect = before.unwrap_or_else(|| {
            let (sample, error) = fault();
            let footer = Footer {
                first_line: line,
                lines: 0,
                sample,
            };
            Self { footer, error }
        });
        suspect.footer.lines += 1;
        if suspect.footer.lines > LONGEST_FOOTER { Err(suspect.error) } else { Ok(suspect) }
    }

    /// They were none: the data go on.
    pub(crate) fn interrupted(self, path: &Path, resumes: usize) -> FileError {
        let problem = FileProblem::Interrupted {
            line: self.footer.first_line,
            found: self.footer.sample,
            resumes,
            source: Box::new(self.error),
        };
        FileError::of(path, problem)
    }
}

impl Columns {
    /// The columns at the end of their rows, with what stands behind these; `none` is the error of no rows at all.
    pub(crate) fn ended(
        mut self,
        suspect: Option<Suspect>,
        none: impl FnOnce() -> FileError,
    ) -> Result<Self, FileError> {
        if self.rows() == 0 {
            return Err(suspect.map_or_else(none, |suspect| suspect.error));
        }
        self.ignored.footer = suspect.map(|suspect| suspect.footer);
        self.finish();
        Ok(self)
    }
}
