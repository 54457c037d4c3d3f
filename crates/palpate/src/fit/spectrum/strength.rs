//! How strongly a spectrum is smoothed: as strongly as the residual allows.

use super::normal::Normal;
use crate::optimise::{BoundedProblem, BoundedSolver, Cholesky, Held};

/// Weakest and strongest smoothing tried, as powers of ten.
const DECADES: (i32, i32) = (-12, 1);

/// Strengths per decade that are distinguished.
const STEPS: i32 = 8;

/// A spectrum at one strength of smoothing, in units of the hold's duration and range.
#[derive(Debug, Clone)]
pub(crate) struct Smoothed {
    pub(crate) strength: f64,
    /// Amplitudes, then the constant; amplitudes have the sign of the relaxation.
    pub(crate) parameters: Vec<f64>,
    held: Vec<Held>,
    /// Mean square left.
    pub(crate) residual: f64,
}

/// One sign of the relaxation: all amplitudes at least zero, or at most zero.
pub(crate) struct Smoother<'a> {
    normal: &'a Normal,
    solver: BoundedSolver,
    smoothed_gram: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    begun: bool,
}

impl<'a> Smoother<'a> {
    /// For amplitudes of this sign and a constant that is free or fixed.
    pub(crate) fn new(normal: &'a Normal, sign: f64, constant: Option<f64>) -> Self {
        let size = normal.right.len();
        let (low, high) = if sign > 0.0 { (0.0, f64::INFINITY) } else { (f64::NEG_INFINITY, 0.0) };
        let (mut lower, mut upper) = (vec![low; size], vec![high; size]);
        lower[size - 1] = constant.unwrap_or(f64::NEG_INFINITY);
        upper[size - 1] = constant.unwrap_or(f64::INFINITY);
        Self {
            normal,
            solver: BoundedSolver::new(size),
            smoothed_gram: Vec::with_capacity(size * size),
            lower,
            upper,
            begun: false,
        }
    }

    /// Mean square + strength × Σ (h_{j+1} − h_j)² at its least; `None` if that is lost in rounding.
    pub(crate) fn solve(&mut self, strength: f64) -> Option<Smoothed> {
        self.smooth(strength);
        let problem = BoundedProblem {
            gram: &self.smoothed_gram,
            right: &self.normal.right,
            lower: &self.lower,
            upper: &self.upper,
        };
        let solved = if self.begun { self.solver.solve_from_last(&problem) } else { None };
        solved.or_else(|| self.solver.solve(&problem))?;
        self.begun = true;
        let parameters = self.solver.solution.clone();
        let residual = self.normal.residual(&parameters);
        Some(Smoothed {
            strength,
            parameters,
            held: self.solver.held.clone(),
            residual,
        })
    }

    /// The weakest smoothing and every decade above it, weakest last.
    pub(crate) fn decades(&mut self) -> Vec<Smoothed> {
        (DECADES.0..=DECADES.1).rev().filter_map(|power| self.solve(10f64.powi(power))).collect()
    }

    /// The strongest smoothing whose residual is at most `limit`, which the last of `decades` keeps.
    ///
    /// The residual grows with the strength, so halving finds it.
    pub(crate) fn strongest(&mut self, decades: &[Smoothed], limit: f64) -> Option<Smoothed> {
        let mut best = decades.iter().find(|smoothed| smoothed.residual <= limit)?.clone();
        let decade = best.strength.log10().round() as i32;
        if decade == DECADES.1 {
            return Some(best);
        }
        let mut step = STEPS / 2;
        let mut at = decade * STEPS;
        while step > 0 {
            let tried = self.solve(10f64.powf(f64::from(at + step) / f64::from(STEPS)))?;
            if tried.residual <= limit {
                at += step;
                best = tried;
            }
            step /= 2;
        }
        Some(best)
    }

    /// Parameters that the samples, not the smoothing, determine: the trace of the hat matrix, (G + μL)⁻¹ G over the free parameters.
    pub(crate) fn effective_parameters(&mut self, smoothed: &Smoothed) -> f64 {
        let size = self.normal.right.len();
        self.smooth(smoothed.strength);
        let free: Vec<usize> = (0..size).filter(|i| smoothed.held[*i] == Held::Free).collect();
        let part = |matrix: &[f64]| -> Vec<f64> {
            free.iter().flat_map(|i| free.iter().map(move |j| matrix[i * size + j])).collect()
        };
        let gram = part(&self.normal.gram);
        let count = free.len();
        let Some(factor) = Cholesky::new(&part(&self.smoothed_gram), count) else {
            return count as f64;
        };
        let diagonal = |j: usize| {
            let mut column = gram[j * count..(j + 1) * count].to_vec();
            factor.solve(&mut column);
            column[j]
        };
        (0..count).map(diagonal).sum()
    }

    /// G + strength × LᵀL with the first differences L of the amplitudes; the constant is left alone.
    fn smooth(&mut self, strength: f64) {
        let size = self.normal.right.len();
        self.smoothed_gram.clone_from(&self.normal.gram);
        for j in 0..size - 2 {
            self.smoothed_gram[j * size + j] += strength;
            self.smoothed_gram[(j + 1) * size + j + 1] += strength;
            self.smoothed_gram[j * size + j + 1] -= strength;
            self.smoothed_gram[(j + 1) * size + j] -= strength;
        }
    }
}
