//! Why a search ended, and what it cost.

use serde::{Deserialize, Serialize};

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Termination {
    /// No step reduces the residual: the optimum is reached.
    Converged,
    /// The relative rate is at its bound: the data determine neither the rate nor the amplitude of the relaxation.
    RateAtBound,
    /// The optimum lies at the edge of the range of the exponent.
    ExponentAtBound,
    /// The optimum lies at the edge of the range of the equilibrium strain (rate domain).
    EquilibriumAtBound,
    /// An amplitude or the constant is at a requested bound; the others are optimal given that bound.
    AmplitudeAtBound,
    /// Two terms of a series merged: their times are not distinguishable, and fewer terms suffice.
    TermsMerged,
    /// The data do not determine two parameters separately.
    Singular,
    /// The allowed number of steps was used up.
    IterationLimit,
}

impl Termination {
    /// Whether the estimates and their errors may be used as they are.
    #[must_use]
    pub fn is_good(self) -> bool {
        self == Self::Converged
    }
}

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
