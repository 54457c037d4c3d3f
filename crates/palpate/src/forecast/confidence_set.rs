//! Which laws a test of their forecasts does not distinguish from the best.
//!
//! The rest of a hold behind every cut point is two stretches: what follows at first, and what follows later. With s² the mean square
//! error of a law in a stretch, and b that of the best law,
//!
//! ```text
//! d = ln s² − ln b² − 2 ln 1.05,   t = mean(d)/(sd(d)/√S)
//! ```
//!
//! over S stretches: the paired test of Diebold and Mariano (1995) on logarithms, so that a late stretch, in which errors are large, does
//! not decide alone. A law is worse than the best by more than 5 % where t exceeds the quantile of Student's t with S − 1 degrees of
//! freedom at 0.05/(K − 1), one-sided, since each of the K − 1 others is tested (Bonferroni). Stretches of one hold are not independent,
//! so the level is nominal: `docs/validation/law-probability.md` counts how often the set contains the law that turned out to be the best.

use super::ForwardScore;
use crate::statistics::{coverage_factor, mean};

/// Probability that a law as good as the best is left out, over all laws together.
const LEVEL: f64 = 0.05;

/// Larger errors by less than this factor do not matter.
pub(super) const MARGIN: f64 = 1.05;

/// Errors below this share of the change count as this large: what is left there is rounding.
const LEAST: f64 = 1e-4;

/// Logarithms of mean square errors over the square of the change, two stretches a cut point; `None` where there are no samples.
pub(super) fn losses(forward: &ForwardScore, change: f64) -> Vec<Option<f64>> {
    let stretch = |squares: &[Option<f64>]| {
        let squares: Vec<f64> = squares.iter().flatten().copied().collect();
        (!squares.is_empty()).then(|| (mean(&squares) / (change * change)).max(LEAST * LEAST).ln())
    };
    let of_cut = |eighths: [Option<f64>; 8]| [stretch(&eighths[..4]), stretch(&eighths[4..])];
    forward
        .forecasts
        .iter()
        .flat_map(|found| of_cut(found.map_or([None; 8], |found| found.square_by_eighth)))
        .collect()
}

/// Whether `losses` are larger than those of the best by more than chance and this factor of the error, one of `others` tests.
pub(super) fn is_worse(losses: &[Option<f64>], best: &[Option<f64>], margin: f64, others: usize) -> bool {
    let margin = 2.0 * margin.ln();
    let differences: Vec<f64> =
        losses.iter().zip(best).filter_map(|(one, best)| Some((*one)? - (*best)? - margin)).collect();
    let count = differences.len() as f64;
    let middle = mean(&differences);
    if differences.len() < 2 || middle <= 0.0 {
        return false;
    }
    let square = differences.iter().map(|difference| (difference - middle).powi(2)).sum::<f64>();
    let error = (square / (count - 1.0) / count).sqrt();
    // One-sided: what is outside the central part is on both sides.
    let level = 1.0 - 2.0 * LEVEL / others.max(1) as f64;
    middle > coverage_factor(level, count - 1.0) * error
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_test_is_students() {
        let best = [Some(0.0); 6];
        // Differences with mean 1 and standard deviation 1 beyond the margin: t = √6 = 2.449.
        let margin = 2.0 * 1.05_f64.ln();
        let spread = (5.0_f64 / 6.0).sqrt();
        let losses = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0].map(|sign| Some(1.0 + margin + sign * spread));
        // Student's t, 5 degrees of freedom, one-sided: 2.015 at 0.05, 2.571 at 0.025 (standard table).
        assert!(is_worse(&losses, &best, MARGIN, 1));
        assert!(!is_worse(&losses, &best, MARGIN, 2));
    }

    #[test]
    fn a_difference_of_less_than_a_twentieth_never_counts() {
        let best = [Some(0.0); 6];
        assert!(!is_worse(&[Some(2.0 * 1.049_f64.ln()); 6], &best, MARGIN, 1));
        assert!(is_worse(&[Some(2.0 * 1.051_f64.ln()); 6], &best, MARGIN, 1));
        assert!(!is_worse(&[Some(9.0), None], &best[..2], MARGIN, 1), "one stretch says nothing of its scatter");
    }
}
