//! The nonlinear latency law as a law of relaxation and creep.
//!
//! y(t) = y_e + Δ φ(t; λ, n),  φ = [1 + (n−1) λt]^(−1/(n−1)): equations (4) and (5) of Tsai, Kao et al.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | equilibrium y_e | of y | any | what the signal tends to |
//! | amplitude Δ | of y | any, falls if positive | excess at the start |
//! | relative rate λ = v \|Δ\|ⁿ⁻¹ | 1/s | above 0 | how fast the excess falls at first, per unit of itself |
//! | exponent n | 1 | 0.2 to 30 | 1: exponential; large: logarithmic |
//!
//! Limits: n → 1 is the standard linear solid; n = 2 the hyperbola 1/(1 + λt) that food science writes as Peleg's
//! t/(k₁ + k₂t) (Peleg 1980), with Δ = 1/k₂ and λ = k₂/k₁; large n the logarithm; without equilibrium a power law.

use crate::latency::{decay_columns, decay_many};
use crate::laws::{BasisFunction, Description, ExponentChoice, Kernel, ShapeParameter, ShapeParameterKind, two};

/// In words; two exponents have names of their own.
pub(in crate::laws) fn description(exponent: ExponentChoice) -> Description {
    match exponent {
        ExponentChoice::Fixed(1.0) => Description {
            title: "linear latency",
            equation: "y_e + Δ exp(−λt)",
            source: "Tsai, Kao et al., equation (1)",
        },
        ExponentChoice::Fixed(2.0) => Description {
            title: "Peleg's hyperbola",
            equation: "y_e + Δ/(1 + λt)",
            source: "Peleg 1980: t/(k₁ + k₂t) with Δ = 1/k₂, λ = k₂/k₁",
        },
        _ => Description {
            title: "nonlinear latency",
            equation: "y_e + Δ [1 + (n−1) λt]^(−1/(n−1))",
            source: "Tsai, Kao et al., equations (2)–(5)",
        },
    }
}

impl ExponentChoice {
    /// The basis function of the law.
    pub(crate) fn shape(self) -> BasisFunction {
        self.given().map_or(BasisFunction::Latency, BasisFunction::LatencyWith)
    }
}

const RATE: ShapeParameter = ShapeParameter::new("relative_rate_per_s", ShapeParameterKind::Rate);

/// Exponents of a coarse search.
const COARSE: [f64; 15] = [0.2, 0.3, 0.6, 1.0, 1.4, 2.0, 2.7, 3.6, 5.0, 7.0, 10.0, 14.0, 20.0, 28.0, 30.0];

/// φ with n found.
pub(in crate::laws) struct FreeLatency;

impl Kernel for FreeLatency {
    fn parameters(&self) -> &'static [ShapeParameter] {
        const EXPONENT: ShapeParameter = ShapeParameter::pure("exponent", 0.2, 30.0, &COARSE);
        &[RATE, EXPONENT]
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        decay_many(times, theta[0].exp(), theta[1], value);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        let [by_rate, by_exponent] = two(derivatives);
        decay_columns(times, theta[0].exp(), theta[1], [value, by_rate, by_exponent]);
    }
}

/// φ with n given.
pub(in crate::laws) struct FixedLatency {
    pub(in crate::laws) exponent: f64,
}

impl Kernel for FixedLatency {
    fn parameters(&self) -> &'static [ShapeParameter] {
        &[RATE]
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        decay_many(times, theta[0].exp(), self.exponent, value);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        decay_columns(times, theta[0].exp(), self.exponent, [value, &mut derivatives[0]]);
    }
}
