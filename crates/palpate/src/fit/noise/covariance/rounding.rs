//! Rounding that the noise does not dither: an error which neighbours share, and which no residual shows.

use std::f64::consts::PI;

use crate::statistics::{dot, mean};

/// Harmonics of the error that count: eleven twelfths of its square without any noise.
const HARMONICS: usize = 8;

/// Parts of a step at each of which the noise is looked at.
const PHASES: usize = 8;

/// Amplitude of a harmonic, over the step, below which it is none.
const LEAST: f64 = 1e-3;

/// Harmonics whose course is taken out of residuals before their noise is sought: beyond, what is left looks like more of it.
const FELT: usize = 3;

/// The error that values have which were rounded to a step q, about a curve f.
///
/// With white noise of the standard deviation σ beside it, the mean error of rounding is, on a grid of unknown phase φ (Widrow and Kollár,
/// Quantization Noise, 2008, chapter 4),
///
/// ```text
/// Σ_k A_k sin(2πk f/q + φ_k),   A_k = q/(πk) exp(−2π²k² σ²/q²)
/// ```
///
/// It is the same for all samples where the curve is the same, as at the end of a hold: V = Σ_k ½ A_k² cos(2πk (f_i − f_j)/q).
pub(super) struct Rounding {
    /// ½ A_k², and the sine and the cosine of 2πk f/q, times the roots of weights.
    harmonics: Vec<(f64, [Vec<f64>; 2])>,
}

impl Rounding {
    /// For values about this curve, which leave these residuals, both in one unit with the step; residuals are those times the roots of weights. `None` where
    /// noise dithers all of it.
    pub(super) fn new(curve: &[f64], residuals: &[f64], roots: Option<&[f64]>, step: f64) -> Option<Self> {
        let root = |sample: usize| roots.map_or(1.0, |roots| roots[sample]);
        let phases: Vec<f64> = curve.iter().map(|value| (value / step).rem_euclid(1.0)).collect();
        let squares = residuals.iter().enumerate().map(|(sample, left)| (left / root(sample)).powi(2));
        let share = (noise(&phases, squares) / step.powi(2) - 1.0 / 12.0).max(0.0);
        let amplitude = |k: usize| (-2.0 * (PI * k as f64).powi(2) * share).exp() / (PI * k as f64);
        let angles: Vec<(f64, f64)> = phases.iter().map(|phase| (2.0 * PI * phase).sin_cos()).collect();
        let mut waves = [vec![0.0; curve.len()], (0..curve.len()).map(root).collect::<Vec<f64>>()];
        let mut harmonics = Vec::new();
        for k in (1..=HARMONICS).take_while(|k| amplitude(*k) > LEAST) {
            let [sines, cosines] = &mut waves;
            for ((sine, cosine), (s, c)) in sines.iter_mut().zip(cosines).zip(&angles) {
                (*sine, *cosine) = (*sine * c + *cosine * s, *cosine * c - *sine * s);
            }
            harmonics.push((0.5 * (amplitude(k) * step).powi(2), waves.clone()));
        }
        (!harmonics.is_empty()).then_some(Self { harmonics })
    }

    /// Columns that have the course of the error.
    pub(super) fn waves(&self) -> impl Iterator<Item = &[f64]> {
        self.harmonics.iter().take(FELT).flat_map(|(_, waves)| waves).map(Vec::as_slice)
    }

    /// JᵀVJ.
    pub(super) fn quadratic(&self, columns: &[&[f64]]) -> Vec<f64> {
        let size = columns.len();
        let mut product = vec![0.0; size * size];
        for (variance, waves) in &self.harmonics {
            for wave in waves {
                let along: Vec<f64> = columns.iter().map(|column| dot(column, wave)).collect();
                for (row, one) in product.chunks_exact_mut(size).zip(&along) {
                    row.iter_mut().zip(&along).for_each(|(entry, other)| *entry += variance * one * other);
                }
            }
        }
        product
    }
}

/// Mean square of residuals that are spread evenly over the steps: σ² + q²/12. Most of them may lie at one place of a step, where rounding leaves
/// anything from none of the noise to four times as much.
fn noise(phases: &[f64], squares: impl Iterator<Item = f64>) -> f64 {
    let (mut sums, mut counts) = ([0.0; PHASES], [0_usize; PHASES]);
    for (phase, square) in phases.iter().zip(squares) {
        let part = ((phase * PHASES as f64) as usize).min(PHASES - 1);
        sums[part] += square;
        counts[part] += 1;
    }
    let means = sums.iter().zip(counts).filter(|(_, count)| *count > 0).map(|(sum, count)| sum / count as f64);
    mean(&means.collect::<Vec<f64>>())
}
