//! The model at one point: columns, the best linear parameters and the residuals.

use std::cell::RefCell;

use crate::optimise::{BoundedProblem, BoundedSolver, Cholesky, Few, Held, Square, Target, Termination};
use crate::vector::{add_multiple, cross_products, dot, form_residuals, multiply, normal_equations};

/// The columns of a separable model and their derivatives.
pub(crate) trait Shapes {
    /// Number of linear columns.
    fn columns(&self) -> usize;
    /// The column that nonlinear number `index` shapes.
    fn column_of(&self, index: usize) -> usize;
    /// Bounds of nonlinear number `index`.
    fn bounds(&self, index: usize) -> (f64, f64);
    /// Width of the range that data can tell of for nonlinear number `index`: that of its bounds unless a caller has narrowed these.
    fn room(&self, index: usize) -> f64 {
        let (low, high) = self.bounds(index);
        high - low
    }
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

/// Points kept for the next search over the same samples: only the first allocates.
#[derive(Default)]
pub(crate) struct Spare(RefCell<Vec<Point>>);

/// State of the model at one θ.
pub(crate) struct Point {
    pub(crate) theta: Vec<f64>,
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) derivatives: Vec<Vec<f64>>,
    pub(crate) linear: Vec<f64>,
    pub(crate) residuals: Vec<f64>,
    /// Products of the columns with each other, row-major.
    pub(crate) gram: Vec<f64>,
    /// Linear numbers that lie at a bound.
    pub(crate) held: Vec<bool>,
    pub(crate) square: f64,
    pub(crate) singular: bool,
}

impl Point {
    /// A point to be evaluated, with whatever numbers in it.
    pub(crate) fn new(shapes: &impl Shapes, numbers: usize, samples: usize) -> Self {
        let kept = shapes.spare().and_then(|spare| spare.0.borrow_mut().pop());
        kept.unwrap_or_else(|| Self {
            theta: vec![0.0; numbers],
            columns: (0..shapes.columns()).map(|_| vec![0.0; samples]).collect(),
            derivatives: (0..numbers).map(|_| vec![0.0; samples]).collect(),
            linear: vec![0.0; shapes.columns()],
            residuals: vec![0.0; samples],
            gram: vec![0.0; shapes.columns() * shapes.columns()],
            held: vec![false; shapes.columns()],
            square: f64::INFINITY,
            singular: false,
        })
    }

    /// Gives the room back for another point.
    pub(crate) fn release(self, shapes: &impl Shapes) {
        if let Some(spare) = shapes.spare() {
            spare.0.borrow_mut().push(self);
        }
    }

    /// Columns and derivatives at `theta`, times the roots of the weights.
    pub(crate) fn fill(&mut self, shapes: &impl Shapes, theta: &[f64], target: Target<'_>) {
        self.theta.clear();
        self.theta.extend_from_slice(theta);
        shapes.fill(theta, &mut self.columns, &mut self.derivatives);
        if let Some(roots) = target.roots {
            for column in self.columns.iter_mut().chain(&mut self.derivatives) {
                multiply(column, roots);
            }
        }
    }

    /// Solves for the linear numbers at `theta` and forms the residuals.
    pub(crate) fn evaluate(&mut self, shapes: &impl Shapes, theta: &[f64], target: Target<'_>) {
        self.fill(shapes, theta, target);
        self.solve(shapes, target);
    }

    /// The same a step away, so short that the columns follow their tangents and the derivatives stay as they are.
    pub(crate) fn slide(&mut self, shapes: &impl Shapes, theta: &[f64], target: Target<'_>) {
        for (index, derivative) in self.derivatives.iter().enumerate() {
            let step = theta[index] - self.theta[index];
            add_multiple(&mut self.columns[shapes.column_of(index)], step, derivative);
        }
        self.theta.copy_from_slice(theta);
        self.solve(shapes, target);
    }

    /// A step along the tangent so short that columns and residuals stay as they are: the linear numbers follow it as the normal
    /// equations say.
    pub(crate) fn lean(&mut self, normal: &[f64], step: &[f64]) {
        let (l, size) = (self.columns.len(), self.columns.len() + step.len());
        let Some(factor) = Cholesky::new(&self.gram, l) else {
            return;
        };
        let across = |i: usize| -> f64 { step.iter().zip(&normal[i * size + l..]).map(|(by, entry)| by * entry).sum() };
        let mut change: Few = (0..l).map(across).collect();
        factor.solve(&mut change);
        self.linear.iter_mut().zip(change).for_each(|(value, by)| *value -= by);
        self.theta.iter_mut().zip(step).for_each(|(value, by)| *value += by);
    }

    /// Solves for the linear numbers and forms the residuals.
    fn solve(&mut self, shapes: &impl Shapes, target: Target<'_>) {
        let values = target.values;
        let size = self.columns.len();
        normal_equations(&self.columns, values, &mut self.gram, &mut self.linear);
        let factor = Cholesky::new(&self.gram, size);
        self.singular = factor.is_none();
        match factor {
            Some(factor) => {
                factor.solve(&mut self.linear);
                self.keep_bounds(shapes.linear_bounds(), values);
                self.form_residuals(values);
                // A round of refinement recovers what squaring the condition number lost.
                let worth = target.exact || self.square < 1e-12 * target.square;
                if worth && !self.held.contains(&true) {
                    let mut correction: Few = self.columns.iter().map(|c| dot(c, &self.residuals)).collect();
                    factor.solve(&mut correction);
                    for (value, change) in self.linear.iter_mut().zip(correction) {
                        *value += change;
                    }
                    self.form_residuals(values);
                }
            }
            None => {
                self.linear.fill(0.0);
                self.square = f64::INFINITY;
            }
        }
        if !self.square.is_finite() {
            self.square = f64::INFINITY;
        }
    }

    /// Where the free solution leaves its bounds, the best one inside them.
    fn keep_bounds(&mut self, bounds: &[(f64, f64)], values: &[f64]) {
        self.held.fill(false);
        let inside = |(value, (low, high)): (&f64, &(f64, f64))| low <= value && value <= high;
        if self.linear.iter().zip(bounds).all(inside) {
            return;
        }
        let right: Vec<f64> = self.columns.iter().map(|column| dot(column, values)).collect();
        let (lower, upper): (Vec<f64>, Vec<f64>) = bounds.iter().copied().unzip();
        let problem = BoundedProblem {
            gram: &self.gram,
            right: &right,
            lower: &lower,
            upper: &upper,
        };
        let mut solver = BoundedSolver::new(right.len());
        if solver.solve(&problem).is_some() {
            self.linear.copy_from_slice(&solver.solution);
            for (held, end) in self.held.iter_mut().zip(&solver.held) {
                *held = *end != Held::Free;
            }
        } else {
            self.singular = true;
        }
    }

    pub(crate) fn form_residuals(&mut self, values: &[f64]) {
        self.square = form_residuals(values, &self.columns, &self.linear, &mut self.residuals);
    }

    /// JᵀJ over linear, then nonlinear numbers, row-major, and Jᵀr by the nonlinear ones.
    pub(crate) fn normal(&self, shapes: &impl Shapes) -> (Square, Few) {
        let (l, p) = (self.columns.len(), self.theta.len());
        let size = l + p;
        let factor = |i: usize| self.linear[shapes.column_of(i)];
        let (mut among, mut gradient, mut across) = (zeros(p * p), Few::from_elem(0.0, p), zeros(p * l));
        normal_equations(&self.derivatives, &self.residuals, &mut among, &mut gradient);
        cross_products(&self.derivatives, &self.columns, &mut across);
        let mut normal = zeros(size * size);
        for i in 0..l {
            normal[i * size..i * size + l].copy_from_slice(&self.gram[i * l..(i + 1) * l]);
        }
        for i in 0..p {
            gradient[i] *= factor(i);
            for j in 0..l {
                let product = factor(i) * across[i * l + j];
                normal[(l + i) * size + j] = product;
                normal[j * size + l + i] = product;
            }
            for j in 0..p {
                normal[(l + i) * size + l + j] = factor(i) * factor(j) * among[i * p + j];
            }
        }
        (normal, gradient)
    }

    /// Jᵀr by the nonlinear numbers.
    pub(crate) fn gradient(&self, shapes: &impl Shapes) -> Few {
        let mut gradient = Few::from_elem(0.0, self.theta.len());
        for (p, (entry, derivative)) in gradient.iter_mut().zip(&self.derivatives).enumerate() {
            *entry = self.linear[shapes.column_of(p)] * dot(derivative, &self.residuals);
        }
        gradient
    }
}

fn zeros(count: usize) -> Square {
    Square::from_elem(0.0, count)
}
