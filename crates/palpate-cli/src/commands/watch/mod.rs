//! `palpate watch`: a recorded log replayed as if live.
//!
//! | file | what |
//! |---|---|
//! | `events.rs` | what happens from tick to tick, and the holds that were seen |
//! | `words.rs` | an observation in words |
//! | `lines.rs` | plain lines |
//! | `jsonl.rs` | one JSON object a line |
//! | `view.rs` | a view that is drawn in place on a terminal |

mod events;
mod jsonl;
mod lines;
mod view;
mod words;

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

use palpate::observe::{Observation, ObserveError, Observer, ObserverOptions};
use palpate_files::description::read_material;

use self::events::{Event, HoldSeen, Holds};
use super::record::{Opened, description, one_part, tell_skipped};
use crate::arguments::{ReplaySpeed, WatchArguments, WatchFormat};
use crate::failure::{Failure, Outcome};
use crate::terminal::{note, print_with};

/// Where observations go.
trait Shown {
    /// A tick, and whether it is one of those that were asked for.
    fn tick(&mut self, out: &mut dyn Write, seen: &Observation, asked: bool) -> io::Result<()>;
    /// Something that happened.
    fn event(&mut self, out: &mut dyn Write, event: &Event) -> io::Result<()>;
    /// The holds of the log.
    fn end(&mut self, out: &mut dyn Write, holds: &[HoldSeen]) -> io::Result<()>;
}

pub(crate) fn run(arguments: &WatchArguments) -> Result<Outcome, Failure> {
    let test = description(arguments.test.as_deref(), arguments.part.as_deref())?;
    let material = match &arguments.material {
        Some(path) => Some(read_material(path).map_err(|error| {
            let hint = error.hint();
            Failure::new(error, hint)
        })?),
        None => None,
    };
    let mut observer = Observer::new(ObserverOptions {
        material: material.map(|file| file.material),
        exponent: arguments.exponent,
        exponent_deviation: arguments.exponent_deviation,
        slip_force: arguments.slip_force,
        warn_before: arguments.warn_before,
        confidence: arguments.confidence,
        ..ObserverOptions::default()
    })
    .map_err(|error| refused(arguments, &error))?;
    let opened = Opened::open(&arguments.log, test.as_ref())?;
    tell_skipped(&opened);
    let file = opened.read(one_part(&opened)?)?;
    let record = &file.record;
    // Rows that came late are in order here: a controller would have had to refuse them.
    for done in record.corrections() {
        note(&format!("done: {done}"));
    }
    if file.per_unit_area {
        note("the log holds stress: forces are those on 1 m²");
    }
    let (time, force, displacement) = (record.time(), record.force(), record.displacement());
    let on_terminal = io::stdout().is_terminal() && arguments.format == WatchFormat::Text;
    let speed = match arguments.speed {
        Some(ReplaySpeed::Times(times)) => Some(times),
        Some(ReplaySpeed::Max) => None,
        None => on_terminal.then_some(10.0),
    };
    let mut shown: Box<dyn Shown> = match arguments.format {
        WatchFormat::Jsonl => Box::new(jsonl::Jsonl),
        WatchFormat::Text if on_terminal => {
            Box::new(view::View::new(&arguments.log, time, speed, arguments.slip_force))
        }
        WatchFormat::Text => Box::new(lines::Lines::new(arguments.slip_force)),
    };
    let mut bad = None;
    print_with(|out| {
        let mut holds = Holds::default();
        let (started, mut next) = (Instant::now(), time[0]);
        for (index, (time_here, force)) in time.iter().zip(force).enumerate() {
            if let Some(speed) = speed {
                out.flush()?;
                wait(started, (time_here - time[0]) / speed);
            }
            let seen = match observer.feed(*time_here, displacement.map(|column| column[index]), *force) {
                Ok(seen) => seen,
                Err(error) => {
                    bad = Some(error);
                    return Ok(());
                }
            };
            for event in holds.follow(&seen) {
                shown.event(out, &event)?;
            }
            let asked = *time_here >= next;
            if asked {
                next += arguments.every * ((time_here - next) / arguments.every).floor() + arguments.every;
            }
            shown.tick(out, &seen, asked)?;
        }
        shown.end(out, &holds.all())
    })?;
    match bad {
        Some(error) => Err(refused(arguments, &error)),
        None => Ok(Outcome::Done),
    }
}

fn wait(started: Instant, until: f64) {
    // A log may say that it lasts for ages.
    let until = Duration::try_from_secs_f64(until).unwrap_or(Duration::MAX);
    if let Some(left) = until.checked_sub(started.elapsed()) {
        std::thread::sleep(left);
    }
}

fn refused(arguments: &WatchArguments, error: &ObserveError) -> Failure {
    let hint = error.hint();
    Failure::of_file(&arguments.log, error, (!hint.is_empty()).then(|| hint.to_owned()))
}
