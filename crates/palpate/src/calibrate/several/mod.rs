//! Several records in one calibration: tests of one body, or of specimens of one batch.
//!
//! A parameter is *shared* (one value for all records) or each record's *own*. Of the own ones the spread between specimens is estimated, and
//! from both a [`Material`](super::Material) of a specimen of the batch that was not tested.
//!
//! | file | what |
//! |---|---|
//! | `sharing.rs` | which parameters are shared |
//! | `start.rs` | where the search starts |
//! | `joint.rs` | the parameters with the least weighted squares of all residuals |
//! | `covariance.rs` | their covariance, for residuals that correlate as those of each record do |
//! | `causes.rs` | errors of the instruments: which records have them in common, and what they move |
//! | `spread.rs` | the standard deviation between specimens, with its interval |
//! | `specimen.rs` | the material of another specimen |
//! | `result.rs` | what comes out |
//! | `calibrate.rs` | the steps in order |
//! | `error.rs` | why there is none |

mod calibrate;
mod causes;
mod covariance;
mod error;
mod joint;
mod result;
mod sharing;
mod specimen;
mod spread;
mod start;

pub use calibrate::calibrate_several;
pub use error::SeveralError;
pub use result::{BatchParameter, BatchRecord, Between, CalibratedSpecimen, SeveralCalibration};
pub use sharing::Sharing;
pub use spread::Spread;
