//! A record cut into its phases.

use serde::{Deserialize, Serialize};

/// From where in a hold the laws are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldStart {
    /// From where the signal begins to relax: its last extreme in the first tenth of the hold (its maximum after loading, its
    /// minimum after unloading), after the machine has settled on what it holds.
    #[default]
    Peak,
    /// From the first sample of the hold.
    Settled,
    /// This long after the extreme, s.
    AfterPeak(f64),
}

/// How the sample was chosen from which laws are fitted to a hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FitStartRule {
    /// The first sample of the hold.
    HoldStart,
    /// The first sample from which on the machine stays at the level that it holds.
    DriveSettled,
    /// The last extreme of the signal early in the hold.
    Extreme,
    /// The requested time after that.
    AfterExtreme,
    /// The first sample at which the body meets the jaw again.
    ContactClosed,
    /// The first sample behind rows of the force that stray.
    BehindStrays,
    /// The first sample at which a force that an amplifier or a filter delays has caught up.
    DelayFaded,
}

impl FitStartRule {
    /// The rule in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::HoldStart => "start of the hold",
            Self::DriveSettled => "machine settled",
            Self::Extreme => "last extreme",
            Self::AfterExtreme => "requested delay",
            Self::ContactClosed => "contact closed",
            Self::BehindStrays => "behind stray rows",
            Self::DelayFaded => "delay of the force faded",
        }
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
    /// For a hold: the sample from which laws are fitted, see [`HoldStart`](crate::segment::HoldStart).
    pub fit_start: usize,
    /// For a hold: how that sample was chosen.
    #[serde(default)]
    pub fit_start_rule: Option<FitStartRule>,
    /// For a hold found in a force alone: whether ramps, or a drift that was rounded, explain the force nearly as well.
    #[serde(default)]
    pub doubtful: bool,
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

/// Where the labels of a file and a search of its columns disagree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LabelCheck {
    /// Labelled holds.
    pub labelled: usize,
    /// Those of them that a search does not find.
    pub missed: usize,
    /// Holds that a search finds where the file labels none.
    pub extra: usize,
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
    /// Where holds come from the labels of the file, and a search finds others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub labels: Option<LabelCheck>,
    /// The thresholds used.
    pub settings: SegmentSettings,
}

impl Segmentation {
    /// The holds, in order.
    pub fn holds(&self) -> impl Iterator<Item = &Segment> {
        self.segments.iter().filter(|segment| segment.phase == Phase::Hold)
    }

    /// The first loading ramp.
    pub(crate) fn first_loading(&self) -> Option<&Segment> {
        self.segments.iter().find(|segment| segment.phase == Phase::Loading)
    }

    /// Whether the record is one hold from its first sample to its last.
    #[must_use]
    pub fn is_one_hold(&self) -> bool {
        matches!(self.segments[..], [Segment { phase: Phase::Hold, .. }])
    }
}
