//! Linear laws of relaxation under the same motions, forces and programs, so that laws are compared in what they predict.
//!
//! The contact layer of the latency law is replaced by one with a memory that fades linearly,
//!
//! ```text
//! ε(t) = ∫ G(t − s) dε_e(s),   G(t) = 1 + Σ g_k exp(−λ_k t),   F = S(u) ε
//! ```
//!
//! or, with an excess x_k for every term, ε = ε_e + Σ x_k and ẋ_k = g_k ε̇_e − λ_k x_k. One term with g = m − 1 and λ = v is the latency
//! law with n = 1. Fung's quasi-linear law is the same with the equilibrium force F_e(u) in the place of ε_e and F in that of ε. Either of them
//! is called q below.
//!
//! | file | what |
//! |---|---|
//! | `law.rs` | the terms of a law: standard linear solid, Prony, Fung |
//! | `fractional.rs` | the fractional Zener law as a sum of terms, with its error |
//! | `contact.rs` | the body with its law, and what the law remembers |
//! | `stage.rs` | the memory while q is a polynomial of time: exact |
//! | `moving.rs` | while the jaw moves at constant speed |
//! | `forced.rs` | while the force goes straight |
//! | `recovery.rs` | what fades while no force changes, and the surface once the jaw has left it |
//! | `layer.rs` | all of it as the walk through a drive asks for it |
//! | `step.rs` | one step at a time |

mod contact;
mod forced;
mod fractional;
mod law;
mod layer;
mod moving;
mod recovery;
mod stage;
mod step;

pub use contact::{LinearContact, Memory};
use forced::Forced;
pub use law::{LinearLaw, LinearLawError, LinearTerm};
use moving::Moving;
use recovery::{Modes, Surface};
pub(super) use step::{LinearStepper, Memories};
