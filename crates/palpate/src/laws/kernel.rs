//! What a shape must be able to do.

use std::fmt;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// What a nonlinear parameter of a shape is, and between which bounds it is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShapeParameterKind {
    /// ln λ, reported as a rate λ in 1/s. Sought from the slowest to the fastest that a hold can show.
    Rate,
    /// ln λ, reported as a time τ = 1/λ in s.
    Time,
    /// A dimensionless parameter between two bounds, with the values that a coarse search tries.
    Pure {
        /// Lowest value.
        low: f64,
        /// Highest value.
        high: f64,
        /// Values of the coarse search.
        coarse: &'static [f64],
    },
    /// ln λ of a rate that only sets the unit of the amplitude: one over the duration of the fit, never sought.
    Reference,
}

/// A nonlinear parameter of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeParameter {
    /// Name in results, with its unit: `relative_rate_per_s`, `time_constant_s`, `exponent`.
    pub name: &'static str,
    /// Kind and range.
    pub kind: ShapeParameterKind,
}

impl ShapeParameter {
    /// A parameter of this name and kind.
    #[must_use]
    pub const fn new(name: &'static str, kind: ShapeParameterKind) -> Self {
        Self { name, kind }
    }

    /// A dimensionless parameter between two bounds, with the values that a coarse search tries.
    #[must_use]
    pub const fn pure(name: &'static str, low: f64, high: f64, coarse: &'static [f64]) -> Self {
        Self::new(name, ShapeParameterKind::Pure { low, high, coarse })
    }
}

/// The unit at the end of a name.
fn unit_of_name(name: &str) -> &'static str {
    ["_per_s", "_s"].into_iter().find(|unit| name.ends_with(unit)).unwrap_or("")
}

/// The name of a parameter of one term of several: the number of the term stands before the unit, as in `time_constant_2_s`.
pub(crate) fn name_of_term(name: &str, term: usize) -> String {
    let unit = unit_of_name(name);
    format!("{}_{term}{unit}", &name[..name.len() - unit.len()])
}

/// The term that a name written by [`name_of_term`] belongs to.
pub(crate) fn term_of_name(name: &str, written: &str) -> Option<usize> {
    let unit = unit_of_name(name);
    let stem = &name[..name.len() - unit.len()];
    written.strip_prefix(stem)?.strip_prefix('_')?.strip_suffix(unit)?.parse().ok()
}

/// The time of a shape.
pub(in crate::laws) const TIME: ShapeParameter = ShapeParameter::new("time_constant_s", ShapeParameterKind::Time);

/// What sets the unit of a shape that grows.
pub(in crate::laws) const REFERENCE: ShapeParameter = ShapeParameter::new("reference", ShapeParameterKind::Reference);

/// The derivatives of a shape of two numbers.
pub(in crate::laws) fn two(derivatives: &mut [Vec<f64>]) -> [&mut Vec<f64>; 2] {
    match derivatives {
        [first, second] => [first, second],
        _ => unreachable!("two numbers"),
    }
}

/// A basis function: a function of time t ≥ 0 and of one or two parameters θ.
///
/// Rates enter as ln λ, so that a change of the unit of time adds a constant to them and no more. A fit needs no starting values: it
/// searches rates between the slowest and the fastest that the hold can show, and dimensionless parameters on their coarse values.
pub trait Kernel: Sync {
    /// The parameters θ of the function, a rate first.
    fn parameters(&self) -> &'static [ShapeParameter];

    /// Whether the shape falls from 1 to 0 (and creeps as 1 − shape) rather than growing from 0 without end.
    fn decays(&self) -> bool {
        true
    }

    /// The shape at every time ≥ 0.
    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]);

    /// The shape and its derivatives by every parameter.
    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]);

    /// The function with its parameters put in, as people write it; without one the name of the function stands in formulas.
    fn formula(&self, theta: &[f64]) -> Option<String> {
        let _ = theta;
        None
    }
}

/// A basis function that another crate defines.
///
/// It is written to JSON by its name and cannot be read from there.
#[derive(Clone, Copy)]
pub struct CustomKernel {
    /// Its name; two functions of one name are one function.
    pub name: &'static str,
    /// The function with its derivatives.
    pub kernel: &'static dyn Kernel,
}

impl PartialEq for CustomKernel {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for CustomKernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl Serialize for CustomKernel {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.name)
    }
}

impl<'de> Deserialize<'de> for CustomKernel {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let name = String::deserialize(from)?;
        Err(D::Error::custom(format!("the basis function {name} is defined outside palpate and cannot be read")))
    }
}
