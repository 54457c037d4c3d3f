//! What is observed of a log, as a log of ROS 2.

use std::path::{Path, PathBuf};

use palpate::fit::Estimate;
use palpate::grip::TimeToSlip;
use palpate::number::significant;
use palpate::observe::{Observation, Slip, SlipForecast};
use palpate::record::Record;
use palpate_files::message_log::{Level, LogError};
use palpate_report::result::word;
use serde_json::Value;

use super::Observed;
use super::holds::Event;
use crate::JobError;
use crate::message_log::{ContactLog, Reading};
use crate::output::{Stage, StagedFile, unwritten_log};

/// Results of an observer that are numbers, in SI; a time is infinite for "never".
const NUMBERS: [&str; 14] = [
    "filtered_force_n",
    "equilibrium_force_n",
    "equilibrium_force_standard_error_n",
    "excess_force_n",
    "excess_force_standard_error_n",
    "excess_strain",
    "excess_strain_standard_error",
    "relative_rate_per_s",
    "creep_rate_m_per_s",
    "creep_rate_standard_error_m_per_s",
    "time_to_slip_s",
    "time_to_slip_low_s",
    "time_to_slip_high_s",
    "hold_duration_s",
];

/// A log that appears once all of a record was observed.
pub struct ObservationLog<'r> {
    path: PathBuf,
    record: &'r Record,
    /// Samples observed.
    count: usize,
    stage: Stage,
    log: ContactLog<StagedFile>,
}

impl<'r> ObservationLog<'r> {
    /// Begins the log at `path` of what is observed of a record; `zero` is the date of its time 0 (ns since 1970), where that is known.
    ///
    /// # Errors
    /// [`JobError`] where the operating system takes no file there.
    pub fn open(path: &Path, record: &'r Record, zero: Option<u64>) -> Result<Self, JobError> {
        let mut stage = Stage::default();
        let start = (record.time()[0], zero);
        let log = ContactLog::new(stage.open(path)?, "palpate watch", start);
        Ok(Self {
            path: path.to_owned(),
            record,
            count: 0,
            stage,
            log: log.map_err(|error| unwritten_log(path, &error))?,
        })
    }

    /// Takes what was observed, in its order.
    ///
    /// # Errors
    /// [`JobError`] where a time has no stamp, or the operating system takes no bytes.
    pub fn see(&mut self, observed: &Observed) -> Result<(), JobError> {
        let written = match observed {
            Observed::Next(_) => Ok(()),
            Observed::Event(event) => self.happened(event),
            Observed::Tick(observed, _) => self.tick(observed),
        };
        written.map_err(|error| unwritten_log(&self.path, &error))
    }

    /// Puts the log into its place.
    ///
    /// # Errors
    /// [`JobError`] where the operating system refuses; there is no log then.
    pub fn commit(mut self) -> Result<(), JobError> {
        let file = self.log.finish().map_err(|error| unwritten_log(&self.path, &error))?;
        self.stage.take(file)?;
        self.stage.commit()
    }

    fn tick(&mut self, observed: &Observation) -> Result<(), LogError> {
        let index = self.count;
        self.count += 1;
        let stamp = self.log.reading(&Reading {
            time: observed.time,
            displacement: self.record.displacement().map(|column| column[index]),
            velocity: None,
            force: self.record.force()[index],
        })?;
        let values = numbers(observed);
        NUMBERS.iter().zip(values).try_for_each(|(name, value)| self.log.number(name, stamp, value))
    }

    /// An event, with the keys and values of its line of `palpate.watch/1`.
    fn happened(&mut self, event: &Event) -> Result<(), LogError> {
        let (time, level, message) = reported(event);
        let document = serde_json::to_value(event.document()).unwrap_or_default();
        let shown = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let values: Vec<(String, String)> = document
            .as_object()
            .map(|known| known.iter().map(|(key, value)| (key.clone(), shown(value))).collect())
            .unwrap_or_default();
        self.log.event(time, level, &message, &values)
    }
}

/// The numbers of an observation, in the order of [`NUMBERS`].
fn numbers(observed: &Observation) -> [Option<f64>; NUMBERS.len()] {
    let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
    let error = |estimate: Option<Estimate>| estimate.and_then(|estimate| estimate.standard_error);
    let seconds = |time: TimeToSlip| time.seconds().unwrap_or(f64::INFINITY);
    let (best, low, high) = match observed.time_to_slip {
        Some(SlipForecast::Known { best, low, high }) => (Some(seconds(best)), Some(seconds(low)), Some(seconds(high))),
        _ => (None, None, None),
    };
    [
        Some(observed.force),
        value(observed.equilibrium_force),
        error(observed.equilibrium_force),
        value(observed.excess_force),
        error(observed.excess_force),
        value(observed.excess_strain),
        error(observed.excess_strain),
        observed.relative_rate,
        value(observed.creep_rate),
        error(observed.creep_rate),
        best,
        low,
        high,
        observed.held_since.map(|since| observed.time - since),
    ]
}

/// When something happened, s, how serious it is, and what it is.
fn reported(event: &Event) -> (f64, Level, String) {
    let held = |observed: &Observation| observed.held.map_or("hold".to_owned(), |held| format!("{} hold", word(held)));
    match event {
        Event::Began(observed) => (observed.time, Level::Ok, format!("{} begins", held(observed))),
        Event::Changed(observed) => (observed.time, Level::Ok, format!("it is a {}", held(observed))),
        Event::Ended(time, hold) => {
            let duration = significant(hold.until - hold.since, 4);
            (*time, Level::Ok, format!("{} hold ends after {duration} s", word(hold.held)))
        }
        Event::Warned(observed) if observed.slip == Slip::Slipping => {
            let force = significant(observed.force, 3);
            (observed.time, Level::Error, format!("slips, the force is {force} N"))
        }
        Event::Warned(observed) => {
            let best = numbers(observed)[SLIP].map_or("unknown".to_owned(), |time| significant(time, 3));
            (observed.time, Level::Warn, format!("slip soon: predicted in {best} s"))
        }
    }
}

/// Place of the time to slip among [`NUMBERS`].
const SLIP: usize = 10;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_of_an_observation_have_their_names() {
        assert_eq!(NUMBERS[SLIP], "time_to_slip_s");
        let slip = SlipForecast::Known {
            best: TimeToSlip::After(2.0),
            low: TimeToSlip::After(1.0),
            high: TimeToSlip::Never,
        };
        let mut observed = Observation::default();
        (observed.time, observed.held_since, observed.time_to_slip) = (3.0, Some(1.0), Some(slip));
        let found = numbers(&observed);
        assert_eq!(found[SLIP..], [Some(2.0), Some(1.0), Some(f64::INFINITY), Some(2.0)]);
        assert_eq!(found[1..SLIP], [None; SLIP - 1]);
        observed.slip = Slip::Soon;
        assert_eq!(reported(&Event::Warned(observed)).2, "slip soon: predicted in 2.00 s");
    }
}
