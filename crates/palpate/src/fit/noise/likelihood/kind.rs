//! The restricted likelihood, and the models of one kind of noise by it.

use crate::fit::noise::model::{Likely, NoiseModel};
use crate::optimise::{Cholesky, Few, Level, Minimum, Square};
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

/// The largest κ = ln((1 + ρ)/(1 − ρ)), ln of how many samples count as one, for a series of this length: a random walk is as good as that.
pub(crate) fn slowest(length: usize) -> f64 {
    (length as f64).ln() + 2.5
}

/// ln(s/(1 − s)) of shares s that differ from nothing and from all.
pub(crate) const SHARES: (f64, f64) = (-8.0, 8.0);

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
