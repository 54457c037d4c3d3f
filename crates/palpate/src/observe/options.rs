//! Options of an observer.

use serde::{Deserialize, Serialize};

use super::ObserveError;
use crate::calibrate::Material;

/// Options of an observer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ObserverOptions {
    /// The calibrated body, if there is one: its excess strain is then known from the first tick. It has a file of its own.
    #[serde(skip)]
    pub material: Option<Material>,
    /// Exponent n of the law if no material is given, from 1 to 30.
    pub exponent: f64,
    /// Standard deviation to which that exponent is known, from 0 to 10; intervals are as much wider. 0 takes it for given.
    pub exponent_standard_error: f64,
    /// Slip force (N): normal force at and below which the held object slips; `None`: no time to slip is computed.
    pub slip_force: Option<f64>,
    /// How long before slip to warn, s.
    pub warn_before: f64,
    /// Coverage of the intervals, between 0 and 1.
    pub confidence: f64,
    /// Standard deviation of one reading, of displacement (m) and force (N); found out from the readings where not given.
    pub noise: Option<(f64, f64)>,
    /// With a material: how much the stiffness of this body may differ from that of the calibrated one, as a standard deviation of its logarithm.
    pub stiffness_standard_error: f64,
    /// With a material: how well first touch is known, as a standard deviation of the displacement (m). What it does is taken as proportional to it:
    /// intervals of 95 % contain the truth in 97 % of contacts at 6 % of the squeeze, in 82 % at 10 %.
    pub touch_standard_error: f64,
}

impl Default for ObserverOptions {
    fn default() -> Self {
        Self {
            material: None,
            exponent: 5.0,
            exponent_standard_error: 0.0,
            slip_force: None,
            warn_before: 1.0,
            confidence: 0.95,
            noise: None,
            stiffness_standard_error: 0.05,
            touch_standard_error: 1e-4,
        }
    }
}

impl ObserverOptions {
    pub(super) fn check(&self) -> Result<(), ObserveError> {
        let within = |option, expected, found: f64, holds: bool| {
            if found.is_finite() && holds {
                Ok(())
            } else {
                Err(ObserveError::Option {
                    option,
                    expected,
                    found,
                })
            }
        };
        within("the exponent", "from 1 to 30", self.exponent, (1.0..=30.0).contains(&self.exponent))?;
        let deviation = self.exponent_standard_error;
        within("the deviation of the exponent", "from 0 to 10", deviation, (0.0..=10.0).contains(&deviation))?;
        if let Some(force) = self.slip_force {
            within("the slip force", "above 0 N", force, force > 0.0)?;
        }
        within("the time to warn before slip", "0 s or more", self.warn_before, self.warn_before >= 0.0)?;
        let inside = self.confidence > 0.0 && self.confidence < 1.0;
        within("the confidence", "between 0 and 1", self.confidence, inside)?;
        if let Some((displacement, force)) = self.noise {
            within("the noise of the displacement", "0 m or more", displacement, displacement >= 0.0)?;
            within("the noise of the force", "above 0 N", force, force > 0.0)?;
        }
        let stiffness = self.stiffness_standard_error;
        within("the deviation of the stiffness", "from 0 to 1", stiffness, (0.0..=1.0).contains(&stiffness))?;
        within(
            "the deviation of first touch",
            "0 m or more",
            self.touch_standard_error,
            self.touch_standard_error >= 0.0,
        )
    }
}
