//! Separable least squares: y ≈ Σ_l a_l c_l(θ), linear in a, nonlinear in the few numbers θ.
//!
//! Variable projection after Golub and Pereyra in Kaufman's form: at every θ the best a is solved for, and the
//! Gauss–Newton step in θ is taken with the part of the Jacobian that no change of a can imitate. Steps are damped
//! (Levenberg–Marquardt) and kept inside bounds. The residual is always formed explicitly, so that a noise-free
//! signal is fitted to rounding.
//!
//! | file | what |
//! |---|---|
//! | `point.rs` | the model at one θ: columns, best linear numbers, residuals |
//! | `step.rs` | the Gauss–Newton step |
//! | `refine.rs` | damped steps from anywhere |
//! | `newton.rs` | undamped steps close to the optimum |
//! | `finish.rs` | from the last point to a solution with its errors |

mod finish;
mod newton;
mod point;
mod refine;
mod step;

use serde::{Deserialize, Serialize};

pub(super) use finish::standing;
pub(super) use newton::{Near, curvature, descend, polished};
pub(super) use point::Spare;
pub(super) use refine::{Refined, refine};
pub(super) use step::{distance, stepped};

use super::linear_algebra::Few;
use crate::vector::products::dot;

/// The columns of a separable model and their derivatives.
pub(super) trait Shapes {
    /// Number of linear columns.
    fn columns(&self) -> usize;
    /// The column that nonlinear number `index` shapes.
    fn column_of(&self, index: usize) -> usize;
    /// Bounds of nonlinear number `index`.
    fn bounds(&self, index: usize) -> (f64, f64);
    /// What it means when nonlinear number `index` ends at a bound.
    fn at_bound(&self, index: usize) -> Termination;
    /// Bounds of the linear numbers; none at all if empty.
    fn linear_bounds(&self) -> &[(f64, f64)] {
        &[]
    }
    /// Fills the columns at `theta` and the derivative of column `column_of(p)` by each number p.
    fn fill(&self, theta: &[f64], columns: &mut [Vec<f64>], derivatives: &mut [Vec<f64>]);
    /// Where points are kept between searches over the same samples, if they are.
    fn spare(&self) -> Option<&Spare> {
        None
    }
}

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Termination {
    /// No step makes the residual smaller: the optimum was found.
    Converged,
    /// The optimum lies at the edge of the range of the relative rate: the data do not say how fast, or from where, it relaxes.
    RateAtBound,
    /// The optimum lies at the edge of the range of the exponent.
    ExponentAtBound,
    /// The optimum lies at the edge of the range of the equilibrium strain (rate domain).
    EquilibriumAtBound,
    /// An amplitude or the constant lies at a bound that was asked for; the others are the best beside it.
    AmplitudeAtBound,
    /// Two terms of a series came together: their times cannot be told apart, so fewer terms say as much.
    TermsMerged,
    /// Two numbers cannot be told apart by these data.
    Singular,
    /// The allowed number of steps was used up.
    IterationLimit,
}

impl Termination {
    /// Whether the estimates and their errors may be used as they are.
    #[must_use]
    pub fn is_good(self) -> bool {
        self == Self::Converged
    }
}

/// What a fit cost, in counts that do not depend on the machine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Points of the coarse search.
    pub grid_points: u64,
    /// Starts refined.
    pub starts: u64,
    /// Evaluations of the columns over the condensed samples.
    pub condensed: u64,
    /// Evaluations of the columns over all samples.
    pub evaluations: u64,
    /// Accepted steps.
    pub iterations: u64,
}

/// Where the search ended: everything that estimates and errors are made of.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    pub(super) linear: Vec<f64>,
    pub(super) nonlinear: Vec<f64>,
    pub(super) residuals: Vec<f64>,
    pub(super) residual_square: f64,
    /// Variance of the noise of a sample of weight one, s² = RSS/(N − p) in least squares.
    pub(super) variance: f64,
    /// Columns and derivatives there, times the roots of the weights.
    pub(super) columns: Vec<Vec<f64>>,
    pub(super) derivatives: Vec<Vec<f64>>,
    /// Sums of squares of the columns.
    pub(super) column_squares: Few,
    /// (JᵀJ)⁻¹ over linear, then nonlinear numbers, row-major; `None` if singular.
    pub(super) inverse_normal: Option<Vec<f64>>,
    pub(super) termination: Termination,
}

/// What is fitted: values, and the square roots of their weights if they differ.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    /// Values, times `roots`.
    values: &'a [f64],
    roots: Option<&'a [f64]>,
    /// Sum of the squared values.
    square: f64,
    /// Whether the linear numbers are worth a second solution, for the digits that normal equations lose.
    exact: bool,
}

impl<'a> Target<'a> {
    /// Samples: up to so many the last digit costs nothing, and with more noise would drown it.
    pub(super) fn new(values: &'a [f64], roots: Option<&'a [f64]>) -> Self {
        const FEW: usize = 256;
        Self {
            values,
            roots,
            square: dot(values, values),
            exact: values.len() <= FEW,
        }
    }

    /// Nodes, on which nothing is decided to the last digit.
    pub(super) fn nodes(values: &'a [f64], roots: &'a [f64]) -> Self {
        Self {
            exact: false,
            ..Self::new(values, Some(roots))
        }
    }

    /// Values, times the roots of their weights.
    pub(super) fn values(&self) -> &'a [f64] {
        self.values
    }

    /// Sum of their squares.
    pub(super) fn square(&self) -> f64 {
        self.square
    }

    /// Square roots of the weights; `None` if all are one.
    pub(super) fn roots(&self) -> Option<&'a [f64]> {
        self.roots
    }

    /// Residual square below which everything is rounding.
    fn floor(&self) -> f64 {
        self.square * 1e-31
    }
}

/// How a local search ends.
#[derive(Clone, Copy)]
pub(super) struct Ending {
    /// Relative fall of the residual square below which a step counts as none.
    pub(super) gain: f64,
    /// Steps after which it ends short.
    pub(super) most_iterations: usize,
}

impl Ending {
    /// As far as double precision goes.
    pub(super) fn tight(most_iterations: usize) -> Self {
        Self {
            gain: 1e-14,
            most_iterations,
        }
    }
}
