//! Thresholds: options in, the values they took out.

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
