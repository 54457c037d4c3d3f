//! What the gripper can do.

use serde::{Deserialize, Serialize};

use super::{GripError, above_zero};
use crate::contact::Specimen;

/// What the gripper can do, and how long it may take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// The fastest that the jaws close and open, m/s.
    pub speed: f64,
    /// How far they may squeeze the body, m; as far as it goes where not given.
    pub stroke: Option<f64>,
    /// The largest force that body and gripper bear, N.
    pub force: Option<f64>,
    /// How long the squeeze may take until the hold begins, s. Where not given any time may, and slower squeezes are tried up to two seconds.
    pub closing: Option<f64>,
}

impl Limits {
    /// A gripper that closes at `speed` (m/s).
    ///
    /// # Errors
    /// [`GripError::Number`] for a speed that is not above zero.
    pub fn new(speed: f64) -> Result<Self, GripError> {
        let limits = Self {
            speed,
            stroke: None,
            force: None,
            closing: None,
        };
        limits.check()?;
        Ok(limits)
    }

    /// Checks the numbers, which are free to be set.
    ///
    /// # Errors
    /// [`GripError::Number`] with the first that describes no gripper.
    pub fn check(&self) -> Result<(), GripError> {
        above_zero("speed of the jaws", self.speed, " m/s")?;
        self.closing.map_or(Ok(()), |closing| above_zero("time to close", closing, " s"))?;
        self.stroke.map_or(Ok(()), |stroke| above_zero("stroke", stroke, " m"))?;
        self.force.map_or(Ok(()), |force| above_zero("largest force", force, " N"))
    }

    /// The slowest closing that is tried, s.
    pub(super) fn slowest_closing(&self) -> f64 {
        const USUAL: f64 = 2.0;
        self.closing.unwrap_or(USUAL)
    }

    /// As far as the jaw gets in the time to close, m, and what sets that: the time, the stroke or the body.
    pub(super) fn reach(&self, body: &Specimen) -> (f64, String) {
        let (deepest, by) = self.deepest(body);
        match self.closing {
            Some(closing) if self.speed * closing < deepest => {
                let reported = [closing, 1e3 * self.speed].map(|number| crate::number::significant(number, 3));
                (self.speed * closing, format!("closed within {} s at {} mm/s", reported[0], reported[1]))
            }
            _ => (deepest, by),
        }
    }

    /// The deepest squeeze (m) within the limits, and what sets it. Of a body it stays a hair short of the end.
    pub(super) fn deepest(&self, body: &Specimen) -> (f64, String) {
        let end = body.limit();
        let margin = if end.included { 1.0 } else { 1.0 - 1e-6 };
        let through = margin * end.at / body.contact_displacement(1.0);
        match self.stroke {
            Some(stroke) if stroke <= through => {
                (stroke, format!("stroke of {} mm", crate::number::significant(1e3 * stroke, 4)))
            }
            _ => (through, format!("the {} ends at {} mm", end.name, crate::number::significant(1e3 * through, 4))),
        }
    }
}
