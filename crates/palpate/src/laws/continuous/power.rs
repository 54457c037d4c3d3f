//! Power laws.
//!
//! Relaxation y(t) = Δ (1 + t/t₀)^(−α): a power of time once t exceeds t₀, finite at the start, and nothing left in the end. It is
//! the latency law with n = 1 + 1/α, λ = α/t₀ and no equilibrium. Creep y(t) = y₀ + Δ (t/T)^α, T the duration of the fit; the
//! coefficient of t^α with t in seconds is derived from it.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | amplitude Δ | of y | any | signal at the start; in creep its growth over the fit |
//! | time t₀ (relaxation) | s | above 0 | where the power begins |
//! | exponent α | 1 | 0.005 to 5; in creep 0.01 to 2 | 0: elastic, 1: viscous |

use crate::latency::{decay_columns, decay_many};
use crate::laws::{
    BasisFunction, Composition, Description, Kernel, LawDefinition, REFERENCE, ShapeParameter, TIME, two,
};

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "power",
    description: Description {
        title: "power law",
        equation: "Δ (1 + t/t₀)^(−α)",
        source: "Nutting 1921; Fabry et al. 2001; as latency without equilibrium: NIST's Bennett5",
    },
    relaxation: Some(Composition::of(&[BasisFunction::PowerDecay])),
    creep: Some(Composition::with_constant(&[BasisFunction::PowerGrowth])),
    contains_exponential: false,
};

/// (1 + λt)^(−α).
pub(in crate::laws) struct PowerDecay;

impl Kernel for PowerDecay {
    fn parameters(&self) -> &'static [ShapeParameter] {
        const COARSE: [f64; 14] = [0.005, 0.01, 0.02, 0.04, 0.07, 0.12, 0.2, 0.35, 0.6, 1.0, 1.6, 2.5, 4.0, 5.0];
        const { &[TIME, ShapeParameter::pure("exponent", 0.005, 5.0, &COARSE)] }
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        decay_many(times, theta[1] * theta[0].exp(), 1.0 + 1.0 / theta[1], value);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        let [by_rate, by_exponent] = two(derivatives);
        let alpha = theta[1];
        decay_columns(times, alpha * theta[0].exp(), 1.0 + 1.0 / alpha, [value, by_rate, by_exponent]);
        // The latency law in (ln λ', n) with λ' = αλ, n = 1 + 1/α.
        for (by_alpha, by_rate) in by_exponent.iter_mut().zip(by_rate.iter()) {
            *by_alpha = by_rate / alpha - *by_alpha / (alpha * alpha);
        }
    }
}

/// (λt)^α with λ one over the duration of the fit.
pub(in crate::laws) struct PowerGrowth;

impl Kernel for PowerGrowth {
    fn parameters(&self) -> &'static [ShapeParameter] {
        const COARSE: [f64; 14] = [0.01, 0.03, 0.06, 0.1, 0.15, 0.22, 0.32, 0.45, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0];
        const { &[REFERENCE, ShapeParameter::pure("exponent", 0.01, 2.0, &COARSE)] }
    }

    fn decays(&self) -> bool {
        false
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        let rate = theta[0].exp();
        for (out, t) in value.iter_mut().zip(times) {
            *out = (rate * t).powf(theta[1]);
        }
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        self.value(times, theta, value);
        let [by_rate, by_exponent] = two(derivatives);
        for (i, t) in times.iter().enumerate() {
            by_rate[i] = theta[1] * value[i];
            by_exponent[i] = if *t > 0.0 { value[i] * (theta[0] + t.ln()) } else { 0.0 };
        }
    }
}
