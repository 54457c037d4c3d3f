//! Why a calibration could not be made.

use crate::analysis::AnalysisError;
use crate::contact::{EquilibriumError, SpecimenError};
use crate::laws::Law;
use crate::number::significant;
use crate::simulate::{MotionError, SimulateError};
use crate::watch::Cancelled;

/// Why parts make no [`Material`](super::Material).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MaterialError {
    /// Other parameters than the law has, or another order or unit.
    #[error("the parameters of this law are {}, found {}", expected.join(", "), found.join(", "))]
    Names {
        /// Names of the parameters of the law.
        expected: Vec<String>,
        /// Names that were given.
        found: Vec<String>,
    },
    /// A value that is not above zero, a negative error, or an interval whose ends are exchanged.
    #[error("expected a finite {name} above 0 with errors of 0 or more and a rising interval, found {value}")]
    Estimate {
        /// Name of the parameter.
        name: String,
        /// Its value.
        value: f64,
    },
    /// A covariance of another size or not finite, a confidence outside 0…1, or degrees of freedom that are not above 0.
    #[error(
        "the uncertainty of {parameters} parameters is a finite covariance of {parameters} rows and columns, a confidence between 0 and 1, and degrees of freedom above 0"
    )]
    Uncertainty {
        /// Number of parameters.
        parameters: usize,
    },
    /// A noise or an end of the range that is negative or not finite.
    #[error("{name} must be finite and 0 or more, found {value}")]
    Number {
        /// Which.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// Parameters within their ranges that make no contact together.
    #[error(
        "the parameters make no contact: a layer is thicker than the body, or the equilibrium forces do not rise with the displacement"
    )]
    NoContact,
}

/// Why a calibration could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrateError {
    /// Columns of different lengths.
    #[error("a calibration needs a force for every time, found {times} times and {forces} forces")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of forces.
        forces: usize,
    },
    /// A sample that is NaN or infinite.
    #[error("times and forces must be finite; sample {sample} is not")]
    NotFinite {
        /// Which, from 1.
        sample: usize,
    },
    /// A held displacement that the jaw does not reach.
    #[error("held displacements must be finite numbers, near to where the jaw goes, up to {farthest} m; found {found}")]
    Held {
        /// What was given, m.
        found: f64,
        /// The farthest displacement of the motion, m.
        farthest: f64,
    },
    /// A time that does not rise or lies outside the motion.
    #[error("sample times must rise and lie from {from} s to {until} s, found {found} s at sample {sample}")]
    SampleTime {
        /// Which, from 1.
        sample: usize,
        /// The time, s.
        found: f64,
        /// Start of the motion, s.
        from: f64,
        /// Its end, s.
        until: f64,
    },
    /// Too little to fit or to predict.
    #[error("a calibration up to {at} s has {before} samples before and {after} after it; each part needs at least 8")]
    Split {
        /// The time, s.
        at: f64,
        /// Samples up to it.
        before: usize,
        /// Samples after it.
        after: usize,
    },
    /// Parameters that make no material.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// No body.
    #[error("a calibration needs the geometry of the body, which is not described")]
    NoGeometry,
    /// A motion against the direction of loading alone.
    #[error("expected a displacement that rises from first touch, found one that falls to {} mm", significant(1e3 * lowest, 3))]
    NeverPressed {
        /// The lowest displacement, m.
        lowest: f64,
    },
    /// No motion.
    #[error("a calibration needs the displacement of the jaw, which the record does not have")]
    NoDisplacement,
    /// A law that no contact is simulated with.
    #[error("{law} describes single holds; it is not a law of a whole contact")]
    NotALaw {
        /// Which.
        law: Law,
    },
    /// A rate coefficient that depends on the state, of a law that has none.
    #[error("{law} has no rate coefficient, so it cannot depend on strain or direction")]
    RateOf {
        /// Which.
        law: Law,
    },
    /// A factor of the rate coefficient that no sample feels.
    #[error("the record does not determine the factor by which v differs: {missing}")]
    FactorUnseen {
        /// What it lacks.
        missing: &'static str,
    },
    /// An exponent that is not above zero.
    #[error("exponent must be above 0, found {found}")]
    Exponent {
        /// What was given.
        found: f64,
    },
    /// Fewer samples than parameters to find.
    #[error("estimating {parameters} parameters needs more than the {samples} samples of the record")]
    TooFewSamples {
        /// Samples to fit.
        samples: usize,
        /// Parameters.
        parameters: usize,
    },
    /// A force of one value while the jaw moves.
    #[error("the force is {} N throughout, while the jaw moves", significant(*force, 4))]
    ConstantForce {
        /// The force, N.
        force: f64,
    },
    /// A body that never pushes back.
    #[error("the force does not rise with the displacement: no positive stiffness fits the record")]
    NoStiffness,
    /// An invalid body, or one that is thinner than the travel of the jaw.
    #[error(transparent)]
    Specimen(#[from] SpecimenError),
    /// An equilibrium law that does not go with the body.
    #[error(transparent)]
    Equilibrium(#[from] EquilibriumError),
    /// A record that has no phases, or a correction that cannot be made.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// An invalid motion.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A simulation that could not be run.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// Its watch ended it.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl CalibrateError {
    /// What would help.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::NoGeometry => "describe the body in [specimen] of the test description; `palpate inspect` drafts one with ⟨write_test⟩".to_owned(),
            Self::NoDisplacement => {
                "name the displacement column in [columns]; without it palpate can only fit single holds".to_owned()
            }
            Self::NeverPressed { .. } => "loading is positive: set sign = -1 in [columns.displacement] of the test description, or give the unit of the column a minus sign".to_owned(),
            Self::NotALaw { .. } => {
                "the laws of a whole contact are latency, latency:N, standard-linear-solid, prony:K and fung:K"
                    .to_owned()
            }
            Self::RateOf { .. } => "omit the dependence of v, or use the law latency".to_owned(),
            Self::FactorUnseen { .. } => "use a constant rate coefficient, or calibrate on a longer record".to_owned(),
            Self::Split { .. } => "choose a time within the record".to_owned(),
            Self::ConstantForce { .. } => "check the force column and that the load cell was connected".to_owned(),
            Self::NoStiffness => "check the signs of force and displacement".to_owned(),
            Self::Specimen(_) => "check the geometry in the test description and its units".to_owned(),
            Self::Equilibrium(_) => "use another equilibrium law: uniform-strain, hertz or table".to_owned(),
            Self::Analysis(error) => error.hint(),
            _ => String::new(),
        }
    }

    /// Whether another record could be calibrated: what is wrong is a record, not what all are calibrated with.
    pub(super) fn is_of_record(&self) -> bool {
        matches!(
            self,
            Self::NeverPressed { .. }
                | Self::NoDisplacement
                | Self::FactorUnseen { .. }
                | Self::TooFewSamples { .. }
                | Self::ConstantForce { .. }
                | Self::NoStiffness
                | Self::Analysis(_)
        )
    }
}
