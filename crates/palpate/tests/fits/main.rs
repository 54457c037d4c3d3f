//! Fits of every law to holds and ramps.

#[path = "../common/mod.rs"]
mod common;
mod coverage;
mod crossval;
mod global_optimum;
mod joint;
mod laws;
mod outliers;
mod ramps;
mod recovery;
#[path = "../common/repeats.rs"]
mod repeats;
mod watched;
