//! Errors of jobs, with messages for every front end.

use std::fmt;
use std::io;
use std::path::Path;

use palpate::analysis::AnalysisError;
use palpate::simulate::SimulateError;
use palpate::watch::Cancelled;
use palpate_files::description::DescriptionError;
use palpate_files::record::ReadError;
use palpate_files::{FileError, FileProblem};
use palpate_report::spelling::spelled;
use palpate_report::study::StudyError;

/// Kind of the failure of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// An invalid option or description.
    Option,
    /// The operating system refuses to read or write a file.
    File(io::ErrorKind),
    /// A record that cannot be read or analysed.
    Record,
    /// A record that processes ended with while they analysed it.
    Ended,
    /// Invalid parameters of a body, a law or a motion.
    Model,
    /// Samples that no law can be fitted to.
    Fit,
    /// A figure or document that could not be made.
    Report,
    /// The watch ended the job.
    Cancelled,
}

/// Error of a job.
///
/// Message and hint name options between `⟨` and `⟩`, such as `⟨poisson_ratio⟩` or `⟨equilibrium=hertz⟩`; a front end writes them as its
/// users do, by [`spelled`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JobError {
    /// Its kind.
    pub kind: ErrorKind,
    /// The file that the message is about, where the message does not name it.
    pub place: Option<String>,
    /// The error: what was expected and what was found.
    pub message: String,
    /// Remedy.
    pub hint: Option<String>,
}

impl JobError {
    /// An error that speaks of no file; an empty hint is none.
    pub fn new(kind: ErrorKind, message: impl fmt::Display, hint: impl Into<Option<String>>) -> Self {
        Self {
            kind,
            place: None,
            message: message.to_string(),
            hint: hint.into().filter(|hint| !hint.is_empty()),
        }
    }

    /// An option that no computation can follow.
    pub fn option(message: impl fmt::Display, hint: &str) -> Self {
        Self::new(ErrorKind::Option, message, hint.to_owned())
    }

    /// The same error, about a file.
    #[must_use]
    pub fn of(mut self, place: impl fmt::Display) -> Self {
        self.place = Some(place.to_string());
        self
    }

    /// What the operating system says about a file to be read.
    pub(crate) fn unread(path: &Path, error: &io::Error) -> Self {
        Self::new(ErrorKind::File(error.kind()), error, None).of(path.display())
    }

    /// Of a simulation that cannot go on.
    pub(crate) fn simulation(error: SimulateError) -> Self {
        match error {
            SimulateError::Cancelled(cancelled) => cancelled.into(),
            error => Self::new(ErrorKind::Model, error, None),
        }
    }

    /// Of an analysis, with its hint.
    pub(crate) fn analysis(error: &AnalysisError, place: &str) -> Self {
        match error {
            AnalysisError::Cancelled(cancelled) => (*cancelled).into(),
            error => Self::new(ErrorKind::Record, error, error.hint()).of(place),
        }
    }

    /// Whether the same input fails so again: what the operating system refused, or ended, once may succeed the next time.
    pub(crate) fn is_lasting(&self) -> bool {
        !matches!(self.kind, ErrorKind::File(_) | ErrorKind::Ended)
    }

    /// The message with the file in front, options spelled as a front end writes them.
    pub fn reported(&self, spell: impl Fn(&str) -> String) -> String {
        let place = self.place.as_ref().map_or(String::new(), |place| format!("{place}: "));
        format!("{place}{}", spell(&self.message))
    }
}

impl fmt::Display for JobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reported(|message| spelled(message, &|name, _| name.to_owned())))
    }
}

impl std::error::Error for JobError {}

/// A message without the path of its file in front, where that stands elsewhere.
pub(crate) fn without(path: &Path, message: &str) -> String {
    let rest = message.strip_prefix(&path.display().to_string());
    rest.map_or(message, |rest| rest.trim_start_matches([':', ',', ' '])).to_owned()
}

impl From<Cancelled> for JobError {
    fn from(cancelled: Cancelled) -> Self {
        Self::new(ErrorKind::Cancelled, cancelled, None)
    }
}

impl From<ReadError> for JobError {
    fn from(error: ReadError) -> Self {
        if let ReadError::File(FileError {
            problem: FileProblem::Cancelled,
            ..
        }) = &error
        {
            return Cancelled.into();
        }
        let io = if let ReadError::File(error) = &error { error.io_kind() } else { None };
        Self::new(io.map_or(ErrorKind::Record, ErrorKind::File), &error, error.hint())
    }
}

impl From<DescriptionError> for JobError {
    fn from(error: DescriptionError) -> Self {
        let io = if let DescriptionError::File(error) = &error { error.io_kind() } else { None };
        Self::new(io.map_or(ErrorKind::Option, ErrorKind::File), &error, error.hint())
    }
}

impl From<StudyError> for JobError {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Cancelled(cancelled) => cancelled.into(),
            error => Self::new(ErrorKind::Report, error, None),
        }
    }
}

impl From<serde_json::Error> for JobError {
    fn from(error: serde_json::Error) -> Self {
        Self::new(ErrorKind::Report, error, None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_options_plainly() {
        let error = JobError::option("⟨poisson_ratio⟩ is for Hertz's law", "add ⟨equilibrium=hertz⟩");
        assert_eq!(error.to_string(), "poisson_ratio is for Hertz's law");
    }
}
