//! The whole study of one record: phases, strains, laws, tables' rows, overlay, findings.
//!
//! | file | what |
//! |---|---|
//! | `options.rs` | everything that may be asked, with defaults |
//! | `pipeline.rs` | the order of the steps |
//! | `hold.rs` | one hold: signal, fits in both domains, prediction beyond the window |
//! | `creep.rs` | holds of constant force |
//! | `behaviour.rs` | holds that are none: drift, feedback control |
//! | `rate_bias.rs` | how far noise takes the rate domain from the truth |
//! | `joint.rs` | one law for several holds against one for each |
//! | `across.rs` | several holds: common exponent, trend of v, agreement of equilibrium strains |
//! | `modulus.rs` | the modulus that the relaxed forces imply |
//! | `overlay.rs` | the same displacement simulated with the fitted numbers |
//! | `corrected.rs` | the corrections that were asked for, in order |
//! | `prepared.rs` | the same with zero at first touch, for fits of the whole record |
//! | `skew.rs`, `kink.rs` | how much later the force is stamped than the displacement |
//! | `signals.rs` | what the columns, and what was done to them, give cause to say |
//! | `finding.rs` | what the user should know, in plain words |

mod across;
mod behaviour;
mod corrected;
mod creep;
mod finding;
mod hold;
mod joint;
mod kink;
mod modulus;
mod options;
mod overlay;
mod pipeline;
mod prepared;
mod rate_bias;
mod signals;
mod skew;

pub use across::{Across, LevelAgreement, Trend};
pub use corrected::{Corrected, corrected};
pub use creep::{CreepError, CreepHold, creep_holds};
pub use finding::{Finding, Severity};
use hold::comparison_findings;
pub use hold::{HoldAnalysis, Prediction, Signal};
pub use joint::{JointAnalysis, JointHolds};
pub use modulus::ModulusSource;
pub use options::{AnalysisOptions, Geometry, LayersChoice};
pub use overlay::Overlay;
pub use pipeline::{Analysis, AnalysisError, analyze, examine};
pub use prepared::{Prepared, prepared};
pub use rate_bias::RateBias;
pub use signals::suspicious_signs;
pub use skew::{ClockSkew, clock_skew};
