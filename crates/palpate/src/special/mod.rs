//! Functions that relaxation laws need and the standard library lacks, right to ten digits and more, for one argument
//! or for thousands at once.
//!
//! | file | what |
//! |---|---|
//! | `contour.rs` | nodes of an inverse Laplace integral |
//! | `mittag_leffler.rs` | E_α(−s^α), the fractional Zener body, by a contour integral of twelve nodes |
//! | `exponential_integral.rs` | E1(x) and Ein(x) |
//! | `fung.rs` | Fung's continuous spectrum, a box in ln τ |
//! | `gauss.rs` | Legendre's polynomials and Gauss's rule |
//! | `diffusion.rs` | exchange of a sheet with both faces |
//!
//! All are checked against 40-digit numbers, `validation/reference/special_functions.json`.

mod contour;
mod diffusion;
mod exponential_integral;
mod fung;
mod gauss;
mod mittag_leffler;

pub use diffusion::diffusion_decay;
pub(crate) use diffusion::diffusion_decay_many;
pub use exponential_integral::exponential_integral;
pub(crate) use fung::fung_continuous_many;
pub(crate) use gauss::{gauss_legendre, legendre};
pub use mittag_leffler::{MittagLeffler, mittag_leffler_decay};
pub(crate) use mittag_leffler::{mittag_leffler_decay_many, mittag_leffler_decay_value_many};
#[cfg(test)]
mod tests;
