//! The bounded solver against every set of bounds there is, against SciPy, and against the conditions of an optimum.

use serde::Deserialize;

use super::*;
use crate::statistics::dot;
use crate::test_problems::Noise;

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
    fn random(noise: &mut Noise, size: usize, shared: f64) -> Self {
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
        let (numbers, size) = (solver.solution(), self.right.len());
        let mut worst = 0.0f64;
        for i in 0..size {
            let row = &self.gram[i * size..(i + 1) * size];
            let gradient = dot(row, numbers) - self.right[i];
            let terms = self.right[i].abs() + row.iter().zip(numbers).map(|(g, a)| (g * a).abs()).sum::<f64>();
            let wrong = match solver.held()[i] {
                Held::Free => gradient.abs(),
                _ if self.lower[i] >= self.upper[i] => 0.0,
                Held::AtLower => -gradient,
                Held::AtUpper => gradient,
            };
            worst = worst.max(wrong / terms);
            assert!(numbers[i] >= self.lower[i] && numbers[i] <= self.upper[i]);
            let bound = match solver.held()[i] {
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
    let mut noise = Noise::new(7);
    let mut bound = 0;
    for trial in 0..600 {
        let owned = Owned::random(&mut noise, 1 + trial % 6, [0.0, 1.0, 30.0][trial % 3]);
        let mut solver = BoundedSolver::new(owned.right.len());
        solver.solve(&owned.problem()).unwrap();
        let (found, least) = (owned.value(solver.solution()), owned.least_of_all());
        let unit = owned.value(solver.solution()).abs().max(1e-3);
        assert!((found - least).abs() < 1e-9 * unit, "trial {trial}: {found} and {least}");
        bound += usize::from(solver.held().contains(&Held::AtUpper));
    }
    assert!(bound > 100, "upper bounds came up {bound} times");
}

#[test]
fn many_numbers_keep_the_conditions_of_an_optimum() {
    let mut noise = Noise::new(11);
    for (size, shared) in [(10, 0.0), (30, 3.0), (60, 0.0), (60, 10.0)] {
        let owned = Owned::random(&mut noise, size, shared);
        let mut solver = BoundedSolver::new(size);
        solver.solve(&owned.problem()).unwrap();
        assert!(owned.breach(&solver) < 1e-11, "{size}: {}", owned.breach(&solver));
        assert!(solver.held().contains(&Held::AtLower));
    }
}

#[test]
fn a_warm_start_ends_where_a_cold_one_does() {
    let mut noise = Noise::new(5);
    let mut warm = BoundedSolver::new(12);
    let mut owned = Owned::random(&mut noise, 12, 1.0);
    warm.solve(&owned.problem()).unwrap();
    for _ in 0..50 {
        owned.right.iter_mut().for_each(|right| *right += 2.0 * noise.normal());
        let mut cold = BoundedSolver::new(12);
        cold.solve(&owned.problem()).unwrap();
        warm.solve_from_last(&owned.problem()).unwrap();
        assert_eq!(warm.held(), cold.held());
        for (a, b) in warm.solution().iter().zip(cold.solution()) {
            assert!((a - b).abs() < 1e-10, "{a} {b}");
        }
    }
}

#[test]
fn twins_are_told_apart_by_a_bound_or_refused() {
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
        solver.solve(&problem).map(|()| solver.solution().iter().sum::<f64>())
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
        let found = owned.value(solver.solution());
        assert!((found / case.value - 1.0).abs() < reference.tolerance.value_relative, "{}: {found}", case.name);
        let unit = case.solution.iter().fold(0.0f64, |most, a| most.max(a.abs()));
        for (a, b) in solver.solution().iter().zip(&case.solution) {
            assert!((a - b).abs() < reference.tolerance.solution * unit, "{}: {a} and {b}", case.name);
        }
    }
}
