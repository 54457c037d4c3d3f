//! What a search cost.

use serde::{Deserialize, Serialize};

/// What a fit cost, in counts that do not depend on the machine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Points of the coarse search.
    pub grid_points: u64,
    /// Starts refined.
    pub starts: u64,
    /// Evaluations of the columns over the condensed samples.
    pub condensed: u64,
    /// Evaluations of the columns over all samples.
    pub evaluations: u64,
    /// Accepted steps.
    pub iterations: u64,
}
