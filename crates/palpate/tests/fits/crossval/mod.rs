//! Fits against parameters from other software.

mod fits;
mod laws;
mod profiles;
