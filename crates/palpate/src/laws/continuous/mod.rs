//! Laws of a continuous spectrum of relaxation times: each file states its law, its parameters and where it comes from, and holds its
//! basis function.

pub(super) mod diffusion;
pub(super) mod fractional_zener;
pub(super) mod fung_continuous;
pub(super) mod latency;
pub(super) mod logarithmic;
pub(super) mod power;
pub(super) mod stretched;
