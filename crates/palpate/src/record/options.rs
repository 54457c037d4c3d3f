//! Corrections that somebody may ask for.

use serde::{Deserialize, Serialize};

use super::{Baseline, Compliance};

/// What to do about a force that is stamped later than the displacement.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SkewChoice {
    /// Report the estimate.
    #[default]
    Report,
    /// Correct the estimate, if it differs significantly from zero.
    Auto,
    /// The force is stamped this much too late, s.
    Given(f64),
}

/// Corrections of a record that are made only on request; they are made in this order.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct CorrectionOptions {
    /// Stamps of the force.
    pub skew: SkewChoice,
    /// Time constant (s) of a filter of first order in the channel of the force.
    pub force_filter: Option<f64>,
    /// Samples a second, Hz.
    pub resample: Option<f64>,
    /// The force without contact.
    pub baseline: Option<Baseline>,
    /// From when to when there is no contact, s as in the record; found where it is not given.
    pub baseline_window: Option<(f64, f64)>,
    /// Compliance of the machine.
    pub compliance: Option<Compliance>,
}
