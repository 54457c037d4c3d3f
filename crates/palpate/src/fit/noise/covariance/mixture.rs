//! Errors and intervals of many numbers side by side, where several models of the noise are likely.

use smallvec::SmallVec;

use super::uncertainty::{Scale, Uncertainty};
use crate::fit::Estimate;
use crate::statistics::{coverage_factor, normal_factor};
use crate::vector::accelerated;
use crate::vector::elementary::{exp, ln, ln_1p};
use crate::vector::normal::scaled_tail;

/// Half an interval in ln beyond which the data leave a parameter open: its curvature then says nothing of where it ends.
const OPEN: f64 = 6.907_755_278_982_137; // ln 1000

/// The coverage of the intervals that standard errors are taken from.
const USUAL: f64 = 0.95;

/// Numbers side by side: two of the widest vectors, since one would wait for its own roots and quotients.
const LANES: usize = 16;

type Lanes = [f64; LANES];

impl Uncertainty {
    /// Estimates of `values`, with standard errors that are halves of 95 % intervals over the quantile of Student's t: what some model with a
    /// small probability and a large variance adds to the mean of variances is no measure of how far an estimate strays.
    ///
    /// Column a of `gradients` has the derivatives by parameter a (of ln value on the logarithmic scale), and the variances `added` come on top;
    /// `white` is the covariance of the parameters if noise were white.
    pub(crate) fn estimates(
        &self,
        values: &[f64],
        gradients: &[impl AsRef<[f64]>],
        white: &[Vec<f64>],
        added: impl Fn(usize) -> f64,
        scale: impl Fn(usize) -> Scale,
    ) -> Vec<Estimate> {
        let mut mixture = Mixture::new(self, self.confidence);
        let mut usual = (self.confidence != USUAL).then(|| Mixture::new(self, USUAL));
        let of_usual = coverage_factor(USUAL, self.freedom);
        let mut found = Vec::with_capacity(values.len());
        for (index, some) in values.chunks(LANES).enumerate() {
            let block: SmallVec<[Lanes; 8]> =
                gradients.iter().map(|column| lanes(&column.as_ref()[index * LANES..])).collect();
            let added: Lanes = std::array::from_fn(|lane| added((index * LANES + lane).min(values.len() - 1)));
            let halves = mixture.halves(&block, &added);
            let errors =
                usual.as_mut().map_or(halves, |usual| usual.halves(&block, &added)).map(|half| half / of_usual);
            let white = variances(&block, white);
            for (lane, value) in some.iter().enumerate() {
                let white = (white[lane] + added[lane]).sqrt();
                found.push(estimate(*value, [errors[lane], white, halves[lane]], scale(index * LANES + lane)));
            }
        }
        found
    }

    /// Standard errors of the parameters.
    pub(super) fn standard_errors(&self) -> Vec<f64> {
        let size = self.covariance.len();
        let mut usual = Mixture::new(self, USUAL);
        let of_usual = coverage_factor(USUAL, self.freedom);
        let mut found = Vec::with_capacity(size);
        for first in (0..size).step_by(LANES) {
            let block: SmallVec<[Lanes; 8]> = (0..size)
                .map(|row| std::array::from_fn(|lane| if (first + lane).min(size - 1) == row { 1.0 } else { 0.0 }))
                .collect();
            let halves = usual.halves(&block, &[0.0; LANES]);
            found.extend(halves.iter().take(size - first).map(|half| half / of_usual));
        }
        found
    }

    /// Half an interval over the root of the variance of a number with this gradient.
    pub(crate) fn factor(&self, gradient: &[f64]) -> f64 {
        let block: SmallVec<[Lanes; 8]> = gradient.iter().map(|entry| [*entry; LANES]).collect();
        Mixture::new(self, self.confidence).halves(&block, &[0.0; LANES])[0]
            / variances(&block, &self.covariance)[0].sqrt()
    }
}

/// The first of a column, the last of them also in place of those that are not there.
fn lanes(column: &[f64]) -> Lanes {
    column
        .first_chunk()
        .copied()
        .unwrap_or_else(|| std::array::from_fn(|lane| column[lane.min(column.len() - 1)]))
}

/// An estimate from its standard error, that for white noise, and half of its interval.
fn estimate(value: f64, [error, white, half]: [f64; 3], scale: Scale) -> Estimate {
    if scale == Scale::Log && half > OPEN {
        return Estimate {
            interval: Some((0.0, f64::INFINITY)),
            ..Estimate::fixed(value)
        };
    }
    let (unit, interval) = match scale {
        Scale::Linear => (1.0, (value - half, value + half)),
        Scale::Log => (value.abs(), (value * (-half).exp(), value * half.exp())),
    };
    let (error, white) = (unit * error, unit * white);
    let good = [error, white, interval.0, interval.1].iter().all(|found| found.is_finite());
    Estimate {
        value,
        standard_error: good.then_some(error),
        white_standard_error: good.then_some(white),
        interval: good.then_some(interval),
    }
}

/// The models of an uncertainty, ready for intervals of its coverage c.
///
/// Half an interval of a number of variance v is h = k √v with Σ_m w_m Q(z_m) = (1 − c)/2, where Q is the tail of the normal distribution, and
/// z² = z_c² ln(1 + h²/(ν v_m))/ln(1 + t_c²/ν) Wallace's transform of Student's t, scaled to be exact for one model: t_c and z_c are the
/// quantiles of Student's and of the normal distribution.
struct Mixture<'a> {
    uncertainty: &'a Uncertainty,
    /// c.
    confidence: f64,
    /// t_c.
    alone: f64,
    /// z² over ln(1 + h²/(ν v_m)).
    square: f64,
    /// Factors that were found before, and how they go on: along a curve they change slowly.
    near: [f64; 2],
}

impl<'a> Mixture<'a> {
    fn new(uncertainty: &'a Uncertainty, confidence: f64) -> Self {
        let alone = coverage_factor(confidence, uncertainty.freedom);
        let square = match uncertainty.models.len() {
            0 => f64::NAN,
            _ => normal_factor(confidence).powi(2) / (alone * alone / uncertainty.freedom).ln_1p(),
        };
        Self {
            uncertainty,
            confidence,
            alone,
            square,
            near: [alone, 1.0],
        }
    }

    /// Halves of intervals.
    fn halves(&mut self, block: &[Lanes], added: &Lanes) -> Lanes {
        let Uncertainty { covariance, models, .. } = self.uncertainty;
        let variance = variances(block, covariance);
        let variance: Lanes = std::array::from_fn(|lane| variance[lane] + added[lane]);
        let errors = variance.map(f64::sqrt);
        if models.is_empty() {
            return errors.map(|error| error * self.alone);
        }
        let ratios: SmallVec<[(f64, Lanes); 16]> = models
            .iter()
            .map(|model| {
                let own = variances(block, &model.covariance);
                (model.probability, std::array::from_fn(|lane| variance[lane] / (own[lane] + added[lane])))
            })
            .collect();
        let factors = accelerated(
            #[inline(always)]
            || self.factors(&ratios),
        );
        let [.., before, last] = factors;
        self.near = [last, last / before];
        // What no parameter moves has no interval under any model.
        std::array::from_fn(|lane| if errors[lane] > 0.0 { errors[lane] * factors[lane] } else { errors[lane] })
    }

    /// The factors k for weights of models and ratios v/v_m, by Halley's method for ln k: the logarithm of a tail is about straight in that of k.
    #[inline(always)]
    fn factors(&self, ratios: &[(f64, Lanes)]) -> Lanes {
        /// Step of ln k whose cube is nothing: the next would be as long as that.
        const ENOUGH: f64 = 1e-3;
        let freedom = self.uncertainty.freedom;
        let target = 0.5 * (1.0 - self.confidence);
        // Each model alone would have a factor between these.
        let (mut low, mut high) = ([f64::INFINITY; LANES], [0.0; LANES]);
        for (_, ratio) in ratios {
            for lane in 0..LANES {
                let own = self.alone / ratio[lane].sqrt();
                low[lane] = if own < low[lane] { own } else { low[lane] };
                high[lane] = if own > high[lane] { own } else { high[lane] };
            }
        }
        let possible: [bool; LANES] = std::array::from_fn(|lane| low[lane] > 0.0 && high[lane] < f64::INFINITY);
        let [last, growth] = self.near;
        let mut going_on = last;
        let mut k: Lanes = std::array::from_fn(|lane| {
            going_on *= growth;
            going_on.min(high[lane]).max(low[lane])
        });
        for _ in 0..40 {
            // The tail, and its first and second derivative by ln k over −1/√(2π) and 1/√(2π).
            let (mut tail, mut fall, mut bend) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for (weight, ratio) in ratios {
                for lane in 0..LANES {
                    let x = k[lane] * k[lane] * ratio[lane] / freedom;
                    let square = self.square * ln_1p(x);
                    let z = square.sqrt();
                    let density = weight * exp(-0.5 * square);
                    tail[lane] += density * scaled_tail(z);
                    let inverse = 1.0 / ((1.0 + x) * z);
                    let by_log = self.square * x * inverse;
                    fall[lane] += density * by_log;
                    bend[lane] += density * by_log * (by_log * z + by_log * (1.0 + x) * inverse - 2.0 * z * inverse);
                }
            }
            let mut moves = false;
            for lane in 0..LANES {
                let found = if tail[lane] > f64::MIN_POSITIVE { tail[lane] } else { f64::MIN_POSITIVE };
                let beyond = ln(found / target);
                low[lane] = if beyond > 0.0 { k[lane] } else { low[lane] };
                high[lane] = if beyond > 0.0 { high[lane] } else { k[lane] };
                let slope = ROOT * fall[lane] / found;
                let straight = beyond / slope;
                let step = straight / (1.0 + 0.5 * straight * (slope - bend[lane] / fall[lane]));
                let next = k[lane] * exp(step);
                let inside = next >= low[lane] && next <= high[lane];
                k[lane] = if inside { next } else { (low[lane] * high[lane]).sqrt() };
                moves |= step.abs() > ENOUGH || (step.is_nan() && possible[lane]);
            }
            if !moves {
                break;
            }
        }
        std::array::from_fn(|lane| if possible[lane] { k[lane] } else { f64::NAN })
    }
}

/// 1/√(2π).
const ROOT: f64 = 0.398_942_280_401_432_7;

/// gᵀ C g of gradients side by side.
fn variances(block: &[Lanes], covariance: &[Vec<f64>]) -> Lanes {
    accelerated(
        #[inline(always)]
        || {
            let mut all = [0.0; LANES];
            for (row, one) in covariance.iter().zip(block) {
                let mut sum = [0.0; LANES];
                for (entry, other) in row.iter().zip(block) {
                    for lane in 0..LANES {
                        sum[lane] += entry * other[lane];
                    }
                }
                for lane in 0..LANES {
                    all[lane] += one[lane] * sum[lane];
                }
            }
            if all.iter().any(|variance| *variance < 0.0) {
                at_least_rounding(all, block, covariance)
            } else {
                all
            }
        },
    )
}

/// Variances of which some are below 0: large products took each other away, and what is left is known to their rounding.
#[inline(never)]
fn at_least_rounding(variances: Lanes, block: &[Lanes], covariance: &[Vec<f64>]) -> Lanes {
    /// Roundings that may add up.
    const ROUNDINGS: f64 = 8.0;
    std::array::from_fn(|lane| {
        let row = |row: &Vec<f64>| row.iter().zip(block).map(|(entry, g)| (entry * g[lane]).abs()).sum::<f64>();
        let all: f64 = covariance.iter().zip(block).map(|(entries, g)| g[lane].abs() * row(entries)).sum();
        if variances[lane] < 0.0 { ROUNDINGS * f64::EPSILON * all } else { variances[lane] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::noise::ModelCovariance;
    use crate::statistics::two_sided_p;
    use crate::vector::tests::on_every_level;

    /// Two parameters, and models of which some have far wider errors.
    fn mixture(freedom: f64, confidence: f64, spreads: &[(f64, f64)]) -> Uncertainty {
        let model = |(probability, spread): &(f64, f64)| ModelCovariance {
            probability: *probability,
            covariance: vec![vec![spread * spread, 0.1], vec![0.1, 2.0]],
        };
        let models: Vec<ModelCovariance> = spreads.iter().map(model).collect();
        let entry = |i: usize, j: usize| models.iter().map(|model| model.probability * model.covariance[i][j]).sum();
        Uncertainty {
            confidence,
            freedom,
            deviation: 1.0,
            covariance: (0..2).map(|i| (0..2).map(|j| entry(i, j)).collect()).collect(),
            models,
        }
    }

    #[test]
    fn intervals_have_the_coverage_of_the_mixture() {
        let gradients = [(0..11).map(|i| 0.2 * f64::from(i)).collect::<Vec<f64>>(), vec![1.0; 11]];
        for (freedom, confidence) in [(3.0, 0.95), (20.0, 0.5), (996.0, 0.999)] {
            let found = mixture(freedom, confidence, &[(0.7, 1.0), (0.29, 3.0), (0.01, 50.0)]);
            let halves = on_every_level(|| {
                let all = found.estimates(&[0.0; 11], &gradients, &found.covariance, |_| 0.5, |_| Scale::Linear);
                all.iter().map(|estimate| estimate.interval.unwrap().1).collect()
            });
            let alone = coverage_factor(confidence, freedom);
            let unit = normal_factor(confidence) / (freedom * (alone * alone / freedom).ln_1p()).sqrt();
            for (i, half) in halves.iter().enumerate() {
                let beyond = |model: &ModelCovariance| {
                    let (c, g) = (&model.covariance, gradients[0][i]);
                    let variance = c[0][0] * g * g + 2.0 * c[0][1] * g + c[1][1] + 0.5;
                    two_sided_p(unit * (freedom * (half * half / variance / freedom).ln_1p()).sqrt())
                };
                let all: f64 = found.models.iter().map(|model| model.probability * beyond(model)).sum();
                assert!((all / (1.0 - confidence) - 1.0).abs() < 1e-9, "{freedom} {i}: {all}");
            }
        }
    }

    /// Standard errors were 1.4 to 7 times the scatter of estimates under white noise, where a walk of a few per cent probability is wide.
    #[test]
    fn a_wide_model_that_is_hardly_likely_hardly_widens_a_standard_error() {
        let at = |confidence: f64| {
            let found = mixture(1e4, confidence, &[(0.97, 1.0), (0.03, 30.0)]);
            found
                .estimates(&[0.0], &[[1.0], [0.0]], &found.covariance, |_| 0.0, |_| Scale::Linear)
                .swap_remove(0)
        };
        let estimate = at(0.95);
        let error = estimate.standard_error.unwrap();
        assert!(error < 1.5, "{error}");
        assert!((estimate.interval.unwrap().1 / error / coverage_factor(0.95, 1e4) - 1.0).abs() < 1e-12);
        // Whatever intervals are wanted.
        assert!((at(0.8).standard_error.unwrap() / error - 1.0).abs() < 1e-9);
    }

    #[test]
    fn models_of_one_spread_are_one_model() {
        let found = mixture(12.0, 0.9, &[(0.4, 2.0), (0.6, 2.0)]);
        let factor = found.factor(&[1.0, 0.3]);
        assert!((factor / coverage_factor(0.9, 12.0) - 1.0).abs() < 1e-12, "{factor}");
        assert!(found.factor(&[0.0, 0.0]).is_nan());
    }
}
