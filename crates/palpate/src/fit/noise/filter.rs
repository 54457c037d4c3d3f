//! Kalman's filter of white noise with AR(1) parts: what it does with each sample, whatever the column.

use super::model::MOST_PARTS;
use crate::vector::accelerated;

/// Kalman's filter of white noise with AR(1) parts, as it takes a column: each part is expected to be what it was, and its gain of what
/// came beyond expectation, times its correlation; what came beyond counts times `root`.
pub(crate) struct Filter {
    /// The correlation of each part with itself a sample later.
    pub(crate) kept: Vec<f64>,
    /// Of the first samples; the last of them for all that follow.
    pub(crate) steps: Vec<Step>,
    /// ln |R|.
    pub(crate) log_determinant: f64,
}

/// What a filter does with one sample.
pub(crate) struct Step {
    pub(crate) root: f64,
    pub(crate) gains: [f64; MOST_PARTS],
}

impl Filter {
    /// The filter for parts, each with its share in the variance and its correlation a sample later; the rest is white.
    pub(crate) fn new(parts: &[(f64, f64)], samples: usize) -> Self {
        accelerated(
            #[inline(always)]
            || match parts.len() {
                0 | 1 => Self::settled::<1>(parts, samples),
                _ => Self::settled::<MOST_PARTS>(parts, samples),
            },
        )
    }

    /// That of up to `P` parts.
    #[inline(always)]
    fn settled<const P: usize>(parts: &[(f64, f64)], samples: usize) -> Self {
        let white = (1.0 - parts.iter().map(|(share, _)| share).sum::<f64>()).max(0.0);
        let of = |part: fn(&(f64, f64)) -> f64| -> [f64; P] {
            std::array::from_fn(|index| parts.get(index).map_or(0.0, part))
        };
        let (shares, kept) = (of(|part| part.0), of(|part| part.1));
        // Covariance of the parts before each sample.
        let mut ahead = [[0.0; P]; P];
        (0..P).for_each(|i| ahead[i][i] = shares[i]);
        let mut steps: Vec<Step> = Vec::with_capacity(samples);
        let (mut log_determinant, mut determinant) = (0.0, 1.0);
        for index in 0..samples {
            let mut with_sum = [0.0; P];
            for row in &ahead {
                (0..P).for_each(|j| with_sum[j] += row[j]);
            }
            let innovation = white + with_sum.iter().sum::<f64>();
            let root = 1.0 / innovation.sqrt();
            let gains = with_sum.map(|with_sum| with_sum / innovation);
            // Gains and variances settle soon, where no part outlasts the series.
            let is_settled = steps.last().is_some_and(|last| {
                (root - last.root).abs() <= 1e-14 * root
                    && (0..P).all(|i| (gains[i] - last.gains[i]).abs() <= 1e-14 * gains[i])
            });
            if is_settled {
                log_determinant += (samples - index) as f64 * innovation.ln();
                break;
            }
            // One logarithm for many factors.
            determinant *= innovation;
            if !(1e-100..1e100).contains(&determinant) {
                log_determinant += determinant.ln();
                determinant = 1.0;
            }
            for i in 0..P {
                let (gain, kept_here) = (gains[i], kept[i]);
                for j in 0..P {
                    ahead[i][j] = kept_here * kept[j] * (ahead[i][j] - gain * with_sum[j]);
                }
                ahead[i][i] += shares[i] * (1.0 - kept_here * kept_here);
            }
            let mut all = [0.0; MOST_PARTS];
            all[..P].copy_from_slice(&gains);
            steps.push(Step { root, gains: all });
        }
        log_determinant += determinant.ln();
        Self {
            kept: parts.iter().map(|(_, correlation)| *correlation).collect(),
            steps,
            log_determinant,
        }
    }

    /// Σ of the squares of a column whitened.
    pub(crate) fn square(&self, column: &[f64]) -> f64 {
        let (mut states, mut expected, mut square) = ([0.0; MOST_PARTS], 0.0, 0.0);
        let (count, last) = (self.kept.len(), self.steps.len() - 1);
        for (index, entry) in column.iter().enumerate() {
            let Step { root, gains } = &self.steps[index.min(last)];
            let new = entry - expected;
            square += (new * root).powi(2);
            for i in 0..count {
                states[i] = (states[i] + gains[i] * new) * self.kept[i];
            }
            expected = states[..count].iter().sum();
        }
        square
    }
}

/// What a filter does with one sample: what came beyond expectation counts times `root`, and changes what is expected by `gain` of it; of all
/// that `kept` is left for the next.
pub(super) struct MarkovStep {
    pub(super) root: f64,
    pub(super) gain: f64,
    pub(super) kept: f64,
}
