//! What a job gives: its result, and everything that can be made of it.

use palpate_files::is_unprintable;
use serde::Serialize;

use crate::JobError;

/// Whether the answer of a job that was done is a yes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Done, and the answer is no worse than expected.
    Positive,
    /// Done, and the answer is no: it does not hold, nothing could be compared, a check failed.
    Negative,
}

/// The outcome of a job. Text, document and files are made of its result when they are wanted; nothing is computed again.
#[derive(Debug, Clone)]
pub struct Outcome<R> {
    /// The typed result.
    pub result: R,
    /// Whether the answer is a yes.
    pub verdict: Verdict,
    /// What to know beside the result, a sentence each.
    pub notes: Vec<String>,
}

/// A result that is shown as text and as a document.
pub trait Results {
    /// What programs read.
    type Document: Serialize;

    /// The document.
    fn document(&self) -> Self::Document;

    /// The document as text, indented, with a line end.
    ///
    /// # Errors
    /// [`JobError`] where it has no form in JSON.
    fn json(&self) -> Result<String, JobError> {
        Ok(escaped(&serde_json::to_string_pretty(&self.document())?) + "\n")
    }

    /// Tables and sentences for people.
    fn text(&self) -> String;
}

/// JSON in which letters that no terminal should show are written as their numbers, which changes nothing of what it says.
fn escaped(json: &str) -> String {
    let mut out = String::with_capacity(json.len());
    for letter in json.chars() {
        if is_unprintable(letter) && letter != '\n' {
            out.push_str(&format!("\\u{:04x}", u32::from(letter)));
        } else {
            out.push(letter);
        }
    }
    out
}

impl<R> Outcome<R> {
    /// A result about which there is nothing more to say.
    pub fn of(result: R) -> Self {
        Self {
            result,
            verdict: Verdict::Positive,
            notes: Vec::new(),
        }
    }

    /// The same, with what to know beside it.
    #[must_use]
    pub fn noted(mut self, notes: Vec<String>) -> Self {
        self.notes = notes;
        self
    }

    /// The same with its result made into another.
    #[must_use]
    pub fn map<T>(self, make: impl FnOnce(R) -> T) -> Outcome<T> {
        let Self { result, verdict, notes } = self;
        Outcome {
            result: make(result),
            verdict,
            notes,
        }
    }

    /// The same, where the answer may be a no.
    #[must_use]
    pub fn answered(mut self, positive: bool) -> Self {
        self.verdict = if positive { Verdict::Positive } else { Verdict::Negative };
        self
    }
}
