//! Walks through a program, step by step.

use super::stretch::{Stretch, force_of};
use super::{Walker, check_force};
use crate::simulate::{ContactRef, Layer, ProgramStep, SimulateError, by_law};
use crate::watch::{Stages, Unwatched};

/// Where a step of a program ended.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub struct StepEnd {
    /// Time, s.
    pub time: f64,
    /// Displacement of the jaw, m.
    pub displacement: f64,
    /// Contact force, N.
    pub force: f64,
}

/// Where each step of a program ends, without its course: see [`simulate`](crate::simulate::simulate()).
///
/// # Errors
/// As for `simulate`.
pub fn step_ends<'a>(
    program: &[ProgramStep],
    contact: impl Into<ContactRef<'a>>,
) -> Result<Vec<StepEnd>, SimulateError> {
    step_ends_of(program, contact.into())
}

/// Without generics, so that it is compiled here, once, and not wherever it is called.
fn step_ends_of(program: &[ProgramStep], contact: ContactRef<'_>) -> Result<Vec<StepEnd>, SimulateError> {
    let mut unwatched = Unwatched;
    let mut stages = Stages::new(String::new(), &mut unwatched);
    by_law!(contact, contact => ends_of(program, contact, &mut stages))
}

pub(in crate::simulate) fn ends_of<L: Layer>(
    program: &[ProgramStep],
    model: &L,
    stages: &mut Stages<'_>,
) -> Result<Vec<StepEnd>, SimulateError> {
    let ends = Walker::new(model, &mut |_: &Stretch<L>| Ok(stages.hear()?)).run(program)?;
    if ends.last().is_none_or(|end| end.time == 0.0) {
        return Err(SimulateError::EmptyProgram);
    }
    Ok(ends)
}

impl<L: Layer> Walker<'_, L> {
    /// Walks through a program that begins at time 0 with the jaw at first touch; returns where each step ended.
    pub(super) fn run(&mut self, program: &[ProgramStep]) -> Result<Vec<StepEnd>, SimulateError> {
        let mut runner = Runner {
            model: self.model,
            walker: self,
            time: 0.0,
            jaw: 0.0,
            kept: None,
        };
        let mut ends = Vec::with_capacity(program.len());
        for (index, step) in program.iter().enumerate() {
            let number = index + 1;
            step.check().map_err(|(name, found, unit)| SimulateError::StepNumber {
                step: number,
                name,
                unit,
                found,
            })?;
            ends.push(runner.take(number, *step)?);
        }
        Ok(ends)
    }
}

/// Where the program stands; `jaw` is one contact's share.
struct Runner<'w, 'a, L: Layer> {
    walker: &'w mut Walker<'a, L>,
    model: &'a L,
    time: f64,
    jaw: f64,
    /// The force (N) that was requested last, as long as it stands: what can be computed back is off by rounding.
    kept: Option<f64>,
}

impl<L: Layer> Runner<'_, '_, L> {
    fn take(&mut self, number: usize, step: ProgramStep) -> Result<StepEnd, SimulateError> {
        match step {
            ProgramStep::Move { to, rate } => {
                self.kept = None;
                self.move_to(to, rate)?;
            }
            ProgramStep::MoveToForce { force, rate } => {
                self.move_to_force(number, force, rate)?;
                self.kept = Some(force);
            }
            ProgramStep::HoldPosition { duration } => {
                self.kept = None;
                self.line(duration, self.jaw, None).map(|_| ())?;
            }
            ProgramStep::Press { to, rate } => {
                let force = self.force();
                check_force(self.time, to, self.model)?;
                self.press(number, (to - force).abs() / rate, to)?;
                self.kept = Some(to);
            }
            ProgramStep::HoldForce { duration } => {
                let force = self.force();
                check_force(self.time, force, self.model)?;
                self.press(number, duration, force)?;
                self.kept = Some(force);
            }
        }
        Ok(StepEnd {
            time: self.time,
            displacement: self.jaw / self.model.specimen().contact_displacement(1.0),
            force: self.force(),
        })
    }

    /// Contact force as it is, N.
    fn force(&self) -> f64 {
        let now = || self.walker.excess().map_or(0.0, |excess| force_of(self.model, excess, self.jaw));
        self.kept.unwrap_or_else(now)
    }

    fn move_to(&mut self, to: f64, rate: f64) -> Result<(), SimulateError> {
        let share = self.model.specimen().contact_displacement(1.0);
        let bonded = self.model.is_bonded();
        self.model.specimen().check_contact_displacement(to * share, bonded).map_err(|source| {
            SimulateError::Displacement {
                time: self.time,
                displacement: to,
                source,
            }
        })?;
        let duration = (to * share - self.jaw).abs() / (rate * share);
        self.line(duration, to * share, None).map(|_| ())
    }

    fn move_to_force(&mut self, number: usize, force: f64, rate: f64) -> Result<(), SimulateError> {
        check_force(self.time, force, self.model)?;
        let now = self.force();
        // There already, to rounding.
        if (now - force).abs() <= 1e-12 * now.abs().max(force.abs()) && self.walker.excess().is_some() {
            return Ok(());
        }
        self.kept = None;
        let specimen = self.model.specimen();
        let depth = specimen.depth();
        // A jaw that approaches may go as deep as the body is; a strip in grips may be stretched as far as it likes.
        let strip = specimen.has_constant_section() && self.model.is_bonded();
        let farthest = match (force > now, strip) {
            (true, false) => specimen.limit().at * (1.0 - 1e-12),
            (false, false) => 0.0,
            (true, true) => self.jaw.max(0.0) + 100.0 * depth,
            (false, true) => self.jaw.min(0.0) - 100.0 * depth,
        };
        let speed = rate * specimen.contact_displacement(1.0);
        // How far the jaw will go is not known: a piece for all that it may go would be too long for a law that depends on the strain.
        let piece = self.model.farthest_piece();
        loop {
            let left = farthest - self.jaw;
            let to = if left.abs() > piece { self.jaw + piece.copysign(left) } else { farthest };
            if self.line((to - self.jaw).abs() / speed, to, Some(force))? {
                return Ok(());
            }
            if to == farthest || self.jaw != to {
                return Err(SimulateError::Unreachable {
                    step: number,
                    target: force,
                    most: self.force(),
                });
            }
        }
    }

    /// Moves straight for `duration` (s); whether the target was reached, if there is one.
    fn line(&mut self, duration: f64, to: f64, target: Option<f64>) -> Result<bool, SimulateError> {
        let (start, from, end) = (self.time, self.jaw, self.time + duration);
        // Shorter than time can tell: there already.
        if end <= start {
            return Ok(false);
        }
        if !end.is_finite() {
            return Err(SimulateError::OutOfRange { time: start });
        }
        let reached = self.walker.line((start, end), (from, to), target)?;
        self.time = reached.unwrap_or(end);
        self.jaw = reached.map_or(to, |time| from + (to - from) * ((time - start) / (end - start)));
        Ok(reached.is_some())
    }

    /// Brings the force straight to `to` (N) within `duration` (s).
    fn press(&mut self, number: usize, duration: f64, to: f64) -> Result<(), SimulateError> {
        let Some(excess) = self.walker.excess() else {
            return Err(SimulateError::NoContact {
                step: number,
                time: self.time,
            });
        };
        let end = self.time + duration;
        if end <= self.time {
            return Ok(());
        }
        if !end.is_finite() {
            return Err(SimulateError::OutOfRange { time: self.time });
        }
        let behind = self.model.behind(excess, self.jaw);
        (self.jaw, _) = self.walker.force((self.time, end), (self.force(), to), &behind)?;
        self.time = end;
        Ok(())
    }
}
