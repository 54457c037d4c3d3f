//! The standard linear solid (Zener): a spring beside a Maxwell arm.
//!
//! Relaxation y(t) = y_e + Δ exp(−t/τ); creep y(t) = y₀ + Δ (1 − exp(−t/τ)). For one material the retardation time exceeds the
//! relaxation time by the ratio of instantaneous to relaxed stiffness.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | equilibrium y_e, or instantaneous y₀ in creep | of y | any | end, or start |
//! | amplitude Δ | of y | any | what relaxes, or creeps |
//! | time τ | s | above 0 | relaxation time, or retardation time |
//!
//! It is Prony with one term, the latency law with n = 1 and the fractional Zener solid of order 1.

use crate::laws::{BasisFunction, Composition, Description, LawDefinition};

const FORM: Composition = Composition::with_constant(&[BasisFunction::Exponential]);

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "standard-linear-solid",
    description: Description {
        title: "standard linear solid",
        equation: "y_e + Δ exp(−t/τ)",
        source: "Zener 1948; Ferry, Viscoelastic Properties of Polymers, chapter 3",
    },
    relaxation: Some(FORM),
    creep: Some(FORM),
    contains_exponential: false,
};
