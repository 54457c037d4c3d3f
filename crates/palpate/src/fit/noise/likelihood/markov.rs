//! White noise beside one Markov process: a random walk, or noise whose correlation fades in time.

use super::filter::MarkovStep;
use super::kind::{Kind, Likelihood, SHARES};
use super::rows::Rows;
use crate::fit::noise::model::NoiseModel;
use crate::optimise::{Few, minimise};
use crate::vector::{LANES, block_sums, cross_products, normal_equations, shifted};

/// The covariance of a noise over σ²: y_i = x_i + v_i, where v is white, and x_i is what is left of x_{i−1} and something new.
pub(crate) struct Markov {
    /// What is left of the process from the sample before.
    kept: Vec<f64>,
    /// Variances of the process.
    variances: Vec<f64>,
    /// Variance of white noise.
    white: f64,
}

impl Markov {
    /// Noise of this correlation time at these times, with this share in the variance.
    pub(crate) fn in_time(correlation_time: f64, share: f64, times: &[f64]) -> Self {
        let kept = |pair: &[f64]| ((pair[0] - pair[1]) / correlation_time).exp();
        Self {
            kept: std::iter::once(0.0).chain(times.windows(2).map(kept)).collect(),
            variances: vec![share; times.len()],
            white: 1.0 - share,
        }
    }

    /// Steps of Kalman's filter, and ln |R|.
    fn steps(&self) -> (Vec<MarkovStep>, f64) {
        let mut steps: Vec<MarkovStep> = Vec::with_capacity(self.kept.len());
        let (mut log_determinant, mut determinant, mut ahead) = (0.0, 1.0, self.variances[0]);
        let count = self.kept.len();
        // What comes anew from one sample to the next.
        let added = |index: usize| self.variances[index + 1] - self.kept[index + 1].powi(2) * self.variances[index];
        for index in 0..count {
            let innovation = (ahead + self.white).max(f64::MIN_POSITIVE);
            let gain = ahead / innovation;
            let (kept, new) =
                if index + 1 < count { (self.kept[index + 1], added(index).max(0.0)) } else { (0.0, 0.0) };
            steps.push(MarkovStep {
                root: 1.0 / innovation.sqrt(),
                gain,
                kept,
            });
            // One logarithm for many factors.
            determinant *= innovation;
            if !(1e-100..1e100).contains(&determinant) {
                log_determinant += determinant.ln();
                determinant = 1.0;
            }
            ahead = kept * kept * ahead * (1.0 - gain) + new;
        }
        (steps, log_determinant + determinant.ln())
    }

    /// JᵀF with F the products of the process at each sample with all before it, and half of that with itself.
    pub(crate) fn across(&self, rows: &Rows) -> Vec<f64> {
        rows.with_process_before(&self.kept, &self.variances)
    }
}

/// Mean times between samples from the first to this one.
pub(crate) fn steps_since(sample: usize, times: Option<&[f64]>) -> f64 {
    match times {
        Some(times) => {
            let last = times.len() - 1;
            (times[sample] - times[0]) / (times[last] - times[0]) * last as f64
        }
        None => sample as f64,
    }
}

/// ln of the shortest and the longest correlation time that samples at these times show.
fn correlation_times(times: &[f64]) -> (f64, f64) {
    let shortest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    ((0.3 * shortest).ln(), (4.0 * (times[times.len() - 1] - times[0])).ln())
}

/// The model of this correlation time, in the unit of these times.
pub(crate) fn in_time(correlation_time_s: f64, share: f64, times: &[f64]) -> NoiseModel {
    let (mut sum, mut before) = (0.0, 0.0);
    for pair in times.windows(2) {
        before = ((pair[0] - pair[1]) / correlation_time_s).exp() * (before + 1.0);
        sum += before;
    }
    let count = times.len() as f64;
    NoiseModel::InTime {
        correlation_time_s,
        share,
        independent: count / (1.0 + 2.0 / count * share * sum),
    }
}

/// Residuals beside the columns of a fit, for noise that is white beside a Markov process.
pub(crate) struct Beside<'a> {
    times: Option<&'a [f64]>,
    samples: usize,
    /// Neighbours that are taken together.
    together: usize,
    /// Z = (J, r), or √b times the means of b neighbours.
    rows: Rows,
    /// ZᵀZ of all samples, and of what means leave out.
    whole: Vec<f64>,
    within: Vec<f64>,
}

impl<'a> Beside<'a> {
    /// Means of as many neighbours are taken as leave at most `most` of them.
    pub(crate) fn new(jacobian: &[&[f64]], residuals: &[f64], times: Option<&'a [f64]>, most: usize) -> Self {
        let columns: Vec<&[f64]> = jacobian.iter().copied().chain([residuals]).collect();
        let samples = residuals.len();
        let together = samples.div_ceil(most);
        let (mut whole, mut right) = (vec![0.0; columns.len() * columns.len()], vec![0.0; columns.len()]);
        normal_equations(&columns, residuals, &mut whole, &mut right);
        if together == 1 {
            return Self {
                times,
                samples,
                together,
                rows: Rows::new(&columns),
                within: vec![0.0; whole.len()],
                whole,
            };
        }
        let root = (together as f64).sqrt().recip();
        let means = |column: &&[f64]| shifted(&block_sums(column, together), 0.0, root);
        let means: Vec<Vec<f64>> = columns.iter().map(means).collect();
        let views: Vec<&[f64]> = means.iter().map(Vec::as_slice).collect();
        let mut between = vec![0.0; whole.len()];
        cross_products(&views, &views, &mut between);
        Self {
            times,
            samples,
            together,
            rows: Rows::new(&views),
            within: whole.iter().zip(&between).map(|(all, between)| all - between).collect(),
            whole,
        }
    }

    /// The restricted likelihood of noise in time.
    fn of_time(&self, correlation_time: f64, share: f64) -> Option<Likelihood> {
        let (steps, log_determinant) = Markov::in_time(correlation_time, share, self.times?).steps();
        self.likelihood(self.rows.filtered(&steps), log_determinant)
    }

    /// The restricted likelihoods of walks of these steps. √b times the means of b neighbours show a step as √b times as large, and it hardly
    /// moves among them.
    fn of_walks(&self, steps: &[f64]) -> Vec<Option<Likelihood>> {
        let (count, together) = (self.rows.samples, self.together);
        let since: Vec<f64> = (0..count).map(|mean| steps_since(mean * together + together / 2, self.times)).collect();
        let mut found = Vec::with_capacity(steps.len());
        for some in steps.chunks(LANES) {
            let square = |lane: usize| together as f64 * some.get(lane).map_or(0.0, |step| step * step);
            let walks = self.rows.beside_walks(&std::array::from_fn(square), &since);
            let walks = walks.into_iter().take(some.len());
            found.extend(walks.map(|(product, log_determinant)| self.likelihood(product, log_determinant)));
        }
        found
    }

    /// From ZᵀR⁻¹Z of the means, and ln |R|.
    fn likelihood(&self, mut product: Vec<f64>, log_determinant: f64) -> Option<Likelihood> {
        product.iter_mut().zip(&self.within).for_each(|(sum, within)| *sum += within);
        Likelihood::of(&product, log_determinant, self.samples)
    }

    /// Noise whose correlation fades in time, alone or beside white noise, about the best.
    pub(crate) fn in_time(&self, alone: bool, deviance: f64) -> Option<Kind> {
        let times = self.times.filter(|_| self.together == 1)?;
        let (low, high) = correlation_times(times);
        let bounds = [(low, high), SHARES];
        let model = |x: &[f64]| {
            let share = x.get(1).map_or(1.0, |x| 1.0 / (1.0 + (-x).exp()));
            let inside = x.iter().zip(&bounds).all(|(x, (low, high))| (low..=high).contains(&x));
            inside.then(|| in_time(x[0].exp(), share, times))
        };
        let at = |x: &[f64]| match model(x)? {
            NoiseModel::InTime {
                correlation_time_s,
                share,
                ..
            } => self.of_time(correlation_time_s, share),
            _ => None,
        };
        let evaluate = |points: &[Few]| points.iter().map(|x| at(x)).collect();
        let count = ((high - low) / 1.2).ceil();
        let taus = (0..=count as i32).map(|i| low + (high - low) * f64::from(i) / count);
        let shares: &[f64] = if alone { &[f64::INFINITY] } else { &[-1.0, 1.5] };
        let places = taus.flat_map(|tau| shares.iter().map(move |share| [tau, *share]));
        let size = if alone { 1 } else { 2 };
        let looked = places.filter_map(|place| Some((at(&place[..size])?.deviance, place)));
        let (best, start) = looked.min_by(|a, b| a.0.total_cmp(&b.0))?;
        if best > deviance {
            return None;
        }
        let found = minimise(&evaluate, &start[..size], &bounds, f64::INFINITY)?;
        Kind::about(&found, &evaluate, model)
    }

    /// White noise alone.
    pub(crate) fn white(&self) -> Option<Likelihood> {
        Likelihood::of(&self.whole, 0.0, self.samples)
    }

    /// Noise whose correlation fades in time, of correlation times evenly spaced in ln; none where samples are spaced evenly.
    pub(crate) fn fading(&self) -> Vec<(Likelihood, NoiseModel)> {
        let Some(times) = self.times else { return Vec::new() };
        let (low, high) = correlation_times(times);
        let correlation_times = (0..=12).map(|i| (low + (high - low) * f64::from(i) / 12.0).exp());
        let found = |tau: f64| Some((self.of_time(tau, 1.0)?, in_time(tau, 1.0, times)));
        correlation_times.filter_map(found).collect()
    }

    /// Walks of sizes evenly spaced in ln, and their part of the sizes there may be: from what no series of this length could show to steps of
    /// three white deviations. Where one of them alone is likely, those about it; none where a few show that none comes near this deviance.
    pub(crate) fn walks(&self, deviance: f64) -> (Vec<(Likelihood, NoiseModel)>, f64) {
        /// Largest step.
        const LARGEST: f64 = 3.0;
        /// From one ln of a step to the next.
        const PACE: f64 = 0.9;
        /// One of so many is looked at first, and how far from the best of them it may be: by this, or as far as a size between two of them
        /// changes the deviance a sample.
        const FIRST: usize = 3;
        const FARTHEST: f64 = 60.0;
        const FARTHEST_BY_SAMPLE: f64 = 0.5;
        /// Deviances between neighbours above which one of them alone is likely, and how often those about it are taken then.
        const ALONE: f64 = 4.0;
        const ROUNDS: usize = 3;
        let smallest = (2.0 / self.samples as f64).ln();
        let count = ((LARGEST.ln() - smallest) / PACE).ceil() as usize + 1;
        let found = |logs: Vec<f64>| {
            let steps: Vec<f64> = logs.iter().map(|log| log.exp()).collect();
            let walk = |(found, log): (Option<Likelihood>, f64)| Some((log, found?));
            self.of_walks(&steps).into_iter().zip(logs).filter_map(walk).collect::<Vec<_>>()
        };
        let grid = |some: &dyn Fn(usize) -> bool| {
            let chosen = (0..count).filter(|i| some(*i));
            found(chosen.map(|i| smallest + PACE * i as f64).collect())
        };
        let mut all = grid(&|i| i % FIRST == 0);
        let farthest = deviance + FARTHEST.max(FARTHEST_BY_SAMPLE * self.samples as f64);
        if all.iter().all(|(_, found)| found.deviance > farthest) {
            return (Vec::new(), 1.0);
        }
        all.extend(grid(&|i| i % FIRST != 0));
        let (mut pace, mut part) = (PACE, 1.0);
        for _ in 0..ROUNDS {
            let Some(best) = all.iter().copied().min_by(|a, b| a.1.deviance.total_cmp(&b.1.deviance)) else {
                break;
            };
            let is_near = |other: &(f64, Likelihood)| other.0 != best.0 && other.1.deviance < best.1.deviance + ALONE;
            if best.1.deviance > farthest || all.iter().any(is_near) {
                break;
            }
            let finer = 2.0 * pace / (LANES + 1) as f64;
            all = found((1..=LANES).map(|i| best.0 - pace + finer * i as f64).collect());
            (pace, part) = (finer, LANES as f64 * finer / (PACE * count as f64));
        }
        let walk = |(log, found): (f64, Likelihood)| (found, NoiseModel::WhiteAndWalk { step: log.exp() });
        (all.into_iter().map(walk).collect(), part)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::optimise::Cholesky;
    use crate::statistics::dot;
    use crate::test_problems::Rng;

    /// R of noise, row by row.
    pub(crate) fn dense(model: NoiseModel, times: &[f64]) -> Vec<f64> {
        let count = times.len();
        let entry = |i: usize, j: usize| {
            let (first, own) = (i.min(j), f64::from(u8::from(i == j)));
            match model {
                NoiseModel::WhiteAndWalk { step } => {
                    let since = (times[first] - times[0]) / (times[count - 1] - times[0]) * (count - 1) as f64;
                    own + step * step * since
                }
                NoiseModel::InTime {
                    correlation_time_s,
                    share,
                    ..
                } => (1.0 - share) * own + share * (-(times[i] - times[j]).abs() / correlation_time_s).exp(),
                _ => own,
            }
        };
        (0..count * count).map(|at| entry(at / count, at % count)).collect()
    }

    /// Residuals of a straight line, with its columns.
    fn residuals(noise: &[f64]) -> ([Vec<f64>; 2], Vec<f64>) {
        let count = noise.len() as f64;
        let slope: Vec<f64> = (0..noise.len()).map(|i| (i as f64 + 0.5) / count - 0.5).collect();
        let (mean, rise) = (noise.iter().sum::<f64>() / count, dot(&slope, noise) / dot(&slope, &slope));
        let left = noise.iter().zip(&slope).map(|(value, x)| value - mean - rise * x).collect();
        ([vec![1.0; noise.len()], slope], left)
    }

    #[test]
    fn filters_agree_with_whole_matrices() {
        let mut random = Rng::new(4);
        let times: Vec<f64> = (0..40).map(|i| f64::from(i * i) * 0.01 + 0.2 * f64::from(i)).collect();
        let noise: Vec<f64> = times.iter().map(|_| random.normal()).collect();
        let (columns, left) = residuals(&noise);
        let jacobian = [columns[0].as_slice(), columns[1].as_slice()];
        let beside = Beside::new(&jacobian, &left, Some(&times), times.len());
        let models = [NoiseModel::WhiteAndWalk { step: 0.3 }, in_time(0.7, 1.0, &times), in_time(2.0, 0.4, &times)];
        for model in models {
            let matrix = dense(model, &times);
            let factor = Cholesky::new(&matrix, 40).unwrap();
            let whole = [jacobian[0], jacobian[1], &left];
            let solved = whole.map(|column| {
                let mut solved = column.to_vec();
                factor.solve(&mut solved);
                solved
            });
            let product: Vec<f64> = (0..9).map(|at| dot(whole[at / 3], &solved[at % 3])).collect();
            let expected = Likelihood::of(&product, factor.log_determinant(), 40).unwrap();
            let found = match model {
                NoiseModel::WhiteAndWalk { step } => beside.of_walks(&[step])[0],
                NoiseModel::InTime {
                    correlation_time_s,
                    share,
                    ..
                } => beside.of_time(correlation_time_s, share),
                _ => None,
            }
            .unwrap();
            assert!((found.deviance - expected.deviance).abs() < 1e-9, "{model:?}");
            assert!((found.variance / expected.variance - 1.0).abs() < 1e-11, "{model:?}");
        }
        // Σ R of a constant column over N: what `independent` says.
        let NoiseModel::InTime { independent, .. } = models[2] else {
            panic!()
        };
        let sum: f64 = dense(models[2], &times).iter().sum();
        assert!((independent * sum / 1600.0 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn means_of_neighbours_show_a_walk_as_all_samples_do() {
        let mut random = Rng::new(9);
        for step in [0.0, 0.01, 0.05] {
            let mut walk = 0.0;
            let mut next = || {
                walk += step * random.normal();
                walk + random.normal()
            };
            let noise: Vec<f64> = (0..1000).map(|_| next()).collect();
            let (columns, left) = residuals(&noise);
            let jacobian = [columns[0].as_slice(), columns[1].as_slice()];
            let whole = Beside::new(&jacobian, &left, None, 1000);
            let means = Beside::new(&jacobian, &left, None, 125);
            assert_eq!(means.together, 8);
            let base = |beside: &Beside<'_>| beside.white().unwrap().deviance;
            for q in [0.003, 0.01, 0.03, 0.1] {
                let fall = |beside: &Beside<'_>| beside.of_walks(&[q])[0].unwrap().deviance - base(beside);
                let (exact, found) = (fall(&whole), fall(&means));
                assert!((found - exact).abs() < 0.5 + 0.12 * exact.abs(), "{step} {q}: {found} {exact}");
            }
        }
    }
}
