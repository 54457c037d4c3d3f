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

/// What makes force and displacement of the torque and the angle of a rheometer: those of a body whose section and length are those of
/// the sample, under the shear stress and the shear strain at its rim.
///
/// With T the torque, φ the angle and R the radius, the shear stress at the rim is 2T/(πR³) between parallel plates and 3T/(2πR³) under
/// a cone, the shear strain φR over the gap (Macosko, Rheology, 1994, chapter 5).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Torsion {
    /// Force per torque, 1/m.
    pub force_per_torque: f64,
    /// Displacement per angle, m.
    pub travel_per_angle: f64,
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
    /// What makes force and displacement of torque and angle, where the body is the sample of a rheometer.
    pub torsion: Option<Torsion>,
    /// Options of the analysis.
    pub analysis: AnalysisOptions,
}

impl Default for TestDescription {
    fn default() -> Self {
        Self {
            about: About::default(),
            reading: ReadOptions::default(),
            columns: ColumnChoices::default(),
            torsion: None,
            analysis: AnalysisOptions {
                separation: Separation::Bonded,
                ..AnalysisOptions::default()
            },
        }
    }
}
