//! A finding with its words.

use palpate::analysis::Finding;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::result::word;

/// A finding with its words.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FindingDocument {
    /// Stable code.
    pub code: String,
    /// `info`, `caution` or `warning`.
    pub severity: String,
    /// What was seen.
    pub seen: String,
    /// What it may mean.
    pub meaning: String,
    /// What helps.
    pub remedy: String,
}

impl From<&Finding> for FindingDocument {
    fn from(finding: &Finding) -> Self {
        Self {
            code: finding.code().to_owned(),
            severity: word(finding.severity()),
            seen: finding.seen(),
            meaning: finding.meaning().to_owned(),
            remedy: finding.remedy().to_owned(),
        }
    }
}
