//! Linear models of few non-negative coefficients with the least largest error.

use crate::optimise::eliminate;

/// Rounds of new weights.
const ROUNDS: usize = 60;

/// Least pivot of the normal equations of columns that are scaled to 1.
const LEAST: f64 = 1e-13;

/// Coefficients c ≥ 0 of the rows (functions, value) for which the largest |Σ c_k f_k − value| is least, by Lawson's rounds of weighted
/// least squares: each multiplies the weights by the residuals (Lawson 1961; Rice and Usow, Mathematics of Computation 22, 1968).
///
/// A coefficient may be above 0 only where those that `needs` names for it are. `None` if no set of coefficients is determined.
pub(super) fn fit<const N: usize>(rows: &[([f64; N], f64)], needs: [Option<usize>; N]) -> Option<[f64; N]> {
    fit_rounds(rows, needs, ROUNDS).map(|(coefficients, _)| coefficients)
}

/// The same after some rounds, with the largest error; after one, it is that of least squares.
pub(super) fn fit_rounds<const N: usize>(
    rows: &[([f64; N], f64)],
    needs: [Option<usize>; N],
    rounds: usize,
) -> Option<([f64; N], f64)> {
    let scale = scales(rows);
    let row = |(functions, value): &([f64; N], f64)| (core::array::from_fn(|k| functions[k] / scale[k]), *value);
    let scaled: Vec<([f64; N], f64)> = rows.iter().map(row).collect();
    let mut weights = vec![1.0 / rows.len() as f64; rows.len()];
    let mut best: Option<([f64; N], f64)> = None;
    for _ in 0..rounds {
        let Some(coefficients) = weighted(&scaled, &weights, needs) else {
            break;
        };
        let residual = |(functions, value): &([f64; N], f64)| (dot(functions, &coefficients) - value).abs();
        let residuals: Vec<f64> = scaled.iter().map(residual).collect();
        let largest = residuals.iter().copied().fold(0.0, f64::max);
        if best.is_none_or(|(_, least)| largest < least) {
            best = Some((coefficients, largest));
        }
        weights.iter_mut().zip(&residuals).for_each(|(weight, residual)| *weight *= residual);
        let sum: f64 = weights.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            break;
        }
        weights.iter_mut().for_each(|weight| *weight /= sum);
    }
    best.map(|(coefficients, largest)| (core::array::from_fn(|k| coefficients[k] / scale[k]), largest))
}

/// Largest size of each function; 1 for one that is 0 everywhere.
fn scales<const N: usize>(rows: &[([f64; N], f64)]) -> [f64; N] {
    let largest = |k: usize| rows.iter().map(|(functions, _)| functions[k].abs()).fold(0.0, f64::max);
    core::array::from_fn(|k| if largest(k) > 0.0 { largest(k) } else { 1.0 })
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The set of coefficients above 0, of all sets, whose weighted squares are least.
fn weighted<const N: usize>(rows: &[([f64; N], f64)], weights: &[f64], needs: [Option<usize>; N]) -> Option<[f64; N]> {
    let (mut matrix, mut right, mut squares) = ([[0.0; N]; N], [0.0; N], 0.0);
    for ((functions, value), weight) in rows.iter().zip(weights) {
        for ((row, own), right) in matrix.iter_mut().zip(functions).zip(&mut right) {
            *right += weight * own * value;
            row.iter_mut().zip(functions).for_each(|(entry, other)| *entry += weight * own * other);
        }
        squares += weight * value * value;
    }
    let largest = (0..N).map(|i| matrix[i][i]).fold(0.0, f64::max);
    let mut best: Option<([f64; N], f64)> = None;
    for set in 1..(1_usize << N) {
        let is_free = |k: usize| (set >> k) & 1 == 1;
        if (0..N).any(|k| is_free(k) && needs[k].is_some_and(|needed| !is_free(needed))) {
            continue;
        }
        let entry = |i: usize, j: usize| match (is_free(i) && is_free(j), i == j) {
            (true, _) => matrix[i][j],
            (false, true) => largest,
            (false, false) => 0.0,
        };
        let part: [[f64; N]; N] = core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)));
        let mut coefficients: [f64; N] = core::array::from_fn(|k| if is_free(k) { right[k] } else { 0.0 });
        let is_solved = eliminate(part, &mut coefficients, LEAST * largest);
        if !is_solved || (0..N).any(|k| is_free(k) && coefficients[k] <= 0.0) {
            continue;
        }
        let left = squares - dot(&coefficients, &right);
        if best.is_none_or(|(_, least)| left < least) {
            best = Some((coefficients, left));
        }
    }
    best.map(|(coefficients, _)| coefficients)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The best line c x through the origin for x² on [0, 1]: c x − x² is largest at c/2 and smallest at 1, and both sizes are equal.
    #[test]
    fn a_line_has_the_least_largest_error() {
        let rows: Vec<([f64; 1], f64)> = (0..=1000).map(|i| f64::from(i) / 1e3).map(|x| ([x], x * x)).collect();
        let [slope] = fit(&rows, [None]).unwrap();
        // c²/4 = 1 − c
        let expected = 2.0 * 2f64.sqrt() - 2.0;
        assert!((slope - expected).abs() < 2e-3, "{slope} instead of {expected}");
    }

    #[test]
    fn coefficients_are_not_negative_and_need_their_partner() {
        let rows: Vec<([f64; 2], f64)> = (1..=100).map(f64::from).map(|x| ([x, x * x], x - 1e-3 * x * x)).collect();
        let [linear, square] = fit(&rows, [None, None]).unwrap();
        assert!(linear > 0.0 && square == 0.0);
        let rows: Vec<([f64; 2], f64)> = (1..=100).map(f64::from).map(|x| ([x, x * x], x * x)).collect();
        let [linear, square] = fit(&rows, [None, Some(0)]).unwrap();
        assert!(linear > 0.0 || square == 0.0, "{linear}, {square}");
    }
}
