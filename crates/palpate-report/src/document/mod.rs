//! Results as JSON: what programs read. Every number carries its unit in its name; a field that has no value is `null`.
//!
//! | file | document |
//! |---|---|
//! | `analysis.rs` | `palpate.analysis/1`, one analysed record |
//! | `fit.rs` | one fit inside it |
//! | `settings.rs` | the resolved settings |
//! | `signals.rs` | the columns of a record, what was done to them, first touch |
//! | `calibration.rs` | `palpate.calibration/1`, laws calibrated on a whole record |
//! | `comparison.rs` | `palpate.comparison/1`, laws compared on the holds of records |
//! | `grip.rs` | `palpate.grip/1`, a planned grip |
//! | `reproduction.rs` | `palpate.reproduction/1`, the summary of the reproduced study |

mod analysis;
mod calibration;
mod comparison;
mod fit;
mod grip;
mod reproduction;
mod settings;
mod signals;

pub(crate) use analysis::after_word;
pub use analysis::mode_word;
pub use analysis::{AnalysisDocument, FindingDocument, HoldDocument, Input, TableRow};
pub use calibration::{
    CalibratedLawDocument, CalibratedNumberDocument, CalibrationDocument, ForetoldDocument, ProfileDocument,
};
pub(crate) use comparison::certainty_word;
pub use comparison::{
    ComparedHoldDocument, ComparedRecordDocument, ComparisonDocument, ComparisonSettingsDocument,
    HoldComparisonDocument, LawDocument, NumberDocument, VerdictDocument,
};
pub use fit::FitDocument;
pub(crate) use fit::termination;
pub use grip::{
    BackOffDocument, GraspDocument, GripDocument, GripLimitsDocument, HoldingDocument, LastsDocument, MoveDocument,
    NeighbourDocument, PressedDocument, RefusedDocument, ScheduleDocument, SensitivityDocument,
};
pub use reproduction::{CheckDocument, ReproductionDocument};
pub use settings::SettingsDocument;
pub use signals::{
    CorrectionDocument, SignalsDocument, SkewDocument, TouchDocument, TouchEstimateDocument, ValuesDocument,
};

use schemars::JsonSchema;
use serde::Serialize;

/// The software that wrote a document.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Software {
    /// Always `palpate`.
    pub name: String,
    /// Its version.
    pub version: String,
}

impl Software {
    /// This build.
    #[must_use]
    pub fn this() -> Self {
        Self {
            name: "palpate".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}
