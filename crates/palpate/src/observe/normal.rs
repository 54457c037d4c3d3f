//! What is known of a value inside an observer.

use super::kept::kept;
use crate::fit::Estimate;

/// A normal distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Normal {
    pub(super) mean: f64,
    pub(super) deviation: f64,
}
kept!(Normal: mean, deviation);

impl Normal {
    pub(super) fn new(mean: f64, deviation: f64) -> Self {
        Self { mean, deviation }
    }
}

impl From<Normal> for Estimate {
    fn from(normal: Normal) -> Self {
        Self {
            value: normal.mean,
            standard_error: Some(normal.deviation),
            white_standard_error: None,
            interval: None,
        }
    }
}
