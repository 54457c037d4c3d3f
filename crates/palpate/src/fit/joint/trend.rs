//! Whether a parameter goes with the strain over several holds: regression of estimates that have errors of their own.

use serde::{Deserialize, Serialize};

use crate::statistics::{coverage_factor, normal_factor, range};

/// ln of a parameter against an abscissa over the holds: ln v_h = a + b x_h + u_h + e_h.
///
/// e_h is the error of the hold's own fit, u_h what holds differ by beyond it, of variance τ² (DerSimonian and Laird's moment
/// estimate). The slope's error follows from the scatter about the line (Hartung and Knapp), but is never below what the fits' own errors make it; its interval from Student's t
/// with H − 2 degrees of freedom; errors of x are not counted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SharedTrend {
    /// Which parameter.
    pub parameter: String,
    /// d ln(parameter)/dx.
    pub slope: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Its confidence interval. Two holds lie on a line: their interval follows from the errors of their fits alone.
    pub interval: (f64, f64),
    /// τ, standard deviation between holds beyond their errors, in ln.
    pub between_holds: f64,
    /// The holds that count.
    pub points: Vec<TrendPoint>,
}

/// One hold in a trend.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct TrendPoint {
    /// Number of the hold among those fitted, from 1.
    pub hold: usize,
    /// x, such as the equilibrium strain.
    pub abscissa: f64,
    /// ln of the parameter, all holds at the same dimensionless parameters.
    pub log_value: f64,
    /// Its standard error, for correlated residuals.
    pub standard_error: f64,
    /// What ln of the parameter gains per standard error of the dimensionless parameter that was held alike.
    pub by_held: f64,
}

impl SharedTrend {
    /// The slope through these points; `None` for fewer than two, or if all lie at one x.
    pub(crate) fn of(parameter: String, points: Vec<TrendPoint>, confidence: f64) -> Option<Self> {
        let count = points.len() as f64;
        let mean = points.iter().map(|point| point.abscissa).sum::<f64>() / count;
        let spread: f64 = points.iter().map(|point| (point.abscissa - mean).powi(2)).sum();
        // Holds at one level show no trend.
        if points.len() < 2 || spread <= (1e-3 * mean).powi(2) * count {
            return None;
        }
        let freedom = count - 2.0;
        let alone = Line::through(&points, 0.0);
        let between = if freedom > 0.0 { ((alone.scatter - freedom) / alone.trace).max(0.0) } else { 0.0 };
        let line = Line::through(&points, between);
        let (scatter, factor) = match freedom {
            0.0 => (1.0, normal_factor(confidence)),
            _ => ((line.scatter / freedom).max(1.0), coverage_factor(confidence, freedom)),
        };
        let standard_error = (scatter * line.variance + line.by_held.powi(2)).sqrt();
        Some(Self {
            parameter,
            slope: line.slope,
            standard_error,
            interval: (line.slope - factor * standard_error, line.slope + factor * standard_error),
            between_holds: between.sqrt(),
            points,
        })
    }

    /// By how much ln of the parameter can still change over the range of x: the largest size of slope in the interval, times it.
    #[must_use]
    pub fn most_change(&self) -> f64 {
        let abscissas: Vec<f64> = self.points.iter().map(|point| point.abscissa).collect();
        self.interval.0.abs().max(self.interval.1.abs()) * range(&abscissas)
    }
}

/// A weighted line.
struct Line {
    slope: f64,
    /// Variance of the slope by the weights.
    variance: f64,
    /// Weighted squares about the line.
    scatter: f64,
    /// What `scatter` gains per variance between holds.
    trace: f64,
    /// What the slope gains per standard error of the parameter held alike.
    by_held: f64,
}

impl Line {
    /// Weights are the inverse of each point's variance plus `between`.
    fn through(points: &[TrendPoint], between: f64) -> Self {
        // Errors of noise-free holds are rounding.
        let weight = |point: &TrendPoint| 1.0 / (point.standard_error.powi(2).max(1e-24) + between);
        let sum = |of: &dyn Fn(&TrendPoint) -> f64| points.iter().map(|point| weight(point) * of(point)).sum::<f64>();
        let total = sum(&|_| 1.0);
        let mean = sum(&|point| point.abscissa) / total;
        let from_mean = |point: &TrendPoint| point.abscissa - mean;
        let spread = sum(&|point| from_mean(point).powi(2));
        let slope = sum(&|point| from_mean(point) * point.log_value) / spread;
        let level = sum(&|point| point.log_value) / total;
        Self {
            slope,
            variance: 1.0 / spread,
            scatter: sum(&|point| (point.log_value - level - slope * from_mean(point)).powi(2)),
            trace: total - sum(&weight) / total - sum(&|point| weight(point) * from_mean(point).powi(2)) / spread,
            by_held: sum(&|point| from_mean(point) * point.by_held) / spread,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_problems::Rng;

    fn point(hold: usize, abscissa: f64, log_value: f64, standard_error: f64) -> TrendPoint {
        TrendPoint {
            hold,
            abscissa,
            log_value,
            standard_error,
            by_held: 0.0,
        }
    }

    #[test]
    fn the_between_hold_variance_is_that_of_the_published_formula() {
        // Worked by hand: errors 0.1, x = 0, 1, 2, 3, y = 0, 1, 0, 1. The line has slope 0.2 and leaves squares of 0.8, so
        // Q = 80, trace = 2/0.01, τ² = (80 − 2)/200 = 0.39; the scatter then is 0.8/0.4 and its share of the slope 0.8/2/5 = 0.08.
        let points = [0.0, 1.0, 0.0, 1.0].iter().enumerate().map(|(i, y)| point(i + 1, i as f64, *y, 0.1)).collect();
        let trend = SharedTrend::of("v".to_owned(), points, 0.95).unwrap();
        assert!((trend.slope - 0.2).abs() < 1e-12);
        assert!((trend.between_holds - 0.39f64.sqrt()).abs() < 1e-12);
        assert!((trend.standard_error - 0.08f64.sqrt()).abs() < 1e-12);
        // Student t, 2 degrees of freedom, 95 %: 4.302653 (standard table)
        assert!((trend.interval.1 - 0.2 - 4.302_653 * 0.08f64.sqrt()).abs() < 1e-5);
    }

    #[test]
    fn two_holds_rest_on_their_own_errors_and_one_level_has_no_trend() {
        let trend =
            SharedTrend::of("v".to_owned(), vec![point(1, 0.0, 0.0, 0.3), point(2, 2.0, 1.0, 0.4)], 0.95).unwrap();
        assert!((trend.slope - 0.5).abs() < 1e-12 && (trend.standard_error - 0.25).abs() < 1e-12);
        assert!((trend.interval.1 - 0.5 - 0.25 * 1.959_964).abs() < 1e-6);
        assert!(
            SharedTrend::of("v".to_owned(), vec![point(1, 0.2, 0.0, 0.3), point(2, 0.2, 1.0, 0.4)], 0.95).is_none()
        );
    }

    #[test]
    fn intervals_cover_as_often_as_they_say() {
        let mut random = Rng::new(5);
        for between in [0.0, 0.3] {
            let runs = 2000;
            let mut covered = 0;
            for _ in 0..runs {
                let mut draw = |hold: usize| {
                    let error = [0.1, 0.2, 0.15, 0.3, 0.1][hold];
                    let x = 0.1 * hold as f64;
                    point(hold + 1, x, 9.9 - 4.0 * x + error * random.normal() + between * random.normal(), error)
                };
                let trend = SharedTrend::of("v".to_owned(), (0..5).map(&mut draw).collect(), 0.95).unwrap();
                covered += usize::from(trend.interval.0 <= -4.0 && -4.0 <= trend.interval.1);
            }
            let share = covered as f64 / f64::from(runs);
            // Two thousand runs tell 95 % to within 0.5 %. More is expected: errors never count below their own size.
            println!("τ = {between}: {share}");
            assert!(share >= 0.93, "τ = {between}: {share}");
        }
    }
}
