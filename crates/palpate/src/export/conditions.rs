//! The depth, the speeds and the time that a fit is for.

use super::ExportError;

/// The loadings and the hold that a model for another program is fitted to: displacement of the jaw from first touch to `depth` at constant
/// speed, then held.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Conditions {
    /// Displacement of the jaw at the end of the loading, m.
    pub depth: f64,
    /// Slowest speed of the jaw, m/s.
    pub slowest: f64,
    /// Fastest speed of the jaw, m/s; the hold follows a loading at this speed.
    pub fastest: f64,
    /// Length of the hold, s.
    pub hold: f64,
}

impl Conditions {
    /// Checks them.
    ///
    /// # Errors
    /// [`ExportError::Condition`] unless all are finite and above 0, and the slowest speed is not above the fastest.
    pub fn new(depth: f64, (slowest, fastest): (f64, f64), hold: f64) -> Result<Self, ExportError> {
        let named = [
            ("depth", depth, " m"),
            ("slowest speed", slowest, " m/s"),
            ("speed", fastest, " m/s"),
            ("hold", hold, " s"),
        ];
        for (name, found, unit) in named {
            if !(found.is_finite() && found > 0.0) {
                let expected = "a finite number above 0";
                return Err(ExportError::Condition {
                    name,
                    expected,
                    found,
                    unit,
                });
            }
        }
        if slowest > fastest {
            return Err(ExportError::Condition {
                name: "slowest speed",
                expected: "at most the fastest",
                found: slowest,
                unit: " m/s",
            });
        }
        Ok(Self {
            depth,
            slowest,
            fastest,
            hold,
        })
    }
}
