//! The complete analysis of one record: phases, strains, laws, rows of tables, overlay, findings.
//!
//! A `Record` comes in with `AnalysisOptions`; an `Analysis` goes out. The record goes through `prepare`, `holds` and `together`
//! once, in this order.
//!
//! | file | what |
//! |---|---|
//! | `options.rs` | all options, with defaults |
//! | `conditions.rs` | temperature, conditioning and the like, as a report states them |
//! | `error.rs` | why a record could not be analysed |
//! | `finding.rs` | findings for the user |
//! | `prepare/` | the record corrected, cut and zero at first touch, with findings on its columns |
//! | `holds/` | one hold: signal, fits, findings |
//! | `together/` | several holds: joint laws, trends, modulus, overlay |
//! | `drifting.rs` | a law fitted to samples that drift |
//! | `effects.rs` | what the uncertainty of the instrument and of the body adds to the parameters |
//! | `pipeline.rs` | the order of the steps |
//! | `stated.rs` | variation of the constraint of a hold and R(t) at stated times |

mod conditions;
mod drifting;
mod effects;
mod error;
mod finding;
mod holds;
mod options;
mod pipeline;
mod prepare;
mod stated;
mod together;

pub use conditions::Conditions;
pub use error::AnalysisError;
pub use finding::{Finding, Severity, unexplained_noise};
pub use holds::{CreepError, CreepHold, HoldAnalysis, HoldoutError, RateBias, Signal, creep_holds};
pub use options::{AnalysisOptions, Geometry, LayersChoice};
pub use pipeline::{Analysis, analyze, analyze_watched, examine};
pub use prepare::{
    ClockSkew, ColumnLag, Corrected, Prepared, clock_skew, corrected, corrected_watched, prepared, record_findings,
    suspicious_signs,
};
pub(crate) use prepare::{measured_motion, signal_findings};
pub use stated::{HoldReport, StatedRelaxation};
pub use together::{
    Across, EstimatedModulus, JointAnalysis, JointHolds, LevelAgreement, LoadingModulus, Misfit, ModulusSource,
    Overlay, Trend,
};
