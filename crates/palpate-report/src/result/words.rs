//! The words for what the library says, the same in documents, tables and pages.

use palpate::calibrate::MaterialUnit;
use palpate::grip::TimeToSlip;
use palpate::number::exact;
use palpate::observe::SlipForecast;
use palpate::segment::{HoldMode, HoldStart};

use crate::word::word;

/// The word for what is held, as a description writes it.
#[must_use]
pub fn mode_word(mode: HoldMode) -> String {
    word(mode).replace("_held", "")
}

/// How a number of a material is written: what its name in a document ends in, its unit, and in which factor and unit people read it.
#[must_use]
pub fn material_unit(unit: MaterialUnit) -> (&'static str, &'static str, (f64, &'static str)) {
    match unit {
        MaterialUnit::One => ("", "1", (1.0, "")),
        MaterialUnit::Second => ("_s", "s", (1.0, "s")),
        MaterialUnit::PerSecond => ("_per_s", "1/s", (1.0, "1/s")),
        MaterialUnit::Metre => ("_m", "m", (1e3, "mm")),
        MaterialUnit::Newton => ("_n", "N", (1.0, "N")),
        MaterialUnit::Pascal => ("_pa", "Pa", (1e-3, "kPa")),
    }
}

/// From where in a hold the laws are fitted, as it is written in a description.
pub(crate) fn hold_start_word(start: HoldStart) -> String {
    match start {
        HoldStart::AfterPeak(delay) => format!("peak + {delay} s"),
        start => word(start),
    }
}

/// A share as people read it, without the last digits of its product with 100.
pub(crate) fn percent(share: f64) -> String {
    format!("{} %", exact((1e11 * share).round() / 1e9))
}

/// The word for whether it slips.
#[must_use]
pub fn slips_word(forecast: SlipForecast) -> &'static str {
    match forecast {
        SlipForecast::Unknown => "not_known_yet",
        SlipForecast::Known {
            low: TimeToSlip::Never, ..
        } => "never",
        SlipForecast::Known {
            best: TimeToSlip::Never,
            ..
        } => "perhaps_never",
        SlipForecast::Known { .. } => "after",
    }
}
