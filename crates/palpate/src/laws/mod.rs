//! Laws of relaxation and creep: every one of them "constant + amplitudes × shapes(t; few parameters)".
//!
//! | law | relaxation y(t) | creep y(t) | file |
//! |---|---|---|---|
//! | `latency` | y_e + Δ [1 + (n−1) λt]^(−1/(n−1)), n found | y₀ + Δ (1 − same) | `continuous/latency.rs` |
//! | `latency:N` | the same, n = N (1: linear latency, 2: Peleg) | the same | `continuous/latency.rs` |
//! | `maxwell` | Δ exp(−t/τ) | y₀ + rate · t | `discrete/maxwell.rs` |
//! | `kelvin-voigt` | | Δ (1 − exp(−t/τ)) | `discrete/kelvin_voigt.rs` |
//! | `standard-linear-solid` | y_e + Δ exp(−t/τ) | y₀ + Δ (1 − exp(−t/τ)) | `discrete/standard_linear_solid.rs` |
//! | `burgers` | Δ₁ exp(−t/τ₁) + Δ₂ exp(−t/τ₂) | y₀ + Δ (1 − exp(−t/τ)) + rate · t | `discrete/burgers.rs` |
//! | `prony:K` | y_e + Σ Δᵢ exp(−t/τᵢ), K terms | y₀ + Σ Δᵢ (1 − exp(−t/τᵢ)) | `discrete/prony.rs` |
//! | `spectrum` | as Prony, times on a dense grid, Δᵢ of one sign | the same | `discrete/spectrum.rs` |
//! | `fung:K` | N [c₀ + Σ cᵢ exp(−νᵢt)], Σ c = 1 | | `discrete/fung.rs` |
//! | `fung-continuous` | N [1 + C (E₁(t/τ_long) − E₁(t/τ_short))]/[1 + C ln(τ_long/τ_short)] | | `continuous/fung_continuous.rs` |
//! | `stretched` | y_e + Δ exp(−(λt)^β) | y₀ + Δ (1 − same) | `continuous/stretched.rs` |
//! | `power` | Δ (1 + t/t₀)^(−α) | y₀ + Δ (t/T)^α | `continuous/power.rs` |
//! | `logarithmic` | y₀ − Δ ln(1 + λt) | y₀ + Δ ln(1 + λt) | `continuous/logarithmic.rs` |
//! | `fractional-zener` | y_e + Δ E_α(−(λt)^α) | y₀ + Δ (1 − same) | `continuous/fractional_zener.rs` |
//! | `diffusion` | y_e + Δ (8/π²) Σ_odd exp(−k²λt)/k² | y₀ + Δ (1 − same) | `continuous/diffusion.rs` |
//!
//! A [`Law`] has its parameters free; a [`LawCurve`] has parameters put in. `law.rs` holds the list of laws,
//! a line each, `definition.rs` what such a line leads to, `form.rs` how a law stands in a signal, `basis.rs` the list of basis functions, `kernel.rs` what one of them must be able to do, `kernels.rs` that they can,
//! `curve.rs` a law with its parameters, `formula.rs` that in writing. Two rooms hold the laws themselves: `discrete/` those with single relaxation times, `continuous/` all
//! others. A hold that follows a ramp is no step: `loading.rs` holds what came before it, `superposition.rs` averages basis functions
//! over that. `fit` fits them all; nothing here looks at data.

mod basis;
mod continuous;
mod curve;
mod definition;
mod discrete;
mod form;
mod formula;
mod kernel;
mod kernels;
mod law;
mod loading;
mod superposition;

pub use basis::{BasisFunction, ExponentChoice, Response};
pub use curve::{LawCurve, Term};
pub use definition::{Composition, Description, LawDefinition};
pub(crate) use form::{Column, Form};
pub use kernel::{CustomKernel, Kernel, ShapeParameter, ShapeParameterKind};
use kernel::{REFERENCE, TIME, two};
pub(crate) use kernel::{name_of_term, term_of_name};
pub use law::{Law, MOST_TERMS, UnknownLaw};
pub use loading::{Loading, LoadingError};
pub(crate) use superposition::Superposition;
