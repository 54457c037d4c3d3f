//! Any law fitted to a hold.
//!
//! | file | what |
//! |---|---|
//! | `fitted.rs` | a problem with its solution |
//! | `derived.rs` | parameters that follow from those that were searched |
//! | `report.rs` | from both to the result |
//! | `robust.rs` | outliers made to count less |
//! | `profile.rs`, `bootstrap.rs` | intervals that may be asymmetric or open, and those from resampled residuals |
//! | `fit_law.rs` | the whole way |
//! | `prediction.rs` | the curve at a time, with its interval |

mod bootstrap;
pub(crate) mod derived;
pub(crate) mod fit_law;
pub(crate) mod fitted;
mod prediction;
mod profile;
mod report;
mod robust;

pub use fit_law::{fit_law, fit_law_watched};
pub(super) use fitted::Fitted;
pub use profile::profile_interval;
