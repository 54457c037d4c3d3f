//! What a shape must be able to do.

/// What a nonlinear number of a shape is, and between which bounds it is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum NumberKind {
    /// ln λ, reported as a rate λ in 1/s. Sought from the slowest to the fastest that a hold can show.
    Rate,
    /// ln λ, reported as a time τ = 1/λ in s.
    Time,
    /// A pure number between two bounds, with the values that a coarse search tries.
    Pure {
        low: f64,
        high: f64,
        coarse: &'static [f64],
    },
    /// ln λ of a rate that only sets the unit of the amplitude: one over the duration of the fit, never sought.
    Reference,
}

/// A nonlinear number of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ShapeNumber {
    /// Name in results, without unit: `relative_rate`, `time`, `exponent`.
    pub(crate) name: &'static str,
    /// Kind and range.
    pub(crate) kind: NumberKind,
}

impl ShapeNumber {
    pub(in crate::laws) const fn new(name: &'static str, kind: NumberKind) -> Self {
        Self { name, kind }
    }

    /// A pure number.
    pub(in crate::laws) const fn pure(name: &'static str, low: f64, high: f64, coarse: &'static [f64]) -> Self {
        Self::new(name, NumberKind::Pure { low, high, coarse })
    }
}

/// The time of a shape.
pub(in crate::laws) const TIME: ShapeNumber = ShapeNumber::new("time", NumberKind::Time);

/// What sets the unit of a shape that grows.
pub(in crate::laws) const REFERENCE: ShapeNumber = ShapeNumber::new("reference", NumberKind::Reference);

/// The derivatives of a shape of two numbers.
pub(in crate::laws) fn two(derivatives: &mut [Vec<f64>]) -> [&mut Vec<f64>; 2] {
    match derivatives {
        [first, second] => [first, second],
        _ => unreachable!("two numbers"),
    }
}

/// One shape: a function of time and of one or two numbers θ.
///
/// Rates enter as ln λ, so that a change of the unit of time adds a constant to them and no more.
pub(crate) trait Kernel {
    /// The numbers θ of the shape, a rate first.
    fn numbers(&self) -> &'static [ShapeNumber];

    /// Whether the shape falls from 1 to 0 (and creeps as 1 − shape) rather than growing from 0 without end.
    fn decays(&self) -> bool {
        true
    }

    /// The shape at every time ≥ 0.
    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]);

    /// The shape and its derivatives by every number.
    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]);
}
