//! Where a curve bends: two pieces that meet.

use crate::optimise::fit_linear;

/// The place at which two pieces of a curve meet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kink {
    /// When, s.
    pub(super) time: f64,
    /// Its standard error, s.
    pub(super) error: f64,
    /// Slope behind it less slope before it, per s.
    pub(super) bend: f64,
    /// Standard deviation of the residuals.
    pub(super) noise: f64,
}

/// A straight piece and one that is straight (`N` = 3) or a parabola (4) behind it, by least squares; the kink is sought within
/// `span` (s) of `around` (s). `None` where it lies at the edge of that, or where nothing bends.
pub(super) fn kink<const N: usize>(times: &[f64], values: &[f64], around: f64, span: f64) -> Option<Kink> {
    const GRID: u32 = 40;
    if times.len() < N + 3 {
        return None;
    }
    let scale = 0.5 * (times[times.len() - 1] - times[0]);
    let square = |at: f64| fitted::<N>(times, values, at, scale).map_or(f64::INFINITY, |(_, square)| square);
    let place = |i: u32| around + span * (2.0 * f64::from(i) / f64::from(GRID) - 1.0);
    let best = (0..=GRID).min_by(|a, b| square(place(*a)).total_cmp(&square(place(*b))))?;
    if best == 0 || best == GRID {
        return None;
    }
    let time = lowest(place(best - 1), place(best + 1), &square);
    let (slopes, least) = fitted::<N>(times, values, time, scale)?;
    let bend = (slopes[2] - slopes[1]) / scale;
    let variance = least / (times.len() - N - 1) as f64;
    // Twice the variance over the curvature of the sum of squares, and never less than two crossing lines allow.
    let step = 0.5 * scale / times.len() as f64;
    let curvature = (square(time + step) - 2.0 * least + square(time - step)) / (step * step);
    let crossing = (8.0 * variance / times.len() as f64).sqrt() / bend.abs();
    let error = if curvature > 0.0 { (2.0 * variance / curvature).sqrt() } else { f64::INFINITY };
    let error = error.max(crossing);
    error.is_finite().then_some(Kink {
        time,
        error,
        bend,
        noise: variance.sqrt(),
    })
}

/// Golden-section search between two places.
fn lowest(mut low: f64, mut high: f64, square: &impl Fn(f64) -> f64) -> f64 {
    const SHARE: f64 = 0.381_966;
    for _ in 0..30 {
        let (a, b) = (low + SHARE * (high - low), high - SHARE * (high - low));
        if square(a) < square(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
}

/// Coefficients of 1, (t − c)₋, (t − c)₊ and (t − c)₊² with the kink c at `at` (times in units of `scale`), and the sum of
/// squared residuals.
fn fitted<const N: usize>(times: &[f64], values: &[f64], at: f64, scale: f64) -> Option<([f64; N], f64)> {
    let row = |time: f64| -> [f64; N] {
        let s = (time - at) / scale;
        let all = [1.0, s.min(0.0), s.max(0.0), s.max(0.0).powi(2)];
        std::array::from_fn(|i| all[i])
    };
    let middle = values.iter().sum::<f64>() / values.len() as f64;
    let rows = times.iter().zip(values).map(|(time, value)| (row(*time), value - middle, 1.0));
    let solution = fit_linear(rows, 1e-10)?.factors;
    let predicted = |time: f64| row(time).iter().zip(&solution).map(|(a, b)| a * b).sum::<f64>();
    let square = times.iter().zip(values).map(|(t, y)| (y - middle - predicted(*t)).powi(2)).sum();
    Some((solution, square))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    #[test]
    fn kinks_between_samples_are_found() {
        let times: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
        let line = |t: &f64| if *t < 2.03 { 3.0 * (t - 2.03) } else { -0.5 * (t - 2.03) };
        let found = kink::<3>(&times, &times.iter().map(line).collect::<Vec<_>>(), 2.0, 0.5).unwrap();
        assert!((found.time - 2.03).abs() < 1e-5 && (found.bend + 3.5).abs() < 1e-4, "{found:?}");
        let parabola = |t: &f64| line(t) + 0.2 * (t - 2.03).max(0.0).powi(2);
        let found = kink::<4>(&times, &times.iter().map(parabola).collect::<Vec<_>>(), 2.0, 0.5).unwrap();
        assert!((found.time - 2.03).abs() < 1e-5, "{found:?}");
        assert!(kink::<3>(&times, &times, 2.0, 0.5).is_none_or(|found| found.bend.abs() < 1e-6));
        assert!(kink::<3>(&times, &times.iter().map(line).collect::<Vec<_>>(), 3.5, 0.5).is_none());
    }

    #[test]
    fn the_error_is_that_of_many_trials() {
        let times: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
        let mut random = Rng::new(11);
        let mut ratios = Vec::new();
        for _ in 0..200 {
            let line = |t: &f64| if *t < 2.03 { 3.0 * (t - 2.03) } else { -0.5 * (t - 2.03) } + 0.1 * random.normal();
            let values: Vec<f64> = times.iter().map(line).collect();
            if let Some(found) = kink::<3>(&times, &values, 2.0, 0.8) {
                ratios.push((found.time - 2.03) / found.error);
            }
        }
        let square = ratios.iter().map(|r| r * r).sum::<f64>() / ratios.len() as f64;
        assert!(ratios.len() > 190 && (0.7..1.4).contains(&square.sqrt()), "{} of {}", square.sqrt(), ratios.len());
    }
}
