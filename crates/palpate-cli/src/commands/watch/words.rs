//! An observation in words.

use palpate::fit::Estimate;
use palpate::grip::TimeToSlip;
use palpate::number::{significant, with_interval};
use palpate::observe::{Observation, Slip, SlipForecast};
use palpate_report::result::word;

/// A value with its 95 % interval.
pub(super) fn uncertain(estimate: Estimate, unit: &str) -> String {
    let text = with_interval(
        estimate.value,
        with_normal_interval(estimate).interval.unwrap_or((estimate.value, estimate.value)),
    );
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

/// An estimate with the 95 % interval of a normal distribution of its standard error.
pub(super) fn with_normal_interval(estimate: Estimate) -> Estimate {
    /// Two-sided 95 % quantile of the standard normal distribution.
    const QUANTILE: f64 = 1.959_964;
    let ends = |error: f64| (estimate.value - QUANTILE * error, estimate.value + QUANTILE * error);
    Estimate {
        interval: estimate.standard_error.map(ends),
        ..estimate
    }
}

/// A time that is left.
pub(super) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{} s", significant(s, 2)),
        s if s < 7200.0 => format!("{} min", significant(s / 60.0, 2)),
        s if s < 172_800.0 => format!("{} h", significant(s / 3600.0, 2)),
        s => format!("{} d", significant(s / 86_400.0, 2)),
    }
}

/// What is known of slip; `None` where no limit is given.
pub(super) fn slip(observed: &Observation) -> Option<String> {
    Some(match observed.time_to_slip? {
        _ if observed.slip == Slip::Slipping => "slipping".to_owned(),
        SlipForecast::Unknown => "not known yet".to_owned(),
        SlipForecast::Known {
            low: TimeToSlip::Never, ..
        } => "never by relaxation".to_owned(),
        SlipForecast::Known { best, low, high } => {
            let words = |time: TimeToSlip| time.seconds().map_or("never".to_owned(), duration);
            match best {
                TimeToSlip::After(_) => format!("in {} ({} to {})", words(best), words(low), words(high)),
                TimeToSlip::Never => format!("perhaps never, not before {}", words(low)),
            }
        }
    })
}

/// Phase and what is held.
pub(super) fn state(observed: &Observation) -> String {
    match (observed.held, observed.held_since) {
        (Some(what), Some(since)) => {
            format!("{} held since {} s", word(what), significant(since, 5))
        }
        _ => word(observed.phase),
    }
}
