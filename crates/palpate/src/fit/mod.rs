//! From a hold to the numbers of the law.
//!
//! Every law of relaxation is "constant + amplitude × shape(t; few numbers)": linear in most of its numbers. For given
//! shape numbers the best linear ones follow from two normal equations, so the search is left with ln λ alone, or
//! with ln λ and n (variable projection). That search is small enough to be exhaustive on a coarse grid, hence no
//! starting values are asked for, and none can be wrong.
//!
//! | file | what | equations |
//! |---|---|---|
//! | `separable/` | the engine: separable least squares with bounds, covariance and a reason to end | |
//! | `linear_algebra.rs` | Cholesky for its small matrices | |
//! | `bounded.rs` | linear least squares with bounds | |
//! | `samples.rs`, `law_options.rs` | what is fitted, and what may be asked | |
//! | `build.rs`, `model.rs` | law, samples and options made ready in the units of the fit | |
//! | `condensed.rs` | a hold condensed to a few dozen nodes | |
//! | `starts.rs` | the exhaustive coarse search | |
//! | `search.rs` | from a model to the global optimum | |
//! | `thorough.rs`, `exact.rs` | the search for hard cases: bounds, merged terms | |
//! | `apart.rs` | merged rates taken apart as far as doubles need | |
//! | `orthogonal.rs`, `confluent.rs` | columns made orthogonal, and what stands for those that imitate each other | |
//! | `lattice.rs`, `growth.rs`, `exchange.rs` | exponentials sought on a grid, added to a series, and replaced in it | |
//! | `ghosts.rs` | terms that a fit lists and the data do not have | |
//! | `robust.rs` | outliers made to count less | |
//! | `law_fit.rs`, `derived.rs` | any law fitted, its numbers and those that follow from them | |
//! | `foretell.rs` | a law fitted to the first part of a hold, held against the rest | |
//! | `time_domain.rs` | the latency law fitted to a signal | (4), (5) |
//! | `ramp_fit.rs` | the latency law of several holds that were reached in different times | section IV |
//! | `rate_domain.rs` | strain rate fitted against strain, as the paper does | (9), (10) |
//! | `joint/` | several holds at once: one law shared by all, or one each | |
//! | `spectrum/` | exponentials of all times at once, none of opposite sign | |
//! | `estimates.rs` | what a fit says | |
//! | `bootstrap.rs` | intervals from resampled residuals | |
//! | `prediction.rs` | the curve at a time, with its interval | |
//! | `profile.rs` | intervals that may be asymmetric or open | |
//! | `noise/`, `uncertainty.rs` | how residuals correlate, and the errors and intervals that follow | |
//! | `prony_terms.rs` | how many exponentials a hold has | |
//! | `selection.rs` | the lowest order that fits best, with its evidence | |

mod apart;
mod bootstrap;
mod bounded;
mod build;
mod condensed;
mod confluent;
mod derived;
mod estimates;
mod exact;
mod exchange;
mod foretell;
mod ghosts;
mod growth;
mod joint;
mod kinks;
mod lattice;
mod law_fit;
mod law_options;
mod linear_algebra;
mod model;
mod noise;
mod orthogonal;
mod prediction;
mod profile;
mod prony_terms;
mod ramp_fit;
mod rate_domain;
mod robust;
mod samples;
mod search;
mod selection;
mod separable;
mod spectrum;
mod starts;
mod thorough;
mod time_domain;
mod uncertainty;

pub use crate::laws::ExponentChoice;
pub use bootstrap::{Bootstrap, BootstrapOptions, bootstrap};
pub use estimates::{Domain, Estimate, LatencyFit, PARAMETERS};
pub use foretell::{Forecast, foretell};
pub use ghosts::Ghost;
pub use joint::{
    HoldWeights, JointComparison, JointFit, JointOptions, SharedTrend, TrendPoint, TrendVerdict, compare_joint,
    fit_joint,
};
pub use law_fit::{LawFit, LawNumber, NumberUnit, fit_law};
pub use law_options::{ConstantChoice, LawOptions, Loss, NoiseChoice, SampleChoice};
pub(crate) use linear_algebra::Cholesky;
pub use noise::NoiseModel;
pub use profile::{Interval, profile_interval};
pub use prony_terms::fit_prony;
pub use ramp_fit::{EquilibriumChoice, RampFit, RampHold, RampHoldNumbers, fit_ramps};
pub use rate_domain::fit_rates;
pub use samples::Samples;
pub use selection::{Candidate, OrderSelection, select_order};
pub use separable::{Termination, Work};
pub use spectrum::{Smoothing, SpectrumFit, SpectrumOptions, SpectrumPeak, SpectrumWork, fit_spectrum};
pub use time_domain::fit_hold;
pub use uncertainty::Uncertainty;
pub(crate) use uncertainty::{Assessed, Scale};

use serde::{Deserialize, Serialize};

use crate::laws::{Law, Response};
use crate::watch::Cancelled;

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
    /// The watch ended the work.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
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
    /// A standard deviation that is none.
    #[error("the standard deviation of sample {index} must be above 0, found {found}")]
    Deviation {
        /// Which sample.
        index: usize,
        /// What was given.
        found: f64,
    },
    /// A law that says nothing about what was measured.
    #[error("the law {law} has no form for {}", match response { Response::Relaxation => "relaxation", Response::Creep => "creep" })]
    NoForm {
        /// The law.
        law: Law,
        /// What was measured.
        response: Response,
    },
    /// An option for a number that the law does not have.
    #[error("the law has no number {name:?}; it has {known}")]
    UnknownNumber {
        /// What was given.
        name: String,
        /// Its numbers.
        known: String,
    },
    /// A number held at a value it cannot have.
    #[error("{name} cannot be held at {found}")]
    FixedNumber {
        /// Which.
        name: String,
        /// What was given.
        found: f64,
    },
    /// An amplitude that is to be held.
    #[error("{name} cannot be held, only {held}; give it bounds instead")]
    HeldAmplitude {
        /// Which.
        name: String,
        /// The numbers of the law that can be held.
        held: String,
    },
    /// Bounds that leave nothing between them.
    #[error("the bounds of {name} must rise and leave room for what a hold can show, found {low} to {high}")]
    Bounds {
        /// Which number.
        name: String,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// NaN or infinity.
    #[error("the {what} of sample {index} must be a finite number, found {found}")]
    NotFinite {
        /// Which sample.
        index: usize,
        /// Which of its numbers, such as "time".
        what: &'static str,
        /// What was found.
        found: f64,
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
    /// Something is wrong with one of several holds.
    #[error("hold {hold}: {source}")]
    Hold {
        /// Number of the hold, from 1.
        hold: usize,
        /// What.
        source: Box<FitError>,
    },
    /// A joint fit of no hold, or of one.
    #[error("a joint fit needs two holds or more, found {found}")]
    TooFewHolds {
        /// Holds found.
        found: usize,
    },
    /// A joint fit of holds that share no number.
    #[error("the law {law} has no number that holds could share")]
    NothingShared {
        /// The law.
        law: Law,
    },
    /// Samples with deviations beside samples without cannot be weighed against each other.
    #[error("all holds of a joint fit must have standard deviations, or none; hold {hold} has none")]
    DeviationsOfSome {
        /// Number of the first hold without, from 1.
        hold: usize,
    },
    /// No number of the law brings the rates nearer than zero does: they point away from every equilibrium.
    #[error("the strain rates do not point towards any equilibrium strain")]
    NoDecay,
}
