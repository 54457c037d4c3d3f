//! From a hold to the numbers of the law.
//!
//! Every law of relaxation is "constant + amplitude × shape(t; few numbers)": linear in most of its numbers. For given
//! shape numbers the best linear ones follow from two normal equations, so the search is left with ln λ alone, or
//! with ln λ and n (variable projection). That search is small enough to be exhaustive on a coarse grid, hence no
//! starting values are asked for, and none can be wrong.
//!
//! | file | what | equations |
//! |---|---|---|
//! | `separable.rs` | the engine: separable least squares with bounds, covariance and a reason to end | |
//! | `linear_algebra.rs` | Cholesky for its small matrices | |
//! | `bounded.rs` | linear least squares with bounds on the numbers | |
//! | `coarse.rs` | the exhaustive coarse search | |
//! | `time_domain.rs` | the closed form fitted to a signal | (4), (5) |
//! | `rate_domain.rs` | strain rate fitted against strain, as the paper does | (9), (10) |
//! | `spectrum/` | exponentials of all times at once, none of opposite sign | |
//! | `estimates.rs` | estimates, standard errors, intervals | |
//! | `selection.rs` | the lowest order that fits best, with its evidence | |

mod bounded;
mod coarse;
mod estimates;
mod linear_algebra;
mod rate_domain;
mod selection;
mod separable;
mod spectrum;
mod time_domain;

pub use estimates::{Domain, Estimate, ExponentChoice, LatencyFit, PARAMETERS};
pub use rate_domain::fit_rates;
pub use selection::{Candidate, OrderSelection, select_order};
pub use separable::{Termination, Work};
pub use spectrum::{Smoothing, SpectrumFit, SpectrumOptions, SpectrumPeak, SpectrumWork, fit_spectrum};
pub use time_domain::fit_hold;

use serde::{Deserialize, Serialize};

/// What may be asked of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FitOptions {
    /// Range in which a free exponent is sought.
    pub exponent_range: (f64, f64),
    /// Coverage of confidence intervals, between 0 and 1.
    pub confidence: f64,
    /// Steps of the refinement after which it ends short.
    pub most_iterations: usize,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            exponent_range: (0.2, 30.0),
            confidence: 0.95,
            most_iterations: 200,
        }
    }
}

impl FitOptions {
    fn check(&self) -> Result<(), FitError> {
        let (low, high) = self.exponent_range;
        if !(low > 0.0 && low <= high && high.is_finite()) {
            return Err(FitError::ExponentRange { low, high });
        }
        if !(self.confidence > 0.0 && self.confidence < 1.0) {
            return Err(FitError::Confidence { found: self.confidence });
        }
        Ok(())
    }
}

/// Why a fit could not be made at all.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Columns of different lengths.
    #[error("a fit needs as many values as abscissas, found {abscissas} and {values}")]
    Lengths {
        /// Number of times or strains.
        abscissas: usize,
        /// Number of values.
        values: usize,
    },
    /// Fewer samples than numbers to find, and one over.
    #[error("a fit of {parameters} numbers needs {needed} samples or more, found {found}")]
    TooFewSamples {
        /// Numbers to find.
        parameters: usize,
        /// Least number of samples.
        needed: usize,
        /// Samples found.
        found: usize,
    },
    /// NaN or infinity.
    #[error("sample {index} is not a finite number")]
    NotFinite {
        /// Which sample.
        index: usize,
    },
    /// Times that do not rise.
    #[error("times must rise, sample {index} does not")]
    TimeNotRising {
        /// Which sample.
        index: usize,
    },
    /// All values are the same: nothing relaxes.
    #[error("all {samples} samples have the value {value}: nothing relaxes")]
    Constant {
        /// The value.
        value: f64,
        /// How many.
        samples: usize,
    },
    /// An exponent that is not a finite number above zero.
    #[error("exponent n must be a number above 0, found {found}")]
    Exponent {
        /// What was given.
        found: f64,
    },
    /// Values or times that span more than double precision can hold.
    #[error("the samples span more than double precision holds")]
    OutOfRange,
    /// A range of exponents that is none.
    #[error("the range of n must run upwards from a number above 0, found {low} to {high}")]
    ExponentRange {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// A coverage that is not between 0 and 1.
    #[error("confidence must lie between 0 and 1, found {found}")]
    Confidence {
        /// What was given.
        found: f64,
    },
    /// A square root of a weight that is not a finite number of zero or more.
    #[error("weight {index} is not a finite number of zero or more")]
    Weight {
        /// Which sample.
        index: usize,
    },
    /// A setting of the spectrum out of its range.
    #[error("{setting} is out of range: {found}")]
    SpectrumSetting {
        /// Which setting, and its range.
        setting: &'static str,
        /// What was given.
        found: f64,
    },
    /// No number of the law brings the rates nearer than zero does: they point away from every equilibrium.
    #[error("the strain rates do not point towards any equilibrium strain")]
    NoDecay,
}
