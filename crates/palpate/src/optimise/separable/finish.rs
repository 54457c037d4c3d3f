//! From the last point to a solution with its errors.

use smallvec::SmallVec;

use super::point::Point;
use super::step::block;
use crate::optimise::{Cholesky, Few, Shapes, Target, Termination};
use crate::vector::normal_equations;

/// Where the search ended: everything that estimates and errors are made of.
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

/// The solution at a point, with the `last` step still to be taken from there if there is one.
pub(crate) fn finish(
    mut here: Point,
    last: Option<&[f64]>,
    shapes: &impl Shapes,
    mut termination: Termination,
) -> Solution {
    let linear = here.columns.len();
    let size = linear + here.theta.len();
    let (normal, _) = here.normal(shapes);
    if let Some(step) = last {
        here.lean(&normal, step);
    }
    // A number at a bound has no errors, the others have theirs beside it.
    let free: SmallVec<[usize; 8]> = (0..size).filter(|&i| i >= linear || !here.held[i]).collect();
    let inverse_normal = Cholesky::new(&block(&normal, size, &free), free.len()).map(|factor| {
        let few = factor.inverse();
        let mut inverse = vec![0.0; size * size];
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free.iter().enumerate() {
                inverse[i * size + j] = few[a * free.len() + b];
            }
        }
        inverse
    });
    let variance = here.square / (here.residuals.len() as f64 - size as f64);
    if termination == Termination::Converged {
        // A number whose error exceeds all the room it has is not felt by the data.
        let is_felt = inverse_normal.as_ref().is_some_and(|inverse| {
            let error = |i: usize| (inverse[(linear + i) * (size + 1)] * variance).sqrt();
            (0..here.theta.len()).all(|i| error(i) <= shapes.room(i))
        });
        let at_bound = |(i, value): (usize, &f64)| {
            let (low, high) = shapes.bounds(i);
            let near = 1e-9 * (high - low);
            *value <= low + near || *value >= high - near
        };
        match here.theta.iter().enumerate().position(at_bound) {
            Some(index) => termination = shapes.at_bound(index),
            None if here.singular || !is_felt => termination = Termination::Singular,
            None if here.held.contains(&true) => termination = Termination::AmplitudeAtBound,
            None => {}
        }
    }
    Solution {
        column_squares: (0..linear).map(|i| here.gram[i * (linear + 1)]).collect(),
        linear: here.linear,
        nonlinear: here.theta,
        residual_square: here.square,
        variance,
        residuals: here.residuals,
        columns: here.columns,
        derivatives: here.derivatives,
        inverse_normal,
        termination,
    }
}

/// A solution found elsewhere, as it stands among these samples: residuals, columns and normal equations anew.
pub(crate) fn standing(
    shapes: &impl Shapes,
    target: Target<'_>,
    theta: &[f64],
    linear: &[f64],
    termination: Termination,
) -> Solution {
    let mut here = Point::new(shapes, theta.len(), target.values.len());
    here.fill(shapes, theta, target);
    normal_equations(&here.columns, target.values, &mut here.gram, &mut here.linear);
    here.linear.copy_from_slice(linear);
    for ((held, value), (low, high)) in here.held.iter_mut().zip(linear).zip(shapes.linear_bounds()) {
        *held = value <= low || value >= high;
    }
    here.form_residuals(target.values);
    finish(here, None, shapes, termination)
}
