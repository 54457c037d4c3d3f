//! What is fitted, and how a local search ends.

use crate::vector::dot;

/// What is fitted: values, and the square roots of their weights if they differ.
#[derive(Clone, Copy)]
pub(crate) struct Target<'a> {
    /// Values, times `roots`.
    pub(crate) values: &'a [f64],
    /// The roots of their weights.
    pub(crate) roots: Option<&'a [f64]>,
    /// Sum of the squared values.
    pub(crate) square: f64,
    /// Whether the linear numbers are worth a second solution, for the digits that normal equations lose.
    pub(super) exact: bool,
}

impl<'a> Target<'a> {
    /// Samples: up to so many the last digit costs nothing, and with more noise would drown it.
    pub(crate) fn new(values: &'a [f64], roots: Option<&'a [f64]>) -> Self {
        const FEW: usize = 256;
        Self {
            values,
            roots,
            square: dot(values, values),
            exact: values.len() <= FEW,
        }
    }

    /// Nodes, on which nothing is decided to the last digit.
    pub(crate) fn nodes(values: &'a [f64], roots: &'a [f64]) -> Self {
        Self {
            exact: false,
            ..Self::new(values, Some(roots))
        }
    }

    /// Residual square below which everything is rounding.
    pub(super) fn floor(&self) -> f64 {
        self.square * 1e-31
    }
}

/// How a local search ends.
#[derive(Clone, Copy)]
pub(crate) struct Ending {
    /// Relative fall of the residual square below which a step counts as none.
    pub(crate) gain: f64,
    /// Steps after which it ends short.
    pub(crate) most_iterations: usize,
}

impl Ending {
    pub(crate) const fn new(gain: f64, most_iterations: usize) -> Self {
        Self { gain, most_iterations }
    }

    /// As far as double precision goes.
    pub(crate) fn tight(most_iterations: usize) -> Self {
        Self::new(1e-14, most_iterations)
    }
}
