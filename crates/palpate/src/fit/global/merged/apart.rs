//! Merged rates taken apart: amplitudes in doubles cannot follow rates that meet, since they grow without bounds against each other.

use crate::fit::problem::model::Sampled;
use crate::optimise::{Effort, Orthogonal, Shapes, Target};
use crate::vector::dot;
use crate::watch::Cancelled;

/// Where a local search ended.
pub(crate) struct Valley {
    pub(crate) theta: Vec<f64>,
    pub(crate) linear: Vec<f64>,
    pub(crate) square: f64,
}

/// The parameters of a place.
pub(crate) fn valley(here: Orthogonal) -> Valley {
    Valley {
        linear: here.linear(),
        theta: here.theta,
        square: here.square,
    }
}

/// The series with rates as far apart as its amplitudes need to be parameters: of some distances the one that leaves the least.
pub(crate) fn apart(
    shapes: &Sampled<'_>,
    target: Target<'_>,
    theta: &[f64],
    effort: &mut Effort<'_>,
) -> Result<Valley, Cancelled> {
    /// Distances of ln λ.
    const DISTANCES: [f64; 11] = [0.0, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 0.7, 1.3, 2.0];
    let mut sorted = theta.to_vec();
    sorted.sort_by(f64::total_cmp);
    let nearest = sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    if nearest > PLAINLY && sorted.first().is_some_and(|slowest| *slowest > -PLAINLY) {
        // Amplitudes are small, and what orthogonal columns leave is right to the last digit.
        return Ok(valley(Orthogonal::new(shapes, theta, target)));
    }
    let mut best: Option<Valley> = None;
    for least in DISTANCES.into_iter().filter(|least| *least == 0.0 || *least > nearest) {
        let here = Orthogonal::new(shapes, &spread(&sorted, least, shapes.bounds(0)), target);
        effort.evaluated()?;
        let mut valley = valley(here);
        // As the curve of these parameters leaves it once they are rounded: where amplitudes are large orthogonal columns leave less.
        let square = standing_square(shapes, target, &valley);
        valley.square = square + rounding(target, square, &valley.linear);
        if best.as_ref().is_none_or(|best| valley.square < best.square) {
            best = Some(valley);
        }
    }
    Ok(best.unwrap_or_else(|| valley(Orthogonal::new(shapes, theta, target))))
}

/// What rounding of large amplitudes and of their rates adds to a residual square: residuals are off by up to d = ε Σ|a| each, and
/// Σ (r + d)² − Σ r² = 2 d Σ r + N d².
pub(crate) fn rounding(target: Target<'_>, square: f64, linear: &[f64]) -> f64 {
    let weights = target.roots.map_or(target.values.len() as f64, |roots| dot(roots, roots));
    let off = f64::EPSILON * linear.iter().map(|factor| factor.abs()).sum::<f64>();
    // At worst is seldom: errors have either sign, and residuals too.
    0.2 * off * (weights * square).sqrt() + weights * off * off
}

/// Residual square of a valley's curve.
fn standing_square(shapes: &Sampled<'_>, target: Target<'_>, valley: &Valley) -> f64 {
    let samples = target.values.len();
    let mut columns = vec![vec![0.0; samples]; shapes.columns()];
    let mut derivatives = vec![vec![0.0; samples]; valley.theta.len()];
    shapes.fill(&valley.theta, &mut columns, &mut derivatives);
    let left = |i: usize| {
        let root = target.roots.map_or(1.0, |roots| roots[i]);
        let curve: f64 = columns.iter().zip(&valley.linear).map(|(column, factor)| factor * column[i]).sum();
        (target.values[i] - root * curve).powi(2)
    };
    let square: f64 = (0..samples).map(left).sum();
    if square.is_finite() { square } else { f64::INFINITY }
}

/// Rising rates with those nearer than `least` spread to that distance about their mean.
fn spread(rising: &[f64], least: f64, (low, high): (f64, f64)) -> Vec<f64> {
    let mut rates = rising.to_vec();
    let mut from = 0;
    while from < rates.len() {
        let mut until = from + 1;
        while until < rates.len() && rising[until] - rising[until - 1] < least {
            until += 1;
        }
        let run = &mut rates[from..until];
        let count = run.len();
        let half = 0.5 * least * (count - 1) as f64;
        let middle = (run.iter().sum::<f64>() / count as f64).clamp(low + half, (high - half).max(low + half));
        if count > 1 {
            run.iter_mut().enumerate().for_each(|(i, rate)| *rate = middle - half + least * i as f64);
        }
        from = until;
    }
    rates
}

/// Difference of ln λ of terms that are plainly apart, for rates that are plainly felt.
const PLAINLY: f64 = 0.3;
