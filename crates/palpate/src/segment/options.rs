//! Thresholds: options in, the values they took out.

use serde::{Deserialize, Serialize};

use super::{After, Phase, Segment};
use crate::record::Record;
use crate::statistics::noise;

/// From where in a hold the laws are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldStart {
    /// From the extreme of the force near the start of the hold: its maximum after loading, its minimum after unloading.
    /// The force may lag behind the jaw by a sample or, where a servo settles, by up to a second; where a servo overshoots
    /// the extreme lies before the jaw is at rest.
    #[default]
    Peak,
    /// From the first sample of the hold.
    Settled,
    /// This long after the extreme, s.
    AfterPeak(f64),
}

impl HoldStart {
    /// The sample from which to fit segment `index`.
    pub(super) fn sample(self, record: &Record, segments: &[Segment], index: usize) -> usize {
        let segment = &segments[index];
        if segment.phase != Phase::Hold {
            return segment.start;
        }
        match self {
            Self::Settled => segment.start,
            Self::Peak => peak(record, segments, index),
            Self::AfterPeak(delay) => {
                let from = record.time()[peak(record, segments, index)] + delay;
                let sample = record.time().partition_point(|time| *time < from);
                sample.clamp(segment.start, segment.end - 1)
            }
        }
    }
}

/// The extreme of the force about the start of a hold, or the start of the hold where there is none.
///
/// It is sought in the first twentieth of the hold (its first 12 samples at least); if the force still runs at the end of
/// that stretch it is no peak but a trend. A jaw that overshoots, or that stops a moment before it counts as standing
/// still, leaves the peak before the hold: it counts if it stands out from all that follows by more than noise.
fn peak(record: &Record, segments: &[Segment], index: usize) -> usize {
    let segment = &segments[index];
    let force = record.force();
    let times = &record.time()[..segment.end];
    let twentieth = times[segment.start] + 0.05 * (times[segment.end - 1] - times[segment.start]);
    let until = times.partition_point(|time| *time <= twentieth).max(segment.start + 12).min(segment.end);
    let sign = if segment.after == Some(After::Unloading) { -1.0 } else { 1.0 };
    let height = |index: &usize| sign * force[*index];
    let highest = |from: usize, until: usize| (from..until).max_by(|a, b| height(a).total_cmp(&height(b)));
    let inside = match highest(segment.start, until) {
        Some(index) if index + 1 < until => index,
        _ => segment.start,
    };
    let from = settling(record, segments, index);
    match highest(from, segment.start) {
        // The first of the stretch is no peak: the force came down to it already.
        Some(early) if early > from && height(&early) > height(&inside) + 3.0 * noise(&force[from..until]) => early,
        _ => inside,
    }
}

/// From where before a hold its peak may lie: 12 samples, or as long as the jaw has been within a fiftieth of its ramp.
fn settling(record: &Record, segments: &[Segment], index: usize) -> usize {
    const FEWEST: usize = 12;
    let start = segments[index].start;
    let moves = |segment: &&Segment| matches!(segment.phase, Phase::Loading | Phase::Unloading);
    let ramp = segments[..index].iter().rev().take_while(moves).last().map_or(start, |segment| segment.start);
    let near = record.displacement().map_or(start, |displacement| {
        let level = displacement[start];
        let band = 0.02 * (level - displacement[ramp.saturating_sub(1)]).abs();
        (ramp..start).rev().take_while(|i| (displacement[*i] - level).abs() <= band).last().unwrap_or(start)
    });
    near.min(start.saturating_sub(FEWEST)).max(ramp)
}

/// What may be set about the search for phases; `None` means: derive it from the record.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct SegmentOptions {
    /// How far the displacement may stray from its level in a hold, m.
    pub tolerance: Option<f64>,
    /// Shortest hold, s.
    pub minimum_hold: Option<f64>,
    /// Speed under which the jaw counts as standing still, as a share of the speed of the ramps.
    pub still_below: Option<f64>,
    /// From where in a hold the laws are fitted.
    pub hold_start: HoldStart,
}

/// The thresholds that a search used.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SegmentSettings {
    /// Whether the phases come from the displacement (else from the force).
    pub from_displacement: bool,
    /// Noise of that column (standard deviation), m or N.
    pub noise: f64,
    /// How far the column may stray from its level in a hold, m or N.
    pub tolerance: f64,
    /// Typical speed of the ramps, m/s or N/s.
    pub ramp_speed: f64,
    /// Speed under which it counts as standing still, m/s or N/s.
    pub still_speed: f64,
    /// Samples on each side of which the slope is the difference of means.
    pub slope_window: usize,
    /// Shortest hold, s.
    pub minimum_hold: f64,
    /// Fewest samples of a hold.
    pub minimum_samples: usize,
}
