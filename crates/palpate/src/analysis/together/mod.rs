//! What the holds of one record say together.
//!
//! | file | what |
//! |---|---|
//! | `across.rs` | common exponent, trend of v, agreement of equilibrium strains |
//! | `joint.rs` | one law for several holds against one for each |
//! | `loading.rs` | the modulus of the first loading ramp |
//! | `modulus.rs` | the modulus that the equilibrium forces imply, and that of the first ramp |
//! | `ramps.rs` | ramps that last longer than what relaxes behind them |
//! | `overlay.rs` | the same displacement simulated with the fitted parameters |

mod across;
mod joint;
mod loading;
mod modulus;
mod overlay;
mod ramps;

pub use across::{Across, LevelAgreement, Trend};
pub(super) use across::{across, changing_rate, exponent_not_listed};
pub use joint::{JointAnalysis, JointHolds, Misfit};
pub use loading::LoadingModulus;
pub(super) use loading::loading_modulus;
pub use modulus::{EstimatedModulus, ModulusSource};
pub(super) use modulus::{ImpliedModulus, implied_modulus};
pub use overlay::Overlay;
pub(super) use overlay::overlay;
pub(super) use ramps::ramp_relaxes;
