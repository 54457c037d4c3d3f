//! What palpate can do: one file or room a job, between the front ends and the library with its files and reports.
//!
//! A job is a struct of options that has units in its names and a JSON form; its defaults stand here and nowhere else. `run` takes what
//! the job works on and a [`Watch`](palpate::watch::Watch), which hears of its progress and may cancel it, and gives an [`Outcome`] or a
//! [`JobError`]. A front end parses or converts, runs one job, and prints or converts.
//!
//! | file | what |
//! |---|---|
//! | `error.rs` | why there is no outcome ([`JobError`]) |
//! | `outcome.rs` | result, document, text and verdict of a job |
//! | `input/` | records, opened and hashed once |
//! | `output.rs` | files that appear whole or not at all, and never in the place of one that is read |
//! | `depends.rs` | what a result depends on, as one digest |
//! | `store.rs` | what can be resumed |
//! | `shard/` | one of several slices of a batch or a sweep |
//! | `threads.rs` | many pieces of work over threads |
//! | `message_log/` | results as logs of ROS 2 |
//! | `report_index.rs` | the index of the reports of several records |
//! | `analyze.rs` … | one job each |
//! | `typed.rs` | options as they are typed on a command line, with the feature `clap` |

pub mod input;
pub mod output;
#[cfg(feature = "clap")]
pub mod typed;

mod analyze;
mod batch;
mod calibrate;
mod calibrate_several;
mod compare;
mod convert;
mod depends;
mod error;
mod export;
mod grip;
mod inspect;
mod merge;
mod message_log;
mod options;
mod outcome;
mod predict;
mod report_index;
mod reproduce;
mod shard;
mod simulate;
mod store;
mod sweep;
mod threads;
mod watch_log;
mod written_by_batch;

pub use analyze::{Analyze, Analyzed};
pub use batch::{Batch, BatchAnswer, Batched, BatchedTest, CurveMap, Refused, Spread};
pub use calibrate::{Calibrate, Calibrated, Equilibrium};
pub use calibrate_several::{CalibrateSeveral, CalibratedSeveral};
pub use compare::{Compare, Compared, no_share};
pub use convert::{Convert, Converted};
pub use depends::BUILD;
pub use error::{ErrorKind, JobError};
pub use export::{Card, CardDocument, CardHoldError, CardParameter, CardPronyTerm, Engine, Export};
pub use grip::{MaterialSource, PlanGrip, RegripFor};
pub use inspect::{
    ColumnRole, Inspect, Inspected, InspectedColumn, InspectedRecord, InspectedTest, InspectionDocument, PhaseDocument,
    RefusalDocument, SkippedDocument, machines_text,
};
pub use merge::{Merge, Merged};
pub use message_log::{is_log, zero_ns};
pub use outcome::{Outcome, Results, Verdict};
pub use predict::{Predict, Predicted};
pub use report_index::{ReportIndex, write_reports};
pub use reproduce::{Reproduce, ReproducedRecord};
pub use shard::{Shard, Slice, forget};
pub use simulate::{DriveBy, Simulate, Simulated};
pub use sweep::{Sweep, Swept, sweep_fields, sweep_rows};
pub use watch_log::{Event, HoldObserved, ObservationLog, Observed, WatchLog};
