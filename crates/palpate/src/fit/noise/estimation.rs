//! Which noise left the residuals of a fit.

use super::likelihood::{Mixture, Neighbours};
use super::model::{Lags, Noise};
use crate::statistics::dot;

/// Fall of −2 ln L that one more parameter of the noise has to bring.
const EVIDENCE: f64 = 4.0;

impl Noise {
    /// The noise that left these residuals beside a fit with this Jacobian, whose columns may have any size.
    ///
    /// Of a long series stretches, evenly spread, say how it correlates; its size comes from all samples.
    pub(crate) fn of(jacobian: &[&[f64]], residuals: &[f64], lags: &Lags) -> Self {
        let white = Self::white(lags, (residuals.len() - jacobian.len()) as f64);
        let signs = Signs::of(residuals, lags, jacobian.len());
        if signs.white() {
            return white;
        }
        if residuals.len() <= STRETCHES * STRETCH {
            return Self::correlated(jacobian, residuals, residuals.len(), &signs).unwrap_or(white);
        }
        let few: Vec<Vec<f64>> = jacobian.iter().copied().chain([residuals]).map(stretches).collect();
        let columns: Vec<&[f64]> = few[..jacobian.len()].iter().map(Vec::as_slice).collect();
        let left = &few[jacobian.len()];
        let Some(mut noise) = Self::correlated(&columns, left, STRETCH, &signs) else {
            return white;
        };
        let scale = white.variance / (dot(left, left) / (left.len() - jacobian.len()) as f64);
        if scale.is_finite() {
            noise.variance *= scale;
            noise.beside.iter_mut().for_each(|(_, variance)| *variance *= scale);
        }
        noise
    }

    /// The correlated noise that left these residuals, in series of `length` samples each that are independent of each other; `None` if
    /// white noise explains them as well.
    fn correlated(jacobian: &[&[f64]], residuals: &[f64], length: usize, signs: &Signs) -> Option<Self> {
        let neighbours = Neighbours::new(jacobian, residuals, length);
        let mut best = (neighbours.likelihood(0.0)?.deviance, None);
        if let Some((deviance, noise)) = neighbours.noise()
            && deviance + EVIDENCE < best.0
        {
            best = (deviance, Some(noise));
        }
        if signs.slow
            && let Some((deviance, noise)) = Mixture::new(jacobian, residuals, length).noise(best.0)
            && deviance + EVIDENCE * if best.1.is_none() { 2.0 } else { 1.0 } < best.0
        {
            best = (deviance, Some(noise));
        }
        best.1
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

/// What a glance at the residuals says, so that white ones cost next to nothing.
#[derive(Default)]
struct Signs {
    /// Neighbours correlate.
    neighbours: bool,
    /// The correlation fades slower than that of neighbours would.
    slow: bool,
}

impl Signs {
    /// Two standard deviations of white noise; fitted parameters pull correlations down by some p/N a lag.
    fn of(residuals: &[f64], lags: &Lags, parameters: usize) -> Self {
        let count = residuals.len() as f64;
        let Lags { square, first, second } = *lags;
        if residuals.len() < 8 || square <= f64::MIN_POSITIVE * 1e20 {
            return Self::default();
        }
        let taken = parameters as f64 / count;
        let neighbours = first + taken > 2.0 / count.sqrt();
        // Sums over blocks show a slow drift that is lost in the noise of neighbours.
        let length = residuals.len().isqrt();
        let blocks = (residuals.len() / length) as f64;
        let of_sums: f64 = residuals.chunks_exact(length).map(|block| block.iter().sum::<f64>().powi(2)).sum();
        let drift = of_sums / square > 1.0 - parameters as f64 / blocks + 2.0 * (2.0 / blocks).sqrt();
        let lasting = (second - first * first) * count.sqrt() > 2.0 * (1.0 - first * first);
        Self {
            neighbours,
            slow: (neighbours && lasting) || (drift && !neighbours),
        }
    }

    fn white(&self) -> bool {
        !(self.neighbours || self.slow)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::NoiseModel;
    use crate::fit::noise::likelihood::{Likelihood, correlation_of};
    use crate::fit::noise::rows::Columns;
    use crate::optimise::Cholesky;
    use crate::vector::cross_products;

    /// Noise of this model from a fixed sequence.
    fn simulated(model: NoiseModel, samples: usize, seed: u64) -> Vec<f64> {
        let (rho, share) = model.parameters();
        let mut random = crate::test_problems::Rng::new(seed);
        let mut state = random.normal();
        let mut next = || {
            let now = share.sqrt() * state + (1.0 - share).sqrt() * random.normal();
            state = rho * state + (1.0 - rho * rho).sqrt() * random.normal();
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
        Noise::of(&[&columns[0], &columns[1]], &left, &Lags::of(&left))
    }

    /// All correlations, row by row.
    fn dense(model: NoiseModel, samples: usize) -> Vec<f64> {
        let (rho, share) = model.parameters();
        let entry = |lag: usize| if lag == 0 { 1.0 } else { share * rho.powi(lag as i32) };
        (0..samples * samples).map(|at| entry((at / samples).abs_diff(at % samples))).collect()
    }

    #[test]
    fn recursions_agree_with_whole_matrices() {
        const COUNT: usize = 40;
        let columns = line(COUNT);
        let jacobian = [columns[0].as_slice(), columns[1].as_slice()];
        let residuals = without_line(&simulated(NoiseModel::White, COUNT, 3));
        let all = [jacobian[0], jacobian[1], &residuals];
        let x = [1.7, 0.4];
        let alone = NoiseModel::Autoregressive {
            correlation: correlation_of(x[0]),
        };
        let likelihoods = [
            (alone, COUNT, Neighbours::new(&jacobian, &residuals, COUNT).likelihood(x[0])),
            (Mixture::model(&x), COUNT, Mixture::new(&jacobian, &residuals, COUNT).likelihood(&x)),
            (alone, COUNT / 2, Neighbours::new(&jacobian, &residuals, COUNT / 2).likelihood(x[0])),
            (Mixture::model(&x), COUNT / 2, Mixture::new(&jacobian, &residuals, COUNT / 2).likelihood(&x)),
        ];
        for (model, length, likelihood) in likelihoods {
            let mut matrix = dense(model, COUNT);
            for (at, entry) in matrix.iter_mut().enumerate() {
                if at / COUNT / length != at % COUNT / length {
                    *entry = 0.0;
                }
            }
            let factor = Cholesky::new(&matrix, COUNT).unwrap();
            let solved = all.map(|column| {
                let mut solved = column.to_vec();
                factor.solve(&mut solved);
                solved
            });
            let product: Vec<f64> = (0..9).map(|at| dot(all[at / 3], &solved[at % 3])).collect();
            let whole = Likelihood::of(&product, factor.log_determinant(), COUNT).unwrap();
            let quick = likelihood.unwrap();
            assert!((quick.deviance - whole.deviance).abs() < 1e-9, "{model:?}: {} {}", quick.deviance, whole.deviance);
            assert!((quick.variance / whole.variance - 1.0).abs() < 1e-12);
            let (matrix, filling) = (dense(model, COUNT), Columns::new(&jacobian).quadratic(model));
            for i in 0..2 {
                for j in 0..2 {
                    let row = |a: usize| dot(&matrix[a * COUNT..(a + 1) * COUNT], jacobian[j]);
                    let sum: f64 = (0..COUNT).map(|a| jacobian[i][a] * row(a)).sum();
                    assert!((filling[i * 2 + j] / sum - 1.0).abs() < 1e-13, "{model:?}");
                }
            }
        }
    }

    #[test]
    fn noise_is_recognised() {
        let alone = NoiseModel::Autoregressive { correlation: 0.9 };
        let both = NoiseModel::WhiteAndAutoregressive {
            correlation: 0.98,
            share: 0.3,
        };
        let (mut white, mut single, mut double, mut errors) = (0, 0, 0, Vec::new());
        for seed in 0..100 {
            white += u32::from(found(&simulated(NoiseModel::White, 1000, seed)).model == NoiseModel::White);
            let noise = found(&simulated(alone, 1000, seed));
            if let NoiseModel::Autoregressive { correlation } = noise.model {
                single += 1;
                errors.push(correlation - 0.9);
            }
            double += u32::from(matches!(
                found(&simulated(both, 1000, seed)).model,
                NoiseModel::WhiteAndAutoregressive { .. }
            ));
        }
        assert!(white >= 92 && single >= 90 && double >= 95, "{white} {single} {double}");
        // √((1 − ρ²)/N) is 0.014; without the restriction ρ would come out lower by some 0.006.
        let bias = errors.iter().sum::<f64>() / errors.len() as f64;
        assert!(bias.abs() < 0.004, "{bias}");
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
                assert!((0.5..2.0).contains(&noise.variance), "{samples} {seed}: {}", noise.variance);
            }
        }
    }

    #[test]
    fn residuals_that_are_nothing_are_white() {
        let nothing = Noise::of(&[&[1.0; 20]], &[0.0; 20], &Lags::of(&[0.0; 20]));
        assert_eq!((nothing.model, nothing.variance), (NoiseModel::White, 0.0));
        assert_eq!(NoiseModel::White.effective_samples(20), 20.0);
    }
}
