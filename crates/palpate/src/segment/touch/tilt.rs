//! A force without contact that follows a straight line over the travel.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::estimators::Approach;
use crate::record::Record;
use crate::segment::segmentation::Segment;
use crate::statistics::{dot, effective_count, lag_one_correlation, mean, median, noise, slope};

/// A force that grows along the way through air: virtual deflection of a cantilever, a spring beside the body, or a drift in time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BaselineTilt {
    /// Force per travel, N/m.
    pub slope: f64,
    /// Its standard error, N/m.
    pub standard_error: f64,
    /// Travel over which the line was observed, m.
    pub observed: f64,
    /// After the jaw has left, the force shows that the line is one in time: it is not subtracted.
    pub in_time: bool,
}

/// The line of the force in air before a ramp meets a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tilt {
    pub(super) slope: f64,
    pub(super) error: f64,
    /// Samples of the approach that the line describes.
    pub(super) from: usize,
    pub(super) until: usize,
    /// Displacement (m) and force (N) in their middle, and the standard error of that force (N).
    middle: f64,
    level: f64,
    level_error: f64,
    /// The force grows in contact by so much more of the travel, N/m.
    stiffness: f64,
}

/// Fewest samples of a line.
const FEWEST: usize = 16;
/// Standard errors beyond which a slope or a bend is no noise; and a slope of a force that is not level beyond doubt.
const SURE: f64 = 5.0;
const LIKELY: f64 = 3.0;
/// Share of the mean slope in contact that a tilt has at most, of a baseline that is straight all the way and of one that bends: a body that is
/// met softly grows stiffer by degrees.
const STRAIGHT: f64 = 0.15;
const BENT: f64 = 0.03;
/// Shares of the way through air, up to first touch, over which a line is sought.
const SHARES: [f64; 6] = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125];
/// Shares of the ways through air and into the body that are left out before first touch, whose place is not sure.
const BEFORE: (f64, f64) = (0.1, 0.2);

impl Tilt {
    /// The line before `touch` (m); `None` where the force keeps its level there, or may be that of a body.
    pub(super) fn before(approach: &Approach, touch: f64) -> Option<Self> {
        let (travel, force) = (&approach.displacement, &approach.force);
        let (from, last) = (travel[0], travel[travel.len() - 1]);
        let (air, depth) = (touch - from, last - touch);
        if air <= 0.0 || depth <= 0.0 {
            return None;
        }
        let until = touch - (BEFORE.0 * air).min(BEFORE.1 * depth);
        let end = travel.iter().position(|d| *d > until)?;
        let lines = SHARES.into_iter().map(|share| (share, until - share * (until - from)));
        let lines = lines.map(|(share, start)| (share, travel.partition_point(|d| *d < start).min(end)..end));
        let (share, mut line) = lines
            .take_while(|(_, samples)| samples.len() >= FEWEST)
            .find_map(|(share, samples)| Some((share, Self::straight(travel, force, samples)?)))?;
        let top = force.iter().fold(f64::MIN, |most, f| most.max(*f));
        line.stiffness = (top - line.at(last)) / depth;
        let most = line.stiffness * if share == 1.0 { STRAIGHT } else { BENT };
        (line.slope.abs() <= most && line.slope.abs() > LIKELY * line.error).then_some(line)
    }

    /// Whether the slope is no noise, whatever else is known of the force.
    pub(super) fn is_sure(&self) -> bool {
        self.slope.abs() > SURE * self.error
    }

    /// The least-squares line of those samples, if the force does not bend there.
    fn straight(travel: &[f64], force: &[f64], samples: Range<usize>) -> Option<Self> {
        let (travel, force) = (&travel[samples.clone()], &force[samples.clone()]);
        let (middle, level, count) = (mean(travel), mean(force), travel.len());
        let slope = slope(travel, force);
        let x: Vec<f64> = travel.iter().map(|d| d - middle).collect();
        let left: Vec<f64> = x.iter().zip(force).map(|(x, f)| f - level - slope * x).collect();
        // A parabola without the line in it.
        let square = dot(&x, &x);
        let mean_square = square / count as f64;
        let skew = x.iter().map(|x| x.powi(3)).sum::<f64>() / square;
        let bow: Vec<f64> = x.iter().map(|x| x * x - mean_square - skew * x).collect();
        let bend = dot(&bow, &left) / dot(&bow, &bow);
        let after: Vec<f64> = left.iter().zip(&bow).map(|(left, bow)| left - bend * bow).collect();
        let independent = effective_count(count, lag_one_correlation(&after));
        let variance = (dot(&after, &after) / count as f64).max(0.1 * noise(force).powi(2));
        let scale = count as f64 / independent;
        let is_straight = bend.abs() <= SURE * (scale * variance / dot(&bow, &bow)).sqrt();
        let error = (scale * variance / square).sqrt();
        (slope.is_finite() && is_straight).then_some(Self {
            slope,
            error,
            from: samples.start,
            until: samples.end,
            middle,
            level,
            level_error: (variance / independent).sqrt(),
            stiffness: 0.0,
        })
    }

    /// The force without contact at a displacement (m), N.
    pub(super) fn at(&self, displacement: f64) -> f64 {
        self.level + self.slope * (displacement - self.middle)
    }

    /// The standard error of the same, N.
    pub(super) fn error_at(&self, displacement: f64) -> f64 {
        self.level_error.hypot(self.error * (displacement - self.middle))
    }

    /// What the error of the line moves first touch by, m.
    pub(super) fn touch_error(&self, touch: f64) -> f64 {
        self.error_at(touch) / self.stiffness
    }

    /// Whether the free force after the ramp, less the line over the travel, is that of a line in time with the same slope.
    pub(super) fn is_in_time(&self, record: &Record, displacement: &[f64], ramp: &Segment) -> bool {
        let (time, force) = (record.time(), record.force());
        let back = displacement.iter().rposition(|d| *d > self.middle).map_or(record.len(), |last| last + 1);
        if back < ramp.end || record.len() - back < FEWEST {
            return false;
        }
        let foot = ramp.start.saturating_sub(1);
        let reached = (foot..ramp.end).find(|i| displacement[*i] >= self.middle).unwrap_or(foot);
        let speed = (displacement[ramp.end - 1] - displacement[foot]) / (time[ramp.end - 1] - time[foot]);
        let rate = self.slope * speed;
        let after = back..record.len();
        let mut shift: Vec<f64> = after.clone().map(|i| force[i] - self.at(displacement[i])).collect();
        let in_time = |i: usize| self.level + rate * (time[i] - time[reached]);
        let mut expected: Vec<f64> = after.map(|i| in_time(i) - self.at(displacement[i])).collect();
        let (shift, expected) = (median(&mut shift), median(&mut expected));
        (shift - expected).abs() < 0.5 * expected.abs()
    }
}
