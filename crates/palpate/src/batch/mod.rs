//! Thousands of simulations at once on all cores.
//!
//! | file | what |
//! |---|---|
//! | `summaries.rs` | what each of many runs comes to, under any drive and law: for sweeps |

mod summaries;

pub use summaries::{Run, summaries};
