//! Whole records: corrected, cut, calibrated, watched.

mod calibrate;
mod corrections;
mod grip;
mod observe;
mod phases;
mod segmentation_suite;
mod touch_and_modulus;
