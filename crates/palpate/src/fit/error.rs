//! Why a fit could not be made at all.

use crate::laws::{Law, Response};
use crate::number::counted;
use crate::watch::Cancelled;

/// Why a fit could not be made at all.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Columns of different lengths.
    #[error("a fit needs as many values as abscissas, found {abscissas} and {values}")]
    Lengths {
        /// Number of times or strains.
        abscissas: usize,
        /// Number of values.
        values: usize,
    },
    /// Fewer samples than parameters to find, and one over.
    #[error("a fit of {} needs {needed} samples or more, found {found}", counted(*parameters, "parameter"))]
    TooFewSamples {
        /// Parameters to find.
        parameters: usize,
        /// Least number of samples.
        needed: usize,
        /// Samples found.
        found: usize,
    },
    /// An invalid standard deviation.
    #[error("the standard deviation of sample {index} must be above 0, found {found}")]
    StandardDeviation {
        /// Which sample.
        index: usize,
        /// What was given.
        found: f64,
    },
    /// A law that does not describe the measured quantity.
    #[error("the law {law} does not describe {}", match response { Response::Relaxation => "relaxation", Response::Creep => "creep" })]
    NoForm {
        /// The law.
        law: Law,
        /// What was measured.
        response: Response,
    },
    /// An option for a parameter that the law does not have.
    #[error("the law has no parameter {name:?}; it has {known}")]
    UnknownParameter {
        /// What was given.
        name: String,
        /// Its parameters.
        known: String,
    },
    /// A parameter held at a value it cannot have.
    #[error("{name} cannot be fixed at {found}")]
    FixedParameter {
        /// Which.
        name: String,
        /// What was given.
        found: f64,
    },
    /// A parameter held at a value that its bounds exclude.
    #[error("{name} cannot be fixed at {found}, outside of its bounds, {low} to {high}; give one of both")]
    FixedOutsideBounds {
        /// Which.
        name: String,
        /// What it was to be held at.
        found: f64,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// An amplitude that is to be held.
    #[error("{name} cannot be fixed, only {held}; give it bounds instead")]
    HeldAmplitude {
        /// Which.
        name: String,
        /// The parameters of the law that can be held.
        held: String,
    },
    /// Bounds that leave nothing between them.
    #[error("the bounds of {name} must rise and overlap the range that a hold determines, found {low} to {high}")]
    Bounds {
        /// Which parameter.
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
        /// Which of its parameters, such as "time_constant_s".
        what: &'static str,
        /// What was found.
        found: f64,
    },
    /// Times that do not rise.
    #[error("times must rise; sample {index} does not")]
    TimeNotRising {
        /// Which sample.
        index: usize,
    },
    /// All values are the same: nothing relaxes.
    #[error("all {samples} samples have the value {value}: there is no relaxation")]
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
    #[error("the samples exceed the range of double precision")]
    OutOfRange,
    /// An invalid range of exponents.
    #[error("the range of n must rise from a value above 0, found {low} to {high}")]
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
    /// A weight that is not a finite number of zero or more.
    #[error("weight {index} must be a finite number of 0 or more")]
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
    /// A joint fit of holds that share no parameter.
    #[error("the law {law} has no parameter that holds can share")]
    NothingShared {
        /// The law.
        law: Law,
    },
    /// Samples with standard deviations beside samples without cannot be weighed against each other.
    #[error("either all holds of a joint fit or no hold must have standard deviations; hold {hold} has none")]
    StandardDeviationsOfSome {
        /// Number of the first hold without, from 1.
        hold: usize,
    },
    /// No parameter of the law brings the rates nearer than zero does: they point away from every equilibrium.
    #[error("the strain rates do not indicate an equilibrium strain")]
    NoDecay,
    /// The watch ended it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl FitError {
    /// Refuses columns of different lengths.
    pub(crate) fn check_lengths(abscissas: usize, values: usize) -> Result<(), Self> {
        if abscissas == values { Ok(()) } else { Err(Self::Lengths { abscissas, values }) }
    }

    /// Refuses samples that all have one value.
    pub(crate) fn check_change(low: f64, high: f64, samples: usize) -> Result<(), Self> {
        if low == high { Err(Self::Constant { value: low, samples }) } else { Ok(()) }
    }

    /// Refuses samples that leave fewer than two beside the parameters that are to be found.
    pub(crate) fn check_samples(parameters: usize, found: usize) -> Result<(), Self> {
        let needed = parameters + 2;
        if found >= needed {
            return Ok(());
        }
        Err(Self::TooFewSamples {
            parameters,
            needed,
            found,
        })
    }
}

/// A comparison, a fit or a forecast; none where nothing could be fitted.
pub(crate) fn fitted<T>(made: Result<T, FitError>) -> Result<Option<T>, Cancelled> {
    match made {
        Err(FitError::Cancelled(cancelled)) => Err(cancelled),
        made => Ok(made.ok()),
    }
}
