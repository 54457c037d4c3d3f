//! Several holds at once: one material law, an equilibrium and amplitudes for each hold.
//!
//! A hold alone leaves rate and exponent (or two times) correlated. Several holds of one body share them, if the body has one
//! law; whether it does is what [`compare_joint`] asks.
//!
//! | file | what |
//! |---|---|
//! | `result.rs` | options and results |
//! | `hold.rs` | how the shared parameters come to a hold, and its normal equations |
//! | `arrow.rs` | the search: a block-arrow system, the holds eliminated |
//! | `starts.rs` | where it starts |
//! | `report.rs` | parameters with their errors |
//! | `fit_joint.rs` | the whole way |
//! | `trend.rs`, `comparison.rs` | whether a parameter goes with the strain; one law against one each |

mod arrow;
mod comparison;
mod fit_joint;
mod hold;
mod report;
mod result;
mod starts;
mod trend;

pub use comparison::{JointComparison, TrendVerdict, compare_joint, compare_joint_watched};
pub use fit_joint::{fit_joint, fit_joint_watched};
pub use result::{HoldWeights, JointFit, JointOptions};
pub use trend::{SharedTrend, TrendPoint};
