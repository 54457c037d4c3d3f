//! One hold of a prepared record.
//!
//! | file | what |
//! |---|---|
//! | `hold.rs` | signal, fits in both domains, prediction beyond the window |
//! | `creep.rs` | holds of constant force |
//! | `rate_bias.rs` | how far noise takes the rate domain from the truth |
//! | `compared.rs` | what a comparison of laws gives cause to say; holds that are none: drift, feedback control |

mod compared;
mod creep;
mod hold;
mod rate_bias;

pub(super) use compared::fitted;
pub use creep::{CreepError, CreepHold, creep_holds};
pub(super) use hold::analyze_hold;
pub use hold::{HoldAnalysis, HoldoutError, Signal};
pub use rate_bias::RateBias;
