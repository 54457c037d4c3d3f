//! The restricted likelihood of a noise, and where it is greatest for noise with slow parts.

use super::filter::{LANES, Noises};
use super::model::{Likely, MOST_PARTS, NoiseModel, Parts};
use super::rows::Rows;
use crate::optimise::{Cholesky, Few, Level, Minimum, Square, minimise};
use crate::statistics::dot;

/// Value of the restricted likelihood: −2 ln L up to a constant, and the variance that belongs to it.
#[derive(Clone, Copy)]
pub(crate) struct Likelihood {
    pub(crate) deviance: f64,
    pub(crate) variance: f64,
}

impl Level for Likelihood {
    fn level(&self) -> f64 {
        self.deviance
    }
}

impl Likelihood {
    /// From ZᵀR⁻¹Z with Z = (J, r), and ln |R|:
    /// −2 ln L = (N − p) ln σ² + ln |R| + ln |JᵀR⁻¹J|, σ² = (rᵀR⁻¹r − what J takes up)/(N − p).
    pub(crate) fn of(product: &[f64], log_determinant: f64, samples: usize) -> Option<Self> {
        let size = product.len().isqrt();
        let parameters = size - 1;
        let block: Square =
            (0..parameters * parameters).map(|i| product[i / parameters * size + i % parameters]).collect();
        let factor = Cholesky::new(&block, parameters)?;
        let right = &product[parameters * size..parameters * size + parameters];
        let mut taken = Few::from_slice(right);
        factor.solve(&mut taken);
        let left = product[size * size - 1] - dot(right, &taken);
        let freedom = (samples - parameters) as f64;
        let variance = left / freedom;
        let deviance = freedom * variance.ln() + log_determinant + factor.log_determinant();
        deviance.is_finite().then_some(Self { deviance, variance })
    }
}

/// A kind of noise: the model of the least deviance, and models about it that stand for all of its kind.
pub(crate) struct Kind {
    pub(crate) deviance: f64,
    pub(crate) model: NoiseModel,
    /// With a probability each, as if noise were of no other kind.
    pub(crate) likely: Vec<Likely>,
}

impl Kind {
    /// By points of a cubature of the posterior of one parameter or two, which is about normal with covariance 2 (∂²deviance)⁻¹: the middle, and
    /// two points √3 standard deviations away along each axis, with weights 1 − K/3 and 1/6, and each times what the posterior is there over
    /// the normal one.
    pub(crate) fn about(
        minimum: &Minimum<Likelihood>,
        evaluate: &impl Fn(&[Few]) -> Vec<Option<Likelihood>>,
        model: impl Fn(&[f64]) -> Option<NoiseModel>,
    ) -> Option<Self> {
        /// Farther from normal the points say little.
        const MOST: f64 = 8.0;
        /// From one point at an edge to the next.
        const PACE: f64 = 0.75;
        let deviance = minimum.value.deviance;
        let mut likely = vec![Likely {
            model: model(&minimum.at)?,
            variance: minimum.value.variance,
            probability: 1.0,
        }];
        let taken = |at: &Few, found: Likelihood, weight: f64| {
            Some(Likely {
                model: model(at)?,
                variance: found.variance,
                probability: weight,
            })
        };
        match minimum.directions() {
            // Many parameters together say what one of them leaves open, at a price of many points.
            _ if minimum.at.len() > 2 => {}
            Some(directions) => {
                let (size, square) = (directions.len() as f64, 3.0_f64);
                // Beyond an edge is nothing: half as far may be inside.
                let fars = [square, 0.25 * square];
                let beside = |direction: &Vec<f64>, side: f64, far: f64| -> Few {
                    minimum.at.iter().zip(direction).map(|(x, d)| x + side * far.sqrt() * d).collect()
                };
                let sides = directions.iter().flat_map(|direction| [1.0, -1.0].map(|side| (direction, side)));
                let points: Vec<Few> =
                    sides.flat_map(|(direction, side)| fars.map(|far| beside(direction, side, far))).collect();
                let found = evaluate(&points);
                for (points, found) in points.chunks(fars.len()).zip(found.chunks(fars.len())) {
                    let inside = points.iter().zip(found).zip(fars).find_map(|((at, found), far)| {
                        let found = (*found)?;
                        let over = (0.5 * (far - found.deviance + deviance)).exp().clamp(1.0 / MOST, MOST);
                        taken(at, found, over / (2.0 * square))
                    });
                    likely.extend(inside);
                }
                likely[0].probability = 1.0 - size / square;
            }
            // At an edge no normal distribution helps: a walk along each axis, each point by its own likelihood.
            None => {
                let beside = |axis: usize, by: f64| {
                    let mut at = minimum.at.clone();
                    at[axis] += PACE * by;
                    at
                };
                let steps = [1.0, 2.0, 3.0, 4.0, -1.0, -2.0, -3.0, -4.0];
                let points: Vec<Few> =
                    (0..minimum.at.len()).flat_map(|axis| steps.map(|by| beside(axis, by))).collect();
                let walked = points.iter().zip(evaluate(&points)).filter_map(|(at, found)| {
                    let found = found?;
                    taken(at, found, (-0.5 * (found.deviance - deviance)).exp())
                });
                likely.extend(walked);
            }
        }
        let all: f64 = likely.iter().map(|likely| likely.probability).sum();
        likely.iter_mut().for_each(|likely| likely.probability /= all);
        likely.retain(|likely| likely.probability > 0.0);
        Some(Self {
            deviance,
            model: model(&minimum.at)?,
            likely,
        })
    }
}

/// Fall of the deviance that a first look has to show: from there to the bottom it falls by some units more. Of white residuals that
/// look slow, two of three are done with here.
const PROMISE: f64 = 2.0;

/// Noise with slow parts: Kalman's filter whitens all columns alike, sample by sample.
pub(crate) struct Slow<'a> {
    rows: Rows,
    residuals: &'a [f64],
    /// Samples of each of the series, which are independent of each other.
    length: usize,
    /// The longest correlation time of a power law, in samples.
    longest: f64,
}

/// The largest κ = ln((1 + ρ)/(1 − ρ)), ln of how many samples count as one, for a series of this length: a random walk is as good as that.
pub(crate) fn slowest(length: usize) -> f64 {
    (length as f64).ln() + 2.5
}

/// ρ and s from κ and ln(s/(1 − s)).
pub(crate) fn mixture(x: &[f64], length: usize) -> Option<NoiseModel> {
    (x[0] >= 0.05 && x[0] <= slowest(length) && x[1].abs() <= 8.0).then(|| NoiseModel::WhiteAndAutoregressive {
        correlation: (0.5 * x[0]).tanh(),
        share: share(x[1]),
    })
}

/// ln(s/(1 − s)) of a share of all but rounding.
const ALONE: f64 = 30.0;

/// a from its double, and the share as above.
pub(crate) fn power_law(x: &[f64], longest: f64) -> Option<NoiseModel> {
    ((0.6..=4.4).contains(&x[0]) && (x[1].abs() <= 8.0 || x[1] == ALONE)).then(|| NoiseModel::PowerLaw {
        exponent: 0.5 * x[0],
        share: share(x[1]),
        longest,
    })
}

fn share(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

impl<'a> Slow<'a> {
    /// Residuals beside the columns of a fit of `samples`, in series of `length` samples.
    pub(crate) fn new(jacobian: &[&'a [f64]], residuals: &'a [f64], length: usize, samples: usize) -> Self {
        let columns: Vec<&[f64]> = jacobian.iter().copied().chain([residuals]).collect();
        Self {
            rows: Rows::new(&columns),
            residuals,
            length,
            longest: OUTLASTS * samples as f64,
        }
    }

    /// The restricted likelihood of each of some models.
    pub(crate) fn likelihoods(&self, models: &[Option<NoiseModel>]) -> Vec<Option<Likelihood>> {
        let of =
            |(product, log_determinant): (Vec<f64>, f64)| Likelihood::of(&product, log_determinant, self.rows.samples);
        let parts = models.iter().copied().flatten().map(NoiseModel::parts);
        let mut found = whitened(&self.rows, self.length, parts).into_iter().map(of);
        models.iter().map(|model| model.and_then(|_| found.next()?)).collect()
    }

    /// The best white noise with AR(1), if a first look finds a deviance that promises to fall below this one.
    pub(crate) fn mixture(&self, deviance: f64) -> Option<Kind> {
        let kappas = (1..).map(|i| 1.2 * f64::from(i)).take_while(|kappa| *kappa < slowest(self.length));
        let places: Vec<[f64; 2]> = kappas.flat_map(|kappa| [-2.5, 0.0, 2.5].map(|share| [kappa, share])).collect();
        self.best(&places, deviance, |x| mixture(x, self.length))
    }

    /// The best power law without white noise, likewise.
    pub(crate) fn power_alone(&self, deviance: f64) -> Option<Kind> {
        let places = [1.0, 2.0, 3.0, 4.0].map(|twice| [twice]);
        self.best(&places, deviance, |x| power_law(&[x[0], ALONE], self.longest))
    }

    /// The best power law with white noise, likewise.
    pub(crate) fn power_law(&self, deviance: f64) -> Option<Kind> {
        let places: Vec<[f64; 2]> = [1.4, 2.4, 3.6]
            .into_iter()
            .flat_map(|twice| [-3.0, -1.0, 1.0, 4.0].map(|share| [twice, share]))
            .collect();
        self.best(&places, deviance, |x| power_law(x, self.longest))
    }

    fn best<const K: usize>(
        &self,
        places: &[[f64; K]],
        deviance: f64,
        model: impl Fn(&[f64]) -> Option<NoiseModel>,
    ) -> Option<Kind> {
        // Where to begin: means of neighbouring residuals can tell, as if nothing had been fitted.
        let together = self.length.div_ceil(GLANCE);
        let length = self.length / together;
        let mean = |some: &[f64]| some.iter().sum::<f64>() / together as f64;
        let series = self.residuals.chunks_exact(self.length);
        let means: Vec<f64> = series.flat_map(|series| series.chunks_exact(together).map(mean)).collect();
        let count = means.len() as f64;
        let models: Vec<(NoiseModel, [f64; K])> =
            places.iter().filter_map(|place| Some((model(place)?, *place))).collect();
        let parts = models.iter().map(|(model, _)| model.of_means(together));
        let deviances = whitened(&Rows::new(&[&means]), length, parts)
            .into_iter()
            .map(|(square, log_determinant)| count * (square[0] / count).ln() + log_determinant);
        let alone = models.iter().zip(deviances).filter(|(_, deviance)| deviance.is_finite());
        let ((_, start), _) = alone.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let evaluate = |points: &[Few]| {
            let models: Vec<Option<NoiseModel>> = points.iter().map(|x| model(x)).collect();
            self.likelihoods(&models)
        };
        let found = minimise(&evaluate, start, deviance - PROMISE)?;
        Kind::about(&found, &evaluate, &model)
    }
}

/// WᵀW and ln |R| of each of some noises with these parts, by which rows are whitened in series of `length` samples.
fn whitened(rows: &Rows, length: usize, noises: impl Iterator<Item = Parts>) -> Vec<(Vec<f64>, f64)> {
    let noises: Vec<Parts> = noises.collect();
    let of_some = |some: &[Parts]| {
        let all = match some.iter().all(|parts| parts.len() <= 1) {
            true => rows.whitened(&Noises::<1>::new(some), length),
            false => rows.whitened(&Noises::<MOST_PARTS>::new(some), length),
        };
        all.into_iter().take(some.len()).collect::<Vec<_>>()
    };
    noises.chunks(LANES).flat_map(of_some).collect()
}

/// Most means of neighbours of a series that a first look takes.
const GLANCE: usize = 200;

/// The longest correlation time of a power law over the length of the hold: what is slower still looks like a constant.
const OUTLASTS: f64 = 16.0;
