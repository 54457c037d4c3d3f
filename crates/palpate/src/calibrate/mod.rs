//! One set of parameters for a whole record: what a hold describes, a calibration predicts.
//!
//! A [`CalibrationData`] and a [`Candidate`] come in, a [`Calibration`] goes out, with the [`Material`] that grips and observers take.
//!
//! | file | what | equations |
//! |---|---|---|
//! | `data.rs` | what is fitted: a motion of the jaw and the force it met | |
//! | `candidate.rs` | a law of the layer and one of the equilibrium force | (10), (11) |
//! | `prepared.rs` | the parameters of a candidate that are searched | |
//! | `search.rs`, `problem.rs` | a grid, then damped steps | |
//! | `uncertainty/` | their errors and intervals | |
//! | `fit.rs` | from there to parameters with intervals | |
//! | `course.rs` | residuals that follow a course: in the whole record, or in its ramps |
//! | `misfit.rs` | what the record shows against a law | |
//! | `profile.rs` | intervals by the profile of the residual sum of squares | |
//! | `material.rs` | the body with its parameters | |
//! | `range.rs`, `extrapolation.rs` | what the test has shown; what lies beyond, and what it adds to the errors |
//! | `predict.rs` | what it does under any drive, with intervals | |
//! | `several/` | several records at once: shared and own parameters, the spread between specimens | |
//! | `error.rs` | why one could not be made | |

mod candidate;
mod course;
mod data;
mod error;
mod extrapolation;
mod fit;
mod material;
mod misfit;
mod predict;
mod prepared;
mod problem;
mod profile;
mod range;
mod search;
mod several;
mod uncertainty;

pub use candidate::{Candidate, EquilibriumLaw, RateLaw};
pub use course::ResidualCourse;
pub use data::CalibrationData;
pub use error::{CalibrateError, MaterialError};
pub use extrapolation::Extrapolation;
pub use fit::{Calibration, calibrate};
pub use material::{
    Body, Material, MaterialParameter, MaterialParts, MaterialUncertainty, MaterialUnit, SystematicEffect,
};
pub use misfit::Misfit;
pub use predict::Prediction;
pub use profile::{ParameterProfile, profile};
pub use range::CalibrationRange;
pub use several::{
    BatchParameter, BatchRecord, Between, CalibratedSpecimen, SeveralCalibration, SeveralError, Sharing, Spread,
    calibrate_several,
};
