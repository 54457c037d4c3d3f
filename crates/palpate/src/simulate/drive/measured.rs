//! The motion that a measured displacement shows: standstills by their mean, ramps by their line.

use super::bends::add_bends;
use super::hats::{Tridiagonal, hats, residuals, sums_of_hats};
use super::motion::{Motion, MotionError};

/// A motion estimated from noisy displacements, with the covariance of its knots.
///
/// A motion through the samples themselves would pass on their noise: a jaw that trembles drives a contact that no jaw drove. Here the knots
/// are least-squares estimates. Corners are where the lines of adjacent stretches meet, so that they may lie between two samples; a curve has as
/// many of them as its noise lets show.
///
/// ```
/// use palpate::simulate::MeasuredMotion;
/// // 2 mm/s for 1.005 s, then a hold, at 100 Hz with ±10 µm.
/// let time: Vec<f64> = (0..=400).map(|i| 0.01 * f64::from(i)).collect();
/// let noise = |i: usize| 1e-5 * [1.0, -1.0, 0.3, -0.3][i % 4];
/// let measured = time.iter().enumerate().map(|(i, t)| 2e-3 * t.min(1.005) + noise(i)).collect();
/// let found = MeasuredMotion::of(time, measured, 5e-5)?;
/// assert_eq!(found.motion.times().len(), 3);
/// assert!((found.motion.times()[1] - 1.005).abs() < 2e-3);              // s
/// assert!((found.motion.displacements()[2] - 2.01e-3).abs() < 1e-6);    // m
/// # Ok::<(), palpate::simulate::MotionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredMotion {
    /// Straight between its knots.
    pub motion: Motion,
    /// Standard deviation of the samples about it, m.
    pub noise: f64,
    /// HᵀH of the hat functions H of its knots; `None` where the knots are samples.
    normal: Option<Tridiagonal>,
    /// What the samples of every stretch say of its ends; none where the knots are samples.
    stretches: Vec<Stretch>,
}

/// Samples of a stretch between two knots.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    /// Sums of (1 − s)², s (1 − s) and s² over its samples, with s the share of the stretch that lies before one.
    sums: [f64; 3],
    /// Variance of a sample, m², of such as are independent of each other.
    variance: f64,
}

/// Samples of a stretch from which its line is known well enough to meet another.
const FEWEST: usize = 4;

/// Knots that are looked at together.
const TOGETHER: usize = 6;

/// How often corners are moved to where lines meet.
const ROUNDS: usize = 3;

/// What is known of measured displacements beside their values, m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Resolution {
    /// What stays within it of a straight line is taken as straight.
    pub(crate) tolerance: f64,
    /// Step that they were rounded to; zero if none.
    pub(crate) step: f64,
    /// Height up to which a course about the straight stretches is not followed.
    pub(crate) course: f64,
}

impl Resolution {
    /// That of displacements that were not rounded, of a jaw that is driven along straight lines.
    pub(crate) fn straight(tolerance: f64) -> Self {
        /// Share of the tolerance within which noise that remembers, and the steps of an encoder, stay.
        const WITHIN: f64 = 0.3;
        Self {
            tolerance,
            step: 0.0,
            course: WITHIN * tolerance,
        }
    }
}

impl MeasuredMotion {
    /// The motion that samples of displacement (m) at rising times (s) show. What stays within `tolerance` (m) of a straight line is taken as
    /// straight.
    ///
    /// # Errors
    /// [`MotionError`] as of [`Motion::new`].
    pub fn of(times: Vec<f64>, displacements: Vec<f64>, tolerance: f64) -> Result<Self, MotionError> {
        Self::resolved(times, displacements, Resolution::straight(tolerance))
    }

    /// The same of displacements with this resolution.
    pub(crate) fn resolved(
        times: Vec<f64>,
        displacements: Vec<f64>,
        Resolution {
            tolerance,
            step,
            course,
        }: Resolution,
    ) -> Result<Self, MotionError> {
        let samples = Motion::new(times, displacements)?;
        let rough = samples.simplified(tolerance);
        let sums = Sums::new(&samples);
        let mut knots = rough.times().to_vec();
        for _ in 0..ROUNDS {
            sums.with_single_corners(&mut knots, tolerance);
            sums.without_needless(&mut knots, tolerance);
            sums.meet(&mut knots);
        }
        sums.with_short_ramps(&mut knots, tolerance);
        add_bends(&samples, &mut knots, tolerance, course);
        let Some((values, normal)) = hats(&samples, &knots) else {
            return Ok(Self {
                motion: rough,
                noise: 0.0,
                normal: None,
                stretches: Vec::new(),
            });
        };
        let motion = Motion::new(knots, values)?;
        let off: Vec<f64> = residuals(&samples, &motion).collect();
        let freedom = samples.times().len().saturating_sub(motion.times().len());
        let square: f64 = off.iter().map(|off| off * off).sum();
        let noise = if freedom > 0 { (square / freedom as f64).sqrt() } else { 0.0 };
        Ok(Self {
            stretches: stretches(&samples, &motion, &off, (noise, step)),
            noise,
            motion,
            normal: Some(normal),
        })
    }

    /// With knots below this displacement (m) raised to it.
    #[must_use]
    pub(crate) fn at_least(mut self, lowest: f64) -> Self {
        let raised = self.motion.displacements().iter().map(|d| d.max(lowest)).collect();
        if let Ok(motion) = Motion::new(self.motion.times().to_vec(), raised) {
            self.motion = motion;
        }
        self
    }

    /// That of a jaw that stands at first touch until it leaves it, as [`Motion::standing_at_touch`].
    #[must_use]
    pub(crate) fn standing_at_touch(mut self, noise: f64) -> Self {
        self.motion = self.motion.standing_at_touch(noise);
        self
    }

    /// Covariance of the displacements at these knots, m², row by row, for white noise and corners at known times.
    #[must_use]
    pub fn covariance(&self, knots: &[usize]) -> Vec<Vec<f64>> {
        let variance = self.noise * self.noise;
        let row = |knot: &usize| match &self.normal {
            None => vec![0.0; knots.len()],
            Some(normal) => {
                let mut unit = vec![0.0; self.motion.times().len()];
                unit[*knot] = variance;
                normal.solve(&mut unit);
                knots.iter().map(|other| unit[*other]).collect()
            }
        };
        knots.iter().map(row).collect()
    }

    /// What the samples say of the displacements, then of the times of all knots: the inverse of their covariance (1/m², 1/(m s), 1/s²), row by
    /// row; singular where a knot is no corner. `None` where nothing is known of the noise, and of a motion of thousands of knots, of which the
    /// matrix would take gigabytes.
    pub(crate) fn information(&self) -> Option<Vec<f64>> {
        /// Most knots, of which the matrix takes 128 MB.
        const MOST: usize = 2000;
        let (times, places) = (self.motion.times(), self.motion.displacements());
        let count = times.len();
        if self.noise == 0.0 || self.stretches.is_empty() || count > MOST {
            return None;
        }
        let mut all = vec![0.0; 4 * count * count];
        for (at, Stretch { sums, variance }) in self.stretches.iter().enumerate() {
            let slope = (places[at + 1] - places[at]) / (times[at + 1] - times[at]);
            // By how much a knot moves the line at its own end.
            let by = [(at, 1.0, 0), (count + at, -slope, 0), (at + 1, 1.0, 1), (count + at + 1, -slope, 1)];
            for (row, a, side) in by {
                for (column, b, other) in by {
                    all[row * 2 * count + column] += a * b * sums[side + other] / variance;
                }
            }
        }
        Some(all)
    }
}

/// What the samples of every stretch of a motion say of its ends, with `off` their distances from it, their noise and the step that they were
/// rounded to.
///
/// Readings that noise does not spread over steps of rounding repeat one error: as many count as there are steps in the stretch.
fn stretches(samples: &Motion, motion: &Motion, off: &[f64], (noise, step): (f64, f64)) -> Vec<Stretch> {
    /// Noise over the step from which on rounding errors are independent.
    const SPREADS: f64 = 0.45;
    let of = |(pair, sums): (&[f64], [f64; 3])| {
        let [from, until] = [pair[0], pair[1]].map(|knot| samples.times().partition_point(|time| *time < knot));
        let count = (until - from).max(1) as f64;
        let scatter = (off[from..until].iter().map(|off| off * off).sum::<f64>() / count).sqrt();
        let (low, high) = samples.displacements()[from..until]
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| (place.min(low), place.max(high)));
        let steps = 1.0 + ((high - low) / step).round().max(0.0);
        let together = if scatter < SPREADS * step { (count / steps).max(1.0) } else { 1.0 };
        Stretch {
            sums,
            variance: together * (noise * noise).max(step * step / 12.0),
        }
    };
    motion.times().windows(2).zip(sums_of_hats(samples, motion.times())).map(of).collect()
}

/// A straight line d = a + s (t − t₀) through some samples.
struct Line {
    slope: f64,
    /// Time and displacement in the middle of the samples.
    middle: (f64, f64),
    /// Sum of the squared distances.
    square: f64,
    samples: usize,
    /// Σ (t − t₀)².
    spread: f64,
}

impl Line {
    fn at(&self, time: f64) -> f64 {
        self.middle.1 + self.slope * (time - self.middle.0)
    }

    /// Variance at a time over that of the noise.
    fn variance_at(&self, time: f64) -> f64 {
        1.0 / self.samples as f64 + (time - self.middle.0).powi(2) / self.spread
    }
}

/// Running sums over the samples, which give the line through any stretch of them at once.
struct Sums<'a> {
    times: &'a [f64],
    displacements: &'a [f64],
    /// Σ of t, d, t², t d, d² before each sample, both less their mean.
    before: Vec<[f64; 5]>,
    middle: (f64, f64),
}

impl<'a> Sums<'a> {
    fn new(samples: &'a Motion) -> Self {
        let (times, displacements) = (samples.times(), samples.displacements());
        let count = times.len() as f64;
        let middle = (times.iter().sum::<f64>() / count, displacements.iter().sum::<f64>() / count);
        let mut before = vec![[0.0; 5]];
        for (time, displacement) in times.iter().zip(displacements) {
            let (t, d) = (time - middle.0, displacement - middle.1);
            let last = before[before.len() - 1];
            before.push([last[0] + t, last[1] + d, last[2] + t * t, last[3] + t * d, last[4] + d * d]);
        }
        Self {
            times,
            displacements,
            before,
            middle,
        }
    }

    /// The line through the samples of a stretch, without `spare` samples at either end.
    fn line(&self, from: f64, until: f64, spare: usize) -> Option<Line> {
        let first = self.times.partition_point(|time| *time < from) + spare;
        let end = self.times.partition_point(|time| *time <= until).checked_sub(spare)?;
        if end < first + FEWEST { None } else { self.line_through(first, end) }
    }

    /// The line through samples `first` to `end`.
    fn line_through(&self, first: usize, end: usize) -> Option<Line> {
        let sum = |which: usize| self.before[end][which] - self.before[first][which];
        let count = (end - first) as f64;
        let (t, d) = (sum(0) / count, sum(1) / count);
        let spread = sum(2) - count * t * t;
        let slope = (sum(3) - count * t * d) / spread;
        let square = (sum(4) - count * d * d - slope * slope * spread).max(0.0);
        (spread > 0.0 && slope.is_finite()).then_some(Line {
            slope,
            middle: (t + self.middle.0, d + self.middle.1),
            square,
            samples: end - first,
            spread,
        })
    }

    /// Variance of the samples about the lines between knots.
    fn variance(&self, knots: &[f64], tolerance: f64) -> f64 {
        /// Share of the tolerance that counts as noise where there is none.
        const LEAST: f64 = 1e-3;
        let lines: Vec<Line> = knots.windows(2).filter_map(|pair| self.line(pair[0], pair[1], 1)).collect();
        let freedom: usize = lines.iter().map(|line| line.samples - 2).sum();
        let square: f64 = lines.iter().map(|line| line.square).sum();
        (square / freedom.max(1) as f64).max((LEAST * tolerance).powi(2))
    }

    /// One corner for knots that are a few samples apart, where the lines beside them meet near there and serve the samples between: a corner
    /// between two samples leaves two knots or three.
    fn with_single_corners(&self, knots: &mut Vec<f64>, tolerance: f64) {
        let variance = self.variance(knots, tolerance);
        replace(knots, |together| self.single_corner(together, variance).map(|corner| [corner]));
    }

    /// The corner that stands for all of these knots but the first and the last.
    fn single_corner(&self, knots: &[f64], variance: f64) -> Option<f64> {
        /// The square of a normal number is above it in one of 10,000.
        const BEYOND: f64 = 15.1;
        let last = knots.len() - 1;
        let (first, second) = (knots[1], knots[last - 1]);
        let from = self.times.partition_point(|time| *time < first);
        let end = self.times.partition_point(|time| *time <= second);
        if end > from + 2 * FEWEST {
            return None;
        }
        let (a, b) = (self.line(knots[0], first, 1)?, self.line(second, knots[last], 1)?);
        let corner = first + (b.at(first) - a.at(first)) / (a.slope - b.slope);
        let serves = |index: usize| {
            let time = self.times[index];
            let line = if time < corner { &a } else { &b };
            (self.displacements[index] - line.at(time)).powi(2) <= BEYOND * variance * (1.0 + line.variance_at(time))
        };
        let width = second - first;
        let (least, most) = ((first - width).max(knots[0]), (second + width).min(knots[last]));
        (corner > least && corner < most && (from..end).all(serves)).then_some(corner)
    }

    /// The corners of ramps of a few samples between two lines: where the line of these samples meets both.
    fn with_short_ramps(&self, knots: &mut Vec<f64>, tolerance: f64) {
        replace(knots, |together| self.short_ramp(together, tolerance));
    }

    /// The two corners that stand for all of these knots but the first and the last.
    fn short_ramp(&self, knots: &[f64], tolerance: f64) -> Option<[f64; 2]> {
        let last = knots.len() - 1;
        let (before, after) = (self.line(knots[0], knots[1], 1)?, self.line(knots[last - 1], knots[last], 1)?);
        let off =
            |line: &Line, index: usize| (self.displacements[index] - line.at(self.times[index])).abs() > tolerance;
        let from = self.times.partition_point(|time| *time < before.middle.0);
        let until = self.times.partition_point(|time| *time < after.middle.0);
        let first = (from..until).find(|index| off(&before, *index))?;
        let end = (first..until).rev().find(|index| off(&after, *index))? + 1;
        if !(2..FEWEST + 2).contains(&(end - first)) || first == 0 || end == self.times.len() {
            return None;
        }
        let ramp = self.line_through(first, end)?;
        if (first..end).any(|index| off(&ramp, index)) {
            return None;
        }
        let [start, stop] = [&before, &after]
            .map(|line| ramp.middle.0 + (line.at(ramp.middle.0) - ramp.middle.1) / (ramp.slope - line.slope));
        // A sample next to a corner may lie within the tolerance of both lines.
        let near = |corner: f64, index: usize| {
            let (least, most) = (index.saturating_sub(2), (index + 1).min(self.times.len() - 1));
            (self.times[least]..=self.times[most]).contains(&corner)
        };
        (near(start, first) && near(stop, end) && start > knots[0] && start < stop && stop < knots[last])
            .then_some([start, stop])
    }

    /// Leaves out knots that only noise has set, alone or a few together: where one line serves the stretches on both sides as well as two.
    fn without_needless(&self, knots: &mut Vec<f64>, tolerance: f64) {
        /// χ² of two degrees of freedom is above it in one of 1,000 stretches.
        const BEYOND: f64 = 13.8;
        /// Square that a sample at a knot may have, which noise has put there because it is far off.
        const OFF: f64 = 16.0;
        let variance = self.variance(knots, tolerance);
        let mut at = 1;
        while at + 1 < knots.len() {
            let is_needless = |count: &usize| {
                let (start, end) = (knots[at - 1], knots[at + count]);
                let a = self.line(start, knots[at], 1);
                let b = self.line(knots[at + count - 1], end, 1);
                a.zip(b).zip(self.line(start, end, 1)).is_some_and(|((a, b), one)| {
                    let between = (one.samples - a.samples - b.samples) as f64;
                    one.square - a.square - b.square < (BEYOND + OFF * between) * variance
                })
            };
            match (1..=TOGETHER.min(knots.len() - 1 - at)).rev().find(is_needless) {
                Some(count) => drop(knots.drain(at..at + count)),
                None => at += 1,
            }
        }
    }

    /// Moves corners to where the lines of the stretches beside them meet, if these say where within a part of the stretches.
    fn meet(&self, knots: &mut [f64]) {
        /// Share of the shorter stretch that a corner may be moved by, and be uncertain by.
        const FARTHEST: f64 = 0.4;
        const VAGUE: f64 = 0.1;
        let before = knots.to_vec();
        for at in 1..before.len() - 1 {
            let lines = self.line(before[at - 1], before[at], 1).zip(self.line(before[at], before[at + 1], 1));
            let Some((a, b)) = lines else { continue };
            let apart = a.slope - b.slope;
            let time = before[at] + (b.at(before[at]) - a.at(before[at])) / apart;
            let variance = (a.square + b.square) / (a.samples + b.samples - 4).max(1) as f64;
            let error = (variance * (a.variance_at(time) + b.variance_at(time))).sqrt() / apart.abs();
            let shorter = (before[at] - before[at - 1]).min(before[at + 1] - before[at]);
            if (time - before[at]).abs() < FARTHEST * shorter && error < VAGUE * shorter {
                knots[at] = time;
            }
        }
    }
}

/// Puts the corners of knots that lie together, with one knot before them and one behind, in their place: of as many together as have any.
fn replace<const N: usize>(knots: &mut Vec<f64>, corners: impl Fn(&[f64]) -> Option<[f64; N]>) {
    let mut at = 1;
    while at + 2 < knots.len() {
        let mut together = (2..=TOGETHER.min(knots.len() - 1 - at)).rev();
        let found = together.find_map(|count| Some((count, corners(&knots[at - 1..=at + count])?)));
        if let Some((count, corners)) = found {
            knots.splice(at..at + count, corners);
        }
        at += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{ProtocolStep, protocol};
    use crate::test_problems::Rng;

    /// A squeeze in two steps with corners between samples.
    fn steps() -> Motion {
        let step = |to, hold| ProtocolStep { to, rate: 8.3e-3, hold };
        protocol(&[step(5.03e-3, 10.0), step(9.01e-3, 8.0), step(1.0e-3, 5.0)]).unwrap()
    }

    fn sampled(motion: &Motion, rate: f64, noise: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
        let mut random = Rng::new(seed);
        let times: Vec<f64> = (0..=(motion.end() * rate) as u32).map(|i| f64::from(i) / rate).collect();
        let displacements = times.iter().map(|t| motion.displacement_at(*t) + noise * random.normal()).collect();
        (times, displacements)
    }

    #[test]
    fn corners_between_samples_are_found_under_noise() {
        let truth = steps();
        for (rate, noise) in [(20.0, 1e-5), (100.0, 1e-5), (500.0, 1e-5), (500.0, 0.0)] {
            let (times, displacements) = sampled(&truth, rate, noise, 3);
            let found = MeasuredMotion::of(times, displacements, (4.0 * noise).max(2e-5)).unwrap();
            assert_eq!(found.motion.times().len(), truth.times().len(), "{rate} {noise}: {:?}", found.motion);
            for (knot, true_knot) in found.motion.times().iter().zip(truth.times()).skip(1).take(5) {
                assert!((knot - true_knot).abs() < 1e-3 + 2.0 * noise / 8.3e-3, "{rate} {noise}: {knot} {true_knot}");
            }
            assert!((found.noise - noise).abs() < 0.06 * noise + 1e-12);
            let off = |t: f64| found.motion.displacement_at(t) - truth.displacement_at(t);
            for held in [5.0, 15.0, 21.0] {
                assert!(off(held).abs() < 0.3 * noise + 1e-12, "{rate} {noise} at {held}: {}", off(held));
            }
        }
    }

    /// Of loggers at 4 and 5 Hz a jaw that takes 0.76 s stopped up to a sample late: v was covered in 1 of 40 calibrations.
    #[test]
    fn corners_of_ramps_of_a_few_samples_are_found() {
        let step = |to| ProtocolStep {
            to,
            rate: 8e-3,
            hold: 20.0,
        };
        let truth = protocol(&[step(6.1e-3), step(12.3e-3), step(18.7e-3)]).unwrap();
        for (rate, noise) in [(4.0, 2e-6), (4.0, 0.0), (5.0, 2e-6), (5.0, 1e-5)] {
            for seed in 0..10 {
                let (mut times, mut displacements) = sampled(&truth, rate, noise, seed);
                // Two seconds of rest before.
                let rest = (2.0 * rate) as usize;
                times = (0..rest).map(|i| i as f64 / rate - 2.0).chain(times).collect();
                displacements = vec![0.0; rest].into_iter().chain(displacements).collect();
                let found = MeasuredMotion::of(times, displacements, (4.0 * noise).max(2e-5)).unwrap().motion;
                for true_knot in &truth.times()[..6] {
                    let off = found.times().iter().map(|knot| (knot - true_knot).abs()).fold(f64::INFINITY, f64::min);
                    assert!(
                        off < 1e-4 + 6.0 * noise / 8e-3,
                        "{rate} {noise} {seed} at {true_knot}: {:?}",
                        found.times()
                    );
                }
            }
        }
    }

    #[test]
    fn covariances_of_knots_are_those_of_repeats() {
        let truth = steps();
        let (mut square, repeats) = (0.0, 400);
        let mut expected = 0.0;
        for seed in 0..repeats {
            let (times, displacements) = sampled(&truth, 50.0, 1e-5, seed + 1);
            let found = MeasuredMotion::of(times, displacements, 5e-5).unwrap();
            square += (found.motion.displacement_at(5.0) - truth.displacement_at(5.0)).powi(2);
            // The middle of the hold between the second and the third knot.
            let knots = found.covariance(&[1, 2]);
            expected += 0.25 * (knots[0][0] + 2.0 * knots[0][1] + knots[1][1]);
        }
        assert!((square / expected).sqrt() > 0.85 && (square / expected).sqrt() < 1.2, "{square} {expected}");
    }

    #[test]
    fn whatever_is_measured_has_a_motion_near_the_samples() {
        for seed in 1..400 {
            let mut random = Rng::new(seed);
            let count = 2 + (60.0 * random.uniform()) as usize;
            let (mut time, mut place, mut speed) = (0.0, 0.0, 0.0);
            let (mut times, mut places) = (Vec::new(), Vec::new());
            for _ in 0..count {
                // Jumps, changes of speed, gaps, standstills.
                time += if random.uniform() < 0.1 { 1.0 } else { 1e-3 + 0.02 * random.uniform() };
                speed = if random.uniform() < 0.2 { 1e-2 * random.normal() } else { speed };
                place += 0.01 * speed + if random.uniform() < 0.05 { 1e-3 * random.normal() } else { 0.0 };
                times.push(time);
                places.push(place + 1e-5 * random.normal());
            }
            let found = MeasuredMotion::of(times.clone(), places.clone(), 5e-5).unwrap();
            assert!(found.motion.times().windows(2).all(|pair| pair[0] < pair[1]), "{seed}");
            assert!(found.noise.is_finite());
            for (time, place) in times.iter().zip(&places) {
                assert!((found.motion.displacement_at(*time) - place).abs() < 1e-3, "{seed} at {time}: {found:?}");
            }
            let variance = found.covariance(&[0, found.motion.times().len() - 1])[0][0];
            assert!(variance.is_finite() && variance >= 0.0, "{seed}");
        }
    }

    #[test]
    fn samples_without_noise_and_curves_keep_their_course() {
        let times: Vec<f64> = (0..400).map(|i| 0.01 * f64::from(i)).collect();
        let curve: Vec<f64> = times.iter().map(|t| 2e-3 * (2.0 * t).sin()).collect();
        let found = MeasuredMotion::of(times.clone(), curve.clone(), 1e-5).unwrap();
        for (time, displacement) in times.iter().zip(&curve) {
            assert!((found.motion.displacement_at(*time) - displacement).abs() < 1.5e-5, "{time}");
        }
        let two = MeasuredMotion::of(vec![0.0, 1.0], vec![0.0, 1e-3], 1e-6).unwrap();
        assert_eq!(two.motion.displacements(), [0.0, 1e-3]);
        assert_eq!(two.covariance(&[0, 1]), vec![vec![0.0; 2]; 2]);
    }
}
