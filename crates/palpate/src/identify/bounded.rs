//! Least squares with bounds on the numbers: minimise aᵀ G a − 2 bᵀ a with lowerᵢ ≤ aᵢ ≤ upperᵢ.
//!
//! G and b are the normal equations of a linear fit, G = CᵀWC and b = CᵀWy. The method is that of active sets (Lawson
//! and Hanson's NNLS, Stark and Parker's BVLS): numbers at a bound are set aside, the others are solved for, and a number
//! leaves its bound only while that makes the sum smaller. The optimum is where no gradient points inwards:
//!
//! ```text
//! g = G a − b:   gᵢ = 0 inside,   gᵢ ≥ 0 at a lower bound,   gᵢ ≤ 0 at an upper bound
//! ```

use super::linear_algebra::Cholesky;

/// The normal equations and the bounds; infinite bounds bind nothing, equal ones fix a number.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoundedProblem<'a> {
    /// G, symmetric, row-major.
    pub(super) gram: &'a [f64],
    /// b.
    pub(super) right: &'a [f64],
    /// Least values, −∞ allowed.
    pub(super) lower: &'a [f64],
    /// Greatest values, +∞ allowed; none below its least value.
    pub(super) upper: &'a [f64],
}

/// Where a number ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Held {
    /// Between its bounds.
    Free,
    /// At its least value.
    AtLower,
    /// At its greatest value.
    AtUpper,
}

/// Solves bounded problems of one size, one after the other, in the same memory.
#[derive(Debug, Clone)]
pub(super) struct BoundedSolver {
    solution: Vec<f64>,
    held: Vec<Held>,
    free: Vec<usize>,
    matrix: Vec<f64>,
    trial: Vec<f64>,
    pivots: u64,
}

impl BoundedSolver {
    /// A solver for `size` numbers.
    pub(super) fn new(size: usize) -> Self {
        Self {
            solution: vec![0.0; size],
            held: vec![Held::Free; size],
            free: Vec::with_capacity(size),
            matrix: Vec::with_capacity(size * size),
            trial: Vec::with_capacity(size),
            pivots: 0,
        }
    }

    /// The numbers of the last solution.
    pub(super) fn solution(&self) -> &[f64] {
        &self.solution
    }

    /// Which of them are at a bound.
    pub(super) fn held(&self) -> &[Held] {
        &self.held
    }

    /// Systems of equations solved so far.
    pub(super) fn pivots(&self) -> u64 {
        self.pivots
    }

    /// Solves `problem`; `None` if numbers that nothing bounds cannot be told apart.
    ///
    /// First as if there were no bounds, which settles most problems of a few numbers; else from that answer cut to
    /// its bounds, or from the bounds nearest zero.
    pub(super) fn solve(&mut self, problem: &BoundedProblem<'_>) -> Option<()> {
        let fixed = |i: usize| problem.lower[i] >= problem.upper[i];
        for i in 0..self.held.len() {
            self.hold(problem, i, if fixed(i) { Held::AtLower } else { Held::Free });
        }
        if self.solve_free(problem).is_none() {
            for i in 0..self.held.len() {
                let unbound = problem.lower[i] == f64::NEG_INFINITY && problem.upper[i] == f64::INFINITY;
                let above = problem.lower[i] == f64::NEG_INFINITY || problem.upper[i] <= 0.0;
                let bound = if above && !fixed(i) { Held::AtUpper } else { Held::AtLower };
                self.hold(problem, i, if unbound { Held::Free } else { bound });
            }
        } else if self.first_bound(problem).is_none() {
            self.take(1.0);
            return Some(());
        } else {
            for k in 0..self.free.len() {
                let (i, value) = (self.free[k], self.trial[k]);
                self.solution[i] = value;
                if value <= problem.lower[i] {
                    self.hold(problem, i, Held::AtLower);
                } else if value >= problem.upper[i] {
                    self.hold(problem, i, Held::AtUpper);
                }
            }
        }
        self.settle(problem)
    }

    /// Solves `problem` from the bounds that the last solution ended at: a short way if the problems are alike.
    pub(super) fn solve_from_last(&mut self, problem: &BoundedProblem<'_>) -> Option<()> {
        for i in 0..self.held.len() {
            self.hold(problem, i, self.held[i]);
        }
        self.settle(problem)
    }

    /// From a point inside the bounds to the optimum.
    fn settle(&mut self, problem: &BoundedProblem<'_>) -> Option<()> {
        let size = self.held.len();
        // Every freed number lowers the sum, so no set of bounds comes twice; the count guards against rounding only.
        let most = 40 * size + 40;
        self.descend(problem)?;
        let mut refused = vec![false; size];
        for _ in 0..most {
            let Some(entering) = self.entering(problem, &refused) else {
                return Some(());
            };
            let before = self.held[entering];
            self.held[entering] = Held::Free;
            // A number that cannot be told from the free ones, or that wants to leave through its own bound, has a
            // gradient of rounding only: it stays where it was.
            let inward = self.solve_free(problem).is_some_and(|()| {
                let at = self.free.partition_point(|i| *i < entering);
                match before {
                    Held::AtUpper => self.trial[at] < self.solution[entering],
                    _ => self.trial[at] > self.solution[entering],
                }
            });
            if inward {
                self.descend_to_trial(problem)?;
                refused.fill(false);
            } else {
                self.held[entering] = before;
                refused[entering] = true;
            }
        }
        None
    }

    /// Solves for the free numbers and goes there, setting those aside that meet a bound on the way.
    fn descend(&mut self, problem: &BoundedProblem<'_>) -> Option<()> {
        self.solve_free(problem)?;
        self.descend_to_trial(problem)
    }

    fn descend_to_trial(&mut self, problem: &BoundedProblem<'_>) -> Option<()> {
        while let Some((share, k, side)) = self.first_bound(problem) {
            let met = self.free[k];
            self.take(share);
            self.hold(problem, met, side);
            self.solve_free(problem)?;
        }
        self.take(1.0);
        Some(())
    }

    /// The bound that is met first on the way from the solution to the trial: share of the way, place in `free`, side.
    fn first_bound(&self, problem: &BoundedProblem<'_>) -> Option<(f64, usize, Held)> {
        let mut first: Option<(f64, usize, Held)> = None;
        for (k, (&i, &to)) in self.free.iter().zip(&self.trial).enumerate() {
            let (bound, side) = if to < problem.lower[i] {
                (problem.lower[i], Held::AtLower)
            } else if to > problem.upper[i] {
                (problem.upper[i], Held::AtUpper)
            } else {
                continue;
            };
            let from = self.solution[i];
            let share = ((bound - from) / (to - from)).clamp(0.0, 1.0);
            if first.is_none_or(|(least, ..)| share < least) {
                first = Some((share, k, side));
            }
        }
        first
    }

    /// Moves the free numbers by this share of the way to the trial.
    fn take(&mut self, share: f64) {
        for (&i, &to) in self.free.iter().zip(&self.trial) {
            self.solution[i] = if share == 1.0 { to } else { self.solution[i] + share * (to - self.solution[i]) };
        }
    }

    /// Puts a number at a bound, or leaves it to be solved for.
    fn hold(&mut self, problem: &BoundedProblem<'_>, i: usize, held: Held) {
        self.held[i] = held;
        match held {
            Held::AtLower => self.solution[i] = problem.lower[i],
            Held::AtUpper => self.solution[i] = problem.upper[i],
            Held::Free => {}
        }
    }

    /// The best free numbers with the others where they are, into `trial`; `None` if they cannot be told apart.
    fn solve_free(&mut self, problem: &BoundedProblem<'_>) -> Option<()> {
        let size = self.held.len();
        let held = &self.held;
        self.free.clear();
        self.free.extend((0..size).filter(|i| held[*i] == Held::Free));
        self.matrix.clear();
        self.trial.clear();
        for &i in &self.free {
            let row = &problem.gram[i * size..(i + 1) * size];
            self.matrix.extend(self.free.iter().map(|j| row[*j]));
            let mut right = problem.right[i];
            for ((entry, value), held) in row.iter().zip(&self.solution).zip(held) {
                if *held != Held::Free && *value != 0.0 {
                    right -= entry * value;
                }
            }
            self.trial.push(right);
        }
        self.pivots += 1;
        Cholesky::new(&self.matrix, self.free.len())?.solve(&mut self.trial);
        self.trial.iter().all(|value| value.is_finite()).then_some(())
    }

    /// The number whose bound costs most: whose gradient, in units of its own column, points inwards the steepest.
    fn entering(&self, problem: &BoundedProblem<'_>, refused: &[bool]) -> Option<usize> {
        let mut steepest: Option<(f64, usize)> = None;
        for (i, refused) in refused.iter().enumerate() {
            if *refused || self.held[i] == Held::Free || problem.lower[i] >= problem.upper[i] {
                continue;
            }
            let slope = self.inward_slope(problem, i);
            if slope.is_finite() && slope > steepest.map_or(0.0, |(most, _)| most) {
                steepest = Some((slope, i));
            }
        }
        steepest.map(|(_, i)| i)
    }

    /// How steeply the sum falls as a held number moves off its bound; 0 where that is rounding of its own terms.
    fn inward_slope(&self, problem: &BoundedProblem<'_>, i: usize) -> f64 {
        let size = self.held.len();
        let row = &problem.gram[i * size..(i + 1) * size];
        let mut upward = problem.right[i];
        let mut terms = upward.abs();
        for (entry, value) in row.iter().zip(&self.solution) {
            upward -= entry * value;
            terms += (entry * value).abs();
        }
        let inward = if self.held[i] == Held::AtUpper { -upward } else { upward };
        if inward > 4.0 * size as f64 * f64::EPSILON * terms { inward / row[i].sqrt() } else { 0.0 }
    }
}

#[cfg(test)]
#[path = "bounded_tests.rs"]
mod tests;
