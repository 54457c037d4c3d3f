//! Kalman's filters of white noise with AR(1) parts, of several noises side by side: what they do with each sample, whatever the column.
//!
//! Noise that has settled needs no covariance matrix of its parts: from a sample to the next it falls by c l lᵀ, and c and l go on by themselves
//! (Morf, Sidhu and Kailath 1974).

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
        let one = f64x8::splat(simd, 1.0);
        let [with_sum, kept] = [&self.shares, &self.kept].map(|of| of.map(|lanes| f64x8::from_slice(simd, &lanes)));
        let innovation = f64x8::from_slice(simd, &self.white) + sum(&with_sum);
        let weight = one / innovation;
        Filters {
            kept,
            innovation,
            weight,
            with_sum,
            gains: with_sum.map(|with_sum| with_sum * weight),
            along: std::array::from_fn(|i| kept[i] * with_sum[i]),
            fall: weight,
            determinants: one,
            log_determinants: [0.0; LANES],
        }
    }
}

/// Filters side by side at a sample: each part is expected to be what it was, and its gain of what came beyond expectation, times its
/// correlation.
pub(super) struct Filters<S: Simd, const P: usize> {
    /// The correlation of each part with itself a sample later.
    pub(super) kept: [f64x8<S>; P],
    /// Variance of what comes beyond expectation, and one over it: what its square counts.
    innovation: f64x8<S>,
    pub(super) weight: f64x8<S>,
    /// Covariance of each part before the sample with the sum of all.
    with_sum: [f64x8<S>; P],
    pub(super) gains: [f64x8<S>; P],
    /// l and c.
    along: [f64x8<S>; P],
    fall: f64x8<S>,
    /// Product of some variances of what comes beyond expectation, and Σ ln of those before.
    determinants: f64x8<S>,
    log_determinants: [f64; LANES],
}

impl<S: Simd, const P: usize> Filters<S, P> {
    /// To the next sample.
    #[inline(always)]
    pub(super) fn go_on(&mut self) {
        // One logarithm for many factors, which are at most 1.
        self.determinants *= self.innovation;
        if self.determinants.simd_lt(self.determinants * 0.0 + 1e-100).any_true() {
            self.settle();
        }
        let sum = sum(&self.along);
        let by = self.fall * sum;
        let before = self.weight;
        self.innovation -= by * sum;
        self.weight = (before * 0.0 + 1.0) / self.innovation;
        self.fall *= self.innovation * before;
        for i in 0..P {
            self.with_sum[i] -= by * self.along[i];
            self.gains[i] = self.with_sum[i] * self.weight;
            self.along[i] = self.kept[i] * (self.along[i] - self.gains[i] * sum);
        }
    }

    #[inline(always)]
    fn settle(&mut self) {
        let factors: [f64; LANES] = self.determinants.into();
        self.log_determinants.iter_mut().zip(factors).for_each(|(sum, factor)| *sum += factor.ln());
        self.determinants = self.determinants * 0.0 + 1.0;
    }

    /// ln |R| of the samples so far.
    #[inline(always)]
    pub(super) fn log_determinants(mut self) -> [f64; LANES] {
        self.settle();
        self.log_determinants
    }
}

#[inline(always)]
fn sum<S: Simd, const P: usize>(parts: &[f64x8<S>; P]) -> f64x8<S> {
    let mut sum = parts[0];
    for part in &parts[1..] {
        sum += *part;
    }
    sum
}
