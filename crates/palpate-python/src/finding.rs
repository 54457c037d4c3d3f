//! What the numbers of a record alone do not tell.

use palpate_report::result::word;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::errors::in_keywords;
use crate::shown::shown;

/// Something about a record, or a hold, that its numbers alone do not tell.
#[pyclass(name = "Finding", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Finding {
    found: palpate_report::page::Finding,
    hold: Option<usize>,
}

impl Finding {
    pub(crate) fn of(found: &palpate_report::page::Finding, hold: Option<usize>) -> Self {
        let found = found.clone();
        Self { found, hold }
    }

    /// What helps; a document names options as the command does.
    fn remedy_in_python(&self) -> String {
        in_keywords(&self.found.remedy)
    }
}

shown! {
    Finding: self
    values {
        /// Stable code, such as "saturated".
        code: &str = &self.found.code,
        /// "info", "caution" or "warning".
        severity: String = word(self.found.severity),
        /// What was observed.
        observation: &str = &self.found.observation,
        /// What it may mean.
        meaning: &str = &self.found.meaning,
        /// What helps.
        remedy: String = self.remedy_in_python(),
        /// Number of the hold, from 1; None for the record as a whole.
        hold: Option<usize> = self.hold,
    }

    fn __repr__(&self) -> String {
        let place = self.hold.map_or(String::new(), |hold| format!(", hold {hold}"));
        format!("<palpate.Finding {} ({}{place}): {}>", self.code(), self.severity(), self.observation())
    }
}
