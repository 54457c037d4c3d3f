//! Holds and ramps, distinguished by the shape of a force, where no displacement was recorded.
//!
//! A force without spikes comes in; its stretches go out, each a hold or a ramp, with what speaks for every hold.
//!
//! The force is taken for a chain of stretches with noise. Over the time u of a stretch, from 0 to 1,
//!
//! ```text
//! hold:  F(u) = F∞ ± Σ aₖ exp(−u/τₖ),   aₖ ≥ 0      (any relaxation of a body that is linear or yields by a power law)
//! ramp:  F(u) = a + b u + c u² + d exp(−u/τ)         (stiffness that grows, and what relaxes when a ramp begins)
//! ```
//!
//! and the chain is the one of least cost: the weighted squares that its stretches leave, plus a price for every parameter and
//! every stretch as by Schwarz's criterion. The search is dynamic programming over the ends of the pieces of a bottom-up
//! approximation (Keogh et al. 2001, doi:10.1109/ICDM.2001.989531).
//!
//! | file | what |
//! |---|---|
//! | `breaks.rs` | where a stretch may end: the force as pieces of parabolas |
//! | `points.rs` | a stretch of samples as a few weighted means |
//! | `shapes.rs` | what a hold and a ramp leave of a stretch |
//! | `chain.rs` | the chain of least cost for one level of noise |
//! | `stretches.rs` | the level of noise, and what speaks for each hold |

mod breaks;
mod chain;
mod points;
mod shapes;
mod stretches;

pub(super) use stretches::{Stretch, stretches};
