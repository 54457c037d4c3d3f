//! `palpate watch`: a recorded log replayed as if live.
//!
//! | file | what |
//! |---|---|
//! | `words.rs` | an observation in words |
//! | `lines.rs` | plain lines |
//! | `jsonl.rs` | one JSON object a line |
//! | `view.rs` | a view that is drawn in place on a terminal |

mod jsonl;
mod lines;
mod view;
mod words;

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

use palpate::record::Correction;
use palpate::watch::Unwatched;
use palpate_files::description::read_material;
use palpate_jobs::input::OpenedFile;
use palpate_jobs::output::{check_log, keep_apart};
use palpate_jobs::{HoldObserved, JobError, ObservationLog, Observed, Verdict, zero_ns};

use crate::arguments::{WatchArguments, WatchFormat};
use crate::progress::Bars;
use crate::terminal::{note, notes, print_with};

/// Where observations go.
trait Output {
    /// A tick, with whether it is one of those that were requested, or something that happened.
    fn see(&mut self, out: &mut dyn Write, observed: &Observed) -> io::Result<()>;
    /// The holds of the log.
    fn end(&mut self, out: &mut dyn Write, holds: &[HoldObserved]) -> io::Result<()>;
}

pub(crate) fn run(arguments: &WatchArguments) -> Result<Verdict, JobError> {
    let reads = [&arguments.log].into_iter().chain(&arguments.described.test).chain(&arguments.described.then);
    let reads = reads.chain(&arguments.material);
    keep_apart(reads, &arguments.out)?;
    arguments.out.as_deref().map_or(Ok(()), check_log)?;
    let described = arguments.described.read()?;
    let material = arguments.material.as_deref().map(read_material).transpose()?;
    let job = arguments.job();
    let opened = OpenedFile::open(&arguments.log, &described)?;
    let log = opened.contents.input.name.clone();
    let place = log.display().to_string();
    notes(&opened.notes());
    let measured = opened.measurement(opened.only()?, &mut Bars::default())?;
    notes(&measured.notes);
    let record = &measured.record;
    // Rows that came late are in order here: a controller would have had to refuse them.
    for done in record.corrections() {
        note(&format!("done: {done}"));
    }
    if record.corrections().contains(&Correction::StressAsForce) {
        note("the log holds stress: forces are those on 1 m²");
    }
    if material.is_none() && job.exponent_standard_error == 0.0 {
        note(&format!(
            "n = {} is assumed exact: the equilibrium and the time to slip depend on it; state n with --exponent and its error with --exponent-standard-error, or a --material",
            job.exponent
        ));
    }
    let on_terminal = io::stdout().is_terminal() && arguments.format == WatchFormat::Text;
    let speed = arguments.speed.or(on_terminal.then_some(10.0)).filter(|times| times.is_finite());
    let mut shown: Box<dyn Output> = match arguments.format {
        WatchFormat::Jsonl => Box::new(jsonl::Jsonl),
        WatchFormat::Text if on_terminal => Box::new(view::View::new(&log, record.time(), speed, arguments.slip_force)),
        WatchFormat::Text => Box::new(lines::Lines {
            slip_force: arguments.slip_force,
        }),
    };
    let zero = zero_ns(&opened.contents, opened.only()?);
    let mut logged = arguments.out.as_deref().map(|path| ObservationLog::open(path, record, zero)).transpose()?;
    let (mut outcome, mut unlogged) = (None, Ok(()));
    print_with(|out| {
        let (started, mut written) = (Instant::now(), Ok(()));
        let made = job.run((record, &place), material, &mut Unwatched, |observed| {
            if let Some(log) = &mut logged {
                unlogged = log.see(&observed);
            }
            // The log is completed where nobody reads the lines any more.
            if written.is_ok() {
                written = match &observed {
                    Observed::Next(time) => {
                        let pause = |speed| out.flush().map(|()| wait(started, (time - record.time()[0]) / speed));
                        speed.map_or(Ok(()), pause)
                    }
                    observed => shown.see(out, observed),
                };
            }
            unlogged.is_ok() && (written.is_ok() || arguments.out.is_some())
        });
        let ended = written.and_then(|()| match (&made, &unlogged) {
            (Ok(holds), Ok(())) => shown.end(out, &holds.result),
            _ => Ok(()),
        });
        outcome = Some(made);
        ended
    })?;
    unlogged?;
    let Some(holds) = outcome.transpose()? else {
        return Ok(Verdict::Positive);
    };
    logged.map_or(Ok(()), ObservationLog::commit)?;
    Ok(holds.verdict)
}

fn wait(started: Instant, until: f64) {
    // A log may say that it lasts for ages.
    let until = Duration::try_from_secs_f64(until).unwrap_or(Duration::MAX);
    if let Some(left) = until.checked_sub(started.elapsed()) {
        std::thread::sleep(left);
    }
}
