//! The dense relaxation spectrum: Prony's series on a fixed grid of times.
//!
//! y(t) = y_e ± Σ hⱼ exp(−t/τⱼ) with hⱼ ≥ 0 and τⱼ equally spaced in ln τ. Grid and smoothing follow a stated rule
//! (`fit/spectrum/`); nothing but the signal's sign is left to choose. It has no standard errors.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | equilibrium y_e | of y | any | what the signal tends to |
//! | amplitudes hⱼ | of y | 0 or more | relaxation strength at τⱼ |

use crate::laws::{Description, LawDefinition};

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "spectrum",
    description: Description {
        title: "dense spectrum",
        equation: "y_e + Σ hⱼ exp(−t/τⱼ), hⱼ of one sign, τⱼ on a grid",
        source: "Provencher 1982; Tschoegl, chapter 4; non-negative least squares: Lawson and Hanson 1974",
    },
    // It is fitted another way.
    relaxation: None,
    creep: None,
    contains_exponential: true,
};
