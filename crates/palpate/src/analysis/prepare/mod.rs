//! Preparation of a record for fits: requested corrections, phases, zero at first touch.
//!
//! A `Record` comes in, goes out as `Prepared`; what its columns give cause to say is found in one go.
//!
//! | file | what |
//! |---|---|
//! | `corrected.rs` | the requested corrections, in order, then zero at first touch |
//! | `baseline.rs` | the errors of a baseline that was subtracted |
//! | `skew.rs`, `kink.rs` | how much later the force is stamped than the displacement |
//! | `lag.rs` | how much later the force answers where one clock stamps both columns |
//! | `motion.rs` | the motion of the jaw, its noise taken out |
//! | `rest.rs` | whether the force drifts while nothing touches the body |
//! | `ramps_alone.rs` | the ramps of a record without a hold |
//! | `seam.rs` | where a second record follows, whether it has the same zero |
//! | `signals.rs` | what the columns, and what was done to them, give cause to say |

mod baseline;
mod corrected;
mod kink;
mod lag;
mod motion;
mod ramps_alone;
mod rest;
mod seam;
mod signals;
mod skew;

pub use corrected::{Corrected, Prepared, corrected, corrected_watched, prepared};
pub use lag::ColumnLag;
pub(crate) use motion::measured_motion;
pub(crate) use signals::signal_findings;
pub use signals::{record_findings, suspicious_signs};
pub use skew::{ClockSkew, clock_skew};
