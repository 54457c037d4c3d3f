//! Intervals from resampled residuals: no normal distribution, no straight lines, the correlation left inside blocks.
//!
//! The moving-block bootstrap (Künsch 1989): residuals are drawn in overlapping blocks of b neighbours, added to the fitted
//! curve and fitted again, many times. With correlations r_k of the noise the block that estimates the variance of a mean
//! best has
//!
//! ```text
//! b = (6 Q²)^(1/3) N^(1/3),   Q = Σ_{k≥1} k r_k / (1 + 2 Σ_{k≥1} r_k)
//! ```
//!
//! samples, one for white noise, 52 for AR(1) noise of 0.9 in 1000 samples. Residuals are smaller than noise, and a block knows
//! nothing of correlation beyond it; both would make intervals too narrow, so that residuals are first scaled to
//! the variance of the noise ([`NoiseModel`]) times that of its long sums over that of sums of independent blocks.
//!
//! Under a robust loss the residuals are those that the loss counts (`robust.rs`), and draws are fitted by least squares. Outliers themselves would be
//! most of the samples in some draws, which no loss withstands.

use super::fitted::Point;
use crate::fit::{BootstrapOptions, Estimate, Fit, FitError, Fitted, LawOptions, NoiseModel, Parameter, condense};
use crate::laws::Law;
use crate::optimise::{Effort, Ending, refine};
use crate::random::Rng;
use crate::watch::{Cancelled, Progress};

impl Fitted {
    /// All parameters of this fit by draws: the standard error is their deviation, the interval runs between percentiles; neither
    /// where a parameter was held.
    pub(crate) fn resample(
        &mut self,
        fit: &Fit,
        options: &LawOptions,
        how: &BootstrapOptions,
        effort: &mut Effort<'_>,
    ) -> Result<Vec<Estimate>, FitError> {
        let count = self.scaled.times.len();
        let block = how.block.unwrap_or_else(|| fit.noise.block(count)).clamp(1, count);
        let mut draws: Vec<Vec<f64>> = vec![Vec::new(); fit.parameters.len()];
        if let Some(uncertainty) = &fit.uncertainty {
            let noise = (uncertainty.deviation / self.scaled.range).powi(2);
            let mut inflation =
                noise * count as f64 / self.solution.residual_square * fit.noise.cut_by_blocks(block, count);
            inflation *= self.take_as_counted();
            let urn = Urn {
                residuals: self.solution.residuals.iter().map(|r| r * inflation.sqrt()).collect(),
                values: self.scaled.values.iter().zip(&self.solution.residuals).map(|(y, r)| y - r).collect(),
                block,
            };
            let mut random = Rng::new(how.seed);
            for done in 0..how.repetitions {
                effort.reach(Progress::counted("resampling residuals", done, how.repetitions))?;
                let values = urn.draw(&mut random);
                if let Some(parameters) = self.refitted(fit.law, options, values, effort)? {
                    draws.iter_mut().zip(parameters).for_each(|(all, parameter)| all.push(parameter));
                }
            }
        }
        let summary = |(parameter, mut all): (&Parameter, Vec<f64>)| {
            let free = parameter.estimate.standard_error.is_some() && all.len() > 1;
            let value = parameter.estimate.value;
            let white_standard_error = parameter.estimate.white_standard_error;
            match free {
                true => Estimate {
                    white_standard_error,
                    ..summarized(value, &mut all, options.confidence)
                },
                false => Estimate::fixed(value),
            }
        };
        Ok(fit.parameters.iter().zip(draws).map(summary).collect())
    }
}

/// Deviation and percentiles of draws.
fn summarized(value: f64, draws: &mut [f64], confidence: f64) -> Estimate {
    draws.sort_by(f64::total_cmp);
    let count = draws.len() as f64;
    let mean = draws.iter().sum::<f64>() / count;
    let square: f64 = draws.iter().map(|draw| (draw - mean).powi(2)).sum();
    // The share α of the distribution lies below place α (B + 1), counted from one.
    let percentile = |share: f64| {
        let place = (share * (count + 1.0) - 1.0).clamp(0.0, count - 1.0);
        let (below, part) = (place.floor() as usize, place.fract());
        draws[below] + part * (draws[(below + 1).min(draws.len() - 1)] - draws[below])
    };
    Estimate {
        value,
        standard_error: Some((square / (count - 1.0)).sqrt()),
        white_standard_error: None,
        interval: Some((percentile(0.5 - 0.5 * confidence), percentile(0.5 + 0.5 * confidence))),
    }
}

/// Fitted values, and residuals to be drawn.
struct Urn {
    values: Vec<f64>,
    residuals: Vec<f64>,
    block: usize,
}

impl Urn {
    /// Fitted values with blocks of residuals.
    fn draw(&self, random: &mut Rng) -> Vec<f64> {
        let starts = self.values.len() - self.block + 1;
        let mut values = self.values.clone();
        for part in values.chunks_mut(self.block) {
            let from = ((random.uniform() * starts as f64) as usize).min(starts - 1);
            part.iter_mut().zip(&self.residuals[from..]).for_each(|(value, residual)| *value += residual);
        }
        values
    }
}

impl Fitted {
    /// All reported parameters for other values, by a search downhill from the present ones; `None` if it leads nowhere.
    fn refitted(
        &mut self,
        law: Law,
        options: &LawOptions,
        values: Vec<f64>,
        effort: &mut Effort<'_>,
    ) -> Result<Option<Vec<f64>>, Cancelled> {
        let measured = std::mem::replace(&mut self.scaled.values, values);
        let nodes = condense(&self.scaled);
        self.scaled.values = measured;
        let ending = Ending::new(1e-8, options.most_iterations);
        let refined = refine(&self.model.at(&nodes.times), nodes.target(), &self.solution.nonlinear, ending, effort)?;
        let point = Point {
            linear: &refined.point.linear,
            nonlinear: &refined.point.theta,
        };
        let all: Vec<f64> = self.quantities(law, point).iter().map(|quantity| quantity.value).collect();
        Ok(all.iter().all(|parameter| parameter.is_finite()).then_some(all))
    }
}

impl NoiseModel {
    /// Samples a block of the bootstrap, by the rule above.
    fn block(self, samples: usize) -> usize {
        let correlations = self.correlations(samples);
        let of_lags: f64 = (1..).zip(&correlations).map(|(lag, r)| f64::from(lag) * r).sum();
        let spread = (of_lags / (1.0 + 2.0 * correlations.iter().sum::<f64>())).max(0.0);
        ((6.0 * spread * spread * samples as f64).cbrt().round() as usize).clamp(1, samples.div_ceil(4))
    }

    /// Variance of long sums of this noise over that of sums of independent blocks of it: what blocks cut off.
    fn cut_by_blocks(self, block: usize, samples: usize) -> f64 {
        let correlations = self.correlations(samples);
        let within: f64 =
            (1..block).zip(&correlations).map(|(lag, r)| 2.0 * (1.0 - lag as f64 / block as f64) * r).sum();
        (1.0 + 2.0 * correlations.iter().sum::<f64>()) / (1.0 + within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::{IntervalMethod, Samples, fit_law};
    use crate::test_problems::noisy_hold;

    #[test]
    fn blocks_suit_the_noise() {
        assert_eq!(NoiseModel::White.block(1000), 1);
        // (6 (0.9/0.19)² 1000)^(1/3) = 51.3
        let noise = NoiseModel::Autoregressive { correlation: 0.9 };
        assert_eq!(noise.block(1000), 51);
        // 19/(1 + 2 Σ (1 − k/2) 0.9^k) with one lag: 19/1.9
        assert!((noise.cut_by_blocks(2, 1000) - 10.0).abs() < 1e-9);
        assert!((noise.cut_by_blocks(100_000, 100_000) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn the_same_seed_gives_the_same_intervals() {
        let (times, values) = noisy_hold(300, 1.0, 1e-2);
        let samples = Samples::new(&times, &values);
        let run = |seed: u64| {
            let how = BootstrapOptions {
                seed,
                repetitions: 99,
                ..BootstrapOptions::default()
            };
            let options = LawOptions {
                intervals: IntervalMethod::Bootstrap(how),
                ..LawOptions::default()
            };
            fit_law(&samples, Law::StandardLinearSolid, &options).unwrap()
        };
        assert_eq!(run(7), run(7));
        assert_ne!(run(7).estimate("time_constant_s"), run(8).estimate("time_constant_s"));
    }

    #[test]
    fn percentiles_of_known_draws() {
        // 1 … 99: a share of 0.05 lies below 0.05 · 100.
        let mut draws: Vec<f64> = (1..100).rev().map(f64::from).collect();
        let found = summarized(50.0, &mut draws, 0.9);
        let (low, high) = found.interval.unwrap();
        assert!((low - 5.0).abs() < 1e-12 && (high - 95.0).abs() < 1e-12);
        // Variance of 1 … n is n (n + 1)/12.
        assert!((found.standard_error.unwrap().powi(2) - 825.0).abs() < 1e-9);
    }
}
