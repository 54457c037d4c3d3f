//! Whole records: corrected, cut, calibrated, watched.

#[path = "../any_state/mod.rs"]
mod any_state;
mod calibrate;
mod causes;
mod corrections;
mod course;
mod curve_modulus;
mod damage;
mod exponents;
mod first_touch;
mod grip;
mod instrument;
mod linear_body;
mod measured_motion;
mod observe;
mod phases;
#[path = "../common/repeats.rs"]
mod repeats;
mod segmentation_suite;
mod several;
mod touch_and_modulus;
