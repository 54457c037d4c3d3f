//! A sweep: numbers of a protocol replaced by many, every run checked as a protocol of its own.
//!
//! | file | what |
//! |---|---|
//! | `table.rs` | the table `[sweep]` as it stands |
//! | `values.rs` | the values of one number |
//! | `plan.rs` | which values stand together in which run |
//! | `convert.rs` | the table to runs ([`Sweep`]) |

mod convert;
mod plan;
mod table;
mod values;

pub use convert::{Spacing, Sweep, SweptParameter, parse_runs, parse_sweep, read_sweep};
pub use plan::Plan;
