//! The exponent of the latency law: given, or found with its other numbers.

use serde::{Deserialize, Serialize};

/// Whether the exponent was given or found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ExponentChoice {
    /// Held at this value.
    Fixed(f64),
    /// Found with the other numbers.
    Free,
}

impl ExponentChoice {
    /// The exponent, if it was given.
    pub(crate) fn given(self) -> Option<f64> {
        match self {
            Self::Fixed(n) => Some(n),
            Self::Free => None,
        }
    }
}
