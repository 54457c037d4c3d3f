//! The description of a test.

use std::path::{Path, PathBuf};

use palpate::analysis::AnalysisOptions;
use palpate_files::description::{NamedColumns, TestDescription, parse_test, read_text};

use crate::JobError;
use crate::output::sha256;

/// What is stated about the tests in a file, and where it stands; the default says nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Described {
    /// What is stated.
    pub test: Option<TestDescription>,
    /// The file in which it stands.
    pub path: Option<PathBuf>,
    /// Its text.
    pub text: Option<String>,
    /// A second file, in which the test goes on.
    pub then: Option<PathBuf>,
}

impl Described {
    /// The description in a file, if there is one, with the part of the record's file that is meant.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read, or is none.
    pub fn read(path: Option<&Path>, part: Option<&str>) -> Result<Self, JobError> {
        let Some(path) = path else {
            return Ok(Self::default().with_part(part));
        };
        let text = read_text(path)?;
        Ok(Self {
            test: Some(parse_test(&text, path)?),
            path: Some(path.to_owned()),
            text: Some(text),
            then: None,
        }
        .with_part(part))
    }

    /// A description that was read already.
    ///
    /// # Errors
    /// [`JobError`] where it is none.
    pub fn parse(text: String, part: Option<&str>) -> Result<Self, JobError> {
        Ok(Self {
            test: Some(parse_test(&text, Path::new("test"))?),
            path: None,
            text: Some(text),
            then: None,
        }
        .with_part(part))
    }

    /// The same of a test that goes on in a second file: its ramp in one, its hold in the other.
    #[must_use]
    pub fn with_then(mut self, then: Option<PathBuf>) -> Self {
        self.then = then;
        self
    }

    fn with_part(mut self, part: Option<&str>) -> Self {
        if let Some(part) = part {
            self.test.get_or_insert_default().reading.part = Some(part.to_owned());
        }
        self
    }

    /// The same with the columns that were named beside it, which go before its own.
    #[must_use]
    pub fn with_columns(mut self, named: Option<&NamedColumns>) -> Self {
        if let Some(NamedColumns { text, columns }) = named {
            self.test.get_or_insert_default().columns.lay_over(columns);
            // Results that keep the description tell what was read by this.
            self.text = Some(format!("{}# --columns \"{text}\"\n", self.text.unwrap_or_default()));
        }
        self
    }

    /// The options of an analysis that it says.
    #[must_use]
    pub fn options(&self) -> AnalysisOptions {
        self.test.as_ref().map_or_else(AnalysisOptions::default, |test| test.analysis.clone())
    }

    /// SHA-256 of what is stated, hexadecimal.
    #[must_use]
    pub fn sha256(&self) -> Option<String> {
        self.text.as_ref().map(|text| sha256(text.as_bytes()))
    }

    /// Its path as results name it.
    pub(crate) fn shown(&self) -> Option<String> {
        self.path.as_ref().map(|path| path.display().to_string())
    }
}
