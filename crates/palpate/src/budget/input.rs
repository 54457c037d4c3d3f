//! An input quantity of a measurement.

use serde::{Deserialize, Serialize};

use crate::random::Rng;

/// How an uncertainty was evaluated (JCGM 100, 3.3.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Evaluation {
    /// By the statistics of observations.
    A,
    /// By other means: a calibration certificate, a data sheet, experience.
    B,
}

/// Distribution of the values that an input quantity may have (JCGM 101, 6.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Normal; Student's t where the degrees of freedom are finite.
    #[default]
    Normal,
    /// The same everywhere between two limits: what a data sheet states as ±a.
    Rectangular,
    /// Falling in straight lines from the estimate to two limits.
    Triangular,
    /// Arcsine (U-shaped) between two limits: what cycles, as a room temperature does.
    Arcsine,
}

impl Distribution {
    /// Half the width of the limits over the standard uncertainty; `None` for a distribution without limits.
    fn half_width(self) -> Option<f64> {
        match self {
            Self::Normal => None,
            Self::Rectangular => Some(3f64.sqrt()),
            Self::Triangular => Some(6f64.sqrt()),
            Self::Arcsine => Some(2f64.sqrt()),
        }
    }
}

/// Which records have the error of an input quantity in common, where several are evaluated together.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// Those that state the same of it, to the last digit.
    #[default]
    AsStated,
    /// None: each record has its own error.
    EachRecord,
    /// Those that name this cause of the quantity, whatever its size in each.
    Named(String),
}

/// An input quantity X of a measurement: its estimate x and the uncertainty of x.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InputQuantity {
    /// What it is.
    pub name: String,
    /// Its unit, `1` of a dimensionless quantity.
    pub unit: String,
    /// x.
    pub estimate: f64,
    /// u(x), in the same unit.
    pub standard_uncertainty: f64,
    /// Degrees of freedom ν of u(x); infinite where u(x) is known.
    #[serde(with = "endless")]
    pub freedom: f64,
    /// The distribution of the values.
    pub distribution: Distribution,
    /// How u(x) was evaluated.
    pub evaluation: Evaluation,
    /// Which records have the error in common.
    #[serde(default)]
    pub cause: Cause,
}

/// A statement of uncertainty that is none.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
    /// A half width, or a standard or an expanded uncertainty, below zero or not finite.
    #[error("an uncertainty must be a finite number of 0 or more, found {found}")]
    Negative {
        /// What was given.
        found: f64,
    },
    /// Fewer than one degree of freedom.
    #[error("degrees of freedom must be 1 or more, found {found}")]
    Freedom {
        /// What was given.
        found: f64,
    },
    /// Limits of a distribution that has none.
    #[error("a normal distribution has no limits: state its standard uncertainty, or another distribution")]
    NoLimits,
}

impl InputQuantity {
    /// A quantity with a standard uncertainty, evaluated as Type B, normal.
    ///
    /// # Errors
    /// [`InputError::Negative`].
    pub fn standard(
        name: impl Into<String>,
        unit: impl Into<String>,
        estimate: f64,
        standard_uncertainty: f64,
    ) -> Result<Self, InputError> {
        if !(standard_uncertainty.is_finite() && standard_uncertainty >= 0.0) {
            return Err(InputError::Negative {
                found: standard_uncertainty,
            });
        }
        Ok(Self {
            name: name.into(),
            unit: unit.into(),
            estimate,
            standard_uncertainty,
            freedom: f64::INFINITY,
            distribution: Distribution::Normal,
            evaluation: Evaluation::B,
            cause: Cause::AsStated,
        })
    }

    /// A quantity between limits ±`half_width` about its estimate: u = a/√3 of a rectangular, a/√6 of a triangular, a/√2 of an arcsine
    /// distribution (JCGM 100, 4.3.7 and 4.3.9; JCGM 101, 6.4.6).
    ///
    /// ```
    /// use palpate::budget::{Distribution, InputQuantity};
    /// let load_cell = InputQuantity::limits("load cell", "N", 0.0, 0.2, Distribution::Rectangular)?;
    /// assert!((load_cell.standard_uncertainty - 0.115_470_05).abs() < 1e-8);
    /// # Ok::<(), palpate::budget::InputError>(())
    /// ```
    ///
    /// # Errors
    /// [`InputError::Negative`], and [`InputError::NoLimits`] for a normal distribution.
    pub fn limits(
        name: impl Into<String>,
        unit: impl Into<String>,
        estimate: f64,
        half_width: f64,
        distribution: Distribution,
    ) -> Result<Self, InputError> {
        let factor = distribution.half_width().ok_or(InputError::NoLimits)?;
        Ok(Self {
            distribution,
            ..Self::standard(name, unit, estimate, half_width / factor)?
        })
    }

    /// The same with degrees of freedom.
    ///
    /// # Errors
    /// [`InputError::Freedom`] for fewer than one.
    pub fn with_freedom(self, freedom: f64) -> Result<Self, InputError> {
        if freedom >= 1.0 {
            Ok(Self { freedom, ..self })
        } else {
            Err(InputError::Freedom { found: freedom })
        }
    }

    /// The same, evaluated by statistics of observations.
    #[must_use]
    pub fn type_a(self) -> Self {
        Self {
            evaluation: Evaluation::A,
            ..self
        }
    }

    /// The same with a statement of which records have its error in common.
    #[must_use]
    pub fn with_cause(self, cause: Cause) -> Self {
        Self { cause, ..self }
    }

    /// Whether the errors of this input and of that of another record are one, as that of one load cell is.
    ///
    /// ```
    /// use palpate::budget::{Cause, InputQuantity};
    /// let gain = |share| InputQuantity::standard("gain of the force", "1", 0.0, share);
    /// assert!(gain(0.02)?.has_cause_of(&gain(0.02)?) && !gain(0.02)?.has_cause_of(&gain(0.0201)?));
    /// let of_cell = |share, cell: &str| gain(share).map(|gain| gain.with_cause(Cause::Named(cell.to_owned())));
    /// assert!(of_cell(0.02, "cell 1")?.has_cause_of(&of_cell(0.0201, "cell 1")?));
    /// assert!(!of_cell(0.02, "cell 1")?.has_cause_of(&of_cell(0.02, "cell 2")?));
    /// # Ok::<(), palpate::budget::InputError>(())
    /// ```
    #[must_use]
    pub fn has_cause_of(&self, other: &Self) -> bool {
        match (&self.cause, &other.cause) {
            (Cause::AsStated, Cause::AsStated) => self == other,
            (Cause::Named(one), Cause::Named(another)) => one == another && self.name == other.name,
            _ => false,
        }
    }

    /// A value at random: x + u t with t of the distribution.
    pub(super) fn draw(&self, random: &mut Rng) -> f64 {
        let t = match self.distribution {
            Distribution::Normal if self.freedom.is_finite() => random.student(self.freedom),
            Distribution::Normal => random.normal(),
            Distribution::Rectangular => 3f64.sqrt() * (2.0 * random.uniform() - 1.0),
            Distribution::Triangular => 6f64.sqrt() * (random.uniform() - random.uniform()),
            Distribution::Arcsine => 2f64.sqrt() * (std::f64::consts::TAU * random.uniform()).sin(),
        };
        self.estimate + self.standard_uncertainty * t
    }
}

/// An endless number of degrees of freedom in JSON, which has no word for infinity: `null`.
mod endless {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
    pub(super) fn serialize<S: Serializer>(freedom: &f64, to: S) -> Result<S::Ok, S::Error> {
        Some(*freedom).filter(|freedom| freedom.is_finite()).serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::INFINITY))
    }
}
