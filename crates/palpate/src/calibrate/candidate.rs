//! A model with parameters to be found: a law of the layer and one of the equilibrium force.

use serde::{Deserialize, Serialize};

use super::CalibrateError;
use crate::contact::{Equilibrium, RateDependence};
use crate::laws::{Law, MOST_TERMS};

/// The law of the force that a body tends to, whose coefficients are to be found.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EquilibriumLaw {
    /// The paper's E ε A, equation (11): one modulus.
    #[default]
    UniformStrain,
    /// Hertz's: one modulus, for balls, pads and the tips of indenters.
    Hertz {
        /// Poisson's ratio ν, from 0 to 0.5; the data do not separate it from the modulus.
        poisson_ratio: f64,
    },
    /// A monotone table with one row per held displacement, and one at the largest displacement.
    Table,
}

impl From<&Equilibrium> for EquilibriumLaw {
    fn from(law: &Equilibrium) -> Self {
        match law {
            Equilibrium::UniformStrain => Self::UniformStrain,
            Equilibrium::Hertz { poisson_ratio } => Self::Hertz {
                poisson_ratio: *poisson_ratio,
            },
            Equilibrium::Measured { .. } => Self::Table,
        }
    }
}

/// Whether the rate coefficient of the latency law is one parameter, or depends on the state of the layer.
///
/// Fitted hold by hold it has a trend with the equilibrium strain (the paper's Table I) and another level after unloading (Table II);
/// a calibration with one more parameter determines whether the body or the fits cause that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RateLaw {
    /// One parameter.
    #[default]
    Constant,
    /// v(ε_e) = v f^(ε_e/0.1), with f to be found: [`RateDependence::Strain`].
    ByStrain,
    /// v after loading and f v after unloading, with f to be found: [`RateDependence::Direction`].
    ByDirection,
}

impl RateLaw {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Constant, Self::ByStrain, Self::ByDirection];

    /// Name of its factor among the parameters of a material.
    #[must_use]
    pub fn factor_name(self) -> Option<&'static str> {
        match self {
            Self::Constant => None,
            Self::ByStrain => Some("strain_factor"),
            Self::ByDirection => Some("unloading_factor"),
        }
    }

    /// What it adds to the name of its law.
    pub(super) fn suffix(self) -> &'static str {
        match self {
            Self::Constant => "",
            Self::ByStrain => ", v by strain",
            Self::ByDirection => ", v by direction",
        }
    }

    /// What a record lacks that does not show its factor.
    pub(super) fn needs(self) -> Option<&'static str> {
        match self {
            Self::Constant => None,
            Self::ByStrain => Some("the force does not relax under compression"),
            Self::ByDirection => Some("no strain rises to equilibrium, as it does in a hold after unloading"),
        }
    }

    /// With its factor put in.
    #[must_use]
    pub fn with(self, factor: f64) -> RateDependence {
        match self {
            Self::Constant => RateDependence::Constant,
            Self::ByStrain => RateDependence::Strain { factor },
            Self::ByDirection => RateDependence::Direction { factor },
        }
    }
}

/// What is fitted to a record: a law of relaxation and one of the equilibrium force.
///
/// The law is `latency` or `latency:N`, `standard-linear-solid`, `prony:K` (memory of strain) or `fung:K` (memory of the equilibrium force,
/// Fung's quasi-linear viscoelasticity).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The law of the layer.
    pub law: Law,
    /// The law of the equilibrium force.
    pub equilibrium: EquilibriumLaw,
    /// What the rate coefficient of the latency law depends on; constant of any other.
    pub rate: RateLaw,
}

impl std::fmt::Display for Candidate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.law, self.rate.suffix())
    }
}

impl Candidate {
    /// A law of the layer, of a rate coefficient that depends on nothing, and one of the equilibrium force.
    #[must_use]
    pub fn new(law: Law, equilibrium: EquilibriumLaw) -> Self {
        Self {
            law,
            equilibrium,
            rate: RateLaw::Constant,
        }
    }

    /// The candidate and what it is held against on the same record: other laws of the layer and, if its rate coefficient depends on the
    /// state, the other ways in which it could.
    #[must_use]
    pub fn with_alternatives(self, laws: &[Law]) -> Vec<Self> {
        let rates = RateLaw::ALL.into_iter().filter(|rate| self.rate != RateLaw::Constant && *rate != self.rate);
        let others = laws.iter().filter(|law| **law != self.law).map(|law| Self {
            law: *law,
            rate: RateLaw::Constant,
            ..self
        });
        std::iter::once(self).chain(rates.map(|rate| Self { rate, ..self })).chain(others).collect()
    }

    /// Whether a material can have this law of the layer.
    #[must_use]
    pub fn accepts(law: Law) -> bool {
        matches!(law, Law::Latency { .. }) || Self::new(law, EquilibriumLaw::default()).terms().is_ok()
    }

    /// Terms of its linear law.
    pub(super) fn terms(self) -> Result<usize, CalibrateError> {
        match self.law {
            Law::StandardLinearSolid => Ok(1),
            Law::Prony { terms } | Law::Fung { terms } if (1..=MOST_TERMS).contains(&terms) => Ok(terms),
            law => Err(CalibrateError::NotALaw { law }),
        }
    }
}
