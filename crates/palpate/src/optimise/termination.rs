//! Why a search ended, and what it cost.

use serde::{Deserialize, Serialize};

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Termination {
    /// No step makes the residual smaller: the optimum was found.
    Converged,
    /// The optimum lies at the edge of the range of the relative rate: the data do not say how fast, or from where, it relaxes.
    RateAtBound,
    /// The optimum lies at the edge of the range of the exponent.
    ExponentAtBound,
    /// The optimum lies at the edge of the range of the equilibrium strain (rate domain).
    EquilibriumAtBound,
    /// An amplitude or the constant lies at a bound that was asked for; the others are the best beside it.
    AmplitudeAtBound,
    /// Two terms of a series came together: their times cannot be told apart, so fewer terms say as much.
    TermsMerged,
    /// Two numbers cannot be told apart by these data.
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
