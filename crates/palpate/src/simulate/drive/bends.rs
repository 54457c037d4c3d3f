//! More knots where samples bend away from straight stretches.

use super::hats::{hats, residuals};
use super::motion::Motion;

/// How often knots are added at most; each time every stretch may have one more.
const ROUNDS: usize = 32;

/// What a knot takes off the square of the residuals, over their variance: where noise alone is left, the largest of all samples of a stretch is
/// above it in one of 1,000.
const BEYOND: f64 = 18.0;

/// Share of the tolerance that counts as noise where there is none.
const LEAST: f64 = 1e-3;

/// Adds knots, at samples, until what straight stretches leave of the samples has no course that is higher than `within` (m).
///
/// Lines that keep within a tolerance of a curve leave residuals with a course, and the contact is driven by a motion that is off by it.
pub(super) fn add_bends(samples: &Motion, knots: &mut Vec<f64>, tolerance: f64, within: f64) {
    let times = samples.times();
    let mut more = knots.clone();
    for _ in 0..ROUNDS {
        let Some(motion) = hats(samples, &more).and_then(|(values, _)| Motion::new(more.clone(), values).ok()) else {
            return;
        };
        knots.clone_from(&more);
        let left: Vec<f64> = residuals(samples, &motion).collect();
        let freedom = times.len().saturating_sub(knots.len()).max(1);
        let square: f64 = left.iter().map(|off| off * off).sum();
        let variance = (square / freedom as f64).max((LEAST * tolerance).powi(2));
        let bend = |pair: &[f64]| {
            let from = times.partition_point(|time| *time < pair[0]);
            let end = times.partition_point(|time| *time <= pair[1]);
            let bend = Bend::of(&times[from..end], &left[from..end])?;
            (bend.drop > BEYOND * variance && bend.height > within).then_some(bend.time)
        };
        more.extend(knots.windows(2).filter_map(bend));
        if more.len() == knots.len() {
            return;
        }
        more.sort_by(f64::total_cmp);
    }
}

/// A knot inside a stretch.
struct Bend {
    /// Its time, that of a sample.
    time: f64,
    /// What it takes off the square of the residuals.
    drop: f64,
    /// How far it moves a sample at most.
    height: f64,
}

impl Bend {
    /// The one that takes off most. With r the residuals and h = max(t − c, 0) less its line by least squares, a knot at sample c takes off
    /// (Σ r h)²/Σ h². Sums from the end of the stretch on give it for every c.
    fn of(times: &[f64], left: &[f64]) -> Option<Self> {
        /// Share of Σ max(t − c, 0)² below which rounding has left Σ h².
        const SINGULAR: f64 = 1e-9;
        let (first, last) = (times.first()?, times.last()?);
        let count = times.len() as f64;
        let middle = times.iter().sum::<f64>() / count;
        let (mut spread, mut level, mut slope) = (0.0, 0.0, 0.0);
        for (time, off) in times.iter().zip(left) {
            let t = time - middle;
            spread += t * t;
            level += off / count;
            slope += t * off;
        }
        slope /= spread;
        let (first, last) = (first - middle, last - middle);
        let mut best: Option<Self> = None;
        let [mut n, mut t, mut tt, mut r, mut tr] = [0.0; 5];
        for (time, off) in times.iter().zip(left).skip(1).rev() {
            let c = time - middle;
            // Sums of max(t − c, 0), of its products with t, itself and r.
            let (sum, with_t, square, product) = (t - c * n, tt - c * t, tt - 2.0 * c * t + c * c * n, tr - c * r);
            n += 1.0;
            t += c;
            tt += c * c;
            r += off;
            tr += c * off;
            let (mean, tilt) = (sum / count, with_t / spread);
            let own = square - sum * mean - with_t * tilt;
            if own.is_nan() || own <= SINGULAR * square {
                continue;
            }
            let along = product - sum * level - with_t * slope;
            let drop = along * along / own;
            if best.as_ref().is_none_or(|best| drop > best.drop) {
                let h = |t: f64| ((t - c).max(0.0) - mean - tilt * t).abs();
                let height = (along / own).abs() * h(first).max(h(c)).max(h(last));
                best = Some(Self {
                    time: *time,
                    drop,
                    height,
                });
            }
        }
        best
    }
}
