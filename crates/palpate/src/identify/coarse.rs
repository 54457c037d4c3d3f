//! The exhaustive coarse search that makes starting values unnecessary.

use super::separable::Work;
use crate::latency::decay_many;

/// A hold condensed to a few dozen weighted points: single samples first, then means over bins that widen with time.
///
/// The shape of the law hardly changes inside a bin, so the condensed hold has nearly the residual of the whole one.
pub(super) struct Condensed {
    times: Vec<f64>,
    values: Vec<f64>,
    weights: Vec<f64>,
}

/// Points that a condensed hold has at most, about.
const POINTS: usize = 56;

impl Condensed {
    pub(super) fn new(times: &[f64], values: &[f64]) -> Self {
        let count = times.len();
        let mut condensed = Self {
            times: Vec::with_capacity(POINTS),
            values: Vec::with_capacity(POINTS),
            weights: Vec::with_capacity(POINTS),
        };
        let growth = if count > POINTS { (count as f64 / 16.0).powf(1.0 / 36.0) } else { 1.0 };
        let mut from = 0;
        while from < count {
            let until = (((from as f64) * growth) as usize).clamp(from + 1, count);
            let weight = (until - from) as f64;
            condensed.times.push(times[from..until].iter().sum::<f64>() / weight);
            condensed.values.push(values[from..until].iter().sum::<f64>() / weight);
            condensed.weights.push(weight);
            from = until;
        }
        condensed
    }

    /// Residual square of the best constant + amplitude × φ(λ t; n), up to a constant.
    fn residual(&self, rate: f64, exponent: f64, phi: &mut [f64]) -> f64 {
        decay_many(&self.times, rate, exponent, phi);
        let (mut w, mut wp, mut wpp, mut wy, mut wpy, mut wyy) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for ((&weight, &y), &p) in self.weights.iter().zip(&self.values).zip(phi.iter()) {
            w += weight;
            wp += weight * p;
            wpp += weight * p * p;
            wy += weight * y;
            wpy += weight * p * y;
            wyy += weight * y * y;
        }
        let (spread, shared) = (wpp - wp * wp / w, wpy - wp * wy / w);
        let total = wyy - wy * wy / w;
        // A shape that is flat over the hold explains nothing.
        if spread <= 1e-14 * wpp { total } else { total - shared * shared / spread }
    }

    /// ln λ at the bottom of a valley found on the grid: the vertex of a parabola through three points, three times over
    /// with points ever closer. Condensed residuals cost next to nothing, and every step saved later costs all samples.
    fn bottom(&self, mut at: f64, mut here: f64, grid: f64, exponent: f64, phi: &mut [f64]) -> f64 {
        for width in [grid, 0.15 * grid, 0.02 * grid] {
            let before = self.residual((at - width).exp(), exponent, phi);
            let after = self.residual((at + width).exp(), exponent, phi);
            let curvature = before - 2.0 * here + after;
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            at += width * (0.5 * (before - after) / curvature).clamp(-1.0, 1.0);
            here = self.residual(at.exp(), exponent, phi);
        }
        at
    }

    /// Starts worth refining, best first: the local minima of the residual over a grid of ln λ, for every exponent given.
    pub(super) fn starts(
        &self,
        log_rates: (f64, f64),
        exponents: &[f64],
        most: usize,
        work: &mut Work,
    ) -> Vec<(f64, f64)> {
        // A law with n < 1 ends in finite time, and the residual has a kink wherever that end passes a sample.
        let step = |exponent: f64| if exponent < 1.0 { 0.1 } else { 1.0 };
        let mut phi = vec![0.0; self.times.len()];
        let mut found: Vec<(f64, f64, f64)> = Vec::new();
        for &exponent in exponents {
            let steps = ((log_rates.1 - log_rates.0) / step(exponent)).ceil().max(2.0) as usize;
            let rate = |i: usize| log_rates.0 + (log_rates.1 - log_rates.0) * i as f64 / steps as f64;
            let residuals: Vec<f64> = (0..=steps).map(|i| self.residual(rate(i).exp(), exponent, &mut phi)).collect();
            work.grid_points += residuals.len() as u64;
            for i in 0..=steps {
                let below = |j: Option<&f64>| j.is_none_or(|other| residuals[i] <= *other);
                let before = i.checked_sub(1).and_then(|i| residuals.get(i));
                if below(before) && below(residuals.get(i + 1)) {
                    let step = (log_rates.1 - log_rates.0) / steps as f64;
                    let bottom = self.bottom(rate(i), residuals[i], step, exponent, &mut phi);
                    found.push((residuals[i], bottom.clamp(log_rates.0, log_rates.1), exponent));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(most);
        found.into_iter().map(|(_, rate, exponent)| (rate, exponent)).collect()
    }
}
