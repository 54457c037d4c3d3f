//! Residuals that follow a course: in the whole record, or in its ramps alone.

use std::ops::Range;

use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use super::CalibrationData;
use super::problem::{dot, sum_of_squares};
use crate::fit::{Assessed, NoiseModel, whitened};
use crate::statistics::median;
use crate::watch::Cancelled;

/// How residuals show that a law misses part of the record it was calibrated on, beyond what the noise of the displacement and the uncertainty
/// of the instrument explain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ResidualCourse {
    /// They are large, and neighbours are nearly alike.
    Systematic,
    /// Few of them are independent of each other.
    Slow,
    /// They follow a course in ramps or at the beginning of holds, though not over the rest of the record.
    Ramps {
        /// Its root mean square where it is largest, over the largest force of the record.
        relative: f64,
    },
}

/// Root mean square over the largest force from which on a course matters.
const LEAST: f64 = 5e-4;

/// The same for one in a part.
const LEAST_OF_PART: f64 = 1e-3;

/// Share of the samples that are independent in a slow course, and the blocks that they then make.
const FEW: f64 = 0.02;
const BLOCKS: usize = 50;

/// How many times the square that errors of the parameters leave anywhere a course in a part has, at least.
const BEYOND_PARAMETERS: f64 = 10.0;

/// Probability below which noise has made no course.
const UNLIKELY: f64 = 1e-4;

/// Samples of a part from which on it shows its own noise.
const OWN_NOISE: usize = 8;

/// Fewest samples of a part, and of the rest of holds in which the noise shows.
const FEWEST: usize = 3;
const FEWEST_OF_REST: usize = 40;

/// Terms of the polynomial that stands for a course in a part, at most.
const TERMS: usize = 4;

impl ResidualCourse {
    /// Of residuals of this noise and of this share of the largest force: such as neighbours hardly differ in.
    #[must_use]
    pub fn is_systematic(noise: NoiseModel, relative: f64) -> bool {
        relative > 5e-3 && noise.correlations(1).first().is_some_and(|correlation| *correlation > 0.9)
    }

    /// The course of these residuals of the fitted samples, beside the columns of their Jacobian.
    pub(super) fn of(
        data: &CalibrationData,
        columns: &[Vec<f64>],
        residuals: &[f64],
    ) -> Result<Option<Self>, Cancelled> {
        let (count, forces) = (residuals.len(), &data.forces()[..residuals.len()]);
        let largest = data.forces().iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let relative = (sum_of_squares(residuals) / count as f64).sqrt() / largest;
        let noise = Assessed::of_columns(columns.to_vec(), (forces, residuals.to_vec()), 0.95)?.noise;
        if Self::is_systematic(noise, relative) {
            return Ok(Some(Self::Systematic));
        }
        if relative > LEAST && noise.effective_samples(count) < FEW * count as f64 && differ_between_blocks(residuals) {
            return Ok(Some(Self::Slow));
        }
        Ok(Parts::of(data, count).course(forces, residuals, columns.len()).map(|course| Self::Ramps {
            relative: course / largest,
        }))
    }
}

/// Samples of a record by what the jaw does.
struct Parts {
    /// Ramps, and the beginnings of the holds behind them.
    short: Vec<Range<usize>>,
    /// The rest of the holds.
    rest: Vec<Range<usize>>,
}

impl Parts {
    fn of(data: &CalibrationData, count: usize) -> Self {
        /// Share of the deepest place within which a line is straight, and of the fastest speed below which the jaw stands.
        const STRAIGHT: f64 = 0.01;
        const STILL: f64 = 0.02;
        /// Share of a hold that is its beginning, at most.
        const BEGINNING: f64 = 0.25;
        let deepest = data.motion().displacements().iter().copied().fold(0.0, f64::max);
        let motion = data.motion().simplified(STRAIGHT * deepest);
        let (knots, places) = (motion.times(), motion.displacements());
        let speeds: Vec<f64> = knots
            .windows(2)
            .zip(places.windows(2))
            .map(|(time, place)| ((place[1] - place[0]) / (time[1] - time[0])).abs())
            .collect();
        let fastest = speeds.iter().copied().fold(0.0, f64::max);
        let held = |from: f64, until: f64| {
            let middle = 0.5 * (from + until);
            data.held().force.iter().any(|(start, end)| (*start..=*end).contains(&middle))
        };
        let mut runs: Vec<(bool, f64, f64)> = Vec::new();
        for (speed, time) in speeds.iter().zip(knots.windows(2)) {
            let moves = *speed > STILL * fastest && !held(time[0], time[1]);
            match runs.last_mut() {
                Some((before, _, until)) if *before == moves => *until = time[1],
                _ => runs.push((moves, time[0], time[1])),
            }
        }
        let samples = |from: f64, until: f64| {
            let [from, until] = [from, until].map(|at| data.times()[..count].partition_point(|time| *time < at));
            from..until
        };
        let (mut short, mut rest) = (Vec::new(), Vec::new());
        let mut ramp = 0.0;
        for (moves, from, until) in runs {
            if moves {
                ramp = until - from;
                short.push(samples(from, until));
            } else {
                let begun = from + f64::min(ramp, BEGINNING * (until - from));
                short.push(samples(from, begun));
                rest.push(samples(begun, until));
            }
        }
        short.retain(|part| part.len() >= FEWEST);
        Self { short, rest }
    }

    /// Root mean square of the course in the part where it is largest, of those in which noise makes none.
    ///
    /// Residuals are made white as those of the rest are. A polynomial in a part then takes no larger share of their square than it has of the samples,
    /// whatever the size of the noise there; in a part of few samples their square is held against that of the rest, in which noise that goes with the
    /// force is smaller.
    fn course(&self, forces: &[f64], residuals: &[f64], parameters: usize) -> Option<f64> {
        let rest: Vec<usize> = self.rest.iter().cloned().flatten().collect();
        if rest.len() < FEWEST_OF_REST {
            return None;
        }
        let resting: Vec<f64> = rest.iter().map(|at| residuals[*at]).collect();
        let white = whitened(residuals, &resting, parameters);
        let size = |samples: &mut dyn Iterator<Item = usize>| {
            let mut sizes: Vec<f64> = samples.map(|at| forces[at].abs()).collect();
            median(&mut sizes)
        };
        let usual = size(&mut rest.iter().copied());
        let square_of_rest = rest.iter().map(|at| white[*at].powi(2)).sum::<f64>() / rest.len() as f64;
        let course = |part: &Range<usize>| {
            let (white, left) = (&white[part.clone()], &residuals[part.clone()]);
            let count = part.len() as f64;
            let (p_value, course) = if part.len() < OWN_NOISE {
                let larger = (size(&mut part.clone()) / usual).max(1.0).powi(2);
                let square = sum_of_squares(white) / count;
                (beyond(square / (larger * square_of_rest), count, rest.len() as f64)?, sum_of_squares(left))
            } else {
                let terms = TERMS.min(part.len() / 4);
                let polynomials = polynomials(part.len(), terms);
                let along = |values: &[f64]| polynomials.iter().map(|unit| dot(unit, values).powi(2)).sum::<f64>();
                let (smooth, freedom) = (along(white), count - terms as f64);
                let scatter = (sum_of_squares(white) - smooth).max(0.0) / freedom;
                (beyond(smooth / terms as f64 / scatter, terms as f64, freedom)?, along(left))
            };
            Some((p_value, course, (course / count).sqrt()))
        };
        let largest = forces.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        let taken_up = BEYOND_PARAMETERS * parameters as f64 * sum_of_squares(residuals) / residuals.len() as f64;
        let tested: Vec<(f64, f64, f64)> = self.short.iter().filter_map(course).collect();
        let is_course = |(p_value, square, size): &&(f64, f64, f64)| {
            p_value * (tested.len() as f64) < UNLIKELY && *square > taken_up && *size > LEAST_OF_PART * largest
        };
        tested.iter().filter(is_course).map(|(_, _, size)| *size).max_by(f64::total_cmp)
    }
}

/// Whether means over blocks differ by more than the scatter inside them allows, whatever its size in each (degrees of freedom by Welch and
/// Satterthwaite): beside noise in proportion to the force a slow part is found that is none.
fn differ_between_blocks(residuals: &[f64]) -> bool {
    let length = (residuals.len() / BLOCKS).max(OWN_NOISE);
    let size = length as f64;
    let (mut between, mut inside, mut squared) = (0.0, 0.0, 0.0);
    for block in residuals.chunks_exact(length) {
        let mean = block.iter().sum::<f64>() / size;
        let variance = block.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (size - 1.0);
        between += size * mean * mean;
        inside += variance;
        squared += variance * variance;
    }
    let freedom = inside * inside / squared;
    beyond(between / inside, freedom, freedom * (size - 1.0)).is_none_or(|p_value| p_value < UNLIKELY)
}

/// Probability of a ratio of variances of so many degrees of freedom that is as large.
fn beyond(ratio: f64, above: f64, below: f64) -> Option<f64> {
    FisherSnedecor::new(above, below).ok().filter(|_| ratio.is_finite()).map(|law| law.sf(ratio))
}

/// Orthonormal polynomials of degree 0, 1, … over so many samples (Gram and Schmidt).
fn polynomials(samples: usize, terms: usize) -> Vec<Vec<f64>> {
    let at = |index: usize| 2.0 * index as f64 / (samples - 1) as f64 - 1.0;
    let mut found: Vec<Vec<f64>> = Vec::with_capacity(terms);
    for degree in 0..terms as i32 {
        let mut next: Vec<f64> = (0..samples).map(|index| at(index).powi(degree)).collect();
        for unit in &found {
            let along = dot(unit, &next);
            next.iter_mut().zip(unit).for_each(|(entry, unit)| *entry -= along * unit);
        }
        let length = sum_of_squares(&next).sqrt();
        next.iter_mut().for_each(|entry| *entry /= length);
        found.push(next);
    }
    found
}
