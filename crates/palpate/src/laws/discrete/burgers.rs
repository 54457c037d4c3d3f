//! The Burgers model: a Maxwell and a Kelvin–Voigt model in series.
//!
//! Creep y(t) = y₀ + Δ (1 − exp(−t/τ)) + rate · t; relaxation y(t) = Δ₁ exp(−t/τ₁) + Δ₂ exp(−t/τ₂), to nothing.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | instantaneous y₀ | of y | any | elastic part |
//! | amplitude Δ | of y | any | delayed part |
//! | time τ | s | above 0 | retardation time |
//! | flow rate | of y per s | any | slope of the flow that never comes back |

use crate::laws::{BasisFunction, Composition, Description, LawDefinition};

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "burgers",
    description: Description {
        title: "Burgers",
        equation: "y₀ + Δ (1 − exp(−t/τ)) + rate · t",
        source: "Burgers 1935; Findley, Lai, Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials, chapter 5",
    },
    relaxation: Some(Composition::of(&[BasisFunction::Exponential, BasisFunction::Exponential])),
    creep: Some(Composition::with_constant(&[BasisFunction::Exponential, BasisFunction::Straight])),
    contains_exponential: false,
};
