//! Where a search ended: everything that estimates and errors are made of.

/// Where the search ended: everything that estimates and errors are made of.
use crate::optimise::{Few, Termination};
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    pub(crate) linear: Vec<f64>,
    pub(crate) nonlinear: Vec<f64>,
    pub(crate) residuals: Vec<f64>,
    pub(crate) residual_square: f64,
    /// Variance of the noise of a sample of weight one, s² = RSS/(N − p) in least squares.
    pub(crate) variance: f64,
    /// Columns and derivatives there, times the roots of the weights.
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) derivatives: Vec<Vec<f64>>,
    /// Sums of squares of the columns.
    pub(crate) column_squares: Few,
    /// (JᵀJ)⁻¹ over linear, then nonlinear numbers, row-major; `None` if singular.
    pub(crate) inverse_normal: Option<Vec<f64>>,
    pub(crate) termination: Termination,
}
