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
