//! What is combined: laws, and straight lines in the logarithm or a power of time through the later samples alone.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::fit::{Condensed, FitError, LawOptions, Samples, before, condensed_curve, extrapolated};
use crate::laws::{Law, LawCurve};
use crate::statistics::interpolated;

/// Fewest samples that a course through the later ones is fitted to.
const FEWEST: usize = 6;

/// One of the forecasts that are combined.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForecastMember {
    /// A law fitted to all samples.
    Law(Law),
    /// a + b ln t through the samples after this share of the duration.
    Logarithm(f64),
    /// a + b tᵖ through the samples after this share of the duration, with p from −2 to 1.
    Power(f64),
    /// a + b x(t) with the course x of each other hold of the body that is longer, through the samples after this share of the duration.
    OtherHolds(f64),
}

impl fmt::Display for ForecastMember {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Law(law) => law.fmt(f),
            Self::Logarithm(share) => write!(f, "logarithm of time from {share} of the hold"),
            Self::Power(share) => write!(f, "power of time from {share} of the hold"),
            Self::OtherHolds(share) => write!(f, "course of the other holds from {share} of the hold"),
        }
    }
}

/// Shares of the duration from which on later samples are taken.
const LATER: [f64; 2] = [0.1, 0.3];

/// All members beside these laws that need no other hold.
pub(super) fn members(laws: &[Law]) -> Vec<ForecastMember> {
    let later = LATER.iter().flat_map(|share| [ForecastMember::Logarithm(*share), ForecastMember::Power(*share)]);
    laws.iter().copied().map(ForecastMember::Law).chain(later).collect()
}

/// A member fitted.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Course {
    Law(Law, LawCurve),
    /// a + b (t/c)ᵖ, or a + b ln(t/c) where p is 0.
    Later {
        scale: f64,
        power: f64,
        a: f64,
        b: f64,
    },
    /// Values at rising times since the first sample, s.
    Known {
        times: Vec<f64>,
        values: Vec<f64>,
    },
}

impl Course {
    /// Fits a member to a hold.
    pub(super) fn of(member: ForecastMember, samples: &Samples<'_>, options: &LawOptions) -> Result<Self, FitError> {
        let (share, powers) = match member {
            ForecastMember::Law(law) => return Ok(Self::Law(law, condensed_curve(samples, law, options)?)),
            ForecastMember::Logarithm(share) => (share, vec![0.0]),
            ForecastMember::Power(share) => {
                (share, (-16..=8).filter(|i| *i != 0).map(|i| 0.125 * f64::from(i)).collect())
            }
            ForecastMember::OtherHolds(_) => return Err(FitError::NoDecay),
        };
        let start = samples.times[0];
        let scale = samples.times[samples.times.len() - 1] - start;
        let first = before(samples.times, share * scale);
        let later = samples.times.len() - first;
        if later < FEWEST {
            return Err(FitError::TooFewSamples {
                parameters: 2,
                needed: FEWEST,
                found: later,
            });
        }
        let times: Vec<f64> = samples.times[first..].iter().map(|t| (t - start) / scale).collect();
        let nodes = Condensed::finer(&times, &samples.values[first..]);
        let fitted = powers.into_iter().filter_map(|power| straight(&nodes, power).map(|line| (power, line)));
        let best = fitted.min_by(|(_, one), (_, other)| one.2.total_cmp(&other.2));
        let (power, (a, b, _)) = best.ok_or(FitError::NoDecay)?;
        Ok(Self::Later { scale, power, a, b })
    }

    /// Its values at times since the first sample, s.
    pub(super) fn at(&self, times: &[f64], options: &LawOptions) -> Vec<f64> {
        match self {
            Self::Law(law, curve) => extrapolated(curve, *law, options, times),
            Self::Later { scale, power, a, b } => {
                times.iter().map(|time| a + b * abscissa(time / scale, *power)).collect()
            }
            Self::Known { times: known, values } => interpolated(known, values, times),
        }
    }
}

/// What such a course is straight in, from a millionth of the duration on.
fn abscissa(time: f64, power: f64) -> f64 {
    let time = time.max(1e-6);
    if power == 0.0 { time.ln() } else { time.powf(power) }
}

/// The line through the nodes, and the square that it leaves.
fn straight(nodes: &Condensed, power: f64) -> Option<(f64, f64, f64)> {
    let values = nodes.values.iter().zip(&nodes.roots);
    let point = |(t, (y, root)): (&f64, (&f64, &f64))| (abscissa(*t, power), y / root, root * root);
    line(&nodes.times.iter().zip(values).map(point).collect::<Vec<_>>())
}

/// a and b of the line y = a + b x through points (x, y, weight), and the weighted square that it leaves.
pub(super) fn line(points: &[(f64, f64, f64)]) -> Option<(f64, f64, f64)> {
    let weight: f64 = points.iter().map(|(_, _, w)| w).sum();
    let mean = |(x, y): (f64, f64), (at, value, w): &(f64, f64, f64)| (x + w * at / weight, y + w * value / weight);
    let (x, y) = points.iter().fold((0.0, 0.0), mean);
    let (square, product) = points.iter().fold((0.0, 0.0), |(square, product), (at, value, w)| {
        (square + w * (at - x) * (at - x), product + w * (at - x) * (value - y))
    });
    let slope = product / square;
    let left: f64 = points.iter().map(|(at, value, w)| w * (value - y - slope * (at - x)).powi(2)).sum();
    (slope.is_finite() && left.is_finite()).then_some((y - slope * x, slope, left))
}
