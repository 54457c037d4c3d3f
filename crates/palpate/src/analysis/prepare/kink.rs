//! Where a curve bends: two pieces that meet.

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

/// Columns of the curve: 1, (t − c)₋, (t − c)₊ and, where it is curved behind the kink, (t − c)₊².
const COLUMNS: usize = 4;

/// A straight piece and one that is straight or (`curved`) a parabola behind it, by least squares; the kink is sought within
/// `span` (s) of `around` (s). `None` where it lies at the edge of that, or where nothing bends.
pub(super) fn kink(times: &[f64], values: &[f64], around: f64, span: f64, curved: bool) -> Option<Kink> {
    const GRID: u32 = 40;
    let columns = if curved { COLUMNS } else { COLUMNS - 1 };
    if times.len() < columns + 3 {
        return None;
    }
    let scale = 0.5 * (times[times.len() - 1] - times[0]);
    let square = |at: f64| fitted(times, values, at, scale, columns).map_or(f64::INFINITY, |(_, square)| square);
    let place = |i: u32| around + span * (2.0 * f64::from(i) / f64::from(GRID) - 1.0);
    let best = (0..=GRID).min_by(|a, b| square(place(*a)).total_cmp(&square(place(*b))))?;
    if best == 0 || best == GRID {
        return None;
    }
    let time = lowest(place(best - 1), place(best + 1), &square);
    let (slopes, least) = fitted(times, values, time, scale, columns)?;
    let bend = (slopes[2] - slopes[1]) / scale;
    let variance = least / (times.len() - columns - 1) as f64;
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

/// Coefficients (times in units of `scale`) and sum of squared residuals with the kink at `at`.
fn fitted(times: &[f64], values: &[f64], at: f64, scale: f64, columns: usize) -> Option<([f64; COLUMNS], f64)> {
    let row = |time: f64| {
        let s = (time - at) / scale;
        [1.0, s.min(0.0), s.max(0.0), s.max(0.0).powi(2)]
    };
    let middle = values.iter().sum::<f64>() / values.len() as f64;
    let mut normal = [[0.0; COLUMNS + 1]; COLUMNS];
    for (time, value) in times.iter().zip(values) {
        let row = row(*time);
        for (own, equation) in row.iter().zip(&mut normal).take(columns) {
            equation.iter_mut().zip(row).take(columns).for_each(|(entry, other)| *entry += own * other);
            equation[COLUMNS] += own * (value - middle);
        }
    }
    let solution = solved(normal, columns)?;
    let predicted = |time: f64| row(time).iter().zip(&solution).map(|(a, b)| a * b).sum::<f64>();
    let square = times.iter().zip(values).map(|(t, y)| (y - middle - predicted(*t)).powi(2)).sum();
    Some((solution, square))
}

/// Gauss's elimination of the first `count` equations; right sides stand last.
fn solved(mut rows: [[f64; COLUMNS + 1]; COLUMNS], count: usize) -> Option<[f64; COLUMNS]> {
    for k in 0..count {
        let pivot = (k..count).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs()))?;
        if rows[pivot][k].abs() < 1e-10 {
            return None;
        }
        rows.swap(k, pivot);
        let upper = rows[k];
        for row in rows.iter_mut().take(count).skip(k + 1) {
            let share = row[k] / upper[k];
            row.iter_mut().zip(upper).for_each(|(value, above)| *value -= share * above);
        }
    }
    let mut solution = [0.0; COLUMNS];
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|j| rows[k][j] * solution[j]).sum();
        solution[k] = (rows[k][COLUMNS] - known) / rows[k][k];
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Noise;

    #[test]
    fn kinks_between_samples_are_found() {
        let times: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
        let line = |t: &f64| if *t < 2.03 { 3.0 * (t - 2.03) } else { -0.5 * (t - 2.03) };
        let found = kink(&times, &times.iter().map(line).collect::<Vec<_>>(), 2.0, 0.5, false).unwrap();
        assert!((found.time - 2.03).abs() < 1e-5 && (found.bend + 3.5).abs() < 1e-4, "{found:?}");
        let parabola = |t: &f64| line(t) + 0.2 * (t - 2.03).max(0.0).powi(2);
        let found = kink(&times, &times.iter().map(parabola).collect::<Vec<_>>(), 2.0, 0.5, true).unwrap();
        assert!((found.time - 2.03).abs() < 1e-5, "{found:?}");
        assert!(kink(&times, &times, 2.0, 0.5, false).is_none_or(|found| found.bend.abs() < 1e-6));
        assert!(kink(&times, &times.iter().map(line).collect::<Vec<_>>(), 3.5, 0.5, false).is_none());
    }

    #[test]
    fn the_error_is_that_of_many_trials() {
        let times: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
        let mut random = Noise::new(11);
        let mut ratios = Vec::new();
        for _ in 0..200 {
            let line = |t: &f64| if *t < 2.03 { 3.0 * (t - 2.03) } else { -0.5 * (t - 2.03) } + 0.1 * random.normal();
            let values: Vec<f64> = times.iter().map(line).collect();
            if let Some(found) = kink(&times, &values, 2.0, 0.8, false) {
                ratios.push((found.time - 2.03) / found.error);
            }
        }
        let square = ratios.iter().map(|r| r * r).sum::<f64>() / ratios.len() as f64;
        assert!(ratios.len() > 190 && (0.7..1.4).contains(&square.sqrt()), "{} of {}", square.sqrt(), ratios.len());
    }
}
