//! The settings that an analysis ran with, defaults and derived thresholds included.

use palpate::analysis::Analysis;
use palpate::contact::{Equilibrium, Sides, Specimen};
use palpate::fit::IntervalMethod;
use palpate::segment::ContactChoice;
use palpate::simulate::Separation;

use crate::result::{hold_start_word, word};

documents! {
    /// Resolved settings.
    SettingsDocument(analysis: &Analysis) with {
        let (options, segment) = (&analysis.options, &analysis.segmentation.settings);
        let geometry = options.geometry.as_ref();
        let shape = serde_json::to_value(geometry.map(|geometry| &geometry.shape)).unwrap_or_default();
        let (tip, layer) = (&shape["tip"], &shape["layer"]);
        let hertz = geometry.and_then(|geometry| match geometry.equilibrium {
            Equilibrium::Hertz { poisson_ratio } => Some(poisson_ratio),
            Equilibrium::UniformStrain | Equilibrium::Measured { .. } => None,
        });
    } {
        /// `ball`, `pad`, `prism`, `profile`, `indenter` or `none`.
        shape: String = shape["kind"].as_str().unwrap_or("none").to_owned(),
        /// `sphere`, `cone`, `pyramid` or `punch` of an indenter.
        tip?: Option<String> = tip["kind"].as_str().map(str::to_owned),
        /// Radius of a ball, a pad, a spherical tip or a punch, m.
        radius_m: Option<f64> = shape["radius"].as_f64().or(tip["radius"].as_f64()),
        /// Half angle of a cone or a pyramid, rad.
        half_angle_rad?: Option<f64> = tip["half_angle"].as_f64(),
        /// Section of a prism, m².
        area_m2: Option<f64> = shape["area"].as_f64(),
        /// Length of a prism, m.
        length_m: Option<f64> = shape["length"].as_f64(),
        /// Thickness of a pad, or of the layer under a tip, m.
        thickness_m?: Option<f64> = shape["thickness"].as_f64().or(layer["thickness"].as_f64()),
        /// `bonded` or `sliding` of the layer under a tip.
        base?: Option<String> = layer["base"].as_str().map(str::to_owned),
        /// Poisson's ratio, with Hertz's law.
        poisson_ratio?: Option<f64> = hertz,
        /// Modulus, Pa.
        modulus_pa: Option<f64> = analysis.specimen.as_ref().map(Specimen::modulus),
        /// `given` or `estimated`.
        modulus_source: Option<String> = analysis.modulus_source.map(word),
        /// Standard error of an estimated modulus, Pa, which allows for the laws that the holds leave open; `null` where it is not known.
        modulus_standard_error_pa?: Option<f64> = analysis.modulus.as_ref().and_then(|found| found.estimate.standard_error),
        /// 1 or 2 sides from which the body is squeezed.
        sides: Option<u8> = geometry.map(|geometry| if geometry.sides == Sides::Two { 2 } else { 1 }),
        /// Whether phases come from the displacement (else from the force).
        phases_from_displacement: bool = segment.from_displacement,
        /// Noise of the column that the phases come from, m or N.
        noise: f64 = segment.noise,
        /// Largest deviation of that column within a hold, m or N.
        tolerance: f64 = segment.tolerance,
        /// Typical speed of the ramps, m/s or N/s.
        ramp_speed: f64 = segment.ramp_speed,
        /// Speed below which it is at rest, m/s or N/s.
        still_speed: f64 = segment.still_speed,
        /// Samples on each side of a slope.
        slope_window: usize = segment.slope_window,
        /// Shortest hold, s.
        minimum_hold_s: f64 = segment.minimum_hold,
        /// Fewest samples of a hold.
        minimum_samples: usize = segment.minimum_samples,
        /// `peak`, `settled` or `peak + … s`.
        hold_start: String = hold_start_word(options.segment.hold_start),
        /// `auto`, `as recorded`, a rule or a displacement.
        touch: String = match options.touch {
            ContactChoice::Auto => "auto".to_owned(),
            ContactChoice::AsRecorded => "as recorded".to_owned(),
            ContactChoice::Displacement(at) => format!("{at} m"),
            ContactChoice::By(method) => method.name().to_owned(),
        },
        /// Force subtracted, N.
        force_zero_n: f64 = analysis.contact.tare.force,
        /// Displacement subtracted, m.
        displacement_zero_m: f64 = analysis.contact.tare.displacement,
        /// Whether the jaw can leave the body in the overlay.
        separation: bool = options.separation == Separation::Unilateral,
        /// Fixed exponents.
        exponents: Vec<f64> = options.exponents.clone(),
        /// Whether n was also estimated.
        free_exponent: bool = options.free_exponent,
        /// Range of a free n.
        exponent_range: [f64; 2] = options.fit.exponent_range.into(),
        /// Coverage of the intervals.
        confidence: f64 = options.fit.confidence,
        /// Method of the intervals, if not automatic: `curvature`, `profile` or `bootstrap`.
        intervals?: Option<String> = unusual(options.fit.intervals),
        /// Duration of the fitted part from the start of the fit, s.
        fit_until_s: Option<f64> = options.fit_until,
        /// Samples on each side of a strain rate, at least.
        rate_window_samples: usize = options.rate_window.samples,
        /// Half width of its window as a share of the time since the start of the hold.
        rate_window_share: f64 = options.rate_window.share,
    }
}

/// What intervals rest on, if not what is usual.
pub(super) fn unusual(intervals: IntervalMethod) -> Option<String> {
    Some(intervals).filter(|way| !way.is_automatic()).map(|way| way.name().to_owned())
}
