//! How noise correlates, by sample; a noise that was found.

use std::fmt;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::autoregression::{Autoregression, MOST_ORDER};

/// Most parts of a noise.
pub(crate) const MOST_PARTS: usize = 8;

/// The least correlation time of a part of a power law, in samples.
const SHORTEST: f64 = 0.5;

/// How residuals correlate with their neighbours, by sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseModel {
    /// Not at all.
    #[default]
    White,
    /// AR(1): ρ^k at k samples.
    Autoregressive {
        /// ρ, −1 to 1.
        correlation: f64,
    },
    /// AR(p): each sample depends on the p before it.
    AutoregressiveOfOrder {
        /// p, 2 to 6.
        order: usize,
        /// Partial autocorrelations at 1 to p samples, −1 to 1; zeros behind.
        partial: [f64; MOST_ORDER],
    },
    /// White noise and AR(1): s ρ^k at k samples.
    WhiteAndAutoregressive {
        /// ρ, 0 to 1.
        correlation: f64,
        /// s, the share of the correlated part in the variance, 0 to 1.
        share: f64,
    },
    /// White noise and noise whose power goes as 1/f^a down to a lowest frequency: a sum of eight AR(1) whose correlation times τ are evenly
    /// spaced in ln τ, from half a sample to the longest, with variances as τ^(a − 1).
    PowerLaw {
        /// a: 1 for pink noise, 2 for a random walk.
        exponent: f64,
        /// Share of this part in the variance, 0 to 1.
        share: f64,
        /// The longest correlation time, in samples.
        longest: f64,
    },
    /// White noise and a random walk from the first sample on: variance 1 + q² k and covariance q² k with all that follow, k samples later.
    WhiteAndWalk {
        /// q, the standard deviation of a step from one sample to the next over that of the white noise; where samples are spaced unevenly, of
        /// a step in a mean time between samples.
        step: f64,
    },
    /// Noise whose correlation fades in time (Ornstein and Uhlenbeck), and white noise: s exp(−|t − t′|/τ).
    InTime {
        /// τ, s.
        correlation_time_s: f64,
        /// s, the share of the correlated part in the variance, 0 to 1.
        share: f64,
        /// Equivalent number of independent samples at the times of the fit: N/(1 + 2/N Σ_{i<j} s exp(−|t_i − t_j|/τ)).
        independent: f64,
    },
}

/// In one word: `white`, `AR(1)`, `AR(3)`, `white and AR(1)`, `1/f^1.2`, `white and 1/f^0.8`, `white and random walk`, `OU`.
impl fmt::Display for NoiseModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::White => f.write_str("white"),
            Self::Autoregressive { .. } => f.write_str("AR(1)"),
            Self::AutoregressiveOfOrder { order, .. } => write!(f, "AR({order})"),
            Self::WhiteAndAutoregressive { .. } => f.write_str("white and AR(1)"),
            Self::PowerLaw { exponent, share, .. } => {
                let beside = if *share < 1.0 { "white and " } else { "" };
                write!(f, "{beside}1/f^{exponent:.1}")
            }
            Self::WhiteAndWalk { .. } => f.write_str("white and random walk"),
            Self::InTime { share, .. } if *share < 1.0 => f.write_str("white and OU"),
            Self::InTime { .. } => f.write_str("OU"),
        }
    }
}

impl NoiseModel {
    /// What correlates, as AR(1) of which each has a share in the variance and a ρ; none for an autoregression of higher order.
    pub(crate) fn parts(self) -> Parts {
        match self {
            Self::White | Self::AutoregressiveOfOrder { .. } | Self::WhiteAndWalk { .. } | Self::InTime { .. } => {
                Parts::new()
            }
            Self::Autoregressive { correlation } => Parts::from_iter([(1.0, correlation)]),
            Self::WhiteAndAutoregressive { correlation, share } => Parts::from_iter([(share, correlation)]),
            Self::PowerLaw {
                exponent,
                share,
                longest,
            } => {
                let ratio = (longest / SHORTEST).powf(1.0 / (MOST_PARTS as f64 - 1.0));
                let times = || (0..MOST_PARTS as i32).map(|power| SHORTEST * ratio.powi(power));
                let sizes = times().map(|time: f64| time.powf(exponent - 1.0));
                let unit = share / sizes.clone().sum::<f64>();
                sizes.zip(times()).map(|(size, time)| (unit * size, (-1.0 / time).exp())).collect()
            }
        }
    }

    /// The same where times were in this unit, in s.
    pub(crate) fn in_unit(mut self, unit: f64) -> Self {
        if let Self::InTime { correlation_time_s, .. } = &mut self {
            *correlation_time_s *= unit;
        }
        self
    }

    /// The parts of the means of so many neighbours, as if each part were the same in all of them or changed from one to the next.
    pub(crate) fn of_means(self, together: usize) -> Parts {
        let count = together as f64;
        let mut parts = self.parts();
        let mut rest = (1.0 - parts.iter().map(|(share, _)| share).sum::<f64>()).max(0.0) / count;
        parts.retain(|(share, correlation)| {
            let lasts = correlation.powf(count);
            let slow = lasts > 0.2;
            if !slow {
                rest += *share * (1.0 + *correlation) / (1.0 - *correlation) / count;
            }
            *correlation = lasts;
            slow
        });
        let all = rest + parts.iter().map(|(share, _)| share).sum::<f64>();
        parts.iter_mut().for_each(|(share, _)| *share /= all);
        parts
    }

    /// Correlations r_k at k = 1 to `lags` samples, up to where they have faded to 1e-12; of a walk the means over so many samples, of noise in
    /// time those of AR(1) with as many independent samples among them.
    ///
    /// ```
    /// use palpate::fit::NoiseModel;
    /// let noise = NoiseModel::WhiteAndAutoregressive { correlation: 0.5, share: 0.8 };
    /// assert_eq!(noise.correlations(3), [0.4, 0.2, 0.1]);
    /// ```
    #[must_use]
    pub fn correlations(self, lags: usize) -> Vec<f64> {
        const FADED: f64 = 1e-12;
        let mut all: Vec<f64> = Vec::new();
        match self {
            Self::AutoregressiveOfOrder { order, partial } => {
                let kept = Autoregression::new(&partial[..order]);
                while all.len() < lags && (all.len() < order || all.iter().rev().take(order).any(|r| r.abs() > FADED)) {
                    // Yule and Walker: the coefficients of the order that looks back to the first sample.
                    let before = all.iter().rev().chain([&1.0]);
                    all.push(kept.at(all.len() + 1).iter().zip(before).map(|(by, before)| by * before).sum());
                }
            }
            Self::WhiteAndWalk { step } => {
                let (square, count) = (step * step, lags as f64);
                let mean = |lag: usize| 0.5 * square * (count - lag as f64) / (1.0 + 0.5 * square * count);
                all.extend((1..=lags).map(mean));
            }
            Self::InTime { independent, .. } => {
                let together = (lags as f64 / independent).max(1.0);
                let correlation = (together - 1.0) / (together + 1.0);
                return Self::Autoregressive { correlation }.correlations(lags);
            }
            _ => {
                let mut parts = self.parts();
                while all.len() < lags && all.last().is_none_or(|r: &f64| r.abs() > FADED) {
                    parts.iter_mut().for_each(|(share, correlation)| *share *= *correlation);
                    all.push(parts.iter().map(|(share, _)| share).sum());
                }
            }
        }
        all
    }

    /// Equivalent number of independent samples among `samples` of this noise: N / (1 + 2 Σ (1 − k/N) r_k) with the correlations r_k at k
    /// samples, at least two and at most N.
    ///
    /// ```
    /// use palpate::fit::NoiseModel;
    /// let noise = NoiseModel::Autoregressive { correlation: 0.5 };
    /// assert!((noise.effective_samples(300) - 100.4).abs() < 0.1);
    /// ```
    #[must_use]
    pub fn effective_samples(self, samples: usize) -> f64 {
        let count = samples as f64;
        if let Self::InTime { independent, .. } = self {
            return independent.clamp(count.min(2.0), count);
        }
        let correlations = self.correlations(samples.saturating_sub(1));
        let sum: f64 = (1..).zip(&correlations).map(|(lag, r)| (1.0 - f64::from(lag) / count) * r).sum();
        (count / (1.0 + 2.0 * sum)).clamp(count.min(2.0), count)
    }
}

/// Shares in the variance and correlations of neighbours.
pub(crate) type Parts = SmallVec<[(f64, f64); MOST_PARTS]>;

/// The noise of a fit: models of it, and how likely each is.
#[derive(Debug, Clone)]
pub(crate) struct Noise {
    /// The most likely model.
    pub(crate) model: NoiseModel,
    /// Models with their variance and their probability; those add up to 1.
    pub(crate) likely: Vec<Likely>,
}

/// A model that may have left the residuals.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Likely {
    pub(crate) model: NoiseModel,
    /// σ².
    pub(crate) variance: f64,
    pub(crate) probability: f64,
}

impl Noise {
    /// White noise of this variance.
    pub(crate) fn white(variance: f64) -> Self {
        let (model, probability) = (NoiseModel::White, 1.0);
        Self {
            model,
            likely: vec![Likely {
                model,
                variance,
                probability,
            }],
        }
    }

    /// Mean over the models of the variance of a sample, itself a mean over the samples.
    pub(crate) fn variance(&self, samples: usize) -> f64 {
        let of = |likely: &Likely| match likely.model {
            NoiseModel::WhiteAndWalk { step } => 1.0 + 0.5 * step * step * (samples as f64 - 1.0),
            _ => 1.0,
        };
        self.likely.iter().map(|likely| likely.probability * likely.variance * of(likely)).sum()
    }
}
