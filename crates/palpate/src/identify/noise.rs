//! How the residuals of a fit correlate with their neighbours.
//!
//! The noise of a hold is taken as white, as autoregressive of first order, or as a sum of both:
//!
//! ```text
//! e_i = σ (√s a_i + √(1 − s) w_i),   a_i = ρ a_{i−1} + √(1 − ρ²) v_i,   corr(e_i, e_{i+k}) = s ρ^k
//! ```
//!
//! by sample, not by time: an instrument's filter acts that way, and for samples spaced unevenly it is an approximation.
//! ρ and s are those of the largest *restricted* likelihood (Patterson and Thompson 1971): residuals are flatter than
//! noise by what the fitted numbers took up, and a plain estimate of ρ from them is too small by some p (1 + ρ)/N.

use serde::{Deserialize, Serialize};

use super::linear_algebra::Cholesky;
use crate::statistics::{dot, lag_one_correlation};
use crate::vector::products::cross_products;

/// How residuals correlate with their neighbours, by sample.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseModel {
    /// Not at all.
    #[default]
    White,
    /// AR(1): ρ^k at k samples.
    Autoregressive {
        /// ρ, 0 to 1.
        correlation: f64,
    },
    /// White noise and AR(1): s ρ^k at k samples.
    WhiteAndAutoregressive {
        /// ρ, 0 to 1.
        correlation: f64,
        /// s, the share of the correlated part in the variance, 0 to 1.
        share: f64,
    },
}

impl NoiseModel {
    /// ρ and s.
    pub(super) fn numbers(self) -> (f64, f64) {
        match self {
            Self::White => (0.0, 0.0),
            Self::Autoregressive { correlation } => (correlation, 1.0),
            Self::WhiteAndAutoregressive { correlation, share } => (correlation, share),
        }
    }

    /// Samples that say as much about a mean as `samples` of this noise: N / (1 + 2 s ρ/(1 − ρ)), two at least.
    ///
    /// ```
    /// use palpate::identify::NoiseModel;
    /// let noise = NoiseModel::Autoregressive { correlation: 0.5 };
    /// assert_eq!(noise.effective_samples(300), 100.0);
    /// ```
    #[must_use]
    pub fn effective_samples(self, samples: usize) -> f64 {
        let (correlation, share) = self.numbers();
        (samples as f64 / (1.0 + 2.0 * share * correlation / (1.0 - correlation))).max(2.0)
    }

    /// JᵀRJ, row-major, with R the correlations of this noise, in one pass over the columns.
    ///
    /// F_i = ρ (F_{i−1} + J_{i−1}) sums all that came before, so that JᵀRJ = JᵀJ + s (JᵀF + FᵀJ).
    pub(super) fn quadratic(self, columns: &[&[f64]]) -> Vec<f64> {
        let size = columns.len();
        let mut product = vec![0.0; size * size];
        cross_products(columns, columns, &mut product);
        let (correlation, share) = self.numbers();
        if share == 0.0 {
            return product;
        }
        let before = |column: &&[f64]| {
            let mut sum = 0.0;
            let mut step = |entry: &f64| {
                let now = sum;
                sum = correlation * (sum + entry);
                now
            };
            column.iter().map(&mut step).collect::<Vec<f64>>()
        };
        let sums: Vec<Vec<f64>> = columns.iter().map(before).collect();
        let mut across = vec![0.0; size * size];
        cross_products(columns, &sums, &mut across);
        for i in 0..size {
            for j in 0..size {
                product[i * size + j] += share * (across[i * size + j] + across[j * size + i]);
            }
        }
        product
    }
}

/// The noise of a fit: a model, its variance, and how sure both are.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    pub(super) model: NoiseModel,
    /// σ².
    pub(super) variance: f64,
    /// The model with its variance one standard error away, in each direction in which it is uncertain.
    pub(super) beside: Vec<(NoiseModel, f64)>,
}

/// Fall of −2 ln L that one more number of the noise has to bring.
const EVIDENCE: f64 = 4.0;

impl Noise {
    /// White noise that left these residuals.
    pub(super) fn white(residuals: &[f64], freedom: f64) -> Self {
        Self {
            model: NoiseModel::White,
            variance: dot(residuals, residuals) / freedom,
            beside: Vec::new(),
        }
    }

    /// The noise that left these residuals beside a fit with this Jacobian, whose columns may have any size.
    ///
    /// Of a long series four stretches, evenly spread, say how it correlates; its size comes from all samples.
    pub(super) fn of(jacobian: &[&[f64]], residuals: &[f64]) -> Self {
        if residuals.len() <= STRETCHES * STRETCH {
            return Self::of_all(jacobian, residuals);
        }
        let few: Vec<Vec<f64>> = jacobian.iter().copied().chain([residuals]).map(stretches).collect();
        let columns: Vec<&[f64]> = few[..jacobian.len()].iter().map(Vec::as_slice).collect();
        let left = &few[jacobian.len()];
        let mut noise = Self::of_all(&columns, left);
        let whole = dot(residuals, residuals) / (residuals.len() - jacobian.len()) as f64;
        let scale = whole / (dot(left, left) / (left.len() - jacobian.len()) as f64);
        if scale.is_finite() {
            noise.variance *= scale;
            noise.beside.iter_mut().for_each(|(_, variance)| *variance *= scale);
        }
        noise
    }

    fn of_all(jacobian: &[&[f64]], residuals: &[f64]) -> Self {
        let white = Self::white(residuals, (residuals.len() - jacobian.len()) as f64);
        let signs = Signs::of(residuals, jacobian.len());
        if signs.white() {
            return white;
        }
        let neighbours = Neighbours::new(jacobian, residuals);
        let Some(alone) = neighbours.likelihood(0.0) else {
            return white;
        };
        let mut best = (alone.deviance, white);
        if let Some((deviance, noise)) = neighbours.noise()
            && deviance + EVIDENCE < best.0
        {
            best = (deviance, noise);
        }
        if signs.slow
            && let Some((deviance, noise)) = Mixture::new(jacobian, residuals).noise()
            && deviance + EVIDENCE * if best.1.model == NoiseModel::White { 2.0 } else { 1.0 } < best.0
        {
            best = (deviance, noise);
        }
        best.1
    }
}

/// Stretches of a long series, and samples of each.
const STRETCHES: usize = 4;
const STRETCH: usize = 1024;

/// Stretches of a series from its start to its end, side by side.
fn stretches(series: &[f64]) -> Vec<f64> {
    let apart = (series.len() - STRETCH) / (STRETCHES - 1);
    (0..STRETCHES).flat_map(|i| &series[i * apart..i * apart + STRETCH]).copied().collect()
}

/// What a glance at the residuals says, so that white ones cost next to nothing.
struct Signs {
    /// Neighbours correlate.
    neighbours: bool,
    /// The correlation fades slower than that of neighbours would.
    slow: bool,
}

impl Signs {
    /// Two standard deviations of white noise; fitted numbers pull correlations down by some p/N a lag.
    fn of(residuals: &[f64], parameters: usize) -> Self {
        let count = residuals.len() as f64;
        let square = dot(residuals, residuals);
        if residuals.len() < 8 || square <= f64::MIN_POSITIVE * 1e20 {
            return Self {
                neighbours: false,
                slow: false,
            };
        }
        let taken = parameters as f64 / count;
        let first = lag_one_correlation(residuals);
        let second = dot(&residuals[2..], residuals) / square;
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

/// Value of the restricted likelihood: −2 ln L up to a constant, and the variance that belongs to it.
#[derive(Clone, Copy)]
struct Likelihood {
    deviance: f64,
    variance: f64,
}

impl Likelihood {
    /// From ZᵀR⁻¹Z with Z = (J, r), and ln |R|:
    /// −2 ln L = (N − p) ln σ² + ln |R| + ln |JᵀR⁻¹J|, σ² = (rᵀR⁻¹r − what J takes up)/(N − p).
    fn of(product: &[f64], log_determinant: f64, samples: usize) -> Option<Self> {
        let size = product.len().isqrt();
        let numbers = size - 1;
        let block: Vec<f64> = (0..numbers * numbers).map(|i| product[i / numbers * size + i % numbers]).collect();
        let factor = Cholesky::new(&block, numbers)?;
        let right = &product[numbers * size..numbers * size + numbers];
        let mut taken = right.to_vec();
        factor.solve(&mut taken);
        let left = product[size * size - 1] - dot(right, &taken);
        let freedom = (samples - numbers) as f64;
        let variance = left / freedom;
        let deviance = freedom * variance.ln() + log_determinant + factor.log_determinant();
        deviance.is_finite().then_some(Self { deviance, variance })
    }
}

/// ρ from ln of how many samples count as one, κ = ln((1 + ρ)/(1 − ρ)): the scale on which ρ is searched.
fn correlation_of(kappa: f64) -> f64 {
    (0.5 * kappa).tanh()
}

/// AR(1): its R⁻¹ has three diagonals, so products of neighbours, formed once, give the likelihood at every ρ.
struct Neighbours {
    samples: usize,
    size: usize,
    /// ZᵀZ.
    same: Vec<f64>,
    /// Σ z_i z_{i+1}ᵀ, made symmetric.
    next: Vec<f64>,
    /// Products of the first and of the last row.
    ends: Vec<f64>,
}

impl Neighbours {
    fn new(jacobian: &[&[f64]], residuals: &[f64]) -> Self {
        let all: Vec<&[f64]> = jacobian.iter().copied().chain([residuals]).collect();
        let (samples, size) = (residuals.len(), all.len());
        let early: Vec<&[f64]> = all.iter().map(|column| &column[..samples - 1]).collect();
        let late: Vec<&[f64]> = all.iter().map(|column| &column[1..]).collect();
        let mut same = vec![0.0; size * size];
        let mut shifted = vec![0.0; size * size];
        cross_products(&all, &all, &mut same);
        cross_products(&early, &late, &mut shifted);
        let pairs = || (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
        Self {
            samples,
            size,
            same,
            next: pairs().map(|(i, j)| shifted[i * size + j] + shifted[j * size + i]).collect(),
            ends: pairs().map(|(i, j)| all[i][0] * all[j][0] + all[i][samples - 1] * all[j][samples - 1]).collect(),
        }
    }

    /// R⁻¹ has 1 + ρ² on its diagonal (1 at the ends) and −ρ beside it, over 1 − ρ²; |R| = (1 − ρ²)^(N−1).
    fn likelihood(&self, kappa: f64) -> Option<Likelihood> {
        let rho = correlation_of(kappa);
        let square = rho * rho;
        let entry =
            |i: usize| ((1.0 + square) * self.same[i] - square * self.ends[i] - rho * self.next[i]) / (1.0 - square);
        let product: Vec<f64> = (0..self.size * self.size).map(entry).collect();
        Likelihood::of(&product, (self.samples - 1) as f64 * (1.0 - square).ln(), self.samples)
    }

    /// The best ρ, between white noise and noise that is one sample in all.
    fn noise(&self) -> Option<(f64, Noise)> {
        let model = |kappa: f64| NoiseModel::Autoregressive {
            correlation: correlation_of(kappa),
        };
        let most = (self.samples as f64).ln();
        let evaluate = |x: &[f64]| if x[0] < 0.0 || x[0] > most { None } else { self.likelihood(x[0]) };
        let last = self.same.len() - 1;
        let start = 2.0 * (0.5 * self.next[last] / self.same[last]).clamp(-0.999, 0.999).atanh();
        let found = minimise(&evaluate, &[start.clamp(0.1, most - 0.1)])?;
        Some(found.noise(&evaluate, |x| model(x[0])))
    }
}

/// White noise and AR(1): Kalman's filter whitens all columns alike, sample by sample.
struct Mixture<'a> {
    columns: Vec<&'a [f64]>,
    samples: usize,
}

impl<'a> Mixture<'a> {
    fn new(jacobian: &[&'a [f64]], residuals: &'a [f64]) -> Self {
        Self {
            columns: jacobian.iter().copied().chain([residuals]).collect(),
            samples: residuals.len(),
        }
    }

    /// ρ and s from κ and ln(s/(1 − s)).
    fn model(x: &[f64]) -> NoiseModel {
        NoiseModel::WhiteAndAutoregressive {
            correlation: correlation_of(x[0]),
            share: 1.0 / (1.0 + (-x[1]).exp()),
        }
    }

    /// The likelihood over columns `from` on: all, or the residuals alone as if nothing had been fitted.
    fn likelihood(&self, x: &[f64], from: usize) -> Option<Likelihood> {
        if x[0] < 0.05 || x[0] > (self.samples as f64).ln() || x[1].abs() > 8.0 {
            return None;
        }
        let (rho, share) = Self::model(x).numbers();
        // Gains and variances of the innovations; they settle soon.
        let (mut gains, mut roots) = (Vec::new(), Vec::new());
        let (mut ahead, mut log_determinant) = (share, 0.0);
        for _ in 0..self.samples {
            let innovation = ahead + 1.0 - share;
            let gain = ahead / innovation;
            gains.push(gain);
            roots.push(1.0 / innovation.sqrt());
            log_determinant += innovation.ln();
            let next = rho * rho * ahead * (1.0 - gain) + share * (1.0 - rho * rho);
            if (next - ahead).abs() <= 1e-14 * ahead {
                log_determinant += (self.samples - gains.len()) as f64 * innovation.ln();
                break;
            }
            ahead = next;
        }
        let filter = Filter { rho, gains, roots };
        // The filter waits for its own last step: four columns at a time take as long as one.
        let (fours, rest) = self.columns[from..].as_chunks::<4>();
        let mut white: Vec<Vec<f64>> = fours.iter().flat_map(|four| filter.whitened(*four)).collect();
        white.extend(rest.iter().flat_map(|one| filter.whitened([*one])));
        let mut product = vec![0.0; white.len() * white.len()];
        cross_products(&white, &white, &mut product);
        Likelihood::of(&product, log_determinant, self.samples)
    }

    fn noise(&self) -> Option<(f64, Noise)> {
        let most = (self.samples as f64).ln();
        let starts = (1..).map(|i| 1.2 * f64::from(i)).take_while(|kappa| *kappa < most);
        let starts = starts.flat_map(|kappa| [-2.5, 0.0, 2.5].map(|share| [kappa, share]));
        let evaluate = |x: &[f64]| self.likelihood(x, 0);
        // Where to begin, the residuals alone can tell.
        let depth =
            |x: &[f64; 2]| self.likelihood(x, self.columns.len() - 1).map_or(f64::INFINITY, |found| found.deviance);
        let start = starts.map(|x| (depth(&x), x)).min_by(|a, b| a.0.total_cmp(&b.0))?.1;
        let found = minimise(&evaluate, &start)?;
        Some(found.noise(&evaluate, Self::model))
    }
}

/// Kalman's filter of the mixture: gains and scales of the first samples, the last of them for all that follow.
struct Filter {
    rho: f64,
    gains: Vec<f64>,
    roots: Vec<f64>,
}

impl Filter {
    /// Columns less what was expected from the samples before, over the deviation of that.
    fn whitened<const COUNT: usize>(&self, columns: [&[f64]; COUNT]) -> [Vec<f64>; COUNT] {
        let samples = columns[0].len();
        let columns = columns.map(|column| &column[..samples]);
        let mut white = columns.map(|column| vec![0.0; column.len()]);
        let mut expected = [0.0; COUNT];
        let last = self.gains.len() - 1;
        for i in 0..samples {
            let (gain, root) = (self.gains[i.min(last)], self.roots[i.min(last)]);
            let (kept, taken) = (self.rho * (1.0 - gain), self.rho * gain);
            for k in 0..COUNT {
                let entry = columns[k][i];
                white[k][i] = (entry - expected[k]) * root;
                expected[k] = kept * expected[k] + taken * entry;
            }
        }
        white
    }
}

/// Where a likelihood is largest.
struct Minimum {
    at: Vec<f64>,
    likelihood: Likelihood,
}

/// Compass search: along each axis to where the deviance stops falling, with steps down to 1/50, an eighth of an error.
fn minimise(evaluate: &impl Fn(&[f64]) -> Option<Likelihood>, start: &[f64]) -> Option<Minimum> {
    let mut at = start.to_vec();
    let mut best = evaluate(&at)?;
    let mut step = 0.5;
    while step > 2e-2 {
        let mut moved = false;
        for axis in 0..at.len() {
            for side in [step, -step] {
                let mut trial = at.clone();
                trial[axis] += side;
                if let Some(found) = evaluate(&trial)
                    && found.deviance < best.deviance
                {
                    (at, best, moved) = (trial, found, true);
                    break;
                }
            }
        }
        if !moved {
            step *= 0.5;
        }
    }
    Some(Minimum { at, likelihood: best })
}

impl Minimum {
    /// The noise there, and beside it along the columns of the Cholesky factor of its covariance, 2 (∂²deviance)⁻¹.
    fn noise(
        self,
        evaluate: &impl Fn(&[f64]) -> Option<Likelihood>,
        model: impl Fn(&[f64]) -> NoiseModel,
    ) -> (f64, Noise) {
        let mut beside = Vec::new();
        for spread in self.directions(evaluate) {
            // At an edge the other side has to do.
            for side in [1.0, -1.0, 0.5, -0.5] {
                let at: Vec<f64> = self.at.iter().zip(&spread).map(|(x, d)| x + side * d).collect();
                if let Some(found) = evaluate(&at) {
                    beside.push((model(&at), found.variance));
                    break;
                }
            }
        }
        let noise = Noise {
            model: model(&self.at),
            variance: self.likelihood.variance,
            beside,
        };
        (self.likelihood.deviance, noise)
    }

    /// Vectors d with Σ d dᵀ = covariance; half a unit an axis where the curvature says nothing.
    fn directions(&self, evaluate: &impl Fn(&[f64]) -> Option<Likelihood>) -> Vec<Vec<f64>> {
        const STEP: f64 = 0.1;
        let size = self.at.len();
        let at = |moves: &[(usize, f64)]| {
            let mut x = self.at.clone();
            moves.iter().for_each(|(axis, by)| x[*axis] += by);
            evaluate(&x).map(|found| found.deviance)
        };
        let entry = |i: usize, j: usize| {
            let pairs = [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)];
            let step = if i == j { 0.5 * STEP } else { STEP };
            let terms = pairs.map(|(a, b, sign)| at(&[(i, a * step), (j, b * step)]).map(|value| sign * value));
            let sum: Option<f64> = terms.into_iter().sum();
            sum.map(|sum| 0.5 * sum / (4.0 * step * step))
        };
        let curvature: Option<Vec<f64>> = (0..size * size).map(|i| entry(i / size, i % size)).collect();
        let covariance = curvature.and_then(|matrix| Cholesky::new(&matrix, size)).map(|factor| factor.inverse());
        match covariance.and_then(|covariance| Cholesky::new(&covariance, size)) {
            Some(factor) => (0..size).map(|j| factor.column(j)).collect(),
            None => (0..size).map(|i| (0..size).map(|j| if i == j { 0.5 } else { 0.0 }).collect()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of this model from a fixed sequence.
    fn simulated(model: NoiseModel, samples: usize, seed: u64) -> Vec<f64> {
        let (rho, share) = model.numbers();
        let mut random = crate::test_problems::Noise::new(seed);
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
        Noise::of(&[&columns[0], &columns[1]], &without_line(noise))
    }

    /// All correlations, row by row.
    fn dense(model: NoiseModel, samples: usize) -> Vec<f64> {
        let (rho, share) = model.numbers();
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
            (alone, Neighbours::new(&jacobian, &residuals).likelihood(x[0])),
            (Mixture::model(&x), Mixture::new(&jacobian, &residuals).likelihood(&x, 0)),
        ];
        for (model, likelihood) in likelihoods {
            let matrix = dense(model, COUNT);
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
            let filling = model.quadratic(&jacobian);
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

    #[test]
    fn residuals_that_are_nothing_are_white() {
        let nothing = Noise::of(&[&[1.0; 20]], &[0.0; 20]);
        assert_eq!((nothing.model, nothing.variance), (NoiseModel::White, 0.0));
        assert_eq!(NoiseModel::White.effective_samples(20), 20.0);
    }
}
