//! The conditions of a test, as reports of stress-relaxation tests ask for them.

use serde::{Deserialize, Serialize};

/// What a description states of the conditions of a test, and at which times its relaxation is to be stated.
///
/// Reports by ISO 3384 (rubber in compression) and ASTM E328 (materials and structures) give these beside the body and the forces; what is
/// not stated stays open. Nothing here makes a test conform to either.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Conditions {
    /// Temperature of the test, K.
    pub temperature: Option<f64>,
    /// Relative humidity, 0 to 1.
    pub relative_humidity: Option<f64>,
    /// Medium around the specimen, such as air or water.
    pub medium: Option<String>,
    /// Conditioning before the test, mechanical and thermal.
    pub conditioning: Option<String>,
    /// Form of the specimen and how it was made.
    pub specimen_form: Option<String>,
    /// What lies between specimen and plates.
    pub lubricant: Option<String>,
    /// Time from the start of the fit of a hold at which its initial force F₀ is taken, s; from there the times count. 0: at the start of the fit.
    pub initial_force_after: f64,
    /// Times at which R(t) = (F₀ − F(t))/F₀ is stated, s, ascending; `None` for the [usual ones](Self::USUAL_TIMES) that a hold reaches.
    pub relaxation_at: Option<Vec<f64>>,
}

impl Conditions {
    /// Times at which R(t) is stated where none are chosen, s: 1 s to 24 h.
    pub const USUAL_TIMES: [f64; 13] =
        [1.0, 3.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0, 10_800.0, 36_000.0, 86_400.0];
}
