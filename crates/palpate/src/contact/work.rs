//! What a simulation costs.

use serde::{Deserialize, Serialize};

/// What a simulation cost, in counts that do not depend on the machine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SimulationWork {
    /// Holds and recoveries solved by the closed form.
    pub closed_forms: u64,
    /// Ramps integrated.
    pub ramps: u64,
    /// Integration steps taken in ramps (and, for a strain wave, in holds).
    pub steps: u64,
    /// Evaluations of the law's rate by the integrator.
    pub evaluations: u64,
    /// Contacts lost or regained.
    pub events: u64,
}
