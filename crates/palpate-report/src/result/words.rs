//! The words for what the library says, the same in documents, tables and pages.

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

/// What holds of one kind have in common: "after loading, 10.00 mm"; empty where nothing is known of them.
pub(crate) fn condition(after: Option<&str>, held: Option<String>) -> String {
    after.map(|after| format!("after {after}")).into_iter().chain(held).collect::<Vec<_>>().join(", ")
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
