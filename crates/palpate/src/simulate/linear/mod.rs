//! Linear laws of relaxation under the same motions, so that laws are compared in what they foretell.
//!
//! The contact layer of the latency law is replaced by one with a memory that fades linearly,
//!
//! ```text
//! ε(t) = ∫ G(t − s) dε_e(s),   G(t) = 1 + Σ g_k exp(−λ_k t),   F = S(u) ε
//! ```
//!
//! or, with an excess strain x_k for every term, ε = ε_e + Σ x_k and ẋ_k = g_k ε̇_e − λ_k x_k. While the jaw moves at constant speed each
//! x_k has a closed form, so that a motion is followed by exact recursion from knot to knot. One term with g = m − 1 and λ = v is the
//! latency law with n = 1.
//!
//! | file | what |
//! |---|---|
//! | `law.rs` | the terms of a law: standard linear solid, Prony, Fung |
//! | `fractional.rs` | the fractional Zener law as a sum of terms, with its error |
//! | `recovery.rs` | the surface once the jaw has left it |
//! | `course.rs` | through a motion: in contact, jaw off, in contact again |

mod course;
mod fractional;
mod law;
mod recovery;

pub use course::{LinearContact, simulate_linear};
pub use law::{LinearLaw, LinearLawError, LinearTerm};
