//! Figures and pages as others see them.

mod figures;
mod pages;
#[cfg(feature = "png")]
mod print;
