//! Laws of relaxation and creep: every one of them "constant + amplitudes × shapes(t; few numbers)".
//!
//! | law | relaxation y(t) | creep y(t) | file |
//! |---|---|---|---|
//! | `latency` | y_e + Δ [1 + (n−1) λt]^(−1/(n−1)), n found | y₀ + Δ (1 − same) | `latency.rs` |
//! | `latency:N` | the same, n = N (1: linear latency, 2: Peleg) | the same | `latency.rs` |
//! | `maxwell` | Δ exp(−t/τ) | y₀ + rate · t | `maxwell.rs` |
//! | `kelvin-voigt` | | Δ (1 − exp(−t/τ)) | `kelvin_voigt.rs` |
//! | `standard-linear-solid` | y_e + Δ exp(−t/τ) | y₀ + Δ (1 − exp(−t/τ)) | `standard_linear_solid.rs` |
//! | `burgers` | Δ₁ exp(−t/τ₁) + Δ₂ exp(−t/τ₂) | y₀ + Δ (1 − exp(−t/τ)) + rate · t | `burgers.rs` |
//! | `prony:K` | y_e + Σ Δᵢ exp(−t/τᵢ), K terms | y₀ + Σ Δᵢ (1 − exp(−t/τᵢ)) | `prony.rs` |
//! | `spectrum` | as Prony, times on a dense grid, Δᵢ of one sign | the same | `spectrum.rs` |
//! | `fung:K` | N [c₀ + Σ cᵢ exp(−νᵢt)], Σ c = 1 | | `fung.rs` |
//! | `fung-continuous` | N [1 + C (E₁(t/τ_long) − E₁(t/τ_short))]/[1 + C ln(τ_long/τ_short)] | | `fung_continuous.rs` |
//! | `stretched` | y_e + Δ exp(−(λt)^β) | y₀ + Δ (1 − same) | `stretched.rs` |
//! | `power` | Δ (1 + t/t₀)^(−α) | y₀ + Δ (t/T)^α | `power.rs` |
//! | `logarithmic` | y₀ − Δ ln(1 + λt) | y₀ + Δ ln(1 + λt) | `logarithmic.rs` |
//! | `fractional-zener` | y_e + Δ E_α(−(λt)^α) | y₀ + Δ (1 − same) | `fractional_zener.rs` |
//! | `diffusion` | y_e + Δ (8/π²) Σ_odd exp(−k²λt)/k² | y₀ + Δ (1 − same) | `diffusion.rs` |
//!
//! A [`Law`] has its numbers free; a [`LawCurve`] has numbers put in. `law.rs` holds the list and its names, `form.rs` what a law
//! is made of, `kernel.rs` what a shape must be able to do, `shape.rs` the list of shapes, `curve.rs` a law with numbers,
//! `exponential.rs` the shape that six of them share. A hold that follows a ramp is no step: `loading.rs` holds what came before it,
//! `superposition.rs` averages shapes over that.

mod burgers;
mod curve;
mod description;
mod diffusion;
mod exponential;
mod form;
mod fractional_zener;
mod fung;
mod fung_continuous;
mod kelvin_voigt;
mod kernel;
mod latency;
mod law;
mod loading;
mod logarithmic;
mod maxwell;
mod power;
mod prony;
mod shape;
mod spectrum;
mod standard_linear_solid;
mod stretched;
mod superposition;

pub use curve::{LawCurve, Term};
pub use description::Description;
pub(crate) use form::{Column, Form};
pub(crate) use kernel::{Kernel, NumberKind};
pub use latency::ExponentChoice;
pub use law::{Law, MOST_TERMS, Response, UnknownLaw};
pub use loading::{Loading, LoadingError};
pub use shape::Shape;
pub(crate) use superposition::Superposition;
