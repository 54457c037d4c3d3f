//! The list of laws and their names.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::continuous::{diffusion, fractional_zener, fung_continuous, latency, logarithmic, power, stretched};
use super::discrete::{burgers, fung, kelvin_voigt, maxwell, prony, spectrum, standard_linear_solid};
use super::{BasisFunction, Description, ExponentChoice, Form, LawDefinition, Response};

/// Declares [`Law`] from the laws whose names hold no number: a line each, with the variant and the definition in the file of the law.
macro_rules! laws {
    ($($(#[$about:meta])* $variant:ident = $definition:path;)*) => {
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
            /// The paper's law, n given or estimated.
            Latency {
                /// Whether n is given.
                exponent: ExponentChoice,
            },
            /// A few exponentials and a constant.
            Prony {
                /// How many, from 1 to [`MOST_TERMS`].
                terms: usize,
            },
            /// Prony in Fung's parameters (relaxation only).
            Fung {
                /// How many, from 1 to [`MOST_TERMS`].
                terms: usize,
            },
            $($(#[$about])* $variant,)*
            /// A law that another crate defines. It is written by its name, and cannot be read from there.
            Custom(&'static LawDefinition),
        }

        /// The laws whose names hold no number.
        const PLAIN: &[(Law, &LawDefinition)] = &[$((Law::$variant, &$definition)),*];
    };
}

laws! {
    /// Spring and dashpot in series.
    Maxwell = maxwell::LAW;
    /// Spring and dashpot side by side (creep only).
    KelvinVoigt = kelvin_voigt::LAW;
    /// One exponential and a constant.
    StandardLinearSolid = standard_linear_solid::LAW;
    /// Maxwell and Kelvin–Voigt in series.
    Burgers = burgers::LAW;
    /// Many exponentials on a fixed grid of times, of one sign.
    Spectrum = spectrum::LAW;
    /// Fung's continuous spectrum (relaxation only).
    FungContinuous = fung_continuous::LAW;
    /// Stretched exponential.
    Stretched = stretched::LAW;
    /// Power of time.
    Power = power::LAW;
    /// Logarithm of time.
    Logarithmic = logarithmic::LAW;
    /// Mittag-Leffler function.
    FractionalZener = fractional_zener::LAW;
    /// One-dimensional diffusion.
    Diffusion = diffusion::LAW;
}

/// Names with a number, and the free latency law.
const NUMBERED: [&str; 4] = ["latency", "latency:N", "prony:K", "fung:K"];

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
    /// Names as they are written; N, K stand for numbers.
    pub const NAMES: [&'static str; NUMBERED.len() + PLAIN.len()] = {
        let mut names = [""; NUMBERED.len() + PLAIN.len()];
        let mut index = 0;
        while index < names.len() {
            names[index] = if index < NUMBERED.len() { NUMBERED[index] } else { PLAIN[index - NUMBERED.len()].1.name };
            index += 1;
        }
        names
    };

    const FREE_LATENCY: Self = Self::Latency {
        exponent: ExponentChoice::Free,
    };

    const LINEAR_LATENCY: Self = Self::Latency {
        exponent: ExponentChoice::Fixed(1.0),
    };

    /// The definition of a law whose name holds no number.
    fn definition(self) -> Option<&'static LawDefinition> {
        match self {
            Self::Custom(definition) => Some(definition),
            law => PLAIN.iter().find(|(plain, _)| *plain == law).map(|(_, definition)| *definition),
        }
    }

    /// What the law is, in words.
    #[must_use]
    pub fn description(self) -> Description {
        match self {
            Self::Latency { exponent } => latency::description(exponent),
            Self::Fung { .. } => fung::DESCRIPTION,
            law => law.definition().map_or(prony::DESCRIPTION, |definition| definition.description),
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
                Self::Burgers => other == Self::KelvinVoigt,
                _ if self.definition().is_some_and(|definition| definition.contains_exponential) => exponential,
                _ => terms(self).zip(terms(other)).is_some_and(|(own, its)| own >= its),
            }
    }

    /// Whether the law is a sum of exponentials, of which the slowest is the last that it knows.
    pub(crate) fn is_series(self) -> bool {
        matches!(self, Self::StandardLinearSolid | Self::Prony { .. })
    }

    /// Whether the law has a form for this response.
    #[must_use]
    pub fn describes(self, response: Response) -> bool {
        self == Self::Spectrum || self.form(response).is_some()
    }

    /// Columns of the law; `None` where it has no form for the response, and for the spectrum, which is fitted another way.
    pub(crate) fn form(self, response: Response) -> Option<Form> {
        let (constant, shapes) = match (self, response) {
            (Self::Latency { exponent }, _) => (true, vec![exponent.shape()]),
            (Self::Prony { terms }, _) | (Self::Fung { terms }, Response::Relaxation) => {
                (true, vec![BasisFunction::Exponential; terms])
            }
            _ => {
                let definition = self.definition()?;
                let composition = match response {
                    Response::Relaxation => definition.relaxation?,
                    Response::Creep => definition.creep?,
                };
                (composition.constant, composition.basis.to_vec())
            }
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
            Self::Latency {
                exponent: ExponentChoice::Free,
            } => f.write_str("latency"),
            law => f.write_str(law.definition().map_or("", |definition| definition.name)),
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
                "latency" => Self::FREE_LATENCY,
                _ => PLAIN.iter().find(|(_, definition)| definition.name == text).ok_or_else(unknown)?.0,
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
