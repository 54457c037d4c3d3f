//! What the holds of one record say together.
//!
//! | file | what |
//! |---|---|
//! | `across.rs` | common exponent, trend of v, agreement of equilibrium strains |
//! | `joint.rs` | one law for several holds against one for each |
//! | `modulus.rs` | the modulus that the equilibrium forces imply, and that of the first ramp |
//! | `overlay.rs` | the same displacement simulated with the fitted parameters |

mod across;
mod joint;
mod modulus;
mod overlay;

pub(super) use across::across;
pub use across::{Across, LevelAgreement, Trend};
pub(super) use joint::changing_rate;
pub use joint::{JointAnalysis, JointHolds};
pub use modulus::{LoadingModulus, ModulusSource};
pub(super) use modulus::{implied_modulus, loading_modulus};
pub use overlay::Overlay;
pub(super) use overlay::overlay;
