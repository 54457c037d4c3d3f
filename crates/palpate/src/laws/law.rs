//! The list of laws and their names.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::continuous::{diffusion, fractional_zener, fung_continuous, latency, logarithmic, power, stretched};
use super::discrete::{burgers, fung, kelvin_voigt, maxwell, prony, spectrum, standard_linear_solid};
use super::{BasisFunction, Description, ExponentChoice, Form, Response};

/// A law of relaxation or creep whose parameters are to be found; see the [table of laws](crate::laws).
///
/// In text and JSON a law is its name: `latency` (n found), `latency:5`, `prony:2`, `standard-linear-solid`, …
///
/// ```
/// use palpate::laws::{ExponentChoice, Law};
/// let law: Law = "latency:5".parse()?;
/// assert_eq!(law, Law::Latency { exponent: ExponentChoice::Fixed(5.0) });
/// assert_eq!(Law::Prony { terms: 2 }.to_string(), "prony:2");
/// # Ok::<(), palpate::laws::UnknownLaw>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum Law {
    /// The paper's law, n given or found.
    Latency {
        /// Whether n is given.
        exponent: ExponentChoice,
    },
    /// Spring and dashpot in series.
    Maxwell,
    /// Spring and dashpot side by side (creep only).
    KelvinVoigt,
    /// One exponential and a constant.
    StandardLinearSolid,
    /// Maxwell and Kelvin–Voigt in series.
    Burgers,
    /// A few exponentials and a constant.
    Prony {
        /// How many, from 1 to [`MOST_TERMS`].
        terms: usize,
    },
    /// Many exponentials on a fixed grid of times, of one sign.
    Spectrum,
    /// Prony in Fung's parameters (relaxation only).
    Fung {
        /// How many, from 1 to [`MOST_TERMS`].
        terms: usize,
    },
    /// Fung's continuous spectrum (relaxation only).
    FungContinuous,
    /// Stretched exponential.
    Stretched,
    /// Power of time.
    Power,
    /// Logarithm of time.
    Logarithmic,
    /// Mittag-Leffler function.
    FractionalZener,
    /// One-dimensional diffusion.
    Diffusion,
}

/// Largest number of terms of a series with free times; a hold does not distinguish more.
pub const MOST_TERMS: usize = 5;

/// A text that names no law.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no law is called {found:?}; {}", nearest(found))]
#[non_exhaustive]
pub struct UnknownLaw {
    /// What was given.
    pub found: String,
}

/// The names of laws in a sentence, the most similar one first.
fn nearest(found: &str) -> String {
    // A number behind a colon belongs to any name.
    let plain = |name: &str| name.split(':').next().unwrap_or_default().to_lowercase();
    let mut names = Law::NAMES.to_vec();
    names.sort_by_key(|name| strsim::levenshtein(&plain(found), &plain(name)));
    format!("did you mean {}? Other laws are {}", names[0], names[1..].join(", "))
}

impl Law {
    /// Names as they are written; N, K stand for parameters.
    pub const NAMES: [&'static str; 15] = [
        "latency",
        "latency:N",
        "maxwell",
        "kelvin-voigt",
        "standard-linear-solid",
        "burgers",
        "prony:K",
        "spectrum",
        "fung:K",
        "fung-continuous",
        "stretched",
        "power",
        "logarithmic",
        "fractional-zener",
        "diffusion",
    ];

    /// The laws whose names hold no number.
    const PLAIN: [(Self, &str); 12] = [
        (Self::FREE_LATENCY, "latency"),
        (Self::Maxwell, "maxwell"),
        (Self::KelvinVoigt, "kelvin-voigt"),
        (Self::StandardLinearSolid, "standard-linear-solid"),
        (Self::Burgers, "burgers"),
        (Self::Spectrum, "spectrum"),
        (Self::FungContinuous, "fung-continuous"),
        (Self::Stretched, "stretched"),
        (Self::Power, "power"),
        (Self::Logarithmic, "logarithmic"),
        (Self::FractionalZener, "fractional-zener"),
        (Self::Diffusion, "diffusion"),
    ];

    const FREE_LATENCY: Self = Self::Latency {
        exponent: ExponentChoice::Free,
    };

    const LINEAR_LATENCY: Self = Self::Latency {
        exponent: ExponentChoice::Fixed(1.0),
    };

    /// What the law is, in words.
    #[must_use]
    pub fn description(self) -> Description {
        match self {
            Self::Latency { exponent } => latency::description(exponent),
            Self::Maxwell => maxwell::DESCRIPTION,
            Self::KelvinVoigt => kelvin_voigt::DESCRIPTION,
            Self::StandardLinearSolid => standard_linear_solid::DESCRIPTION,
            Self::Burgers => burgers::DESCRIPTION,
            Self::Prony { .. } => prony::DESCRIPTION,
            Self::Spectrum => spectrum::DESCRIPTION,
            Self::Fung { .. } => fung::DESCRIPTION,
            Self::FungContinuous => fung_continuous::DESCRIPTION,
            Self::Stretched => stretched::DESCRIPTION,
            Self::Power => power::DESCRIPTION,
            Self::Logarithmic => logarithmic::DESCRIPTION,
            Self::FractionalZener => fractional_zener::DESCRIPTION,
            Self::Diffusion => diffusion::DESCRIPTION,
        }
    }

    /// Whether the law can take the form of another, so that it must fit as well: a free exponent any exponent, more terms
    /// fewer, the spectrum everything that relaxes one way, and any shape with a parameter that makes it exponential the standard
    /// linear solid.
    ///
    /// ```
    /// use palpate::laws::{ExponentChoice, Law};
    /// let latency = |exponent| Law::Latency { exponent };
    /// assert!(latency(ExponentChoice::Free).contains(latency(ExponentChoice::Fixed(5.0))));
    /// assert!(Law::Prony { terms: 3 }.contains(Law::StandardLinearSolid));
    /// assert!(!Law::StandardLinearSolid.contains(Law::Stretched));
    /// ```
    #[must_use]
    pub fn contains(self, other: Self) -> bool {
        let terms = |law: Self| match law {
            Self::StandardLinearSolid => Some(1),
            Self::Prony { terms } | Self::Fung { terms } => Some(terms),
            _ => None,
        };
        let exponential = terms(other) == Some(1) || other == Self::LINEAR_LATENCY;
        self == other
            || match self {
                Self::Spectrum => true,
                Self::FREE_LATENCY => matches!(other, Self::Latency { .. } | Self::Power) || exponential,
                Self::Stretched | Self::FractionalZener | Self::FungContinuous => exponential,
                Self::Burgers => other == Self::KelvinVoigt,
                _ => terms(self).zip(terms(other)).is_some_and(|(own, its)| own >= its),
            }
    }

    /// Whether the law has a form for this response.
    #[must_use]
    pub fn describes(self, response: Response) -> bool {
        self == Self::Spectrum || self.form(response).is_some()
    }

    /// Columns of the law; `None` where it has no form for the response, and for the spectrum, which is fitted another way.
    pub(crate) fn form(self, response: Response) -> Option<Form> {
        use BasisFunction::{Exponential, Straight};
        use Response::{Creep, Relaxation};

        let (constant, shapes) = match (self, response) {
            (Self::Latency { exponent }, _) => (true, vec![exponent.shape()]),
            (Self::Maxwell, Relaxation) => (false, vec![Exponential]),
            (Self::Maxwell, Creep) => (true, vec![Straight]),
            (Self::KelvinVoigt, Creep) => (false, vec![Exponential]),
            (Self::StandardLinearSolid, _) => (true, vec![Exponential]),
            (Self::Burgers, Relaxation) => (false, vec![Exponential; 2]),
            (Self::Burgers, Creep) => (true, vec![Exponential, Straight]),
            (Self::Prony { terms }, _) | (Self::Fung { terms }, Relaxation) => (true, vec![Exponential; terms]),
            (Self::FungContinuous, Relaxation) => (true, vec![BasisFunction::FungContinuous]),
            (Self::Stretched, _) => (true, vec![BasisFunction::Stretched]),
            (Self::Power, Relaxation) => (false, vec![BasisFunction::PowerDecay]),
            (Self::Power, Creep) => (true, vec![BasisFunction::PowerGrowth]),
            (Self::Logarithmic, _) => (true, vec![BasisFunction::Logarithm]),
            (Self::FractionalZener, _) => (true, vec![BasisFunction::MittagLeffler]),
            (Self::Diffusion, _) => (true, vec![BasisFunction::Diffusion]),
            (Self::KelvinVoigt, Relaxation)
            | (Self::Fung { .. } | Self::FungContinuous, Creep)
            | (Self::Spectrum, _) => return None,
        };
        Some(Form {
            response,
            constant,
            shapes,
        })
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Latency {
                exponent: ExponentChoice::Fixed(n),
            } => write!(f, "latency:{n}"),
            Self::Prony { terms } => write!(f, "prony:{terms}"),
            Self::Fung { terms } => write!(f, "fung:{terms}"),
            _ => f.write_str(Self::PLAIN.iter().find(|(law, _)| law == self).map_or("", |(_, name)| name)),
        }
    }
}

impl FromStr for Law {
    type Err = UnknownLaw;

    /// Reads a name; `linear-latency` (n = 1), `peleg` (n = 2), `sls` and `kww` are understood too.
    fn from_str(text: &str) -> Result<Self, UnknownLaw> {
        let unknown = || UnknownLaw { found: text.to_owned() };
        let terms = |parameter: &str| match parameter.parse() {
            Ok(terms) if (1..=MOST_TERMS).contains(&terms) => Ok(terms),
            _ => Err(unknown()),
        };
        let exponent = |parameter: &str| match parameter.parse::<f64>() {
            Ok(n) if n.is_finite() && n > 0.0 => Ok(ExponentChoice::Fixed(n)),
            _ => Err(unknown()),
        };
        Ok(match text.split_once(':') {
            Some(("latency", n)) => Self::Latency { exponent: exponent(n)? },
            Some(("prony", k)) => Self::Prony { terms: terms(k)? },
            Some(("fung", k)) => Self::Fung { terms: terms(k)? },
            Some(_) => return Err(unknown()),
            None => match text {
                "linear-latency" => Self::LINEAR_LATENCY,
                "peleg" => Self::Latency {
                    exponent: ExponentChoice::Fixed(2.0),
                },
                "sls" => Self::StandardLinearSolid,
                "kww" => Self::Stretched,
                _ => Self::PLAIN.iter().find(|(_, name)| *name == text).ok_or_else(unknown)?.0,
            },
        })
    }
}

impl From<Law> for String {
    fn from(law: Law) -> Self {
        law.to_string()
    }
}

impl TryFrom<String> for Law {
    type Error = UnknownLaw;

    fn try_from(text: String) -> Result<Self, UnknownLaw> {
        text.parse()
    }
}
