//! Noise whose size changes along the samples: by their own squares.

use crate::fit::noise::spread::LEAST_LEFT;
use crate::statistics::dot;

/// Rows of a Jacobian in order, whose last columns are bare derivatives that count times the amplitudes.
fn each_row(columns: &[&[f64]], amplitudes: &[f64], mut with: impl FnMut(usize, &[f64])) {
    let linear = columns.len() - amplitudes.len();
    let factor = |column: usize| if column < linear { 1.0 } else { amplitudes[column - linear] };
    let factors: Vec<f64> = (0..columns.len()).map(factor).collect();
    let mut row = vec![0.0; columns.len()];
    for sample in 0..columns.first().map_or(0, |column| column.len()) {
        row.iter_mut()
            .zip(columns)
            .zip(&factors)
            .for_each(|((entry, column), by)| *entry = by * column[sample]);
        with(sample, &row);
    }
}

/// hᵢ = Jᵢ (JᵀJ)⁻¹ Jᵢᵀ, the share of a sample that the fit takes up.
fn leverage(inverse: &[f64], row: &[f64]) -> f64 {
    inverse.chunks_exact(row.len()).zip(row).map(|(line, entry)| entry * dot(line, row)).sum()
}

/// The leverages of all samples.
pub(super) fn leverages(columns: &[&[f64]], amplitudes: &[f64], inverse: &[f64]) -> Vec<f64> {
    let mut found = Vec::with_capacity(columns.first().map_or(0, |column| column.len()));
    each_row(columns, amplitudes, |_, row| found.push(leverage(inverse, row)));
    found
}

/// JᵀVJ of white noise with V = diag(e²/(1 − h)²), h the leverages: HC3 of MacKinnon and White (1985), which needs no course of the size.
pub(super) fn by_residuals(columns: &[&[f64]], amplitudes: &[f64], inverse: &[f64], residuals: &[f64]) -> Vec<f64> {
    let size = columns.len();
    let mut filling = vec![0.0; size * size];
    each_row(columns, amplitudes, |sample, row| {
        let variance = (residuals[sample] / (1.0 - leverage(inverse, row)).max(LEAST_LEFT)).powi(2);
        for (line, one) in filling.chunks_exact_mut(size).zip(row) {
            line.iter_mut().zip(row).for_each(|(sum, other)| *sum += variance * one * other);
        }
    });
    filling
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::mean;
    use crate::test_problems::Rng;

    #[test]
    fn hc3_of_a_mean_is_that_of_the_jackknife() {
        // Of one constant column h = 1/N, and Σ e²/(1 − 1/N)² / N² the variance of the mean.
        let mut random = Rng::new(3);
        let residuals: Vec<f64> = (0..50).map(|_| 2.0 * random.normal()).collect();
        let middle = mean(&residuals);
        let left: Vec<f64> = residuals.iter().map(|value| value - middle).collect();
        let ones = [1.0; 50];
        let filling = by_residuals(&[&ones], &[], &[1.0 / 50.0], &left);
        let without = |skip: usize| (50.0 * middle - residuals[skip]) / 49.0;
        let jackknife: f64 = (0..50).map(|skip| (without(skip) - middle).powi(2)).sum();
        assert!((filling[0] / 2500.0 / jackknife - 1.0).abs() < 1e-12);
    }
}
