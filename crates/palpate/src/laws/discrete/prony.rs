//! The Prony series: the generalised Maxwell model with few terms, each with its own time.
//!
//! y(t) = y_e + Σ Δᵢ exp(−t/τᵢ), τ₁ < τ₂ < …; creep y(t) = y₀ + Σ Δᵢ (1 − exp(−t/τᵢ)).
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | equilibrium y_e, or instantaneous y₀ | of y | any | end, or start in creep |
//! | amplitudes Δᵢ | of y | any, or of one sign on request | share of each term |
//! | times τᵢ | s | above 0, rising | relaxation or retardation times |
//!
//! With one term it is the standard linear solid. Two terms whose times lie too close for the data to part, and terms that
//! vanish, are no terms: the fit reports them.

use crate::laws::Description;

pub(in crate::laws) const DESCRIPTION: Description = Description {
    title: "Prony series",
    equation: "y_e + Σ Δᵢ exp(−t/τᵢ)",
    source: "Wiechert 1893; Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior, chapter 3",
};
