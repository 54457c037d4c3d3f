//! One hold of a prepared record.
//!
//! | file | what |
//! |---|---|
//! | `hold.rs` | signal, choice of the exponent, comparison of laws, findings |
//! | `imposed.rs` | what was imposed before it |
//! | `exponents.rs` | fits in both domains with the listed exponents, the extension of the list, the free one |
//! | `creep.rs` | holds of constant force |
//! | `end_value.rs` | the value that a hold tends to: how far beyond its end, and beyond what a body can do |
//! | `drive.rs` | what is held and goes on in the hold |
//! | `jump.rs` | steps of the force within a hold |
//! | `rate_bias.rs` | how far noise takes the rate domain from the truth |
//! | `compared.rs` | what a comparison of laws gives cause to say; holds that are none: drift, feedback control |

mod compared;
mod creep;
mod drive;
mod end_value;
mod exponents;
mod hold;
mod imposed;
mod jump;
mod rate_bias;

pub use creep::{CreepError, CreepHold, creep_holds};
pub(super) use exponents::fit_exponents;
pub use hold::{HoldAnalysis, HoldoutError, Signal};
pub(super) use hold::{complete_hold, fit_options, forecast_holds, prepare_hold};
pub(super) use imposed::imposed;
pub use rate_bias::RateBias;
