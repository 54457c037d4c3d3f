//! Corrections that make a new record and leave the old one as it was; the new one lists them.
//!
//! | file | what |
//! |---|---|
//! | `dropouts.rs` | single rows that strayed |
//! | `clocks.rs` | force and displacement stamped by different clocks brought onto one |
//! | `resample.rs` | other sample times |
//! | `baseline.rs` | the force without contact |
//! | `compliance.rs` | what the machine gives way, the deflection of a cantilever |
//! | `air_run.rs` | tare, and the same motion without a body |
//! | `interpolation.rs` | values between samples |

mod air_run;
mod baseline;
mod clocks;
mod compliance;
mod dropouts;
mod interpolation;
mod resample;

pub use compliance::{Compliance, ComplianceError, ComplianceTable};
