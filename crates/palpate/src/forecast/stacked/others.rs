//! The course of other holds of the body as a forecast: where they are longer, what followed there is known.

use super::member::{Course, ForecastMember, line};
use super::trial::{LONGER, Trial, TriedHold};
use crate::fit::{Condensed, Samples, before};
use crate::statistics::interpolated;

/// Shares of the duration from which on the course of another hold is scaled to this one.
const FROM: [f64; 2] = [0.0, 0.3];

/// Fewest other holds that are longer: what one tells of the next is tried on the others.
const FEWEST: usize = 2;

/// Fewest samples of a straight line that takes their noise off.
const FEWEST_OF_LINE: usize = 6;

/// A share of the last time that a hold has to reach, to tell of it.
const REACHES: f64 = 0.95;

/// Squares of residuals below this share of the square of the signal are rounding.
const ROUNDING: f64 = 1e-24;

/// Other holds that are known for longer than this one.
pub(super) struct Others {
    /// Time since the first sample up to which they are known, s.
    pub(super) until: f64,
    known: Vec<Known>,
}

/// A hold that is known whole, with its noise reduced.
struct Known {
    /// Its number among the others.
    number: usize,
    times: Vec<f64>,
    values: Vec<f64>,
}

impl Others {
    /// Those of the others that at least half of them (and two) are as long as; `None` where fewer are longer than this hold by half.
    pub(super) fn longer(hold: &TriedHold<'_>, others: &[&TriedHold<'_>]) -> Option<Self> {
        let mut durations: Vec<f64> = others.iter().map(|other| other.duration()).collect();
        durations.retain(|duration| *duration >= LONGER * hold.duration());
        durations.sort_by(|a, b| b.total_cmp(a));
        let until = *durations.get(durations.len().div_ceil(2).max(FEWEST) - 1)?;
        let long = others.iter().enumerate().filter(|(_, other)| other.duration() >= until);
        let known = long.map(|(number, other)| Known::new(number, &other.samples, until)).collect();
        Some(Self { until, known })
    }

    /// Their course scaled to a hold from a share of its duration on, at rising times; without one of them, and `None` where no other hold
    /// reaches the last time.
    fn course(&self, from: f64, samples: &Samples<'_>, without: Option<usize>, times: &[f64]) -> Option<Course> {
        let (start, last) = (samples.times[0], *times.last()?);
        let elapsed: Vec<f64> = samples.times.iter().map(|t| t - start).collect();
        let nodes = Condensed::finer(&elapsed, samples.values);
        let first = before(&nodes.times, from * elapsed[elapsed.len() - 1]);
        let reaches = |known: &&Known| Some(known.number) != without && known.end() >= REACHES * last;
        let (mut values, mut weights) = (vec![0.0; times.len()], 0.0);
        for known in self.known.iter().filter(reaches) {
            let course = known.at(&nodes.times[first..]);
            let nodes = nodes.values[first..].iter().zip(&nodes.roots[first..]);
            let points: Vec<_> = course.iter().zip(nodes).map(|(x, (y, root))| (*x, y / root, root * root)).collect();
            let Some((a, b, left)) = line(&points) else { continue };
            let square: f64 = points.iter().map(|(_, y, weight)| weight * y * y).sum();
            let weight = 1.0 / left.max(ROUNDING * square);
            weights += weight;
            values.iter_mut().zip(known.at(times)).for_each(|(value, at)| *value += weight * (a + b * at));
        }
        values.iter_mut().for_each(|value| *value /= weights);
        let times = times.to_vec();
        (weights > 0.0 && weights.is_finite()).then_some(Course::Known { times, values })
    }

    /// The members that follow their course, fitted to a hold, up to where they are known.
    pub(super) fn courses(&self, samples: &Samples<'_>) -> impl Iterator<Item = (ForecastMember, Option<Course>)> {
        let mut times: Vec<f64> = self.known.iter().flat_map(|known| known.times.iter().copied()).collect();
        times.retain(|t| *t < self.until);
        times.push(self.until);
        times.sort_by(f64::total_cmp);
        times.dedup();
        FROM.into_iter()
            .map(move |from| (ForecastMember::OtherHolds(from), self.course(from, samples, None, &times)))
    }

    /// A trial of a hold with what they would have predicted; the hold may be one of them.
    pub(super) fn tried(&self, trial: &Trial, hold: &TriedHold<'_>, number: Option<usize>) -> Trial {
        let fitted = hold.first_part(trial.cut);
        trial.with(FROM.into_iter().map(|from| {
            let course = self.course(from, &fitted, number, &trial.times)?;
            Some(course.at(&trial.times, &hold.options))
        }))
    }
}

impl Known {
    /// Its course up to a time since the first sample, s; the last tenth is a straight line, since from its end laws go on.
    fn new(number: usize, samples: &Samples<'_>, until: f64) -> Self {
        const LAST: f64 = 0.1;
        let elapsed: Vec<f64> = samples.times.iter().map(|t| t - samples.times[0]).collect();
        let nodes = Condensed::finer(&elapsed, samples.values);
        let bare = nodes.values.iter().zip(&nodes.roots).map(|(value, root)| value / root);
        let (mut times, mut values): (Vec<f64>, Vec<f64>) = nodes.times.iter().copied().zip(bare).unzip();
        let points = elapsed.iter().zip(samples.values).map(|(t, y)| (*t, *y, 1.0));
        let last: Vec<_> = points.filter(|(t, ..)| *t >= (1.0 - LAST) * until && *t <= until).collect();
        if last.len() >= FEWEST_OF_LINE
            && let Some((a, b, _)) = line(&last)
        {
            let kept = times.partition_point(|t| *t < last[0].0);
            times.truncate(kept);
            values.truncate(kept);
            for t in [last[0].0, until] {
                times.push(t);
                values.push(a + b * t);
            }
        }
        Self { number, times, values }
    }

    fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    fn at(&self, times: &[f64]) -> Vec<f64> {
        interpolated(&self.times, &self.values, times)
    }
}
