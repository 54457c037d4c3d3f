//! What neither the noise of the displacement nor the uncertainty of the instrument explains of the residuals.

use crate::calibrate::CalibrationData;
use crate::calibrate::problem::{Found, Problem, Response, dot};
use crate::optimise::Cholesky;
use crate::parallel::for_each;
use crate::record::rounding_step;
use crate::simulate::{MeasuredMotion, Motion};
use crate::statistics::noise_in_time;
use crate::watch::{Cancelled, Stages};

/// Knots whose displacement and time are moved each for itself at most; of more, displacements move together, as between evenly chosen ones.
const MOST_KNOTS: usize = 40;

/// Simulations between two looks at the watch.
const AT_ONCE: usize = 8;

/// Change of a displacement over the deepest squeeze, and of a time over the shorter stretch beside it.
const STEP: f64 = 1e-4;

/// Noise of a force over the largest one below which it is rounding.
const LEAST_NOISE: f64 = 1e-9;

/// The residuals r less what errors of the motion and of the instrument most likely make of them.
///
/// An error δ of the motion, which its samples leave open with the covariance C, and one of the instrument change the residuals by K δ, less what
/// the parameters take up: K̃ = (1 − J (JᵀJ)⁻¹ Jᵀ) K. With σᵢ the white noise of the force at a sample the most likely one has least
///
/// ```text
/// Σᵢ (r − K̃ δ)ᵢ²/σᵢ² + δᵀ C⁻¹ δ
/// ```
///
/// so that force and displacement are fitted together: noise of the displacement passes through the memory of the body and comes back as
/// residuals that last. They stay plausible, whatever the residuals ([`likely`]). `changes` are those of the residuals by one standard uncertainty of every input of the instrument.
pub(super) fn beyond_instrument(
    problem: &Problem<'_>,
    data: &CalibrationData,
    found: &Found,
    (open, changes): (&[Vec<f64>], Vec<Vec<f64>>),
    stages: &mut Stages<'_>,
) -> Result<Vec<f64>, Cancelled> {
    stages.hear()?;
    let residuals = &found.residuals;
    let of_motion = OfMotion::new(problem, data, found, stages)?;
    let Some(response) = Response::new(open) else {
        return Ok(residuals.clone());
    };
    let (mut columns, known) = of_motion.map_or_else(Default::default, |of| (of.columns, of.information));
    let motions = columns.len();
    columns.extend(changes);
    let size = columns.len();
    if size == 0 {
        return Ok(residuals.clone());
    }
    for column in &mut columns {
        let moved = response.to(column);
        for (taken, by) in open.iter().zip(&moved) {
            column.iter_mut().zip(taken).for_each(|(entry, taken)| *entry -= by * taken);
        }
    }
    let weights = weights(problem, residuals);
    let weighed: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| column.iter().zip(&weights).map(|(entry, weight)| entry * weight).collect())
        .collect();
    let gain: Vec<f64> = (0..size * size).map(|at| dot(&columns[at / size], &weighed[at % size])).collect();
    let right: Vec<f64> = weighed.iter().map(|column| dot(column, residuals)).collect();
    let mut prior = vec![0.0; size * size];
    for row in 0..motions {
        prior[row * size..][..motions].copy_from_slice(&known[row * motions..][..motions]);
    }
    (motions..size).for_each(|input| prior[input * (size + 1)] = 1.0);
    let mut left = residuals.clone();
    for (column, error) in columns.iter().zip(likely(&gain, &right, &prior).unwrap_or_default()) {
        left.iter_mut().zip(column).for_each(|(left, by)| *left -= error * by);
    }
    Ok(left)
}

/// The errors of least δᵀ G δ/λ − 2 gᵀ δ/λ + δᵀ C⁻¹ δ, with `prior` C⁻¹ and the least λ ≥ 1 that leaves them plausible: δᵀ C⁻¹ δ follows χ² of as many
/// degrees of freedom as there are errors. A law that is wrong by far would draw them anywhere.
fn likely(gain: &[f64], right: &[f64], prior: &[f64]) -> Option<Vec<f64>> {
    /// Standard deviations of χ² that are plausible, and steps to the λ that leaves them.
    const PLAUSIBLE: f64 = 4.0;
    const STEPS: usize = 30;
    let size = right.len();
    let with = |doubt: f64| -> Option<(Vec<f64>, f64)> {
        let normal: Vec<f64> = gain.iter().zip(prior).map(|(gain, prior)| gain / doubt + prior).collect();
        let mut errors: Vec<f64> = right.iter().map(|right| right / doubt).collect();
        Cholesky::new(&normal, size)?.solve(&mut errors);
        let square = prior.chunks(size).zip(&errors).map(|(row, error)| error * dot(row, &errors)).sum();
        Some((errors, square))
    };
    let count = size as f64;
    let most = count + PLAUSIBLE * (2.0 * count).sqrt();
    let (errors, square) = with(1.0)?;
    if square <= most {
        return Some(errors);
    }
    let (mut low, mut high) = (0.0, 1.0);
    while with(f64::exp(high))?.1 > most {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if with(middle.exp())?.1 > most { low = middle } else { high = middle }
    }
    with(high.exp()).map(|(errors, _)| errors)
}

/// One over the variance of the white noise at every sample, as neighbours show it there.
fn weights(problem: &Problem<'_>, residuals: &[f64]) -> Vec<f64> {
    /// Samples that show it, and the share of that of all samples which it has at least.
    const TOGETHER: usize = 64;
    const LEAST: f64 = 0.1;
    let (times, forces) = (problem.times, problem.forces);
    let largest = forces.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
    // Readings that rounding repeats show none.
    let rounding = rounding_step(forces).unwrap_or(0.0) / 12f64.sqrt();
    let least = (LEAST * noise_in_time(times, residuals)).max(rounding).max(LEAST_NOISE * largest);
    let of = |(times, residuals): (&[f64], &[f64])| {
        let noise = noise_in_time(times, residuals).max(least);
        std::iter::repeat_n(1.0 / (noise * noise), times.len())
    };
    times.chunks(TOGETHER).zip(residuals.chunks(TOGETHER)).flat_map(of).collect()
}

/// Errors that a motion may have.
struct OfMotion {
    /// Changes of the residuals by a unit of each.
    columns: Vec<Vec<f64>>,
    /// What the measured displacements say of them, row by row.
    information: Vec<f64>,
}

impl OfMotion {
    /// `None` for a motion that is exact.
    fn new(
        problem: &Problem<'_>,
        data: &CalibrationData,
        found: &Found,
        stages: &mut Stages<'_>,
    ) -> Result<Option<Self>, Cancelled> {
        let Some(known) = data.measured().and_then(MeasuredMotion::information) else {
            return Ok(None);
        };
        let (times, places) = (data.motion().times(), data.motion().displacements());
        let knots = times.len();
        // What the jaw did after the last fitted sample has no effect.
        let until = problem.times[problem.times.len() - 1];
        let count = (times.partition_point(|time| *time < until) + 1).min(knots);
        let errors = errors(knots, count);
        let size = errors.len();
        let entry = |a: &Error, b: &Error| -> f64 {
            a.iter().map(|(i, x)| b.iter().map(|(j, y)| x * y * known[i * 2 * knots + j]).sum::<f64>()).sum()
        };
        let mut information: Vec<f64> =
            (0..size * size).map(|at| entry(&errors[at / size], &errors[at % size])).collect();
        // A knot that is no corner is somewhere between its samples.
        let apart = (until - problem.times[0]) / problem.times.len() as f64;
        let deepest = places.iter().copied().fold(0.0, f64::max);
        for (index, error) in errors.iter().enumerate().filter(|(_, error)| error[0].0 >= knots) {
            information[index * (size + 1)] += (error[0].1 / apart).powi(2);
        }
        let column = |index: usize| {
            let error = &errors[index];
            let (mut moved, mut earlier) = (places.to_vec(), times.to_vec());
            let step = match error[0].0.checked_sub(knots) {
                None => STEP * deepest,
                Some(knot) => STEP * (times[knot] - times[knot - 1]).min(times[knot + 1] - times[knot]),
            };
            for (at, by) in error {
                match at.checked_sub(knots) {
                    None => moved[*at] += step * by,
                    Some(knot) => earlier[knot] += step * by,
                }
            }
            let motion = Motion::new(earlier, moved).ok()?;
            let there = Problem {
                motion: &motion,
                ..*problem
            }
            .residuals(&found.theta)?;
            Some(found.residuals.iter().zip(&there).map(|(here, there)| (here - there) / step).collect())
        };
        let mut columns = Vec::with_capacity(size);
        for from in (0..size).step_by(AT_ONCE) {
            stages.hear()?;
            columns.extend(for_each(AT_ONCE.min(size - from), |index| column(from + index)));
        }
        let columns: Option<Vec<Vec<f64>>> = columns.into_iter().collect();
        Ok(columns.map(|columns| Self { columns, information }))
    }
}

/// What moves together, and by how much: displacements of knots, then, from their number on, times.
type Error = Vec<(usize, f64)>;

/// The errors of a motion of so many knots, of which `count` have an effect.
fn errors(knots: usize, count: usize) -> Vec<Error> {
    if count <= MOST_KNOTS {
        let inside = (1..count.min(knots - 1)).map(|knot| vec![(knots + knot, 1.0)]);
        return (0..count).map(|knot| vec![(knot, 1.0)]).chain(inside).collect();
    }
    let every = (count - 1).div_ceil(MOST_KNOTS - 1);
    let hat = |middle: usize| {
        let near = middle.saturating_sub(every - 1)..(middle + every).min(count);
        near.map(|knot| (knot, 1.0 - knot.abs_diff(middle) as f64 / every as f64)).collect()
    };
    (0..count.div_ceil(every)).map(|at| hat(at * every)).collect()
}
