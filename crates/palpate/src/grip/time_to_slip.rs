//! How long a hold lasts.

use serde::{Deserialize, Serialize};

/// How long a hold lasts until the contact slips.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimeToSlip {
    /// So long, s; 0 if it slips at once.
    After(f64),
    /// It does not: longer than ten years.
    Never,
}

impl TimeToSlip {
    /// The time, s; `None` for never.
    #[must_use]
    pub fn seconds(self) -> Option<f64> {
        match self {
            Self::After(time) => Some(time),
            Self::Never => None,
        }
    }

    /// Whether it is `duration` (s) at least.
    #[must_use]
    pub fn covers(self, duration: f64) -> bool {
        self.seconds().is_none_or(|time| time >= duration)
    }
}

/// Ten years, s: what holds that long never slips.
pub(super) const ALWAYS: f64 = 3.156e8;
