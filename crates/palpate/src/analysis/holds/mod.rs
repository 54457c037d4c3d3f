//! One hold of a prepared record.
//!
//! | file | what |
//! |---|---|
//! | `hold.rs` | signal, fits in both domains, prediction beyond the window |
//! | `holdout.rs` | how well the first part predicts the rest |
//! | `creep.rs` | holds of constant force |
//! | `behaviour.rs` | holds that are none: drift, feedback control |
//! | `rate_bias.rs` | how far noise takes the rate domain from the truth |
//! | `compared.rs` | what a comparison of laws gives cause to say |

mod behaviour;
mod compared;
mod creep;
mod hold;
mod holdout;
mod rate_bias;

pub(super) use compared::fitted;
pub use creep::{CreepError, CreepHold, creep_holds};
pub(super) use hold::analyze_hold;
pub use hold::{HoldAnalysis, Signal};
pub use holdout::HoldoutError;
pub use rate_bias::RateBias;
