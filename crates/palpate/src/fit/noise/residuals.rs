//! Residuals of a fit, with what they show at once of how they correlate.

use super::autoregression::{MOST_ORDER, innovations};
use crate::optimise::Few;
use crate::statistics::dot;

/// Fall of N ln σ² that a sample to look back at has to bring before it is tried: the last one, and each before it.
const EVIDENCE: [f64; 2] = [4.0, 7.0];

/// The residuals of a fit.
pub(crate) struct Residuals<'a> {
    pub(crate) values: &'a [f64],
    /// Σ rᵢ².
    pub(crate) square: f64,
    /// Σ rᵢ rᵢ₊ₖ over it, for k from 1.
    pub(crate) correlations: [f64; MOST_ORDER],
    /// Partial autocorrelations, as many as speak for themselves.
    pub(crate) partial: Few,
    /// Whether those behind are above 0 together, by two standard deviations: then noise lasts longer than such an autoregression would.
    pub(crate) lasts: bool,
}

impl<'a> Residuals<'a> {
    /// Those of a fit of so many parameters.
    pub(crate) fn of(values: &'a [f64], parameters: usize) -> Self {
        let square = dot(values, values);
        let correlation = |lag: usize| match values.get(lag..) {
            Some(later) if square > 0.0 => (dot(later, &values[..later.len()]) / square).clamp(-1.0, 1.0),
            _ => 0.0,
        };
        let correlations = std::array::from_fn(|index| correlation(index + 1));
        let (partial, lasts) = partial(&correlations, values.len(), parameters);
        Self {
            values,
            square,
            correlations,
            partial,
            lasts,
        }
    }
}

/// Residuals made white by the autoregression that some of them show, `resting`, in the unit of the residuals.
pub(crate) fn whitened(residuals: &[f64], resting: &[f64], parameters: usize) -> Vec<f64> {
    innovations(residuals, &Residuals::of(resting, parameters).partial)
}

/// The partial autocorrelations of residuals, as many as speak for themselves; and whether those behind are above 0 together, by two standard
/// deviations: then noise lasts longer than such an autoregression would.
///
/// Each fitted parameter pulls the correlations of residuals down by some 1/N, that of a sample with itself too: what adds it to the others
/// alone makes correlations beyond 1 of smooth noise.
fn partial(correlations: &[f64], samples: usize, parameters: usize) -> (Few, bool) {
    /// Partial autocorrelations behind the first that are looked at together.
    const BEHIND: usize = 3;
    let taken = parameters as f64 / samples as f64;
    let lags: Few = correlations.iter().map(|correlation| (correlation + taken) / (1.0 + taken)).collect();
    let (mut kept, mut variance) = (Few::new(), 1.0);
    let (mut all, mut best) = (Few::new(), (0.0, 0));
    for (index, correlation) in lags.iter().enumerate() {
        let predicted: f64 = kept.iter().zip(lags[..index].iter().rev()).map(|(by, r)| by * r).sum();
        let by = (correlation - predicted) / variance;
        if by.is_nan() || by.abs() >= 1.0 || samples <= 4 * (index + 1) {
            break;
        }
        kept = kept.iter().zip(kept.iter().rev()).map(|(ahead, back)| ahead - by * back).chain([by]).collect();
        variance *= 1.0 - by * by;
        all.push(by);
        let price = samples as f64 * variance.ln() + EVIDENCE[0] + EVIDENCE[1] * index as f64;
        if price < best.0 {
            best = (price, all.len());
        }
    }
    let behind = all.iter().skip(best.1.max(1)).take(BEHIND);
    let lasts = behind.clone().sum::<f64>() > 2.0 * (behind.len() as f64 / samples as f64).sqrt();
    all.truncate(best.1);
    (all, lasts)
}
