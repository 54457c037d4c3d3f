//! Which noise left the residuals of a fit.

use super::autoregression::{MOST_ORDER, innovations};
use super::likelihood::{Beside, Kind, Lagged, Likelihood, Slow, first_order};
use super::model::{Likely, Noise, NoiseModel};
use super::residuals::Residuals;
use crate::statistics::dot;
use crate::vector::block_sums;

/// Fall of −2 ln L that one more parameter of the noise has to bring.
const EVIDENCE: f64 = 4.0;

/// Probability of a walk beside white noise over that of white noise alone, before the residuals say anything; and that of AR(1) for few samples.
const WALKS: f64 = 0.3;
const CORRELATES: f64 = 1.5;

/// Up to so many samples any correlation may be, whatever the residuals show.
const FEW: usize = 40;

/// Up to so many samples residuals seldom show how many samples noise looks back, or that it is slow.
const SHORT: usize = 150;

/// Where the search for a partial autocorrelation begins that residuals do not show.
const NEXT: f64 = 0.02;

/// Means of neighbours that show a walk beside white noise.
const MEANS: usize = 64;

/// A hold of so many correlation times of its noise shows that it is no walk.
const OUTLASTED: f64 = 25.0;

/// A kind whose price is that much above the least one is left aside: it has a probability of some percent.
const COUNTS: f64 = 7.0;

impl Noise {
    /// The noise that left these residuals beside a fit with this Jacobian, whose columns may have any size; `times` where samples are spaced
    /// unevenly: models have their unit.
    ///
    /// Of a long series stretches, evenly spread, say how it correlates; its size comes from all samples.
    pub(crate) fn of(jacobian: &[&[f64]], left: &Residuals<'_>, times: Option<&[f64]>) -> Self {
        let (residuals, partial) = (left.values, &left.partial);
        let (samples, parameters) = (residuals.len(), jacobian.len());
        let white = Self::white(left.square / (samples - parameters) as f64);
        if samples < 8 || left.square <= f64::MIN_POSITIVE * 1e20 {
            return white;
        }
        let is_slow = left.lasts
            || match partial.is_empty() {
                true => drifts(residuals, parameters),
                false => drifts(&innovations(residuals, partial), parameters),
            };
        let is_short = samples <= STRETCHES * STRETCH;
        if samples <= FEW {
            return few_samples(jacobian, residuals, times).and_then(Kinds::noise).unwrap_or(white);
        }
        if partial.is_empty() && !is_slow && (times.is_none() || !is_short) {
            let kinds = beside_white(&Beside::new(jacobian, residuals, times, MEANS));
            return kinds.and_then(Kinds::noise).unwrap_or(white);
        }
        if is_short {
            let series = Series {
                jacobian,
                residuals,
                length: samples,
                samples,
            };
            return series.noise(partial, is_slow, times).unwrap_or(white);
        }
        let few: Vec<Vec<f64>> = jacobian.iter().copied().chain([residuals]).map(stretches).collect();
        let columns: Vec<&[f64]> = few[..parameters].iter().map(Vec::as_slice).collect();
        let left = few[parameters].as_slice();
        let series = Series {
            jacobian: &columns,
            residuals: left,
            length: STRETCH,
            samples,
        };
        let Some(mut noise) = series.noise(partial, is_slow, None) else {
            return white;
        };
        let scale = white.variance(samples) / (dot(left, left) / (left.len() - parameters) as f64);
        if scale.is_finite() {
            noise.likely.iter_mut().for_each(|likely| likely.variance *= scale);
        }
        noise
    }
}

/// Residuals beside the columns of a fit of `samples`, in series of `length` samples that are independent of each other.
struct Series<'a> {
    jacobian: &'a [&'a [f64]],
    residuals: &'a [f64],
    length: usize,
    samples: usize,
}

impl Series<'_> {
    /// The noise that left them, of every kind that may have.
    fn noise(&self, partial: &[f64], is_slow: bool, times: Option<&[f64]>) -> Option<Noise> {
        let Self {
            jacobian,
            residuals,
            length,
            samples,
        } = *self;
        let order = partial.len().max(1);
        let lagged = Lagged::new(jacobian, residuals, length, order);
        let white = lagged.likelihood(&vec![0.0; order])?;
        let mut kinds = Kinds::white(white);
        let start = if partial.is_empty() { &[0.1] } else { partial };
        let alike = order > 1 && start.iter().all(|by| *by > 0.0);
        kinds.take(lagged.noise(start), if alike { 2 * order } else { order });
        if order > 1 {
            // An autoregression that needs several samples, all of them alike, may stand for slow noise.
            kinds.take(Lagged::new(jacobian, residuals, length, 1).noise(&start[..1]), 1);
        }
        if !partial.is_empty() && samples <= SHORT && order < MOST_ORDER {
            let one_more: Vec<f64> = start.iter().copied().chain([NEXT]).collect();
            kinds.take(Lagged::new(jacobian, residuals, length, order + 1).noise(&one_more), order + 1);
        }
        if is_slow || alike {
            let slow = Slow::new(jacobian, residuals, length, samples);
            // Two parameters, and a walk or a power law is as good an account of a slow drift: priced as three.
            kinds.take(slow.mixture(kinds.worth(3)), 3);
            // Most white residuals that look slow are done with here.
            if kinds.least() < white.deviance {
                slow.power_laws(|kind| {
                    kinds.take(kind, 1);
                    kinds.worth(1)
                });
            }
        }
        if length == samples {
            let beside = Beside::new(jacobian, residuals, times, samples);
            if times.is_some() {
                kinds.take(beside.in_time(true, kinds.worth(1)), 1);
                kinds.take(beside.in_time(false, kinds.worth(2)), 2);
            }
            // Noise that fades well within a long hold is no walk.
            if is_slow
                || alike
                || samples <= SHORT
                || partial.first().is_none_or(|by| *by > 1.0 - OUTLASTED / samples as f64)
            {
                kinds.take_walks(&beside);
            }
        }
        kinds.noise()
    }
}

/// Kinds that few samples leave possible.
fn few_samples(jacobian: &[&[f64]], residuals: &[f64], times: Option<&[f64]>) -> Option<Kinds> {
    let beside = Beside::new(jacobian, residuals, times, residuals.len());
    let mut kinds = Kinds::white(beside.white()?);
    let in_time = beside.fading();
    let each = if in_time.is_empty() { CORRELATES } else { 0.5 * CORRELATES };
    kinds.take_all(&first_order(jacobian, residuals), each);
    kinds.take_all(&in_time, each);
    Some(kinds)
}

/// White noise, and a walk beside it.
fn beside_white(beside: &Beside<'_>) -> Option<Kinds> {
    let mut kinds = Kinds::white(beside.white()?);
    kinds.take_walks(beside);
    Some(kinds)
}

/// Kinds of noise with their prices: the deviance, and what the parameters cost.
struct Kinds {
    priced: Vec<(f64, Kind)>,
}

impl Kinds {
    fn white(found: Likelihood) -> Self {
        let alone = Likely {
            model: NoiseModel::White,
            variance: found.variance,
            probability: 1.0,
        };
        let kind = Kind {
            deviance: found.deviance,
            model: NoiseModel::White,
            likely: vec![alone],
        };
        Self {
            priced: vec![(found.deviance, kind)],
        }
    }

    /// Models that stand for a kind, all of them alike, and as probable together as `odds` to that of white noise.
    fn take_all(&mut self, points: &[(Likelihood, NoiseModel)], odds: f64) {
        /// A model of a smaller share of its kind is left out.
        const LEAST: f64 = 1e-2;
        let Some((best, model)) = points.iter().min_by(|a, b| a.0.deviance.total_cmp(&b.0.deviance)).copied() else {
            return;
        };
        let share = |found: &Likelihood| (0.5 * (best.deviance - found.deviance)).exp();
        let all: f64 = points.iter().map(|(found, _)| share(found)).sum();
        let price = best.deviance - 2.0 * (odds * all / points.len() as f64).ln();
        let likely = points.iter().filter(|(found, _)| share(found) > LEAST * all).map(|(found, model)| Likely {
            model: *model,
            variance: found.variance,
            probability: share(found) / all,
        });
        let kind = Kind {
            deviance: best.deviance,
            model,
            likely: likely.collect(),
        };
        self.priced.push((price, kind));
    }

    /// Walks beside white noise, as probable together as [`WALKS`] says.
    fn take_walks(&mut self, beside: &Beside<'_>) {
        let (walks, part) = beside.walks(self.least());
        self.take_all(&walks, WALKS * part);
    }

    fn take(&mut self, kind: Option<Kind>, parameters: usize) {
        self.priced.extend(kind.map(|kind| (kind.deviance + EVIDENCE * parameters as f64, kind)));
    }

    fn least(&self) -> f64 {
        self.priced.iter().fold(f64::INFINITY, |least, (price, _)| least.min(*price))
    }

    /// The deviance below which one more kind of so many parameters counts.
    fn worth(&self, parameters: usize) -> f64 {
        self.least() + COUNTS - EVIDENCE * parameters as f64
    }

    /// All that count, by their probability.
    fn noise(self) -> Option<Noise> {
        let least = self.least();
        let share = |price: f64| (0.5 * (least - price)).exp();
        let model = self.priced.iter().find(|(price, _)| *price <= least)?.1.model;
        let counting = || self.priced.iter().filter(|(price, _)| *price <= least + COUNTS);
        let all: f64 = counting().map(|(price, _)| share(*price)).sum();
        let likely = counting().flat_map(|(price, kind)| {
            let of_kind = share(*price) / all;
            kind.likely.iter().map(move |likely| Likely {
                probability: of_kind * likely.probability,
                ..*likely
            })
        });
        Some(Noise {
            model,
            likely: likely.collect(),
        })
    }
}

/// Stretches of a long series, and samples of each.
const STRETCHES: usize = 8;

const STRETCH: usize = 1024;

/// Stretches of a series from its start to its end, side by side.
fn stretches(series: &[f64]) -> Vec<f64> {
    let apart = (series.len() - STRETCH) / (STRETCHES - 1);
    (0..STRETCHES).flat_map(|i| &series[i * apart..i * apart + STRETCH]).copied().collect()
}

/// Whether sums over blocks show a slow drift that is lost between neighbours, by two and a half standard deviations of white noise.
fn drifts(series: &[f64], parameters: usize) -> bool {
    let square = dot(series, series);
    let beyond = |length: usize| {
        let blocks = (series.len() / length) as f64;
        let sums = block_sums(series, length);
        dot(&sums, &sums) / square > 1.0 - parameters as f64 / blocks + 2.5 * (2.0 / blocks).sqrt()
    };
    let length = series.len().isqrt();
    beyond(length) || (series.len() >= 64 && (beyond(length / 3) || beyond(3 * length)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::NoiseModel;
    use crate::fit::noise::autoregression::Autoregression;
    use crate::fit::noise::covariance::Columns;
    use crate::fit::noise::likelihood::Likelihood;
    use crate::optimise::Cholesky;
    use crate::vector::cross_products;

    /// Noise of this model from a fixed sequence.
    fn simulated(model: NoiseModel, samples: usize, seed: u64) -> Vec<f64> {
        let mut random = crate::test_problems::Rng::new(seed);
        if let NoiseModel::AutoregressiveOfOrder { order, partial } = model {
            let kept = Autoregression::new(&partial[..order]);
            let mut made: Vec<f64> = Vec::new();
            for index in 0..samples {
                let predicted: f64 = kept.at(index).iter().zip(made.iter().rev()).map(|(by, before)| by * before).sum();
                made.push(predicted + kept.variance_at(index).sqrt() * random.normal());
            }
            return made;
        }
        let parts = model.parts();
        let white = (1.0 - parts.iter().map(|(share, _)| share).sum::<f64>()).max(0.0);
        let mut states: Vec<f64> = parts.iter().map(|_| random.normal()).collect();
        let mut next = || {
            let now = parts.iter().zip(&states).map(|((share, _), state)| share.sqrt() * state).sum::<f64>();
            let now = now + white.sqrt() * random.normal();
            for ((_, rho), state) in parts.iter().zip(&mut states) {
                *state = rho * *state + (1.0 - rho * rho).sqrt() * random.normal();
            }
            now
        };
        (0..samples).map(|_| next()).collect()
    }

    /// A line: columns 1 and i/N.
    fn line(samples: usize) -> [Vec<f64>; 2] {
        [vec![1.0; samples], (0..samples).map(|i| i as f64 / samples as f64).collect()]
    }

    /// Residuals of a straight line.
    fn without_line(noise: &[f64]) -> Vec<f64> {
        let columns = line(noise.len());
        let mut gram = vec![0.0; 4];
        cross_products(&columns, &columns, &mut gram);
        let mut linear = vec![dot(&columns[0], noise), dot(&columns[1], noise)];
        Cholesky::new(&gram, 2).unwrap().solve(&mut linear);
        let value = |i: usize| noise[i] - linear[0] * columns[0][i] - linear[1] * columns[1][i];
        (0..noise.len()).map(value).collect()
    }

    fn found(noise: &[f64]) -> Noise {
        let columns = line(noise.len());
        let left = without_line(noise);
        Noise::of(&[&columns[0], &columns[1]], &Residuals::of(&left, 2), None)
    }

    /// All correlations, row by row, in series of `length` samples.
    fn dense(model: NoiseModel, samples: usize, length: usize) -> Vec<f64> {
        let mut all = model.correlations(samples);
        all.resize(samples, 0.0);
        let entry = |row: usize, column: usize| match row.abs_diff(column) {
            0 => 1.0,
            _ if row / length != column / length => 0.0,
            lag => all[lag - 1],
        };
        (0..samples * samples).map(|at| entry(at / samples, at % samples)).collect()
    }

    const SEVERAL: NoiseModel = NoiseModel::AutoregressiveOfOrder {
        order: 3,
        partial: [0.7, -0.4, 0.3, 0.0, 0.0, 0.0],
    };

    #[test]
    fn recursions_agree_with_whole_matrices() {
        const COUNT: usize = 40;
        let columns = line(COUNT);
        let jacobian = [columns[0].as_slice(), columns[1].as_slice()];
        let residuals = without_line(&simulated(NoiseModel::White, COUNT, 3));
        let all = [jacobian[0], jacobian[1], &residuals];
        let alone = NoiseModel::Autoregressive { correlation: -0.6 };
        let slow = [
            NoiseModel::WhiteAndAutoregressive {
                correlation: 0.7,
                share: 0.6,
            },
            NoiseModel::PowerLaw {
                exponent: 1.3,
                share: 0.8,
                longest: 160.0,
            },
        ];
        for length in [COUNT, COUNT / 2] {
            let lagged = |order| Lagged::new(&jacobian, &residuals, length, order);
            let by_lags = [
                (alone, lagged(1).likelihood(&[-0.6])),
                (alone, lagged(4).likelihood(&[-0.6, 0.0, 0.0, 0.0])),
                (SEVERAL, lagged(3).likelihood(&[0.7, -0.4, 0.3])),
            ];
            let filtered = Slow::new(&jacobian, &residuals, length, COUNT);
            let side_by_side = slow.into_iter().zip(filtered.likelihoods(&slow.map(Some)));
            for (model, quick) in by_lags.into_iter().chain(side_by_side) {
                let factor = Cholesky::new(&dense(model, COUNT, length), COUNT).unwrap();
                let solved = all.map(|column| {
                    let mut solved = column.to_vec();
                    factor.solve(&mut solved);
                    solved
                });
                let product: Vec<f64> = (0..9).map(|at| dot(all[at / 3], &solved[at % 3])).collect();
                let whole = Likelihood::of(&product, factor.log_determinant(), COUNT).unwrap();
                let quick = quick.unwrap();
                let pair = (quick.deviance, whole.deviance);
                assert!((pair.0 - pair.1).abs() < 1e-9, "{model:?} {length}: {pair:?}");
                assert!((quick.variance / whole.variance - 1.0).abs() < 1e-11);
                let (matrix, filling) = (dense(model, COUNT, COUNT), Columns::new(&jacobian, None).quadratic(model));
                for i in 0..2 {
                    for j in 0..2 {
                        let row = |a: usize| dot(&matrix[a * COUNT..(a + 1) * COUNT], jacobian[j]);
                        let sum: f64 = (0..COUNT).map(|a| jacobian[i][a] * row(a)).sum();
                        assert!((filling[i * 2 + j] / sum - 1.0).abs() < 1e-12, "{model:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn correlations_are_those_of_the_noise() {
        // φ of the partial autocorrelations 0.7, −0.4, 0.3 by Levinson and Durbin: 1.1, −0.694, 0.3.
        let found = Autoregression::new(&[0.7, -0.4, 0.3]);
        let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        found.at(9).iter().zip([1.1, -0.694, 0.3]).for_each(|(found, expected)| close(*found, expected));
        close(found.variance_at(9), 0.51 * 0.84 * 0.91);
        let r = SEVERAL.correlations(3);
        close(r[0], 0.7);
        close(r[1], 0.98 * 0.7 - 0.4);
        close(r[2], 1.1 * r[1] - 0.694 * r[0] + 0.3);
        let pink = NoiseModel::PowerLaw {
            exponent: 1.0,
            share: 1.0,
            longest: 64.0,
        };
        // Correlation times of 0.5, 1, 2 … 64 samples.
        let of_parts = (0..8).map(|power| (-5.0 / (0.5 * 2f64.powi(power))).exp());
        close(pink.correlations(5)[4], of_parts.sum::<f64>() / 8.0);
    }

    #[test]
    fn noise_is_recognised() {
        let alone = NoiseModel::Autoregressive { correlation: 0.9 };
        let both = NoiseModel::WhiteAndAutoregressive {
            correlation: 0.98,
            share: 0.3,
        };
        let pink = NoiseModel::PowerLaw {
            exponent: 1.0,
            share: 1.0,
            longest: 4000.0,
        };
        let opposed = NoiseModel::Autoregressive { correlation: -0.5 };
        let all = [NoiseModel::White, alone, both, SEVERAL, pink, opposed];
        let (mut errors, mut counts) = (Vec::new(), [0; 6]);
        for seed in 0..100 {
            for (count, model) in counts.iter_mut().zip(all) {
                let found = found(&simulated(model, 1000, seed)).model;
                let kind = std::mem::discriminant::<NoiseModel>;
                // A slow part beside white noise is often as likely a walk.
                let walks = model == both && matches!(found, NoiseModel::WhiteAndWalk { .. });
                *count += u32::from(walks || kind(&found) == kind(&model));
                if let NoiseModel::Autoregressive { correlation } = found
                    && model == alone
                {
                    errors.push(correlation - 0.9);
                }
            }
        }
        let least = [85, 85, 65, 95, 90, 90];
        assert!(counts.iter().zip(least).all(|(count, least)| *count >= least), "{counts:?}");
        // √((1 − ρ²)/N) is 0.014; without the restriction ρ would come out lower by some 0.006.
        let bias = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(bias.abs() < 0.004, "{bias}");
    }

    /// Noise of a low-pass filter was AR(1): what fitted parameters take out of correlations, added to all but that at no lag, made a second partial
    /// autocorrelation of −16.
    #[test]
    fn filtered_noise_needs_more_than_one_lag() {
        // Poles at 0.9 exp(±0.1 i).
        let filtered = NoiseModel::AutoregressiveOfOrder {
            order: 2,
            partial: [0.989_4, -0.81, 0.0, 0.0, 0.0, 0.0],
        };
        for samples in [100, 400, 1000] {
            let several = |seed: &u64| {
                matches!(found(&simulated(filtered, samples, *seed)).model, NoiseModel::AutoregressiveOfOrder { .. })
            };
            let count = (0..40).filter(several).count();
            assert!(count >= if samples > 100 { 39 } else { 30 }, "{samples}: {count}");
        }
    }

    /// A walk that drowns white noise was found only if its steps were near one of those looked at first, which lie a factor of 15 apart.
    #[test]
    fn a_plain_walk_is_found_whatever_its_steps() {
        for samples in [1000, 2000] {
            for step in [0.7, 1.0] {
                let near = |seed: &u64| {
                    let (mut random, mut walk) = (crate::random::Rng::new(*seed), 0.0);
                    let mut next = || {
                        walk += step * random.normal();
                        walk + random.normal()
                    };
                    let noise: Vec<f64> = (0..samples).map(|_| next()).collect();
                    let found = found(&noise);
                    let walks = found.likely.iter().filter(|likely| {
                        matches!(likely.model, NoiseModel::WhiteAndWalk { step: found } if (found / step).ln().abs() < 0.5)
                    });
                    walks.map(|likely| likely.probability).sum::<f64>() > 0.3
                };
                let count = (0..20).filter(near).count();
                println!("{samples} {step}: {count}");
                assert!(count >= 15, "{samples} {step}: {count}");
            }
        }
    }

    #[test]
    fn a_slow_drift_below_white_noise_is_not_overlooked() {
        let drift = NoiseModel::WhiteAndAutoregressive {
            correlation: 0.99,
            share: 0.1,
        };
        let wide = (0..40).filter(|seed| found(&simulated(drift, 2000, *seed)).model.effective_samples(2000) < 400.0);
        // 2000/(1 + 0.2 · 99) = 96 samples count.
        assert!(wide.count() >= 36);
    }

    /// Stretches of a long series were taken for one, and its jumps from one to the next for noise ten times as slow.
    #[test]
    fn slow_noise_of_a_long_series_is_no_slower() {
        let model = NoiseModel::Autoregressive { correlation: 0.99 };
        for samples in [8000, 10_000, 50_000] {
            for seed in 0..6 {
                let noise = found(&simulated(model, samples, seed));
                let counts = noise.model.effective_samples(samples) / model.effective_samples(samples);
                assert!((0.5..2.0).contains(&counts), "{samples} {seed}: {counts} {:?}", noise.model);
                let variance = noise.variance(samples);
                assert!((0.5..2.0).contains(&variance), "{samples} {seed}: {variance}");
            }
        }
    }

    #[test]
    fn residuals_that_are_nothing_are_white() {
        let nothing = Noise::of(&[&[1.0; 20]], &Residuals::of(&[0.0; 20], 1), None);
        assert_eq!((nothing.model, nothing.variance(20)), (NoiseModel::White, 0.0));
        assert_eq!(NoiseModel::White.effective_samples(20), 20.0);
    }
}
