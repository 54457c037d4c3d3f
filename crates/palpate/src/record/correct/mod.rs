//! Corrections that make a new record and leave the old one as it was; the new one lists them.
//!
//! | file | what |
//! |---|---|
//! | `dropouts.rs` | single rows that strayed |
//! | `clocks.rs` | force and displacement stamped by different clocks brought onto one |
//! | `filter.rs` | what a filter of the force took away |
//! | `resample.rs` | other sample times, and values between samples |
//! | `baseline.rs` | the force without contact |
//! | `compliance.rs` | what the machine gives way, the deflection of a cantilever |
//! | `then.rs` | a test that goes on in a second record |
//! | `air_run.rs` | tare, and the same motion without a body |

mod air_run;
mod baseline;
mod clocks;
mod compliance;
mod dropouts;
mod filter;
mod resample;
mod then;

pub use compliance::{Compliance, ComplianceError, ComplianceTable};
