//! Turning points: all of a column, and those that noise makes look like a standstill.

use crate::optimise::fit_linear;
use crate::segment::standstill::Level;

/// Whether a stretch about a level, half as long again on either side, is one smooth turning point.
///
/// The parabola must leave no more than `share` of the square deviation from the mean.
pub(super) fn turns(time: &[f64], values: &[f64], level: Level, tolerance: f64, share: f64) -> bool {
    let duration = time[level.end - 1] - time[level.start];
    let from = time.partition_point(|t| *t < time[level.start] - 0.25 * duration);
    let until = time.partition_point(|t| *t <= time[level.end - 1] + 0.25 * duration);
    let centre = 0.5 * (time[level.start] + time[level.end - 1]);
    let scaled: Vec<(f64, f64)> =
        (from..until).map(|i| (2.0 * (time[i] - centre) / duration, values[i] - level.value)).collect();
    let Some((fit, curvature, vertex)) = parabola(&scaled) else {
        return false;
    };
    let inside: Vec<&(f64, f64)> = scaled.iter().filter(|(u, _)| u.abs() <= 1.0).collect();
    let square =
        |f: &dyn Fn(f64) -> f64| inside.iter().map(|(u, v)| (v - f(*u)).powi(2)).sum::<f64>() / inside.len() as f64;
    let mean = inside.iter().map(|(_, v)| v).sum::<f64>() / inside.len() as f64;
    let (flat, bent) = (square(&|_| mean), square(&|u| fit[0] + u * (fit[1] + u * fit[2])));
    // A flat level with ramps beside it is fitted worse by the parabola than by its own mean.
    curvature.abs() > 0.1 * tolerance && vertex.abs() < 0.5 && bent < share * flat
}

/// The turning points of a column that turns by more than `turn`, with its first and its last sample.
pub(super) fn extremes(values: &[f64], turn: f64) -> Vec<usize> {
    let mut found = vec![0];
    let (mut low, mut high, mut rising) = (0, 0, None);
    for (i, value) in values.iter().enumerate() {
        if *value > values[high] {
            high = i;
        }
        if *value < values[low] {
            low = i;
        }
        let turned = match rising {
            Some(true) | None if values[high] - value > turn => Some((high, false)),
            Some(false) | None if value - values[low] > turn => Some((low, true)),
            _ => None,
        };
        if let Some((at, up)) = turned {
            if at > 0 {
                found.push(at);
            }
            (low, high, rising) = (i, i, Some(up));
        }
    }
    found.push(values.len() - 1);
    found
}

/// Least-squares parabola: its coefficients, curvature and vertex.
fn parabola(points: &[(f64, f64)]) -> Option<([f64; 3], f64, f64)> {
    let [level, slope, bend] = fit_linear(points.iter().map(|(u, v)| ([1.0, *u, u * u], *v, 1.0)), 0.0)?.factors;
    (points.len() > 3).then_some(([level, slope, bend], bend, -0.5 * slope / bend))
}
