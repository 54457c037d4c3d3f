//! Fung's reduced relaxation function as a sum of exponentials, as used for soft fingers.
//!
//! f(t) = N(δ) g(t),  g(t) = c₀ + Σ cᵢ exp(−νᵢt),  Σ c = 1 (c₀ included), so that g(0) = 1 and N is the force right after the squeeze.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | elastic response N | of y | any | signal at the start |
//! | c₀ | 1 | below 1 | share that stays; N c₀ is the equilibrium force of equation (1), ε_e = −N₀c₀/α_c |
//! | cᵢ | 1 | | share of each term |
//! | νᵢ | 1/s | above 0 | their rates |
//!
//! It is Prony's series in other parameters: N = y_e + Σ Δᵢ, c₀ = y_e/N, cᵢ = Δᵢ/N, νᵢ = 1/τᵢ.

use crate::laws::Description;

pub(in crate::laws) const DESCRIPTION: Description = Description {
    title: "Fung, reduced relaxation function",
    equation: "N [c₀ + Σ cᵢ exp(−νᵢt)], Σ c = 1",
    source: "Fung, Biomechanics, section 7.6; Tiezzi and Kao 2007; Tsai, Kao et al., equation (1)",
};
