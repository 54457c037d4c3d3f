//! Fits against numbers from other software.

mod fits;
mod laws;
mod profiles;
