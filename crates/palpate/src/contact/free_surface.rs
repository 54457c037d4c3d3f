//! The surface once the jaw has left it.

use crate::latency::LatencyLaw;

/// A stress-free surface on its way back to the undeformed shape.
///
/// Without a jaw the contact layer carries no stress, ε₁ = 0, so u₁ = u₂ = u and its excess strain is −u/depth.
/// The node behind it then moves by u̇ = −ℓ v (u/depth)ⁿ. With y = u/depth this is the latency law itself,
/// ẏ = −(v/m) yⁿ, so the recovery of a dent has the closed form (5).
#[derive(Debug, Clone, Copy)]
pub(crate) struct FreeSurface {
    recovery: LatencyLaw,
    depth: f64,
    dent: f64,
}

impl FreeSurface {
    /// A surface left behind at contact displacement `dent` (m) in a body of `depth` (m) cut into `layers`.
    ///
    /// `None` if v/m is no rate coefficient (it has run out of the range of doubles).
    pub(crate) fn new(law: LatencyLaw, depth: f64, layers: f64, dent: f64) -> Option<Self> {
        let recovery = LatencyLaw::new(law.exponent(), law.rate_coefficient() / layers).ok()?;
        Some(Self { recovery, depth, dent })
    }

    /// Displacement of the surface (m) a time `elapsed` (s) after the jaw left.
    pub(crate) fn displacement_at(&self, elapsed: f64) -> f64 {
        self.depth * self.recovery.excess_after(self.dent / self.depth, elapsed)
    }
    /// When (s after the jaw left) the surface is at displacement `dent` (m), which lies between that at which it was left and 0: (5) solved
    /// for the time.
    pub(crate) fn time_to(&self, dent: f64) -> f64 {
        let (log, order) = ((dent / self.dent).ln(), self.recovery.exponent() - 1.0);
        let stretched = if order == 0.0 { -log } else { (-order * log).exp_m1() / order };
        stretched / self.recovery.relative_rate(self.dent / self.depth)
    }
}
