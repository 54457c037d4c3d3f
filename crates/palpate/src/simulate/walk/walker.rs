//! Goes along straight pieces of motion and force and keeps track of the contact.

use super::stretch::{ContactEvent, ContactEventKind, Stretch, StretchState};
use crate::contact::{SimulationWork, Specimen, Stopped, UnderForce};
use crate::simulate::error::MOST_EVENTS;
use crate::simulate::layer::{InMotion, Layer, crossing};
use crate::simulate::{ForceHistory, Motion, Separation, SimulateError};

/// The state carried from one stretch to the next.
enum Contact<L: Layer> {
    Touching { excess: L::Excess },
    Free { surface: L::Surface, since: f64 },
}

/// What is shown every stretch. Called once a stretch, so that one walk serves all who look on.
pub(in crate::simulate) type Visit<'a, L> = dyn FnMut(&Stretch<L>) -> Result<(), SimulateError> + 'a;

/// Goes from one stretch to the next.
pub(super) struct Walker<'a, L: Layer> {
    pub(super) model: &'a L,
    visit: &'a mut Visit<'a, L>,
    contact: Contact<L>,
    known: L::Known,
    pub(super) events: Vec<ContactEvent>,
    pub(super) work: SimulationWork,
}

impl<'a, L: Layer> Walker<'a, L> {
    pub(super) fn new(model: &'a L, visit: &'a mut Visit<'a, L>) -> Self {
        Self {
            model,
            visit,
            contact: Contact::Touching {
                excess: model.relaxed(),
            },
            known: L::Known::default(),
            events: Vec::new(),
            work: SimulationWork::default(),
        }
    }

    pub(super) fn travel(&mut self, motion: &Motion) -> Result<(), SimulateError> {
        let specimen = self.model.specimen();
        check_displacements(motion, specimen, self.model.separation())?;
        let share = |displacement: f64| specimen.contact_displacement(displacement);
        // A jaw that begins off the body meets its surface where that has always been.
        if motion.displacements().first().is_some_and(|first| *first < 0.0)
            && !self.model.is_bonded()
            && let Some(surface) = self.model.left(&self.model.relaxed(), 0.0)
        {
            let since = motion.start();
            self.contact = Contact::Free { surface, since };
        }
        let knots = motion.times().windows(2).zip(motion.displacements().windows(2));
        for (times, displacements) in knots {
            let ends = (share(displacements[0]), share(displacements[1]));
            self.line((times[0], times[1]), ends, None)?;
        }
        Ok(())
    }

    /// Walks along a straight piece of motion of one contact's share of the jaw, or until the force reaches `target` (N) from the
    /// side on which it is; returns when that was, if it was.
    pub(super) fn line(
        &mut self,
        (begin, end): (f64, f64),
        (from, to): (f64, f64),
        target: Option<f64>,
    ) -> Result<Option<f64>, SimulateError> {
        if target.is_none() && from > 0.0 && !self.model.can_go_back_to(to) {
            return Err(SimulateError::NoArea { time: end });
        }
        let speed = (to - from) / (end - begin);
        let mut start = begin;
        let before = self.events.len();
        while start < end {
            if self.events.len() - before > MOST_EVENTS {
                return Err(SimulateError::Chatter { time: begin });
            }
            let contact_from = if start == begin { from } else { from + speed * (start - begin) };
            let mut stretch = Stretch {
                start,
                end,
                contact_from,
                contact_speed: speed,
                state: match &self.contact {
                    Contact::Touching { excess } => {
                        let line = (contact_from, speed);
                        let (known, work) = (&mut self.known, &mut self.work);
                        StretchState::Touching(self.model.moving(excess, line, end - start, known, work))
                    }
                    Contact::Free { surface, since } => StretchState::Free {
                        surface: surface.clone(),
                        since: *since,
                    },
                },
            };
            let mut event = next_event(&stretch, self.model);
            // Lost at the moment it was met, again and again: that is rounding.
            if let (Some(last), Some(now)) = (self.events.last(), event)
                && (last.kind, last.time) == (ContactEventKind::Regained, now.time)
            {
                event = None;
            }
            if let Some(event) = event {
                stretch.end = event.time;
            }
            let mut reached = target.and_then(|target| reaching(&stretch, target, self.model));
            // A jaw that goes back until no force is left stays in touch: that is where it would leave.
            let stays = target.is_some_and(|force| force <= 0.0);
            if let Some(lost) = event.filter(|event| event.kind == ContactEventKind::Lost && stays) {
                reached = Some(lost.time);
            }
            if let Some(time) = reached {
                (stretch.end, event) = (time, None);
            }
            if stretch.end > stretch.start {
                (self.visit)(&stretch)?;
            }
            self.contact = after(&stretch, event, self.model, &mut self.work)?;
            start = stretch.end;
            // First touch of a jaw that begins off the body is no return.
            let returns = |event: &ContactEvent| event.kind == ContactEventKind::Lost || !self.events.is_empty();
            let event = event.filter(returns);
            self.events.extend(event);
            if reached.is_some() {
                return Ok(reached);
            }
        }
        Ok(None)
    }

    /// Walks through a force history. The jaw keeps in touch: at no force it follows the surface.
    pub(super) fn press(&mut self, history: &ForceHistory) -> Result<(), SimulateError> {
        let mut behind = self.model.behind(&self.model.relaxed(), 0.0);
        for (&time, &force) in history.times().iter().zip(history.forces()) {
            check_force(time, force, self.model)?;
        }
        for (times, forces) in history.times().windows(2).zip(history.forces().windows(2)) {
            if times[1] > times[0] {
                (_, behind) = self.force((times[0], times[1]), (forces[0], forces[1]), &behind)?;
            }
        }
        Ok(())
    }

    /// Walks along a straight piece of force with `behind` behind the contact layer; returns the contact displacement (m) and what is
    /// behind the layer at the end.
    pub(super) fn force(
        &mut self,
        (start, end): (f64, f64),
        (from, to): (f64, f64),
        behind: &L::Behind,
    ) -> Result<(f64, L::Behind), SimulateError> {
        let duration = end - start;
        let forced = self.model.forced((from, to), behind, duration, &mut self.work);
        let forced = forced.map_err(|stopped| match stopped {
            Stopped::TooMuch { elapsed } => SimulateError::Force {
                time: start + elapsed,
                force: from + (to - from) * (elapsed / duration),
            },
            Stopped::TooStiff { elapsed } => SimulateError::TooStiff { time: start + elapsed },
        })?;
        let (first, last) = (forced.at(0.0), forced.displacement_at(duration));
        let (excess, behind) = (forced.excess_at(duration), forced.behind_at(duration));
        if !(L::is_finite(&excess) && last.is_finite()) {
            return Err(SimulateError::OutOfRange { time: end });
        }
        self.contact = Contact::Touching { excess };
        (self.visit)(&Stretch {
            start,
            end,
            contact_from: first.displacement,
            contact_speed: first.speed,
            state: StretchState::Forced(forced),
        })?;
        Ok((last, behind))
    }

    /// Excess of the contact layer; `None` while the jaw is off.
    pub(super) fn excess(&self) -> Option<&L::Excess> {
        match &self.contact {
            Contact::Touching { excess } => Some(excess),
            Contact::Free { .. } => None,
        }
    }
}

/// When the force reaches a target in a stretch, from below if the jaw approaches, from above if it retreats.
fn reaching<L: Layer>(stretch: &Stretch<L>, target: f64, model: &L) -> Option<f64> {
    let (specimen, approaches) = (model.specimen(), stretch.contact_speed > 0.0);
    // Positive before the target is reached.
    let missing = |elapsed: f64| {
        let force = match &stretch.state {
            StretchState::Touching(piece) => {
                let u = stretch.jaw_at(stretch.start + elapsed);
                specimen.force(piece.strain_at(elapsed) + specimen.equilibrium_strain(u), u)
            }
            StretchState::Forced(forced) => forced.force_at(elapsed),
            StretchState::Free { .. } => 0.0,
        };
        if approaches { target - force } else { force - target }
    };
    if missing(0.0) <= 0.0 {
        return Some(stretch.start);
    }
    let StretchState::Touching(piece) = &stretch.state else {
        return None;
    };
    let duration = stretch.end - stretch.start;
    let mut before = 0.0;
    // Between two ends of steps the force bends a little; a step of a long ramp is cut once more.
    for end in piece.step_ends().into_iter().filter(|end| *end < duration).chain([duration]) {
        for part in 1..=PARTS {
            let elapsed = before + (end - before) * f64::from(part) / f64::from(PARTS);
            if missing(elapsed) <= 0.0 {
                let from = before + (end - before) * f64::from(part - 1) / f64::from(PARTS);
                return Some(stretch.start + crossing(from, elapsed, missing));
            }
        }
        before = end;
    }
    None
}

/// Parts in which a step is looked through for a target.
const PARTS: i32 = 4;

/// The contact at the end of a stretch, changed by the event that ended it.
fn after<L: Layer>(
    stretch: &Stretch<L>,
    event: Option<ContactEvent>,
    model: &L,
    work: &mut SimulationWork,
) -> Result<Contact<L>, SimulateError> {
    let out_of_range = SimulateError::OutOfRange { time: stretch.end };
    let elapsed = stretch.end - stretch.start;
    Ok(match (&stretch.state, event) {
        (StretchState::Touching(piece), None) => {
            let excess = piece.excess_at(elapsed);
            if !L::is_finite(&excess) {
                return Err(out_of_range);
            }
            Contact::Touching { excess }
        }
        (StretchState::Touching(piece), Some(event)) => {
            work.closed_forms += 1;
            let excess = piece.excess_at(elapsed);
            Contact::Free {
                surface: model.left(&excess, event.contact_displacement).ok_or(out_of_range)?,
                since: event.time,
            }
        }
        (StretchState::Free { surface, since }, None) => Contact::Free {
            surface: surface.clone(),
            since: *since,
        },
        (StretchState::Forced(forced), _) => Contact::Touching {
            excess: forced.excess_at(elapsed),
        },
        (StretchState::Free { surface, since }, Some(event)) => Contact::Touching {
            excess: model.met(surface, event.time - since, event.contact_displacement),
        },
    })
}

/// The event that ends a stretch early, if there is one.
fn next_event<L: Layer>(stretch: &Stretch<L>, model: &L) -> Option<ContactEvent> {
    if model.is_bonded() {
        return None;
    }
    let (times, speed, jaw) = ((stretch.start, stretch.end), stretch.contact_speed, |time: f64| stretch.jaw_at(time));
    let (kind, time) = match &stretch.state {
        StretchState::Touching(piece) => (ContactEventKind::Lost, model.loss(piece, times, speed, &jaw)?),
        StretchState::Free { surface, since } => {
            (ContactEventKind::Regained, model.meeting(surface, *since, times, speed, &jaw)?)
        }
        StretchState::Forced(_) => return None,
    };
    Some(ContactEvent {
        kind,
        time,
        contact_displacement: stretch.jaw_at(time),
    })
}

/// Checks that a force can be requested at all.
pub(in crate::simulate) fn check_force(time: f64, force: f64, model: &impl Layer) -> Result<(), SimulateError> {
    let bonded = model.is_bonded();
    if force < 0.0 && !(bonded && model.specimen().has_constant_section()) {
        return Err(SimulateError::Tension { time, force, bonded });
    }
    Ok(())
}

/// Checks that the body can take every displacement of a motion.
pub(super) fn check_displacements(
    motion: &Motion,
    specimen: &Specimen,
    separation: Separation,
) -> Result<(), SimulateError> {
    let bonded = separation == Separation::Bonded;
    for (&time, &displacement) in motion.times().iter().zip(motion.displacements()) {
        specimen
            .check_contact_displacement(specimen.contact_displacement(displacement), bonded)
            .map_err(|source| SimulateError::Displacement {
                time,
                displacement,
                source,
            })?;
    }
    Ok(())
}
