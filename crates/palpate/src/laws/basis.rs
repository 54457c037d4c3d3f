//! The list of functions of time that laws are made of.

use serde::{Deserialize, Serialize};

/// A function of time with one or two numbers, of which laws are made; its file says which.
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
}

impl BasisFunction {
    /// Whether the answers to several steps add up to that to all of them: the latency law is not linear.
    pub(crate) fn superposes(&self) -> bool {
        !matches!(self, Self::Latency | Self::LatencyWith(_))
    }
}
