//! Results as logs of ROS 2: MCAP files with messages of well-known types.
//!
//! A log has the readings of the contact, `/palpate/joint_states` and `/palpate/wrench`, and a topic for every other quantity, named after it
//! with its unit (`/palpate/equilibrium_force_n`). A quantity that is not known at a sample has no message there.
//!
//! | file | what |
//! |---|---|
//! | `contact.rs` | one sample after the other to a log ([`ContactLog`]) |
//! | `series.rs` | simulated and predicted series |

mod contact;
mod series;

use std::path::Path;

pub use contact::zero_ns;
pub(crate) use contact::{ContactLog, Reading};
pub(crate) use series::{write_prediction, write_readings, write_trajectory};

/// Whether the name of an output file requests a log.
#[must_use]
pub fn is_log(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "mcap")
}
