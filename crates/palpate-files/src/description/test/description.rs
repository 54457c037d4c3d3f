//! A checked description of a test.

use palpate::{analysis::AnalysisOptions, simulate::Separation};
use schemars::JsonSchema;
use serde::Deserialize;

use super::columns::ColumnChoices;
use crate::table::ReadOptions;

/// What the test is about.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// Title for reports.
    pub title: Option<String>,
    /// Where the record comes from.
    pub source: Option<String>,
    /// Anything else.
    pub note: Option<String>,
}

/// A checked description of a test, everything in SI.
///
/// [`TestDescription::default`] is an empty description.
#[derive(Debug, Clone, PartialEq)]
pub struct TestDescription {
    /// What it is about.
    pub about: About,
    /// What is fixed about how the file is written, and which of its tests is meant.
    pub reading: ReadOptions,
    /// Which columns hold what.
    pub columns: ColumnChoices,
    /// Options of the analysis.
    pub analysis: AnalysisOptions,
}

impl Default for TestDescription {
    fn default() -> Self {
        Self {
            about: About::default(),
            reading: ReadOptions::default(),
            columns: ColumnChoices::default(),
            analysis: AnalysisOptions {
                separation: Separation::Bonded,
                ..AnalysisOptions::default()
            },
        }
    }
}
