//! Weights of forecasts.

/// How strongly weights are drawn to equal ones, as a share of the least mean square error.
const RIDGE: f64 = 0.03;

/// Weights w ≥ 0 with Σ w = 1 that make wᵀ G w + ρ g |w − 1/m|² least, where G are the mean products of the errors of m
/// forecasts, g is the least of its diagonal, and ρ is 0.03.
///
/// The condition of Karush, Kuhn and Tucker is met by moving weight from where the gradient is highest to where it is lowest.
pub(super) fn stacked(products: &[f64], count: usize) -> Vec<f64> {
    const STEPS: usize = 20_000;
    const CLOSE: f64 = 1e-9;
    let least = (0..count).map(|i| products[i * count + i]).fold(f64::INFINITY, f64::min);
    let equal = 1.0 / count as f64;
    let mut weights = vec![equal; count];
    if !(least > 0.0 && least.is_finite()) {
        return weights;
    }
    let entry = |i: usize, j: usize| products[i * count + j] / least + if i == j { RIDGE } else { 0.0 };
    let mut gradient: Vec<f64> =
        (0..count).map(|i| (0..count).map(|j| entry(i, j) * equal).sum::<f64>() - RIDGE * equal).collect();
    for _ in 0..STEPS {
        let lowest = (0..count).min_by(|a, b| gradient[*a].total_cmp(&gradient[*b])).unwrap_or(0);
        let given = (0..count).filter(|i| weights[*i] > 0.0);
        let highest = given.max_by(|a, b| gradient[*a].total_cmp(&gradient[*b])).unwrap_or(0);
        let slope = gradient[highest] - gradient[lowest];
        if slope <= CLOSE {
            break;
        }
        let curvature = entry(lowest, lowest) + entry(highest, highest) - 2.0 * entry(lowest, highest);
        let moved = (slope / curvature).min(weights[highest]);
        weights[lowest] += moved;
        // What is all gone is exactly none.
        weights[highest] = if moved == weights[highest] { 0.0 } else { weights[highest] - moved };
        for (i, gradient) in gradient.iter_mut().enumerate() {
            *gradient += moved * (entry(i, lowest) - entry(i, highest));
        }
    }
    weights
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

    #[test]
    fn forecasts_without_errors_share_alike() {
        assert_eq!(stacked(&[0.0; 4], 2), [0.5; 2]);
    }
}
