//! Separable least squares: y ≈ Σ_l a_l c_l(θ), linear in a, nonlinear in the few numbers θ.
//!
//! Variable projection after Golub and Pereyra in Kaufman's form: at every θ the best a is solved for, and the
//! Gauss–Newton step in θ is taken with the part of the Jacobian that no change of a can imitate. Steps are damped
//! (Levenberg–Marquardt) and kept inside bounds. The residual is always formed explicitly, so that a noise-free
//! signal is fitted to rounding.

use serde::{Deserialize, Serialize};

use super::bounded::{BoundedProblem, BoundedSolver, Held};
use super::linear_algebra::Cholesky;
use crate::vector::products::{cross_products, dot, form_residuals, normal_equations};

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
    /// (JᵀJ)⁻¹ over linear, then nonlinear numbers, row-major; `None` if singular.
    pub(super) inverse_normal: Option<Vec<f64>>,
    pub(super) termination: Termination,
}

/// What is fitted: values, and the square roots of their weights if they differ.
#[derive(Clone, Copy)]
pub(super) struct Target<'a> {
    /// Values, times `roots`.
    pub(super) values: &'a [f64],
    pub(super) roots: Option<&'a [f64]>,
}

/// State of the model at one θ.
struct Point {
    theta: Vec<f64>,
    columns: Vec<Vec<f64>>,
    derivatives: Vec<Vec<f64>>,
    linear: Vec<f64>,
    residuals: Vec<f64>,
    /// Products of the columns with each other, row-major.
    gram: Vec<f64>,
    /// Linear numbers that lie at a bound.
    held: Vec<bool>,
    square: f64,
    singular: bool,
}

impl Point {
    fn new(shapes: &impl Shapes, numbers: usize, samples: usize) -> Self {
        Self {
            theta: vec![0.0; numbers],
            columns: vec![vec![0.0; samples]; shapes.columns()],
            derivatives: vec![vec![0.0; samples]; numbers],
            linear: vec![0.0; shapes.columns()],
            residuals: vec![0.0; samples],
            gram: vec![0.0; shapes.columns() * shapes.columns()],
            held: vec![false; shapes.columns()],
            square: f64::INFINITY,
            singular: false,
        }
    }

    /// Columns and derivatives at `theta`, times the roots of the weights.
    fn fill(&mut self, shapes: &impl Shapes, theta: &[f64], target: Target<'_>) {
        self.theta.copy_from_slice(theta);
        shapes.fill(theta, &mut self.columns, &mut self.derivatives);
        if let Some(roots) = target.roots {
            for column in self.columns.iter_mut().chain(&mut self.derivatives) {
                for (entry, root) in column.iter_mut().zip(roots) {
                    *entry *= root;
                }
            }
        }
    }

    /// Solves for the linear numbers at `theta` and forms the residuals.
    fn evaluate(&mut self, shapes: &impl Shapes, theta: &[f64], target: Target<'_>) {
        let values = target.values;
        self.fill(shapes, theta, target);
        let size = self.columns.len();
        normal_equations(&self.columns, values, &mut self.gram, &mut self.linear);
        let factor = Cholesky::new(&self.gram, size);
        self.singular = factor.is_none();
        match factor {
            Some(factor) => {
                factor.solve(&mut self.linear);
                self.keep_bounds(shapes.linear_bounds(), values);
                self.form_residuals(values);
                // A round of refinement recovers what squaring the condition number lost. With many samples noise
                // would drown it, unless next to nothing is left over.
                let worth = values.len() <= FEW || self.square < 1e-12 * dot(values, values);
                if worth && !self.held.contains(&true) {
                    let mut correction: Vec<f64> = self.columns.iter().map(|c| dot(c, &self.residuals)).collect();
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
            self.linear.copy_from_slice(solver.solution());
            for (held, end) in self.held.iter_mut().zip(solver.held()) {
                *held = *end != Held::Free;
            }
        } else {
            self.singular = true;
        }
    }

    fn form_residuals(&mut self, values: &[f64]) {
        self.square = form_residuals(values, &self.columns, &self.linear, &mut self.residuals);
    }

    /// JᵀJ over linear, then nonlinear numbers, row-major, and Jᵀr by the nonlinear ones.
    fn normal(&self, shapes: &impl Shapes) -> (Vec<f64>, Vec<f64>) {
        let (l, p) = (self.columns.len(), self.theta.len());
        let size = l + p;
        let factor = |i: usize| self.linear[shapes.column_of(i)];
        let (mut among, mut gradient, mut across) = (vec![0.0; p * p], vec![0.0; p], vec![0.0; p * l]);
        normal_equations(&self.derivatives, &self.residuals, &mut among, &mut gradient);
        cross_products(&self.derivatives, &self.columns, &mut across);
        let mut normal = vec![0.0; size * size];
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
    fn gradient(&self, shapes: &impl Shapes) -> Vec<f64> {
        let part =
            |(p, derivative): (usize, &Vec<f64>)| self.linear[shapes.column_of(p)] * dot(derivative, &self.residuals);
        self.derivatives.iter().enumerate().map(part).collect()
    }
}

/// Up to so many samples the last digit costs nothing.
const FEW: usize = 256;

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

/// Where a refinement ended.
pub(super) struct Refined {
    point: Point,
    /// Room for another point, kept for polishing.
    spare: Point,
    termination: Termination,
}

impl Refined {
    /// Sum of squared residuals there.
    pub(super) fn square(&self) -> f64 {
        self.point.square
    }

    /// The nonlinear numbers there.
    pub(super) fn theta(&self) -> &[f64] {
        &self.point.theta
    }

    /// The linear numbers there.
    pub(super) fn linear(&self) -> &[f64] {
        &self.point.linear
    }
}

/// Refines θ from `start` to the nearest local optimum inside the bounds.
pub(super) fn refine(
    shapes: &impl Shapes,
    target: Target<'_>,
    start: &[f64],
    ending: Ending,
    work: &mut Work,
) -> Refined {
    let numbers = start.len();
    let values = target.values;
    let mut here = Point::new(shapes, numbers, values.len());
    let mut trial = Point::new(shapes, numbers, values.len());
    here.evaluate(shapes, start, target);
    work.evaluations += 1;
    work.starts += 1;
    let mut damping = 1e-4;
    let mut termination = Termination::IterationLimit;
    // The floor under which a fall of the residual is rounding.
    let floor = dot(values, values) * 1e-31;
    'search: for _ in 0..ending.most_iterations {
        let Some((hessian, gradient)) = projected(&here, shapes) else {
            termination = Termination::Singular;
            break;
        };
        // What the full Gauss–Newton step promises; less than this is rounding, or far inside the errors.
        let full = stepped(&here.theta, &hessian, &gradient, 0.0, shapes);
        if promise(&here.theta, &full, &gradient) <= ending.gain * here.square + floor
            && distance(&here.theta, &full) < 1e-4
        {
            termination = Termination::Converged;
            break;
        }
        loop {
            let theta = stepped(&here.theta, &hessian, &gradient, damping, shapes);
            let moved = distance(&here.theta, &theta);
            if moved <= 1e-14 || damping > 1e12 {
                termination = Termination::Converged;
                break 'search;
            }
            trial.evaluate(shapes, &theta, target);
            work.evaluations += 1;
            if trial.square < here.square {
                let gain = here.square - trial.square;
                std::mem::swap(&mut here, &mut trial);
                work.iterations += 1;
                damping = (damping * 0.1).max(1e-14);
                if gain <= ending.gain * here.square + floor {
                    termination = Termination::Converged;
                    break 'search;
                }
                break;
            }
            // At a flat bottom rounding decides; a step that would gain nothing measurable is the end.
            if moved < 1e-7 && damping < 1.0 && trial.square <= here.square * (1.0 + 1e-14) + floor {
                termination = Termination::Converged;
                break 'search;
            }
            damping = (damping * 8.0).max(1e-6);
        }
    }
    Refined {
        point: here,
        spare: trial,
        termination,
    }
}

/// Half the second derivative of the residual square by the nonlinear numbers, the linear ones at their best: differences
/// of its gradient. `None` where it is not positive definite, or a number lies at a bound.
pub(super) fn curvature(shapes: &impl Shapes, target: Target<'_>, theta: &[f64], work: &mut Work) -> Option<Vec<f64>> {
    /// Of the width of bounds; the error of the difference is some 10⁻⁸ of the curvature.
    const STEP: f64 = 1e-4;
    let count = theta.len();
    let mut point = Point::new(shapes, count, target.values.len());
    let mut hessian = vec![0.0; count * count];
    for j in 0..count {
        let (low, high) = shapes.bounds(j);
        if theta[j] - STEP < low || theta[j] + STEP > high {
            return None;
        }
        for side in [-1.0, 1.0] {
            let mut beside = theta.to_vec();
            beside[j] += side * STEP;
            point.evaluate(shapes, &beside, target);
            work.evaluations += 1;
            if point.singular || point.held.contains(&true) {
                return None;
            }
            for (i, entry) in point.gradient(shapes).into_iter().enumerate() {
                // The gradient points downhill.
                hessian[i * count + j] -= side * entry / (2.0 * STEP);
            }
        }
    }
    for i in 0..count {
        for j in 0..i {
            let mean = 0.5 * (hessian[i * count + j] + hessian[j * count + i]);
            hessian[i * count + j] = mean;
            hessian[j * count + i] = mean;
        }
    }
    Cholesky::new(&hessian, count).map(|_| hessian)
}

/// Most steps of [`descend`].
const STEPS: usize = 12;

/// Newton's method from a point near the optimum, with a curvature from elsewhere: the gradient comes from all samples, the
/// curvature from few. `None` if it does not lead downhill to where the gradient vanishes.
pub(super) fn descend(
    shapes: &impl Shapes,
    target: Target<'_>,
    theta: &[f64],
    hessian: &[f64],
    work: &mut Work,
) -> Option<Refined> {
    let mut here = Point::new(shapes, theta.len(), target.values.len());
    let mut trial = Point::new(shapes, theta.len(), target.values.len());
    here.evaluate(shapes, theta, target);
    work.evaluations += 1;
    work.starts += 1;
    let floor = dot(target.values, target.values) * 1e-31;
    let outlook = |point: &Point| {
        let gradient = point.gradient(shapes);
        let next = stepped(&point.theta, hessian, &gradient, 0.0, shapes);
        let gain = promise(&point.theta, &next, &gradient);
        (next, gain)
    };
    let (mut next, mut gain) = outlook(&here);
    for _ in 0..STEPS {
        if here.singular || here.held.contains(&true) {
            return None;
        }
        if gain.abs() <= NOTHING * here.square + floor {
            return Some(Refined {
                point: here,
                spare: trial,
                termination: Termination::Converged,
            });
        }
        trial.evaluate(shapes, &next, target);
        work.evaluations += 1;
        work.iterations += 1;
        let (after, less) = outlook(&trial);
        // What is left of the gain is rounding once it stops falling far below the residual.
        let settled = less.abs() > 0.5 * gain.abs() && gain.abs() < 1e-16 * here.square;
        if less.abs() <= 0.5 * gain.abs() && trial.square <= here.square * (1.0 + 1e-10) + floor {
            std::mem::swap(&mut here, &mut trial);
            (next, gain) = (after, less);
        } else if settled {
            return Some(Refined {
                point: here,
                spare: trial,
                termination: Termination::Converged,
            });
        } else {
            return None;
        }
    }
    None
}

/// Share of the residual square that a step may promise at the end of [`descend`]: some 10⁻¹¹ of the errors.
const NOTHING: f64 = 1e-22;

/// Most undamped steps after the residual has stopped falling.
const POLISHING: usize = 30;

/// The solution of a refinement, with undamped steps taken from it for as long as they make the gradient smaller.
///
/// The residual is flat to rounding within some 1e-8 of the optimum; the gradient is not, and shows the way further in.
pub(super) fn polished(shapes: &impl Shapes, target: Target<'_>, refined: Refined, work: &mut Work) -> Solution {
    let values = target.values;
    let mut here = refined.point;
    if refined.termination != Termination::Converged {
        return finish(here, shapes, refined.termination);
    }
    let mut trial = refined.spare;
    // The gain that a full step promises, gᵀ H⁻¹ g, measures the gradient.
    let outlook = |point: &Point| {
        let (hessian, gradient) = projected(point, shapes)?;
        let next = stepped(&point.theta, &hessian, &gradient, 0.0, shapes);
        let gain = promise(&point.theta, &next, &gradient);
        Some((next, gain))
    };
    let Some((mut next, mut gain)) = outlook(&here) else {
        return finish(here, shapes, Termination::Converged);
    };
    // Few samples make wide errors and cost nothing to polish.
    let enough = 1e-32 * (values.len() as f64).powi(3);
    for _ in 0..POLISHING {
        // Far from flat it is no polishing; at this share of the residual the step is some 1e-10 of the errors.
        if !(gain > enough * here.square && gain < 1e-9 * here.square) {
            break;
        }
        trial.evaluate(shapes, &next, target);
        work.evaluations += 1;
        match outlook(&trial) {
            Some((after, less)) if less < 0.5 * gain && trial.square <= here.square * (1.0 + 1e-10) => {
                std::mem::swap(&mut here, &mut trial);
                (next, gain) = (after, less);
            }
            _ => break,
        }
    }
    finish(here, shapes, Termination::Converged)
}

/// A solution found elsewhere, as it stands among these samples: residuals, columns and normal equations anew.
pub(super) fn standing(
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
    finish(here, shapes, termination)
}

/// Largest change of one nonlinear number.
pub(super) fn distance(here: &[f64], next: &[f64]) -> f64 {
    here.iter().zip(next).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// How much a Gauss–Newton step from `here` to `next` takes off the residual square, to first order.
fn promise(here: &[f64], next: &[f64], gradient: &[f64]) -> f64 {
    next.iter().zip(here).zip(gradient).map(|((a, b), g)| (a - b) * g).sum()
}

/// The Gauss–Newton matrix and gradient in θ with the linear numbers projected out.
fn projected(here: &Point, shapes: &impl Shapes) -> Option<(Vec<f64>, Vec<f64>)> {
    if here.singular {
        return None;
    }
    let (l, p) = (here.columns.len(), here.theta.len());
    let size = l + p;
    let (normal, gradient) = here.normal(shapes);
    // Linear numbers at a bound do not move with θ.
    let free: Vec<usize> = (0..l).filter(|&i| !here.held[i]).collect();
    let block: Vec<f64> = free
        .iter()
        .flat_map(|i| free.iter().map(move |j| (i, j)))
        .map(|(i, j)| normal[i * size + j])
        .collect();
    let linear = Cholesky::new(&block, free.len())?;
    let mut hessian: Vec<f64> = (0..p * p).map(|i| normal[(l + i / p) * size + l + i % p]).collect();
    let mut cross = vec![0.0; free.len()];
    for j in 0..p {
        for (entry, &i) in cross.iter_mut().zip(&free) {
            *entry = normal[i * size + l + j];
        }
        linear.solve(&mut cross);
        for i in 0..p {
            let imitated: f64 = free.iter().zip(&cross).map(|(&k, entry)| normal[k * size + l + i] * entry).sum();
            hessian[i * p + j] -= imitated;
        }
    }
    Some((hessian, gradient))
}

/// θ after a damped step, clipped to the bounds; a number that sits at a bound and is pushed outwards stays out of the step.
pub(super) fn stepped(
    theta: &[f64],
    hessian: &[f64],
    gradient: &[f64],
    damping: f64,
    shapes: &impl Shapes,
) -> Vec<f64> {
    let p = theta.len();
    let pinned = |i: usize| {
        let (low, high) = shapes.bounds(i);
        (theta[i] <= low && gradient[i] < 0.0) || (theta[i] >= high && gradient[i] > 0.0)
    };
    let free: Vec<usize> = (0..p).filter(|&i| !pinned(i)).collect();
    let mut matrix = vec![0.0; free.len() * free.len()];
    let mut step: Vec<f64> = free.iter().map(|&i| gradient[i]).collect();
    for (a, &i) in free.iter().enumerate() {
        for (b, &j) in free.iter().enumerate() {
            matrix[a * free.len() + b] = hessian[i * p + j];
        }
        // Scaled damping, with a floor for a number that the data do not feel at all.
        matrix[a * free.len() + a] = hessian[i * p + i].max(f64::MIN_POSITIVE) * (1.0 + damping);
    }
    match Cholesky::new(&matrix, free.len()) {
        Some(factor) => factor.solve(&mut step),
        None => {
            for (value, &i) in step.iter_mut().zip(&free) {
                *value /= hessian[i * p + i].max(f64::MIN_POSITIVE) * (1.0 + damping);
            }
        }
    }
    let mut next = theta.to_vec();
    for (&i, change) in free.iter().zip(step) {
        let (low, high) = shapes.bounds(i);
        // No step longer than a quarter of the range: the model is trusted only so far.
        let most = 0.25 * (high - low);
        next[i] = (theta[i] + change.clamp(-most, most)).clamp(low, high);
    }
    next
}

fn finish(here: Point, shapes: &impl Shapes, mut termination: Termination) -> Solution {
    let linear = here.columns.len();
    let size = linear + here.theta.len();
    let (normal, _) = here.normal(shapes);
    // A number at a bound has no errors, the others have theirs beside it.
    let free: Vec<usize> = (0..size).filter(|&i| i >= linear || !here.held[i]).collect();
    let block: Vec<f64> = free
        .iter()
        .flat_map(|i| free.iter().map(move |j| (i, j)))
        .map(|(i, j)| normal[i * size + j])
        .collect();
    let inverse_normal = Cholesky::new(&block, free.len()).map(|factor| {
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
            (0..here.theta.len()).all(|i| error(i) <= shapes.bounds(i).1 - shapes.bounds(i).0)
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
