//! A record cut into its phases.

use serde::{Deserialize, Serialize};

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
#[non_exhaustive]
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

/// What the jaw does in a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Standing still with nothing held: before anything moved, or after the body broke.
    Rest,
    /// The displacement grows.
    Loading,
    /// The displacement stays, or the force.
    Hold,
    /// The displacement falls.
    Unloading,
}

/// What came before a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum After {
    /// The displacement had grown.
    Loading,
    /// The displacement had fallen.
    Unloading,
}

/// What stays in a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldMode {
    /// The displacement: the force may relax.
    DisplacementHeld,
    /// The force: the displacement creeps.
    ForceHeld,
    /// Both move, if slowly.
    Neither,
}

/// A stretch of the record in one phase.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Segment {
    /// What the jaw does.
    pub phase: Phase,
    /// First sample.
    pub start: usize,
    /// Sample after the last.
    pub end: usize,
    /// For a hold: what came before it.
    pub after: Option<After>,
    /// For a hold: what is held in it.
    pub mode: Option<HoldMode>,
    /// For a hold: the sample from which laws are fitted, see [`HoldStart`](crate::segment::HoldStart). It lies before `start` where the force peaked
    /// while the jaw was still settling.
    pub fit_start: usize,
}

impl Segment {
    /// Whether it is loading or unloading.
    pub(crate) fn is_ramp(&self) -> bool {
        matches!(self.phase, Phase::Loading | Phase::Unloading)
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.end - self.start
    }

    /// Never true.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.end == self.start
    }
}

/// The ramps right before segment `index`, the last of them first.
pub(crate) fn ramps_before(segments: &[Segment], index: usize) -> impl Iterator<Item = &Segment> + Clone {
    segments[..index].iter().rev().take_while(|segment| segment.is_ramp())
}

/// A body that broke while it was loaded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Rupture {
    /// The sample at which the force had fallen by half.
    pub sample: usize,
    /// Its time, s.
    pub time: f64,
    /// The largest force before, N.
    pub before: f64,
    /// The force where the jaw stops, N.
    pub after: f64,
}

/// A regular ripple on a column.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Ripple {
    /// From peak to peak, in the unit of the column.
    pub height: f64,
    /// Its period, s.
    pub period: f64,
}

/// All segments of a record in order, and the thresholds that found them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Segmentation {
    /// Segments; together they cover the record without gaps.
    pub segments: Vec<Segment>,
    /// Where the body broke.
    pub ruptures: Vec<Rupture>,
    /// Ripple of a jaw that oscillates about the positions it holds, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ripple: Option<Ripple>,
    /// The thresholds used.
    pub settings: SegmentSettings,
}

impl Segmentation {
    /// The holds, in order.
    pub fn holds(&self) -> impl Iterator<Item = &Segment> {
        self.segments.iter().filter(|segment| segment.phase == Phase::Hold)
    }

    /// Whether the record is one hold from its first sample to its last.
    #[must_use]
    pub fn is_one_hold(&self) -> bool {
        matches!(self.segments[..], [Segment { phase: Phase::Hold, .. }])
    }
}
