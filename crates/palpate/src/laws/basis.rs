//! What laws are made of and described by: functions of time, the choice of an exponent, the response.

use serde::{Deserialize, Serialize};

use super::CustomKernel;

/// A function of time with one or two parameters, of which laws are composed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BasisFunction {
    /// [1 + (n−1) λt]^(−1/(n−1)); θ = (ln λ, n).
    Latency,
    /// The same with this exponent; θ = ln λ.
    LatencyWith(f64),
    /// exp(−λt); θ = ln λ.
    Exponential,
    /// exp(−(λt)^β); θ = (ln λ, β).
    Stretched,
    /// (1 + λt)^(−α); θ = (ln λ, α).
    PowerDecay,
    /// (λt)^α; θ = (ln λ, α).
    PowerGrowth,
    /// ln(1 + λt); θ = ln λ.
    Logarithm,
    /// E_α(−(λt)^α); θ = (ln λ, α).
    MittagLeffler,
    /// [E₁(λt) − E₁(ϱλt)]/ln ϱ; θ = (ln λ, ln ϱ).
    FungContinuous,
    /// (8/π²) Σ_odd exp(−k²λt)/k²; θ = ln λ.
    Diffusion,
    /// λt; θ = ln λ.
    Straight,
    /// A function that another crate defines.
    Custom(CustomKernel),
}

impl BasisFunction {
    /// Whether the answers to several steps add up to that to all of them: the latency law is not linear.
    pub(crate) fn superposes(&self) -> bool {
        !matches!(self, Self::Latency | Self::LatencyWith(_))
    }
}

/// Whether the exponent was given or found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ExponentChoice {
    /// Held at this value.
    Fixed(f64),
    /// Found with the other parameters.
    Free,
}

impl ExponentChoice {
    /// The exponent, if it was given.
    pub(crate) fn given(self) -> Option<f64> {
        match self {
            Self::Fixed(n) => Some(n),
            Self::Free => None,
        }
    }
}

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Response {
    /// Force, stress or strain of a contact held at constant displacement.
    #[default]
    Relaxation,
    /// Displacement or strain at constant force, and recovery after release.
    Creep,
}
