//! A small view that is drawn in place on a terminal.

use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use anstyle::{AnsiColor, Style};
use palpate::observe::{Observation, Slip};
use palpate_jobs::{Event, HoldObserved, Observed};
use palpate_report::number::significant;
use palpate_report::sparkline::sparkline;

use super::Output;
use super::lines::{reported, scaled, summary, warning};
use super::words::{slip, state, uncertain};

/// Time between two pictures.
const FRAME: Duration = Duration::from_millis(80);
/// Characters of the curve of the force.
const WIDTH: usize = 60;
/// The last things that happened which stay in view.
const LAST: usize = 3;

pub(super) struct View {
    name: String,
    duration: (f64, f64),
    speed: Option<f64>,
    slip_force: Option<f64>,
    /// Means of the force over shares of the log, as they come.
    curve: (Vec<f64>, Vec<f64>, usize),
    happened: Vec<String>,
    drawn: usize,
    next: Instant,
    last: Option<Observation>,
}

impl View {
    pub(super) fn new(path: &Path, time: &[f64], speed: Option<f64>, slip_force: Option<f64>) -> Self {
        let (first, last) = (time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(0.0));
        Self {
            name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            duration: (first, last),
            speed,
            slip_force,
            curve: (Vec::new(), Vec::new(), 0),
            happened: Vec::new(),
            drawn: 0,
            next: Instant::now(),
            last: None,
        }
    }

    fn remember(&mut self, observed: &Observation) {
        let share = (observed.time - self.duration.0) / (self.duration.1 - self.duration.0).max(f64::MIN_POSITIVE);
        let place = (share * WIDTH as f64) as usize;
        let (times, forces, last) = &mut self.curve;
        if times.is_empty() || place > *last {
            times.push(observed.time);
            forces.push(observed.force);
            *last = place;
        }
        self.last = Some(*observed);
    }

    fn note(&mut self, event: &Event) {
        let (time, what) = reported(event);
        if self.happened.len() == LAST {
            self.happened.remove(0);
        }
        self.happened.push(format!("{time:.2} s  {what}"));
    }

    fn draw(&mut self, out: &mut dyn Write, observed: &Observation) -> io::Result<()> {
        let (first, last) = self.duration;
        let speed = self.speed.map_or("as fast as it goes".to_owned(), |speed| format!("×{}", significant(speed, 3)));
        let share = (observed.time - first) / (last - first).max(f64::MIN_POSITIVE);
        let filled = ((share * WIDTH as f64) as usize).clamp(1, WIDTH);
        let mut rows = vec![
            format!("{}   {:.1} s of {:.1} s, {speed}", self.name, observed.time - first, last - first),
            format!(
                "force        {:<WIDTH$}  {} N",
                sparkline(&self.curve.0, &self.curve.1, filled),
                significant(observed.force, 3)
            ),
            format!("phase        {}", state(observed)),
        ];
        let known = |number: Option<palpate::fit::Estimate>, unit| {
            number.map_or("not known yet".to_owned(), |number| uncertain(number, unit))
        };
        match observed.creep_rate {
            Some(creep) => rows.push(format!("creeps at    {}", uncertain(scaled(creep), "µm/s"))),
            None if observed.held.is_some() => {
                rows.push(format!("equilibrium  {}", known(observed.equilibrium_force, "N")));
            }
            None => rows.push("equilibrium  –".to_owned()),
        }
        if let Some(strain) = observed.excess_strain {
            rows.push(format!("excess       {} of strain", uncertain(strain, "")));
        }
        if let Some(force) = self.slip_force {
            let words = slip(observed).unwrap_or_default();
            rows.push(format!("slip         at {} N: {words}", significant(force, 3)));
        }
        let color = match observed.slip {
            Slip::None => None,
            Slip::Soon => Some(AnsiColor::Yellow),
            Slip::Slipping => Some(AnsiColor::Red),
        };
        let style = Style::new().bold().fg_color(color.map(Into::into));
        rows.push(if observed.slip == Slip::None {
            String::new()
        } else {
            format!("{style}{}{style:#}", warning(observed))
        });
        rows.extend(self.happened.iter().map(|what| format!("  {what}")));
        if self.drawn > 0 {
            write!(out, "\x1b[{}A\x1b[J", self.drawn)?;
        }
        self.drawn = rows.len();
        for row in &rows {
            writeln!(out, "{row}")?;
        }
        out.flush()
    }
}

impl Output for View {
    fn see(&mut self, out: &mut dyn Write, observed: &Observed) -> io::Result<()> {
        let observed = match observed {
            Observed::Tick(observed, _) => observed,
            Observed::Event(event) => {
                self.note(event);
                return Ok(());
            }
            Observed::Next(_) => return Ok(()),
        };
        self.remember(observed);
        if Instant::now() < self.next {
            return Ok(());
        }
        self.next = Instant::now() + FRAME;
        self.draw(out, observed)
    }

    fn end(&mut self, out: &mut dyn Write, holds: &[HoldObserved]) -> io::Result<()> {
        if let Some(observed) = self.last {
            self.draw(out, &observed)?;
        }
        write!(out, "\n{}", summary(holds, self.slip_force))
    }
}
