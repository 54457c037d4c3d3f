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

use crate::laws::basis::Description;

pub(in crate::laws) const DESCRIPTION: Description = Description {
    title: "Burgers",
    equation: "y₀ + Δ (1 − exp(−t/τ)) + rate · t",
    source: "Burgers 1935; Findley, Lai, Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials, chapter 5",
};
