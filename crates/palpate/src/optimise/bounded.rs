//! Least squares with bounds on the numbers: minimise aᵀ G a − 2 bᵀ a with lowerᵢ ≤ aᵢ ≤ upperᵢ.
//!
//! G and b are the normal equations of a linear fit, G = CᵀWC and b = CᵀWy. The method is that of active sets (Lawson
//! and Hanson's NNLS, Stark and Parker's BVLS): numbers at a bound are set aside, the others are solved for, and a number
//! leaves its bound only while that makes the sum smaller. The optimum is where no gradient points inwards:
//!
//! ```text
//! g = G a − b:   gᵢ = 0 inside,   gᵢ ≥ 0 at a lower bound,   gᵢ ≤ 0 at an upper bound
//! ```

use super::cholesky::Cholesky;

/// The normal equations and the bounds; infinite bounds bind nothing, equal ones fix a number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoundedProblem<'a> {
    /// G, symmetric, row-major.
    pub(crate) gram: &'a [f64],
    /// b.
    pub(crate) right: &'a [f64],
    /// Least values, −∞ allowed.
    pub(crate) lower: &'a [f64],
    /// Greatest values, +∞ allowed; none below its least value.
    pub(crate) upper: &'a [f64],
}

/// Where a number ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Held {
    /// Between its bounds.
    Free,
    /// At its least value.
    AtLower,
    /// At its greatest value.
    AtUpper,
}

/// Solves bounded problems of one size, one after the other, in the same memory.
#[derive(Debug, Clone)]
pub(crate) struct BoundedSolver {
    /// The numbers of the last solution.
    pub(crate) solution: Vec<f64>,
    /// Which of them are at a bound.
    pub(crate) held: Vec<Held>,
    free: Vec<usize>,
    matrix: Vec<f64>,
    trial: Vec<f64>,
}

impl BoundedSolver {
    /// A solver for `size` numbers.
    pub(crate) fn new(size: usize) -> Self {
        Self {
            solution: vec![0.0; size],
            held: vec![Held::Free; size],
            free: Vec::with_capacity(size),
            matrix: Vec::with_capacity(size * size),
            trial: Vec::with_capacity(size),
        }
    }

    /// Solves `problem`; `None` if numbers that nothing bounds cannot be distinguished.
    ///
    /// First as if there were no bounds, which settles most problems of a few numbers; else from that answer cut to
    /// its bounds, or from the bounds nearest zero.
    pub(crate) fn solve(&mut self, problem: &BoundedProblem<'_>) -> Option<()> {
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
    pub(crate) fn solve_from_last(&mut self, problem: &BoundedProblem<'_>) -> Option<()> {
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
            // A number that cannot be determined from the free ones, or that wants to leave through its own bound, has a
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

    /// The best free numbers with the others where they are, into `trial`; `None` if they cannot be distinguished.
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

/// Against every set of bounds there is, against SciPy, and against the conditions of an optimum.
#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;
    use crate::statistics::dot;
    use crate::test_problems::Rng;

    struct Owned {
        gram: Vec<f64>,
        right: Vec<f64>,
        lower: Vec<f64>,
        upper: Vec<f64>,
    }

    impl Owned {
        fn problem(&self) -> BoundedProblem<'_> {
            BoundedProblem {
                gram: &self.gram,
                right: &self.right,
                lower: &self.lower,
                upper: &self.upper,
            }
        }

        /// Columns of random numbers that lean towards each other by `shared`, and bounds of every kind.
        fn random(noise: &mut Rng, size: usize, shared: f64) -> Self {
            let rows = 2 * size + 2;
            let common: Vec<f64> = (0..rows).map(|_| noise.normal()).collect();
            let mut column = |share: f64| -> Vec<f64> { common.iter().map(|c| share * c + noise.normal()).collect() };
            let columns: Vec<Vec<f64>> = (0..size).map(|_| column(shared)).collect();
            let signal = column(1.0);
            let bounds = (0..size).map(|_| match (5.0 * noise.uniform()) as u32 {
                0 => (0.0, f64::INFINITY),
                1 => (f64::NEG_INFINITY, 0.1 * noise.normal()),
                2 => (f64::NEG_INFINITY, f64::INFINITY),
                3 => (-0.1 * noise.uniform(), 0.1 * noise.uniform()),
                _ => (0.2, 0.2),
            });
            let (lower, upper) = bounds.unzip();
            Self {
                gram: columns.iter().flat_map(|a| columns.iter().map(move |b| dot(a, b))).collect(),
                right: columns.iter().map(|a| dot(a, &signal)).collect(),
                lower,
                upper,
            }
        }

        fn value(&self, numbers: &[f64]) -> f64 {
            let size = numbers.len();
            let row = |i: usize| dot(&self.gram[i * size..(i + 1) * size], numbers) - 2.0 * self.right[i];
            (0..size).map(|i| numbers[i] * row(i)).sum()
        }

        /// Least value over all choices of free, lower and upper that end inside the bounds.
        fn least_of_all(&self) -> f64 {
            let size = self.right.len();
            let mut least = f64::INFINITY;
            for choice in 0..3usize.pow(size as u32) {
                let held = |i: usize| choice / 3usize.pow(i as u32) % 3;
                let at = |i: usize| match held(i) {
                    0 => 0.0,
                    1 => self.lower[i],
                    _ => self.upper[i],
                };
                let mut numbers: Vec<f64> = (0..size).map(at).collect();
                if numbers.iter().any(|number| number.is_infinite()) {
                    continue;
                }
                let free: Vec<usize> = (0..size).filter(|i| held(*i) == 0).collect();
                let matrix: Vec<f64> =
                    free.iter().flat_map(|i| free.iter().map(move |j| self.gram[i * size + j])).collect();
                let left = |i: &usize| self.right[*i] - dot(&self.gram[i * size..(i + 1) * size], &numbers);
                let mut trial: Vec<f64> = free.iter().map(left).collect();
                Cholesky::new(&matrix, free.len()).unwrap().solve(&mut trial);
                free.iter().zip(&trial).for_each(|(i, value)| numbers[*i] = *value);
                if (0..size).all(|i| numbers[i] >= self.lower[i] && numbers[i] <= self.upper[i]) {
                    least = least.min(self.value(&numbers));
                }
            }
            least
        }

        /// Largest breach of the conditions of an optimum, in units of the terms that make up each gradient.
        fn breach(&self, solver: &BoundedSolver) -> f64 {
            let (numbers, size) = (&solver.solution, self.right.len());
            let mut worst = 0.0f64;
            for i in 0..size {
                let row = &self.gram[i * size..(i + 1) * size];
                let gradient = dot(row, numbers) - self.right[i];
                let terms = self.right[i].abs() + row.iter().zip(numbers).map(|(g, a)| (g * a).abs()).sum::<f64>();
                let wrong = match solver.held[i] {
                    Held::Free => gradient.abs(),
                    _ if self.lower[i] >= self.upper[i] => 0.0,
                    Held::AtLower => -gradient,
                    Held::AtUpper => gradient,
                };
                worst = worst.max(wrong / terms);
                assert!(numbers[i] >= self.lower[i] && numbers[i] <= self.upper[i]);
                let bound = match solver.held[i] {
                    Held::Free => numbers[i],
                    Held::AtLower => self.lower[i],
                    Held::AtUpper => self.upper[i],
                };
                assert_eq!(numbers[i], bound);
            }
            worst
        }
    }

    #[test]
    fn finds_the_best_of_all_sets_of_bounds() {
        let mut noise = Rng::new(7);
        let mut bound = 0;
        for trial in 0..600 {
            let owned = Owned::random(&mut noise, 1 + trial % 6, [0.0, 1.0, 30.0][trial % 3]);
            let mut solver = BoundedSolver::new(owned.right.len());
            solver.solve(&owned.problem()).unwrap();
            let (found, least) = (owned.value(&solver.solution), owned.least_of_all());
            let unit = owned.value(&solver.solution).abs().max(1e-3);
            assert!((found - least).abs() < 1e-9 * unit, "trial {trial}: {found} and {least}");
            bound += usize::from(solver.held.contains(&Held::AtUpper));
        }
        assert!(bound > 100, "upper bounds came up {bound} times");
    }

    #[test]
    fn many_numbers_keep_the_conditions_of_an_optimum() {
        let mut noise = Rng::new(11);
        for (size, shared) in [(10, 0.0), (30, 3.0), (60, 0.0), (60, 10.0)] {
            let owned = Owned::random(&mut noise, size, shared);
            let mut solver = BoundedSolver::new(size);
            solver.solve(&owned.problem()).unwrap();
            assert!(owned.breach(&solver) < 1e-11, "{size}: {}", owned.breach(&solver));
            assert!(solver.held.contains(&Held::AtLower));
        }
    }

    #[test]
    fn a_warm_start_ends_where_a_cold_one_does() {
        let mut noise = Rng::new(5);
        let mut warm = BoundedSolver::new(12);
        let mut owned = Owned::random(&mut noise, 12, 1.0);
        warm.solve(&owned.problem()).unwrap();
        for _ in 0..50 {
            owned.right.iter_mut().for_each(|right| *right += 2.0 * noise.normal());
            let mut cold = BoundedSolver::new(12);
            cold.solve(&owned.problem()).unwrap();
            warm.solve_from_last(&owned.problem()).unwrap();
            assert_eq!(warm.held, cold.held);
            for (a, b) in warm.solution.iter().zip(cold.solution) {
                assert!((a - b).abs() < 1e-10, "{a} {b}");
            }
        }
    }

    #[test]
    fn twins_are_reported_apart_by_a_bound_or_refused() {
        let gram = [1.0, 1.0, 1.0, 1.0];
        let both = |lower: &[f64]| {
            let mut solver = BoundedSolver::new(2);
            let upper = [f64::INFINITY; 2];
            let problem = BoundedProblem {
                gram: &gram,
                right: &[3.0, 3.0],
                lower,
                upper: &upper,
            };
            solver.solve(&problem).map(|()| solver.solution.iter().sum::<f64>())
        };
        // Any split of 3 is an optimum; one of the two stays at its bound.
        assert_eq!(both(&[0.0, 0.0]), Some(3.0));
        assert_eq!(both(&[f64::NEG_INFINITY; 2]), None);
    }

    #[derive(Deserialize)]
    struct Tolerance {
        value_relative: f64,
        solution: f64,
    }

    #[derive(Deserialize)]
    struct Case {
        name: String,
        gram: Vec<f64>,
        right: Vec<f64>,
        lower: Vec<Option<f64>>,
        upper: Vec<Option<f64>>,
        solution: Vec<f64>,
        value: f64,
    }

    #[derive(Deserialize)]
    struct Reference {
        tolerance: Tolerance,
        cases: Vec<Case>,
    }

    /// `validation/bounded_least_squares.py`
    #[test]
    fn agrees_with_scipy() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/reference/bounded_least_squares.json");
        let reference: Reference = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        assert_eq!(reference.cases.len(), 21);
        for case in reference.cases {
            let owned = Owned {
                gram: case.gram,
                right: case.right,
                lower: case.lower.iter().map(|bound| bound.unwrap_or(f64::NEG_INFINITY)).collect(),
                upper: case.upper.iter().map(|bound| bound.unwrap_or(f64::INFINITY)).collect(),
            };
            let mut solver = BoundedSolver::new(case.solution.len());
            solver.solve(&owned.problem()).unwrap();
            let found = owned.value(&solver.solution);
            assert!((found / case.value - 1.0).abs() < reference.tolerance.value_relative, "{}: {found}", case.name);
            let unit = case.solution.iter().fold(0.0f64, |most, a| most.max(a.abs()));
            for (a, b) in solver.solution.iter().zip(&case.solution) {
                assert!((a - b).abs() < reference.tolerance.solution * unit, "{}: {a} and {b}", case.name);
            }
        }
    }
}
