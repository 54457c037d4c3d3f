//! Why the paper's study could not be made.

use crate::analysis::AnalysisError;
use crate::contact::{LayersError, SpecimenError};
use crate::latency::LawError;
use crate::record::RecordError;
use crate::simulate::{LinearLawError, MotionError, SimulateError};
use crate::watch::Cancelled;

/// Why the paper's study could not be made: an invalid number, or the watch ended it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PaperError {
    /// Numbers that make no body.
    #[error(transparent)]
    Specimen(#[from] SpecimenError),
    /// Numbers that make no latency law.
    #[error(transparent)]
    Law(#[from] LawError),
    /// Numbers that make no linear law.
    #[error(transparent)]
    LinearLaw(#[from] LinearLawError),
    /// A number of layers that is none.
    #[error(transparent)]
    Layers(#[from] LayersError),
    /// Steps that make no motion.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A simulation that cannot run.
    #[error(transparent)]
    Simulate(SimulateError),
    /// A simulated record that is none.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A simulated record that cannot be analysed.
    #[error(transparent)]
    Analysis(AnalysisError),
    /// A rate at which no hold has enough samples.
    #[error(
        "sampling rate: at least {least} Hz for the {samples} samples that a fit of a hold needs, found {found} Hz"
    )]
    SampleRate {
        /// What was given, Hz.
        found: f64,
        /// Least rate, Hz.
        least: f64,
        /// Samples that are needed.
        samples: usize,
    },
    /// A rate that makes more samples than a study can have.
    #[error("sampling rate: at most {most} Hz, found {found} Hz")]
    SampleRateTooHigh {
        /// What was given, Hz.
        found: f64,
        /// Largest rate, Hz.
        most: f64,
    },
    /// A repeatability that is none, or larger than the accuracy.
    #[error("repeatability of the force: from 0 N to its accuracy of {most} N, found {found} N")]
    Repeatability {
        /// What was given, N.
        found: f64,
        /// The accuracy, N.
        most: f64,
    },
    /// No seed, or more than a study can have.
    #[error("number of seeds: from 1 to {most}, found {found}")]
    Seeds {
        /// What was given.
        found: usize,
        /// Largest number.
        most: usize,
    },
    /// The watch ended it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<SimulateError> for PaperError {
    fn from(error: SimulateError) -> Self {
        match error {
            SimulateError::Cancelled(cancelled) => cancelled.into(),
            error => Self::Simulate(error),
        }
    }
}

impl From<AnalysisError> for PaperError {
    fn from(error: AnalysisError) -> Self {
        match error {
            AnalysisError::Cancelled(cancelled) => cancelled.into(),
            error => Self::Analysis(error),
        }
    }
}
