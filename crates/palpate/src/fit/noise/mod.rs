//! How the residuals of a fit correlate with their neighbours.
//!
//! The noise of a hold is taken as white, as autoregressive of first order, or as a sum of both:
//!
//! ```text
//! e_i = σ (√s a_i + √(1 − s) w_i),   a_i = ρ a_{i−1} + √(1 − ρ²) v_i,   corr(e_i, e_{i+k}) = s ρ^k
//! ```
//!
//! by sample, not by time: an instrument's filter acts that way, and for samples spaced unevenly it is an approximation.
//! ρ and s are those of the largest *restricted* likelihood (Patterson and Thompson 1971): residuals are flatter than
//! noise by what the fitted parameters took up, and a plain estimate of ρ from them is too small by some p (1 + ρ)/N.
//!
//! | file | what |
//! |---|---|
//! | `model.rs` | how noise correlates; a noise that was found, lags of residuals |
//! | `rows.rs` | sums over residuals and columns |
//! | `likelihood.rs` | the restricted likelihood of AR(1), and of white noise with AR(1) |
//! | `estimation.rs` | which noise left the residuals |
//! | `uncertainty.rs` | errors and intervals that follow |

mod estimation;
mod likelihood;
pub(crate) mod model;
mod rows;
pub(crate) mod uncertainty;

pub use model::NoiseModel;
pub use uncertainty::Uncertainty;
pub(crate) use uncertainty::{Assessed, Scale};
