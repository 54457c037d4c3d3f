//! What the noise of the measured displacement adds to the errors of the parameters.

use crate::calibrate::CalibrationData;
use crate::calibrate::problem::{Found, Problem, Response};
use crate::simulate::Motion;
use crate::watch::{Cancelled, Stages};

/// Knots whose effect is simulated at most; of more, evenly chosen ones stand for those between them.
const MOST_KNOTS: usize = 48;

/// Change of a knot over the deepest squeeze.
const STEP: f64 = 1e-4;

/// Covariance of the searched parameters `open` from the errors of the knots of the motion: A C Aᵀ with C the covariance of the knots,
/// A = (JᵀJ)⁻¹ Jᵀ K, and K the derivatives of the simulated forces by the knots. `None` for a motion that is exact.
pub(crate) fn from_displacement(
    problem: &Problem<'_>,
    data: &CalibrationData,
    found: &Found,
    open: &[Vec<f64>],
    stages: &mut Stages<'_>,
) -> Result<Option<Vec<Vec<f64>>>, Cancelled> {
    let Some(measured) = data.measured().filter(|measured| measured.noise > 0.0) else {
        return Ok(None);
    };
    let Some(response) = Response::new(open) else {
        return Ok(None);
    };
    let motion = data.motion();
    let (times, places) = (motion.times(), motion.displacements());
    // What the jaw did after the last fitted sample has no effect.
    let until = problem.times[problem.times.len() - 1];
    let count = (times.partition_point(|time| *time < until) + 1).min(times.len());
    let every = count.div_ceil(MOST_KNOTS).max(1);
    let chosen: Vec<usize> = (0..count).step_by(every).collect();
    let step = STEP * places.iter().copied().fold(0.0, f64::max);
    let mut effects = Vec::with_capacity(chosen.len());
    for knot in &chosen {
        stages.hear()?;
        let mut moved = places.to_vec();
        moved[*knot] += step;
        let motion = Motion::new(times.to_vec(), moved).ok();
        let forces = motion.and_then(|motion| {
            Problem {
                motion: &motion,
                ..*problem
            }
            .residuals(&found.theta)
        });
        let Some(moved) = forces else { return Ok(None) };
        effects.push(moved);
    }
    let effects: Vec<Vec<f64>> = effects
        .iter()
        .map(|moved| {
            let change: Vec<f64> =
                found.residuals.iter().zip(moved).map(|(still, moved)| (still - moved) / step).collect();
            response.to(&change)
        })
        .collect();
    let covariance = measured.covariance(&chosen);
    let entry = |i: usize, j: usize| {
        let row = |(k, row): (usize, &Vec<f64>)| {
            effects[k][i] * row.iter().zip(&effects).map(|(entry, effect)| entry * effect[j]).sum::<f64>()
        };
        every as f64 * covariance.iter().enumerate().map(row).sum::<f64>()
    };
    let size = open.len();
    Ok(Some((0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()))
}
