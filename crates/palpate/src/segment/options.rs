//! Thresholds: options in, the values they took out.

use serde::{Deserialize, Serialize};

use super::{After, Phase, Segment};
use crate::record::Record;

/// From where in a hold the laws are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldStart {
    /// From the extreme of the force near the start of the hold: its maximum after loading, its minimum after unloading.
    /// The force may lag behind the jaw by a sample or, where a servo settles, by up to a second.
    #[default]
    Peak,
    /// From the first sample of the hold.
    Settled,
    /// This long after the extreme, s.
    AfterPeak(f64),
}

impl HoldStart {
    /// The sample of `segment` from which to fit.
    pub(super) fn sample(self, record: &Record, segment: &Segment) -> usize {
        if segment.phase != Phase::Hold {
            return segment.start;
        }
        match self {
            Self::Settled => segment.start,
            Self::Peak => peak(record, segment),
            Self::AfterPeak(delay) => {
                let from = record.time()[peak(record, segment)] + delay;
                let index = record.time().partition_point(|time| *time < from);
                index.clamp(segment.start, segment.end - 1)
            }
        }
    }
}

/// The extreme of the force in the first twentieth of a hold (its first 12 samples at least), or the start of the hold if
/// the force still runs at the end of that stretch: then it is no peak but a trend.
fn peak(record: &Record, segment: &Segment) -> usize {
    let times = &record.time()[..segment.end];
    let twentieth = times[segment.start] + 0.05 * (times[segment.end - 1] - times[segment.start]);
    let until = times.partition_point(|time| *time <= twentieth).max(segment.start + 12).min(segment.end);
    let sign = if segment.after == Some(After::Unloading) { -1.0 } else { 1.0 };
    let height = |index: &usize| sign * record.force()[*index];
    let extreme = (segment.start..until).max_by(|a, b| height(a).total_cmp(&height(b)));
    match extreme {
        Some(index) if index + 1 < until => index,
        _ => segment.start,
    }
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
