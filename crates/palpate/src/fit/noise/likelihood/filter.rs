//! Kalman's filters of white noise with AR(1) parts, of several noises side by side: what they do with each sample, whatever the column.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8};

/// Noises side by side, and columns in one vector.
pub(super) const LANES: usize = 8;

/// What a filter does with one sample: what came beyond expectation counts times `root`, and changes what is expected by `gain` of it; of all
/// that `kept` is left for the next.
pub(super) struct MarkovStep {
    pub(super) root: f64,
    pub(super) gain: f64,
    pub(super) kept: f64,
}

/// Noises side by side, each of up to `P` parts with a share in the variance and a correlation a sample later; the rest is white.
pub(super) struct Noises<const P: usize> {
    white: [f64; LANES],
    shares: [[f64; LANES]; P],
    kept: [[f64; LANES]; P],
}

impl<const P: usize> Noises<P> {
    /// Of up to [`LANES`] noises; the last of them also in place of those that are not there.
    pub(super) fn new(noises: &[impl AsRef<[(f64, f64)]>]) -> Self {
        let of = |lane: usize| noises[lane.min(noises.len() - 1)].as_ref();
        let each = |part: usize, of_part: fn(&(f64, f64)) -> f64| {
            std::array::from_fn(|lane| of(lane).get(part).map_or(0.0, of_part))
        };
        let rest = |lane| 1.0 - of(lane).iter().map(|(share, _)| share).sum::<f64>();
        Self {
            white: std::array::from_fn(|lane| rest(lane).max(0.0)),
            shares: std::array::from_fn(|part| each(part, |part| part.0)),
            kept: std::array::from_fn(|part| each(part, |part| part.1)),
        }
    }

    /// Their filters before the first sample.
    #[inline(always)]
    pub(super) fn begun<S: Simd>(&self, simd: S) -> Filters<S, P> {
        let nothing = f64x8::splat(simd, 0.0);
        let [shares, kept] = [&self.shares, &self.kept].map(|of| of.map(|lanes| f64x8::from_slice(simd, &lanes)));
        let mut ahead = [[nothing; P]; P];
        (0..P).for_each(|i| ahead[i][i] = shares[i]);
        Filters {
            white: f64x8::from_slice(simd, &self.white),
            kept,
            both_kept: std::array::from_fn(|i| std::array::from_fn(|j| kept[i] * kept[j])),
            fresh: std::array::from_fn(|i| shares[i] * (-(kept[i] * kept[i]) + 1.0)),
            ahead,
            with_sum: [nothing; P],
            gains: [nothing; P],
            determinants: f64x8::splat(simd, 1.0),
            log_determinants: [0.0; LANES],
        }
    }
}

/// Filters side by side at a sample: each part is expected to be what it was, and its gain of what came beyond expectation, times its
/// correlation.
pub(super) struct Filters<S: Simd, const P: usize> {
    white: f64x8<S>,
    /// The correlation of each part with itself a sample later, and products of two.
    pub(super) kept: [f64x8<S>; P],
    both_kept: [[f64x8<S>; P]; P],
    /// Variance of each part that comes anew with each sample.
    fresh: [f64x8<S>; P],
    /// Covariance of the parts before the sample; its upper half.
    ahead: [[f64x8<S>; P]; P],
    /// That of each part with their sum.
    with_sum: [f64x8<S>; P],
    gains: [f64x8<S>; P],
    /// Product of some variances of what comes beyond expectation, and Σ ln of those before.
    determinants: f64x8<S>,
    log_determinants: [f64; LANES],
}

impl<S: Simd, const P: usize> Filters<S, P> {
    /// What a square of what comes beyond expectation counts, and the gains.
    #[inline(always)]
    pub(super) fn gains(&mut self) -> (f64x8<S>, [f64x8<S>; P]) {
        let nothing = self.white * 0.0;
        self.with_sum = [nothing; P];
        for i in 0..P {
            self.with_sum[i] += self.ahead[i][i];
            for j in i + 1..P {
                self.with_sum[i] += self.ahead[i][j];
                self.with_sum[j] += self.ahead[i][j];
            }
        }
        let mut innovation = self.white;
        for i in 0..P {
            innovation += self.with_sum[i];
        }
        let weight = (nothing + 1.0) / innovation;
        for i in 0..P {
            self.gains[i] = self.with_sum[i] * weight;
        }
        // One logarithm for many factors, which are at most 1.
        self.determinants *= innovation;
        if self.determinants.simd_lt(nothing + 1e-100).any_true() {
            self.settle();
        }
        (weight, self.gains)
    }

    /// To the next sample.
    #[inline(always)]
    pub(super) fn go_on(&mut self) {
        for i in 0..P {
            for j in i..P {
                self.ahead[i][j] = self.both_kept[i][j] * (self.ahead[i][j] - self.gains[i] * self.with_sum[j]);
            }
            self.ahead[i][i] += self.fresh[i];
        }
    }

    #[inline(always)]
    fn settle(&mut self) {
        let factors: [f64; LANES] = self.determinants.into();
        self.log_determinants.iter_mut().zip(factors).for_each(|(sum, factor)| *sum += factor.ln());
        self.determinants = self.white * 0.0 + 1.0;
    }

    /// ln |R| of the samples so far.
    #[inline(always)]
    pub(super) fn log_determinants(mut self) -> [f64; LANES] {
        self.settle();
        self.log_determinants
    }
}
