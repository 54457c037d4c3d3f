//! What an observer says after a tick, alone or as columns.

use arrow_array::ArrayRef;
use palpate::fit::Estimate;
use palpate::grip::TimeToSlip;
use palpate::number::significant;
use palpate::observe::{Observation as Observed, Slip, SlipForecast};
use palpate::watch::Cancelled;

use palpate_report::result::{slips_word, word};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::shown::shown;
use crate::table::columns;

/// What an observer says after a tick; None where something is not known.
///
/// Made by `Observer.feed`.
#[pyclass(name = "Observation", module = "palpate", frozen, eq)]
#[derive(PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Observation {
    pub(crate) observed: Observed,
}

/// Best value and ends of the interval, s; infinite for never.
fn times(forecast: Option<SlipForecast>) -> Option<(f64, f64, f64)> {
    let seconds = |time: TimeToSlip| time.seconds().unwrap_or(f64::INFINITY);
    match forecast? {
        SlipForecast::Unknown => None,
        SlipForecast::Known { best, low, high } => Some((seconds(best), seconds(low), seconds(high))),
    }
}

fn value(number: Option<Estimate>) -> Option<f64> {
    number.map(|number| number.value)
}

fn deviation(number: Option<Estimate>) -> Option<f64> {
    number.and_then(|number| number.standard_error)
}

/// Attributes of an observation, which are the columns of observations.
macro_rules! attributes {
    ($observed:ident { $($(#[$doc:meta])* $name:ident: $of:ty = $value:expr,)* } $($methods:tt)*) => {
        shown! {
            Observation: self
            values {
                $($(#[$doc])* $name: $of = {
                    let $observed = &self.observed;
                    $value
                },)*
            }

            $($methods)*
        }

        /// Observations as a table: a column for each attribute of `Observation`, numbers that are not known missing.
        /// `look` says before each column of millions of rows whether it is still wanted.
        pub(crate) fn columns(
            all: &[Observed],
            look: impl Fn() -> Result<(), Cancelled>,
        ) -> Result<Vec<(&'static str, ArrayRef)>, Cancelled> {
            Ok(vec![$({
                look()?;
                columns!(all, $observed => $name = $value).swap_remove(0)
            }),*])
        }
    };
}

attributes! {
    observed {
        /// When, s.
        time_s: f64 = observed.time,
        /// What happens: "free", "loading", "holding" or "unloading".
        phase: String = word(observed.phase),
        /// What is held, "displacement" or "force"; None outside a hold.
        held: Option<String> = observed.held.map(word),
        /// When the hold began, s.
        held_since_s: Option<f64> = observed.held_since,
        /// True on the one tick that says that a hold began.
        began: bool = observed.began,
        /// The force without its noise, N: the fitted curve inside a hold, a filter's elsewhere.
        force_n: f64 = observed.force,
        /// The force that a hold of the displacement tends to, N; None until its interval is narrower than the force itself.
        equilibrium_force_n: Option<f64> = value(observed.equilibrium_force),
        /// Its standard deviation, N.
        equilibrium_force_standard_error_n: Option<f64> = deviation(observed.equilibrium_force),
        /// Force in excess of equilibrium, N.
        excess_force_n: Option<f64> = value(observed.excess_force),
        /// Its standard deviation, N.
        excess_force_standard_error_n: Option<f64> = deviation(observed.excess_force),
        /// Strain in excess of equilibrium; only a material tells it.
        excess_strain: Option<f64> = value(observed.excess_strain),
        /// Its standard deviation.
        excess_strain_standard_error: Option<f64> = deviation(observed.excess_strain),
        /// Rate at which the excess falls now, in shares of itself, 1/s.
        relative_rate_per_s: Option<f64> = observed.relative_rate,
        /// Speed of the creep while the force is held, m/s.
        creep_rate_m_per_s: Option<f64> = value(observed.creep_rate),
        /// Its standard deviation, m/s.
        creep_rate_standard_error_m_per_s: Option<f64> = deviation(observed.creep_rate),
        /// Whether it slips: "not_known_yet", "never" (by relaxation), "perhaps_never" or "after"; None where no force of slip was given.
        slips: Option<&'static str> = observed.time_to_slip.map(slips_word),
        /// How long until the force has fallen to that of slip, s; infinite for never, None where that is not known.
        time_to_slip_s: Option<f64> = times(observed.time_to_slip).map(|times| times.0),
        /// Lower end of its interval, s.
        time_to_slip_low_s: Option<f64> = times(observed.time_to_slip).map(|times| times.1),
        /// Upper end of its interval, s; infinite where never lies inside.
        time_to_slip_high_s: Option<f64> = times(observed.time_to_slip).map(|times| times.2),
        /// "none", "soon" (slip within the time to warn cannot be excluded) or "slipping".
        warning: String = word(observed.slip),
    }

    fn __repr__(&self) -> String {
        let observed = &self.observed;
        let held = observed.held.map_or_else(String::new, |what| format!(" the {}", word(what)));
        let slip = match (observed.slip, observed.time_to_slip) {
            (Slip::Slipping, _) => ", slipping".to_owned(),
            (
                _,
                Some(SlipForecast::Known {
                    best: TimeToSlip::After(time),
                    ..
                }),
            ) => format!(", slips in {} s", significant(time, 3)),
            _ => String::new(),
        };
        let (time, force) = (significant(observed.time, 6), significant(observed.force, 4));
        format!("<palpate.Observation at {time} s: {}{held}, {force} N{slip}>", word(observed.phase))
    }
}
