//! Results as JSON, for programs. The name of each quantity ends in its unit; a field without a value is `null`.
//!
//! | file | document |
//! |---|---|
//! | `analysis.rs` | `palpate.analysis/1`, one analysed record |
//! | `fit.rs` | one fit inside it |
//! | `budget.rs` | uncertainty budgets inside others |
//! | `conditions.rs` | conditions of a test, R(t) at stated times |
//! | `settings.rs` | the resolved settings |
//! | `signals.rs` | the columns of a record, their corrections, first touch |
//! | `calibration.rs` | `palpate.calibration/1`, laws calibrated on a whole record |
//! | `several_calibrations.rs` | `palpate.several-calibrations/1`, one calibration of several records |
//! | `specimens.rs` | `palpate.specimens/1`, the records of several specimens |
//! | `comparison.rs` | `palpate.comparison/1`, laws compared on the holds of records |
//! | `grip.rs` | `palpate.grip/1`, a planned grip |
//! | `finding.rs`, `software.rs` | what stands in several of them |
//! | `watch.rs` | `palpate.watch/1`, a watched contact, one object a line |
//! | `reproduction.rs` | `palpate.reproduction/2`, the paper claim by claim; `palpate.reproduced-record/1`, its conclusions on a record |

/// Documents: of each field its meaning, its type, and its place in the result. A field with `?` after its name is omitted where there
/// is none; any other is `null` then.
macro_rules! documents {
    ($(
        $(#[$about:meta])*
        $name:ident($($from:ident: $source:ty),*) $(with { $($local:stmt;)* })? {
            $($(#[$meaning:meta])* $field:ident$(?$($mark:lifetime)?)?: $type:ty = $value:expr,)*
        }
    )*) => { $(
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        $(#[$about])*
        pub struct $name {
            $(
                $(#[$meaning])*
                $(#[serde(skip_serializing_if = "Option::is_none")] $($mark)?)?
                pub $field: $type,
            )*
        }

        impl $name {
            /// The document of these.
            #[must_use]
            pub fn new($($from: $source),*) -> Self {
                $($($local)*)?
                Self { $($field: $value,)* }
            }
        }
    )* };
}

mod analysis;
mod budget;
mod calibration;
mod comparison;
mod conditions;
mod finding;
mod fit;
mod grip;
mod reproduction;
mod settings;
mod several_calibrations;
mod signals;
mod software;
mod specimens;
mod watch;

pub use analysis::{AnalysisDocument, HoldDocument, LoadingModulusDocument};
pub use budget::{BudgetDocument, ContributionDocument};
pub use calibration::{CalibratedLawDocument, CalibrationDocument};
pub use comparison::{
    ComparisonDocument, ComparisonSettingsDocument, HoldComparisonDocument, LawDocument, VerdictDocument,
};
pub use conditions::{ConditionsDocument, HoldReportDocument, StatedRelaxationDocument};
pub use fit::FitDocument;
pub use grip::{
    BackOffDocument, ForceHoldDocument, GripDocument, PositionHoldDocument, ScheduleDocument, TimeToSlipDocument,
};
pub use reproduction::{ReproducedRecordDocument, ReproductionDocument};
pub(crate) use several_calibrations::of_between;
pub use several_calibrations::{BatchParameterDocument, SeveralCalibrationsDocument, SpecimenDocument};
pub use software::Software;
pub use specimens::{BetweenSpecimensDocument, SpecimenReportDocument, SpecimensDocument};
pub use watch::{ObservationDocument, WatchDocument, WatchSummaryDocument, WatchedHoldDocument};
