//! A measured record: time, displacement and force, checked and in SI.
//!
//! `RawColumns` come in; a `Record` goes out and lists what was done to it, and its `SignalReport` says what it was like.
//!
//! | file | what |
//! |---|---|
//! | `raw.rs` | columns as a file holds them, before anything is checked |
//! | `signals/` | what such columns are like: stamps, gaps, strays, saturation, rounding |
//! | `repair.rs` | time stamps that repeat or step back |
//! | `coarse.rs` | rows of a clock that is coarser than the sampling |
//! | `checks.rs` | what every record must be: finite, of equal lengths, time rising |
//! | `measured.rs` | the record itself |
//! | `label.rs` | phases that the file itself names |
//! | `correct/` | corrections that make a new record |
//! | `options.rs` | options of the corrections |
//! | `correction.rs` | what was done, as a list that goes with the record |

mod checks;
mod coarse;
mod correct;
mod correction;
mod label;
mod measured;
mod options;
mod raw;
mod repair;
mod signals;

pub use checks::RecordError;
pub use correct::{Compliance, ComplianceError, ComplianceTable};
pub use correction::{Baseline, Clock, Column, Correction, SourceQuantity, Tare};
pub use label::LabelledSegment;
pub use measured::Record;
pub use options::{CorrectionOptions, SkewChoice};
pub use raw::RawColumns;
pub(crate) use signals::Astray;
pub use signals::{Gaps, Reversals, SampleInterval, Saturation, SignalReport, Stamps, Strays, Values, rounding_step};
