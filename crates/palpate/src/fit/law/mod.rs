//! Any law fitted to a hold.
//!
//! | file | what |
//! |---|---|
//! | `fitted.rs` | a problem with its solution |
//! | `quantity.rs` | a parameter with its gradient, before it has an error |
//! | `derived.rs` | parameters that follow from those that were searched |
//! | `quantities.rs` | all that are reported at a point |
//! | `report.rs` | from both to the result |
//! | `robust.rs` | outliers made to count less |
//! | `profile/`, `bootstrap.rs` | intervals that may be asymmetric or open, and those from resampled residuals |
//! | `fit_law.rs` | the whole way |
//! | `prediction.rs` | the curve at a time, with its interval |

mod bootstrap;
pub(crate) mod derived;
pub(crate) mod fit_law;
pub(crate) mod fitted;
mod prediction;
mod profile;
mod quantities;
mod quantity;
mod report;
mod robust;

pub use fit_law::{fit_law, fit_law_watched};
pub(super) use fitted::Fitted;
pub use profile::profile_interval;
