//! `palpate.watch/1`: reports of an observer of a contact, one JSON object per line.

use palpate::fit::Estimate;
use palpate::grip::TimeToSlip;
use palpate::observe::{Held, Observation, Slip, SlipForecast};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::result::{slips_word, word};

/// One line: a tick or an event, the end of a hold, or the holds of the whole log. Unknown values are omitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "palpate.watch/1")]
#[serde(untagged)]
pub enum WatchDocument {
    /// The last line.
    Summary(WatchSummaryDocument),
    /// A hold that ended.
    Hold(WatchedHoldDocument),
    /// A tick, a hold that begins or changes, or a warning.
    Observation(ObservationDocument),
}

documents! {
    /// An observed hold.
    #[serde(deny_unknown_fields)]
    WatchedHoldDocument(
        held: Held,
        times: (f64, f64),
        forces: (f64, f64),
        equilibrium_force: Option<Estimate>,
        creep_rate: Option<Estimate>
    ) with {
        let ((start, end), (force_start, force_end)) = (times, forces);
        let (equilibrium, equilibrium_standard_error) = parted(equilibrium_force);
        let (creep, creep_standard_error) = parted(creep_rate);
    } {
        /// Standard error of the creep speed, m/s.
        creep_rate_standard_error_m_per_s?: Option<f64> = creep_standard_error,
        /// The last creep speed, m/s.
        creep_rate_m_per_s?: Option<f64> = creep,
        /// Time of its last tick, s.
        end_s: f64 = end,
        /// Standard error of the equilibrium force, N.
        equilibrium_force_standard_error_n?: Option<f64> = equilibrium_standard_error,
        /// The last equilibrium force, N.
        equilibrium_force_n?: Option<f64> = equilibrium,
        /// `hold_ends`; omitted in the summary.
        event?: Option<String> = None,
        /// Force at its end, the median of its last nine ticks, N.
        force_end_n: f64 = force_end,
        /// Force at its start, N.
        force_start_n: f64 = force_start,
        /// What was held for most of its ticks: `displacement` or `force`.
        held: String = word(held),
        /// First time at or below the force of slip, s.
        slipped_s?: Option<f64> = None,
        /// Time of its start, s.
        start_s: f64 = start,
        /// Time at which its end was detected, s; omitted in the summary.
        time_s?: Option<f64> = None,
        /// First warning, s.
        warned_s?: Option<f64> = None,
    }

    /// The holds of a log.
    #[serde(deny_unknown_fields)]
    WatchSummaryDocument(holds: Vec<WatchedHoldDocument>) {
        /// Always `summary`.
        event: String = "summary".to_owned(),
        /// The holds in order.
        holds: Vec<WatchedHoldDocument> = holds,
    }

    /// Report of an observer after a tick.
    ObservationDocument(event: &str, observed: &Observation) with {
        let (creep, creep_standard_error) = parted(observed.creep_rate);
        let (equilibrium, equilibrium_standard_error) = parted(observed.equilibrium_force);
        let (excess, excess_standard_error) = parted(observed.excess_force);
        let (strain, strain_standard_error) = parted(observed.excess_strain);
        let hold = observed.held.zip(observed.held_since);
        let times = match observed.time_to_slip {
            Some(SlipForecast::Known { best, low: TimeToSlip::After(low), high }) => {
                Some((best.seconds(), low, high.seconds()))
            }
            _ => None,
        };
        let warns = observed.time_to_slip.is_some() || observed.slip != Slip::None;
    } {
        /// Standard error of the creep speed, m/s.
        creep_rate_standard_error_m_per_s?: Option<f64> = creep_standard_error,
        /// Creep speed in a force hold, m/s.
        creep_rate_m_per_s?: Option<f64> = creep,
        /// Standard error of the equilibrium force, N.
        equilibrium_force_standard_error_n?: Option<f64> = equilibrium_standard_error,
        /// Equilibrium force of a position hold, N.
        equilibrium_force_n?: Option<f64> = equilibrium,
        /// `tick`, `hold_begins`, `hold_changes` or `warning`.
        event: String = event.to_owned(),
        /// Standard error of the excess force, N.
        excess_force_standard_error_n?: Option<f64> = excess_standard_error,
        /// Force in excess of equilibrium, N.
        excess_force_n?: Option<f64> = excess,
        /// Strain in excess of equilibrium.
        excess_strain?: Option<f64> = strain,
        /// Standard error of the excess strain.
        excess_strain_standard_error?: Option<f64> = strain_standard_error,
        /// Filtered force, N.
        force_n: f64 = observed.force,
        /// What is held: `displacement` or `force`.
        held?: Option<String> = hold.map(|(held, _)| word(held)),
        /// Start of the hold, s.
        held_since_s?: Option<f64> = hold.map(|(_, since)| since),
        /// `free`, `loading`, `holding` or `unloading`.
        phase: String = word(observed.phase),
        /// Current relative rate at which the excess falls, 1/s.
        relative_rate_per_s?: Option<f64> = observed.relative_rate,
        /// `not_known_yet`, `never`, `perhaps_never` or `after`; omitted without a slip force.
        slips?: Option<String> = observed.time_to_slip.map(|time| slips_word(time).to_owned()),
        /// Time of the report, s.
        time_s: f64 = observed.time,
        /// Upper end of the interval of the time to slip, s; `null` where the interval is unbounded.
        time_to_slip_high_s?: Option<Option<f64>> = times.map(|(_, _, high)| high),
        /// Its lower end, s.
        time_to_slip_low_s?: Option<f64> = times.map(|(_, low, _)| low),
        /// Time until the force has fallen to the slip force, s; `null` for never.
        time_to_slip_s?: Option<Option<f64>> = times.map(|(value, _, _)| value),
        /// `none`, `soon` or `slipping`; omitted without a slip force.
        warning?: Option<String> = warns.then(|| word(observed.slip)),
    }
}

fn parted(number: Option<Estimate>) -> (Option<f64>, Option<f64>) {
    (number.map(|number| number.value), number.and_then(|number| number.standard_error))
}

impl WatchedHoldDocument {
    /// The same as the line that tells of its end.
    #[must_use]
    pub fn ended(mut self, time: f64) -> Self {
        (self.event, self.time_s) = (Some("hold_ends".to_owned()), Some(time));
        self
    }
}
