//! Laws of few relaxation times, or many on a grid: springs and dashpots, sums of exponentials.
//!
//! Each file states its law, its parameters and where it comes from; and the basis functions that it is composed of; `exponential.rs` and `maxwell.rs` hold
//! those.

pub(super) mod burgers;
pub(super) mod exponential;
pub(super) mod fung;
pub(super) mod kelvin_voigt;
pub(super) mod maxwell;
pub(super) mod prony;
pub(super) mod spectrum;
pub(super) mod standard_linear_solid;
