//! Why several records could not be calibrated together.

use crate::calibrate::{CalibrateError, MaterialError};
use crate::watch::Cancelled;

/// Why several records could not be calibrated together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SeveralError {
    /// One record, or none.
    #[error("a calibration of several records needs two or more, found {records}")]
    TooFew {
        /// Number of records.
        records: usize,
    },
    /// The same samples twice, which would count as two specimens without any difference.
    #[error("{first} and {second} are the same record")]
    Repeated {
        /// Name of the one.
        first: String,
        /// Name of the other.
        second: String,
    },
    /// A shared parameter that the law does not estimate.
    #[error("expected shared parameters among {}, found \"{name}\"", names.join(", "))]
    UnknownParameter {
        /// What was given.
        name: String,
        /// What the law estimates.
        names: Vec<String>,
    },
    /// A table of equilibrium forces, whose rows lie where one record was held.
    #[error(
        "a table of equilibrium forces has its rows at the displacements held in one record: several records need a law of the equilibrium force with parameters of the same meaning"
    )]
    Table,
    /// A record that cannot be calibrated alone.
    #[error("{record}: {error}")]
    Record {
        /// Its name.
        record: String,
        /// Why.
        error: CalibrateError,
    },
    /// A record whose own parameters neither it nor the others determine.
    #[error("{record} does not determine its own {}", names.join(", "))]
    Undetermined {
        /// Its name.
        record: String,
        /// Its own parameters.
        names: Vec<String>,
    },
    /// Shared parameters that the records do not determine.
    #[error("the records do not determine the shared {} separately from the others", names.join(", "))]
    SharedUndetermined {
        /// Which.
        names: Vec<String>,
    },
    /// No optimum within the range that is searched, or within the steps allowed.
    #[error("the joint search did not end at an optimum{}", alone(open))]
    NoOptimum {
        /// Records that do not determine their parameters when each is calibrated alone.
        open: Vec<String>,
    },
    /// Parameters that make no material.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// Its watch ended it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SeveralError {
    /// What keeps a record from being calibrated alone.
    pub(super) fn of_record(record: &str, error: CalibrateError) -> Self {
        match error {
            CalibrateError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Record {
                record: record.to_owned(),
                error,
            },
        }
    }

    /// What would help.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::TooFew { .. } => "give two or more records, or share nothing".to_owned(),
            Self::Repeated { .. } => "give each record once".to_owned(),
            Self::Table => "use another equilibrium law: uniform-strain or hertz".to_owned(),
            Self::Record { error, .. } if error.is_of_record() => {
                let hint = error.hint();
                if hint.is_empty() {
                    "leave the record out".to_owned()
                } else {
                    format!("{hint}, or leave the record out")
                }
            }
            Self::Record { error, .. } => error.hint(),
            Self::Undetermined { .. } | Self::NoOptimum { .. } => {
                "share more parameters, leave the record out, or use a law with fewer parameters".to_owned()
            }
            Self::SharedUndetermined { .. } => {
                "use a law with fewer parameters, or add records with holds of different excess strain".to_owned()
            }
            _ => String::new(),
        }
    }
}

/// Which records determine nothing alone.
fn alone(open: &[String]) -> String {
    if open.is_empty() {
        return String::new();
    }
    format!(": calibrated alone, the parameters stay open of {}", open.join(", "))
}
