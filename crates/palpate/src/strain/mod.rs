//! From force and displacement to strain and strain rate: equations (6) to (9).
//!
//! | file | what | equations |
//! |---|---|---|
//! | `measure.rs` | strain at the contact | (6), (7), (8) |
//! | `rate.rs` | strain rate of noisy, irregular samples | (9) |

mod measure;
mod rate;

pub use measure::contact_strain;
pub use rate::{RateWindow, StrainRates, strain_rates};
