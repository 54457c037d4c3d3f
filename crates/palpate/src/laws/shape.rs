//! The list of shapes.

use serde::{Deserialize, Serialize};

use super::diffusion::Diffusion;
use super::exponential::Exponential;
use super::fractional_zener::MittagLeffler;
use super::fung_continuous::FungContinuous;
use super::kernel::{Kernel, ShapeNumber};
use super::latency::{FixedLatency, FreeLatency};
use super::logarithmic::Logarithm;
use super::maxwell::Straight;
use super::power::{PowerDecay, PowerGrowth};
use super::stretched::Stretched;

/// A function of time with one or two numbers, of which laws are made; its file says which.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
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

impl Shape {
    /// Whether the answers to several steps add up to that to all of them: the latency law is not linear.
    pub(crate) fn superposes(&self) -> bool {
        !matches!(self, Self::Latency | Self::LatencyWith(_))
    }

    /// What the shape can do, from its file.
    fn with<R>(&self, act: impl FnOnce(&dyn Kernel) -> R) -> R {
        match *self {
            Self::Latency => act(&FreeLatency),
            Self::LatencyWith(exponent) => act(&FixedLatency { exponent }),
            Self::Exponential => act(&Exponential),
            Self::Stretched => act(&Stretched),
            Self::PowerDecay => act(&PowerDecay),
            Self::PowerGrowth => act(&PowerGrowth),
            Self::Logarithm => act(&Logarithm),
            Self::MittagLeffler => act(&MittagLeffler),
            Self::FungContinuous => act(&FungContinuous),
            Self::Diffusion => act(&Diffusion),
            Self::Straight => act(&Straight),
        }
    }
}

impl Kernel for Shape {
    fn numbers(&self) -> &'static [ShapeNumber] {
        self.with(|kernel| kernel.numbers())
    }

    fn decays(&self) -> bool {
        self.with(|kernel| kernel.decays())
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        self.with(|kernel| kernel.value(times, theta, value));
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        self.with(|kernel| kernel.gradient(times, theta, value, derivatives));
    }
}
