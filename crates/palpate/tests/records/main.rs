//! Whole records: corrected, cut, calibrated, watched.

mod calibrate;
mod corrections;
mod exponents;
mod grip;
mod observe;
mod phases;
#[path = "../common/repeats.rs"]
mod repeats;
mod segmentation_suite;
mod touch_and_modulus;
