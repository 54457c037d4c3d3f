//! Fits of a law to a hold: its parameters, their uncertainty, and why the search ended.
//!
//! Every law of relaxation is "constant + amplitude × shape(t; few parameters)": linear in most of its parameters. For given
//! shape parameters the best linear ones follow from two normal equations, so the search is left with ln λ alone, or
//! with ln λ and n (variable projection). That search is small enough to be exhaustive on a coarse grid, hence no
//! starting values are needed.
//!
//! Rooms and files use only those above them.
//!
//! | file | what | equations |
//! |---|---|---|
//! | `error.rs`, `options.rs`, `levels.rs`, `samples.rs` | samples and whether they were rounded, options, and errors | |
//! | `noise/` | correlation of residuals, and the resulting standard errors and intervals | |
//! | `problem/` | law, samples and options made ready in the units of the fit | |
//! | `global/` | from a problem to the global optimum | |
//! | `parameter.rs`, `result.rs` | what a fit says: a law and its parameters, by name | |
//! | `law/` | any law fitted to a hold; intervals by curvature, profiles or resampling | |
//! | `latency.rs` | the latency law in the time domain; the lowest order that fits best | (4), (5) |
//! | `rate_domain.rs` | strain rate fitted against strain, as the paper does | (9), (10) |
//! | `spectrum/` | exponentials of all times at once, none of opposite sign | |
//! | `forecast.rs` | a law fitted to the first part of a hold, held against the rest | |
//! | `joint/` | several holds at once: one law shared by all, or one each | section IV |

mod error;
mod forecast;
mod global;
mod joint;
mod latency;
mod law;
mod levels;
mod noise;
mod options;
mod parameter;
mod problem;
mod rate_domain;
mod result;
mod samples;
mod spectrum;

pub use crate::laws::ExponentChoice;
pub use crate::optimise::{Termination, Work};
pub use error::FitError;
pub(crate) use error::fitted;
pub use forecast::{Forecast, forecast};
pub(crate) use forecast::{condensed_curve, extrapolated};
pub(crate) use global::{combinations, distinct};
use global::{finalists, local, search};
pub use joint::{
    HoldWeights, JointComparison, JointFit, JointOptions, SharedTrend, TrendPoint, TrendVerdict, compare_joint,
    compare_joint_watched, fit_joint, fit_joint_watched,
};
pub use latency::{Candidate, LatencyFit, OrderSelection, fit_hold, fit_hold_watched, select_order};
use law::Fitted;
pub use law::{fit_law, fit_law_watched, profile_interval};
pub(crate) use noise::{Assessed, Scale, Trust, UNEXPLAINED, whitened};
pub use noise::{ModelCovariance, NoiseCourse, NoiseFollows, NoiseModel, Uncertainty};
pub use options::{
    BootstrapOptions, ConstantChoice, FitOptions, IntervalMethod, LawOptions, Loss, NoiseChoice, SampleChoice,
};
pub use parameter::{ErrorParts, Estimate, Interval, ParameterKind, ParameterName};
pub(crate) use problem::Condensed;
pub use problem::RedundantTerm;
use problem::{Model, ModelParameter, Sampled, build, condense, condense_to, redundant_terms, searched_name};
pub use rate_domain::{fit_rates, fit_rates_watched};
pub use result::{Domain, Fit, Parameter, ParameterRole, ParameterUnit, ProfileCurves};
pub use samples::Samples;
use samples::{Scaled, check_finite};
pub(crate) use samples::{before, until};
pub use spectrum::{Smoothing, SpectrumFit, SpectrumOptions, SpectrumPeak, fit_spectrum};
