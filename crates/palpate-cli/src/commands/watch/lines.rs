//! Plain lines: one an event, one each time that was requested, and a table of holds.

use std::io::{self, Write};

use palpate::observe::{Held, Observation, Slip};
use palpate_jobs::{Event, HoldObserved, Observed};
use palpate_report::number::significant;
use palpate_report::result::word;
use palpate_report::table::{Cell, Table};

use super::Output;
use super::words::{slip, state, uncertain, with_normal_interval};

pub(super) struct Lines {
    pub(super) slip_force: Option<f64>,
}

impl Output for Lines {
    fn see(&mut self, out: &mut dyn Write, observed: &Observed) -> io::Result<()> {
        let observed = match observed {
            Observed::Tick(observed, true) => observed,
            Observed::Event(event) => return happened(out, event),
            Observed::Next(_) | Observed::Tick(_, false) => return Ok(()),
        };
        write!(out, "{:>9.3} s  {:<34}  {:>8} N", observed.time, state(observed), significant(observed.force, 4))?;
        if let Some(equilibrium) = observed.equilibrium_force {
            write!(out, "  equilibrium force {}", uncertain(equilibrium, "N"))?;
        }
        if let Some(strain) = observed.excess_strain {
            write!(out, "  excess strain {}", uncertain(strain, ""))?;
        }
        if let Some(creep) = observed.creep_rate {
            write!(out, "  creeps at {}", uncertain(scaled(creep), "µm/s"))?;
        }
        if let (Some(words), Some(_)) = (slip(observed), observed.held) {
            write!(out, "  slip: {words}")?;
        }
        writeln!(out)
    }

    fn end(&mut self, out: &mut dyn Write, holds: &[HoldObserved]) -> io::Result<()> {
        write!(out, "\n{}", summary(holds, self.slip_force))
    }
}

fn happened(out: &mut dyn Write, event: &Event) -> io::Result<()> {
    let (time, what) = reported(event);
    match event {
        Event::Ended(_, hold) => {
            writeln!(out, "{time:>9.3} s  {what} after {} s", significant(hold.until - hold.since, 4))
        }
        Event::Warned(_) => writeln!(out, "{time:>9.3} s  WARNING: {what}"),
        _ => writeln!(out, "{time:>9.3} s  {what}"),
    }
}

/// When something happened, s, and what.
pub(super) fn reported(event: &Event) -> (f64, String) {
    match event {
        Event::Began(observed) => (observed.time, format!("hold: {}", state(observed))),
        Event::Changed(observed) => (observed.time, format!("it is the {}", state(observed))),
        Event::Ended(time, _) => (*time, "end of the hold".to_owned()),
        Event::Warned(observed) => (observed.time, warning(observed)),
    }
}

/// A warning in words.
pub(super) fn warning(observed: &Observation) -> String {
    match observed.slip {
        Slip::Slipping => format!("slips, the force is {} N", significant(observed.force, 3)),
        _ => format!("slip soon: {}", slip(observed).unwrap_or_default()),
    }
}

/// A speed in µm/s.
pub(super) fn scaled(speed: palpate::fit::Estimate) -> palpate::fit::Estimate {
    palpate::fit::Estimate {
        standard_error: speed.standard_error.map(|error| 1e6 * error),
        ..palpate::fit::Estimate::fixed(1e6 * speed.value)
    }
}

/// The holds of a log.
pub(super) fn summary(holds: &[HoldObserved], slip_force: Option<f64>) -> String {
    if holds.is_empty() {
        return "The log has no hold.\n".to_owned();
    }
    let unknown = |hold: &HoldObserved| if hold.held == Held::Force { "the force was held" } else { "not determined" };
    let mut table = Table::of("holds", "Holds", holds)
        .column("Held", "held", "", |hold| Cell::text(word(hold.held)))
        .column("From", "start_s", "s", |hold| Cell::Number(hold.since, 5))
        .column("To", "end_s", "s", |hold| Cell::Number(hold.until, 5))
        .column("Force at start", "force_start_n", "N", |hold| Cell::Number(hold.forces.0, 4))
        .column("at end", "force_end_n", "N", |hold| Cell::Number(hold.forces.1, 4))
        .estimates("Equilibrium force", "equilibrium_force_n", "N", |hold| {
            let estimate = hold.equilibrium.map(|force| Cell::Estimate(with_normal_interval(force)));
            estimate.unwrap_or_else(|| Cell::missing(unknown(hold)))
        })
        .column("Creep rate", "creep_rate_m_per_s", "m/s", |hold| {
            Cell::number_or(hold.creep.map(|creep| creep.value), 3, "not held by force")
        });
    if slip_force.is_some() {
        table = table
            .column("Warned", "warned_s", "s", |hold| Cell::number_or(hold.warned, 5, "no warning"))
            .column("Slipped", "slipped_s", "s", |hold| Cell::number_or(hold.slipped, 5, "no slip"));
    }
    table.table().to_plain_text()
}
