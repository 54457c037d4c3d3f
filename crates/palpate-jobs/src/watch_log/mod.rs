//! A recorded log as a controller would have observed it: holds, where they tend, time to slip.
//!
//! | file | what |
//! |---|---|
//! | `holds.rs` | what happens from tick to tick, and the holds that were observed |
//! | `log.rs` | what is observed, as a log of ROS 2 |

mod holds;
mod log;

use palpate::observe::{Observation, ObserveError, Observer, ObserverOptions};
use palpate::record::Record;
use palpate::watch::{Progress, Watch};
use palpate_files::description::MaterialFile;
use palpate_report::document::{ObservationDocument, WatchDocument};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use holds::{Event, HoldObserved};
pub use log::ObservationLog;

use crate::{ErrorKind, JobError, Outcome};
use holds::Holds;

/// Replay a recorded log as if live.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WatchLog {
    /// Exponent of the law if no material is given, from 1 to 30.
    pub exponent: f64,
    /// Standard error of that exponent, which the intervals include.
    pub exponent_standard_error: f64,
    /// Normal force below which the held object slips.
    pub slip_force_n: Option<f64>,
    /// Time before the predicted slip at which to warn.
    pub warn_before_s: f64,
    /// Coverage of the intervals, between 0 and 1.
    pub confidence: f64,
    /// Interval of log time between two reported observations.
    pub every_s: f64,
}

impl Default for WatchLog {
    fn default() -> Self {
        Self {
            exponent: 5.0,
            exponent_standard_error: 0.0,
            slip_force_n: None,
            warn_before_s: 1.0,
            confidence: 0.95,
            every_s: 0.5,
        }
    }
}

/// What is reported while a log is watched, in its order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Observed {
    /// A sample of this time comes next, s.
    Next(f64),
    /// Something happened.
    Event(Event),
    /// A sample, and whether it is one of those to be reported.
    Tick(Observation, bool),
}

impl Observed {
    /// The line of `palpate.watch/1` that tells of it; none of what is not reported.
    #[must_use]
    pub fn document(&self) -> Option<WatchDocument> {
        match self {
            Self::Event(event) => Some(event.document()),
            Self::Tick(observed, true) => Some(WatchDocument::Observation(ObservationDocument::new("tick", observed))),
            Self::Next(_) | Self::Tick(_, false) => None,
        }
    }
}

/// Ticks between two reports to the watch.
const TICKS: usize = 256;

impl WatchLog {
    /// Feeds the samples of a log, whose name is `place`, one by one; `see` hears of every one, until it is no longer interested. The excess
    /// strain is known from first touch on if the material is given.
    ///
    /// # Errors
    /// [`JobError`] where the options or the log are none that can be watched, or the watch ends it.
    pub fn run(
        &self,
        (record, place): (&Record, &str),
        material: Option<MaterialFile>,
        watch: &mut dyn Watch,
        mut see: impl FnMut(Observed) -> bool,
    ) -> Result<Outcome<Vec<HoldObserved>>, JobError> {
        let refused = |error: ObserveError| {
            let hint = error.hint().to_owned();
            JobError::new(ErrorKind::Option, error, hint).of(place)
        };
        let options = ObserverOptions {
            material: material.map(|file| file.material),
            exponent: self.exponent,
            exponent_standard_error: self.exponent_standard_error,
            slip_force: self.slip_force_n,
            warn_before: self.warn_before_s,
            confidence: self.confidence,
            ..ObserverOptions::default()
        };
        let mut observer = Observer::new(options).map_err(refused)?;
        let (times, displacement) = (record.time(), record.displacement());
        let (mut holds, mut next) = (Holds::default(), times[0]);
        for (index, (time, force)) in times.iter().zip(record.force()).enumerate() {
            if index % TICKS == 0 {
                watch.report(Progress::counted("watching", index, times.len()))?;
            }
            if !see(Observed::Next(*time)) {
                break;
            }
            let observed = observer.feed(*time, displacement.map(|column| column[index]), *force).map_err(refused)?;
            let reported = *time >= next;
            if reported {
                next += self.every_s * ((time - next) / self.every_s).floor() + self.every_s;
            }
            let events = holds.follow(&observed).into_iter().map(Observed::Event);
            if !events.chain([Observed::Tick(observed, reported)]).all(&mut see) {
                break;
            }
        }
        Ok(Outcome::of(holds.all()))
    }
}
