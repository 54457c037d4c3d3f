//! The settings that an analysis ran with, defaults and derived thresholds included.

use palpate::analysis::Analysis;
use palpate::contact::Sides;
use palpate::segment::ContactChoice;
use palpate::simulate::Separation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::result::{hold_start_word, word};

/// Resolved settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SettingsDocument {
    /// `ball`, `pad`, `prism` or `none`.
    pub shape: String,
    /// Radius of a ball or a pad, m.
    pub radius_m: Option<f64>,
    /// Section of a prism, m².
    pub area_m2: Option<f64>,
    /// Length of a prism, m.
    pub length_m: Option<f64>,
    /// Thickness of a pad, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness_m: Option<f64>,
    /// Modulus, Pa.
    pub modulus_pa: Option<f64>,
    /// `given` or `estimated`.
    pub modulus_source: Option<String>,
    /// 1 or 2 sides from which the body is squeezed.
    pub sides: Option<u8>,
    /// Whether phases come from the displacement (else from the force).
    pub phases_from_displacement: bool,
    /// Noise of the column that the phases come from, m or N.
    pub noise: f64,
    /// How far it may stray in a hold, m or N.
    pub tolerance: f64,
    /// Typical speed of the ramps, m/s or N/s.
    pub ramp_speed: f64,
    /// Speed under which it stands still, m/s or N/s.
    pub still_speed: f64,
    /// Samples on each side of a slope.
    pub slope_window: usize,
    /// Shortest hold, s.
    pub minimum_hold_s: f64,
    /// Fewest samples of a hold.
    pub minimum_samples: usize,
    /// `peak`, `settled` or `peak + … s`.
    pub hold_start: String,
    /// `auto`, `as recorded`, a rule or a displacement.
    pub touch: String,
    /// Force subtracted, N.
    pub force_zero_n: f64,
    /// Displacement subtracted, m.
    pub displacement_zero_m: f64,
    /// Whether the jaw can leave the body in the overlay.
    pub separation: bool,
    /// Exponents tried as given.
    pub exponents: Vec<f64>,
    /// Whether n was also left free.
    pub free_exponent: bool,
    /// Range of a free n.
    pub exponent_range: [f64; 2],
    /// Coverage of the intervals.
    pub confidence: f64,
    /// Fitted only this long from the start of the fit, s.
    pub fit_until_s: Option<f64>,
    /// Samples on each side of a strain rate, at least.
    pub rate_window_samples: usize,
    /// Half width of its window as a share of the time since the hold began.
    pub rate_window_share: f64,
}

impl SettingsDocument {
    pub(super) fn new(analysis: &Analysis) -> Self {
        let (options, segment) = (&analysis.options, &analysis.segmentation.settings);
        let shape = serde_json::to_value(options.geometry.as_ref().map(|geometry| &geometry.shape)).unwrap_or_default();
        let sides = options.geometry.as_ref().map(|geometry| geometry.sides);
        Self {
            shape: shape["kind"].as_str().unwrap_or("none").to_owned(),
            radius_m: shape["radius"].as_f64(),
            thickness_m: shape["thickness"].as_f64(),
            area_m2: shape["area"].as_f64(),
            length_m: shape["length"].as_f64(),
            modulus_pa: analysis.specimen.as_ref().map(palpate::contact::Specimen::modulus),
            modulus_source: analysis.modulus_source.map(word),
            sides: sides.map(|sides| if sides == Sides::Two { 2 } else { 1 }),
            phases_from_displacement: segment.from_displacement,
            noise: segment.noise,
            tolerance: segment.tolerance,
            ramp_speed: segment.ramp_speed,
            still_speed: segment.still_speed,
            slope_window: segment.slope_window,
            minimum_hold_s: segment.minimum_hold,
            minimum_samples: segment.minimum_samples,
            hold_start: hold_start_word(options.segment.hold_start),
            touch: match options.touch {
                ContactChoice::Auto => "auto".to_owned(),
                ContactChoice::AsRecorded => "as recorded".to_owned(),
                ContactChoice::Displacement(at) => format!("{at} m"),
                ContactChoice::By(method) => method.name().to_owned(),
            },
            force_zero_n: analysis.contact.tare.force,
            displacement_zero_m: analysis.contact.tare.displacement,
            separation: options.separation == Separation::Unilateral,
            exponents: options.exponents.clone(),
            free_exponent: options.free_exponent,
            exponent_range: [options.fit.exponent_range.0, options.fit.exponent_range.1],
            confidence: options.fit.confidence,
            fit_until_s: options.fit_until,
            rate_window_samples: options.rate_window.samples,
            rate_window_share: options.rate_window.share,
        }
    }
}
