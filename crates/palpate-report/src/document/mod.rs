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
//! | `finding.rs`, `software.rs` | what stands in several of them |
//! | `watch.rs` | `palpate.watch/1`, a watched contact, one object a line |
//! | `reproduction.rs` | `palpate.reproduction/1`, the summary of the reproduced study |

mod analysis;
mod calibration;
mod comparison;
mod finding;
mod fit;
mod grip;
mod reproduction;
mod settings;
mod signals;
mod software;
mod watch;

pub use analysis::{AnalysisDocument, HoldDocument, TableRow};
pub use calibration::{
    CalibratedLawDocument, CalibratedNumberDocument, CalibrationDocument, ForetoldDocument, ProfileDocument,
};
pub use comparison::{
    ComparedHoldDocument, ComparedRecordDocument, ComparisonDocument, ComparisonSettingsDocument,
    HoldComparisonDocument, LawDocument, NumberDocument, VerdictDocument,
};
pub use fit::FitDocument;
pub use grip::{
    BackOffDocument, GraspDocument, GripDocument, GripLimitsDocument, HoldingDocument, LastsDocument, MoveDocument,
    NeighbourDocument, PressedDocument, RefusedDocument, ScheduleDocument, SensitivityDocument,
};
pub use reproduction::ReproductionDocument;
pub use settings::SettingsDocument;
pub use signals::{
    CorrectionDocument, SignalsDocument, SkewDocument, TouchDocument, TouchEstimateDocument, ValuesDocument,
};
pub use software::Software;
pub use watch::{ObservationDocument, WatchDocument, WatchSummaryDocument, WatchedHoldDocument};
