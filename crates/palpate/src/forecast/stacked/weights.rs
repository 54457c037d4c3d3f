//! Weights of forecasts.

use crate::optimise::{BoundedProblem, BoundedSolver};

/// How strongly weights are drawn to equal ones, as a share of the least mean square error.
const RIDGE: f64 = 0.03;

/// Mean square errors below this share of the greatest are alike.
const NEGLIGIBLE: f64 = 1e-12;

/// Weights w ≥ 0 with Σ w = 1 that make wᵀ G w + ρ g |w − 1/m|² least, where G are the mean products of the errors of m
/// forecasts, g is the least of its diagonal, and ρ is 0.03.
///
/// With A = G + ρ g I they are w = v/Σv, where v ≥ 0 makes vᵀ A v − 2 Σv least: the conditions of Karush, Kuhn and Tucker are the same.
pub(super) fn stacked(products: &[f64], count: usize) -> Vec<f64> {
    let equal = vec![1.0 / count as f64; count];
    let squares = || (0..count).map(|i| products[i * count + i]);
    let unit = squares().fold(f64::INFINITY, f64::min).max(NEGLIGIBLE * squares().fold(0.0, f64::max));
    if !(unit > 0.0 && unit.is_finite()) {
        return equal;
    }
    let ridge = |at: usize| if at.is_multiple_of(count + 1) { RIDGE } else { 0.0 };
    let gram: Vec<f64> = products.iter().enumerate().map(|(at, product)| product / unit + ridge(at)).collect();
    let mut solver = BoundedSolver::new(count);
    let problem = BoundedProblem {
        gram: &gram,
        right: &vec![1.0; count],
        lower: &vec![0.0; count],
        upper: &vec![f64::INFINITY; count],
    };
    let sum = solver.solve(&problem).map_or(0.0, |()| solver.solution.iter().sum());
    if sum > 0.0 { solver.solution.iter().map(|weight| weight / sum).collect() } else { equal }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_the_least_of_all_on_the_simplex() {
        // Errors of three forecasts at four times: the first two cancel at weights 1/3 and 2/3, the third is far off.
        let errors = [[2.0, -1.0, 9.0], [4.0, -2.0, 7.0], [-2.0, 1.0, 8.0], [2.0, -1.0, 9.5]];
        let product = |i: usize, j: usize| errors.iter().map(|row: &[f64; 3]| row[i] * row[j]).sum::<f64>();
        let products: Vec<f64> = (0..9).map(|at| product(at / 3, at % 3)).collect();
        let weights = stacked(&products, 3);
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12 && weights.iter().all(|w| *w >= 0.0));
        let cost = |w: &[f64]| {
            let square: f64 = (0..9).map(|at| w[at / 3] * w[at % 3] * products[at] / products[4]).sum();
            square + RIDGE * w.iter().map(|w| (w - 1.0 / 3.0).powi(2)).sum::<f64>()
        };
        let best = cost(&weights);
        for a in 0..=100 {
            for b in 0..=100 - a {
                let other = [0.01 * f64::from(a), 0.01 * f64::from(b), 0.01 * f64::from(100 - a - b)];
                assert!(best <= cost(&other) + 1e-12, "{weights:?} {other:?}");
            }
        }
        assert!((weights[0] - 0.33).abs() < 0.02 && weights[2] < 0.01, "{weights:?}");
    }

    /// The search for the weights ended on its way: forecasts that were exact had a sixteenth each, and so had some that were far off.
    #[test]
    fn a_forecast_without_errors_has_all_the_weight() {
        let errors = [1e-16, 1e-9, 1e-4, 0.1, 0.3, 0.9];
        let products: Vec<f64> = errors.iter().flat_map(|one| errors.map(|other| one * other)).collect();
        let weights = stacked(&products, errors.len());
        assert!(
            (weights[0] + weights[1] - 1.0).abs() < 1e-3 && weights[3..].iter().all(|weight| *weight < 1e-6),
            "{weights:?}"
        );
    }

    #[test]
    fn forecasts_without_errors_share_alike() {
        assert_eq!(stacked(&[0.0; 4], 2), [0.5; 2]);
    }
}
