//! A checked description of a test.

use palpate::{
    analysis::{AnalysisOptions, Geometry, LayersChoice},
    fit::FitOptions,
    record::CorrectionOptions,
    segment::{ContactChoice, GivenHold, SegmentOptions},
    simulate::Separation,
};

use schemars::JsonSchema;
use serde::Deserialize;

use super::{columns::ColumnChoices, settings};
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
/// [`TestDescription::default`] is the test of which nothing is said.
#[derive(Debug, Clone, PartialEq)]
pub struct TestDescription {
    /// What it is about.
    pub about: About,
    /// What is fixed about how the file is written, and which of its tests is meant.
    pub reading: ReadOptions,
    /// Which columns hold what.
    pub columns: ColumnChoices,
    /// The body, if it is known.
    pub geometry: Option<Geometry>,
    /// Whether the jaw could pull.
    pub separation: Separation,
    /// Into how many layers to cut the body in a simulation of the test, if it is said.
    pub layers: Option<LayersChoice>,
    /// Corrections of the record that are asked for.
    pub corrections: CorrectionOptions,
    /// How to find first touch.
    pub touch: ContactChoice,
    /// How to find the phases.
    pub segment: SegmentOptions,
    /// Holds with given limits; where there are any, no others are sought.
    pub given_holds: Vec<GivenHold>,
    /// How to fit.
    pub fit: FitOptions,
    /// The exponents to compare.
    pub exponents: Vec<f64>,
    /// Whether a free exponent is fitted too.
    pub free_exponent: bool,
    /// How much of a hold is fitted, s from its start; `None`: all of it.
    pub until: Option<f64>,
}

impl Default for TestDescription {
    fn default() -> Self {
        Self {
            about: About::default(),
            reading: ReadOptions::default(),
            columns: ColumnChoices::default(),
            geometry: None,
            separation: Separation::Bonded,
            layers: None,
            corrections: CorrectionOptions::default(),
            touch: ContactChoice::AsRecorded,
            segment: SegmentOptions::default(),
            given_holds: Vec::new(),
            fit: FitOptions::default(),
            exponents: settings::USUAL_EXPONENTS.to_vec(),
            free_exponent: true,
            until: None,
        }
    }
}

impl TestDescription {
    /// What an analysis of the test is asked.
    #[must_use]
    pub fn analysis_options(&self) -> AnalysisOptions {
        AnalysisOptions {
            geometry: self.geometry.clone(),
            segment: self.segment,
            corrections: self.corrections.clone(),
            given_holds: self.given_holds.clone(),
            touch: self.touch,
            separation: self.separation,
            layers: self.layers,
            exponents: self.exponents.clone(),
            free_exponent: self.free_exponent,
            fit: self.fit,
            fit_until: self.until,
            ..AnalysisOptions::default()
        }
    }
}
