//! Why there is no model for another program.

use crate::simulate::{MotionError, SimulateError};

/// Why there is no model for another program.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// A condition that describes no loading.
    #[error("{name} must be {expected}, found {found}{unit}")]
    Condition {
        /// What it is.
        name: &'static str,
        /// What it must be.
        expected: &'static str,
        /// What was given, SI.
        found: f64,
        /// Its unit, behind a blank.
        unit: &'static str,
    },
    /// A law whose hold is no sum of decaying exponentials.
    #[error(
        "a Prony series needs an exponent of 1 or more, found {exponent}: below 1 a hold ends after a finite time, which no sum of decaying exponentials does"
    )]
    NoMixture {
        /// The exponent of the law.
        exponent: f64,
    },
    /// A contact whose force does not relax.
    #[error("the force does not relax in a hold: there is no Prony series")]
    NoRelaxation,
    /// A loading that cannot be fitted.
    #[error("the forces in loading determine no contact of {engine}")]
    NoFit {
        /// Name of the engine's contact.
        engine: &'static str,
    },
    /// The motion of the jaw.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// The simulation of loading and hold.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
}
