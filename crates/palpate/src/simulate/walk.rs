//! Goes through a motion piece by piece and keeps track of the contact.

use serde::{Deserialize, Serialize};

use super::{ContactModel, Drive, ForceHistory, Motion, Separation, SimulateError, Work};
use crate::contact::{Body, Element, Forced, FreeSurface, Ramps, Specimen, Stopped};

/// A contact that was lost or regained.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactEvent {
    /// Lost or regained.
    pub kind: ContactEventKind,
    /// When, s.
    pub time: f64,
    /// Displacement of the surface (and of one contact's share of the jaw) at that moment, m.
    pub contact_displacement: f64,
}

/// What happened to the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactEventKind {
    /// The jaw left the body.
    Lost,
    /// The jaw met the body again.
    Regained,
}

/// A stretch of time over which the jaw moves at constant speed, or its force changes at a constant rate, and the contact does not change
/// its state.
pub(super) struct Stretch {
    pub(super) start: f64,
    pub(super) end: f64,
    /// Share of one contact at `start`, m.
    pub(super) contact_from: f64,
    /// Speed of one contact's share, m/s; of a force, at the start.
    pub(super) contact_speed: f64,
    pub(super) state: StretchState,
}

pub(super) enum StretchState {
    Touching(Element),
    Forced(Forced),
    Free { surface: FreeSurface, since: f64 },
}

impl Stretch {
    /// One contact's share of the jaw's travel at `time`, m.
    pub(super) fn jaw_at(&self, time: f64) -> f64 {
        if let StretchState::Forced(forced) = &self.state {
            return forced.at(time - self.start).displacement;
        }
        if self.contact_speed == 0.0 {
            return self.contact_from;
        }
        self.contact_from + self.contact_speed * (time - self.start)
    }
}

/// The state carried from one stretch to the next.
enum Contact {
    Touching { excess: f64 },
    Free { surface: FreeSurface, since: f64 },
}

/// Walks through what drives the contact, handing every stretch to `visit` in order, and returns the events and the work.
pub(super) fn walk(
    drive: Drive<'_>,
    model: &ContactModel,
    visit: impl FnMut(&Stretch) -> Result<(), SimulateError>,
) -> Result<(Vec<ContactEvent>, Work), SimulateError> {
    let mut walker = Walker::new(model, visit);
    match drive {
        Drive::Motion(motion) => walker.travel(motion)?,
        Drive::Force(history) => walker.press(history)?,
        Drive::Program(program) => {
            walker.run(program)?;
        }
    }
    walker.work.events = walker.events.len() as u64;
    Ok((walker.events, walker.work))
}

/// Goes from one stretch to the next.
pub(super) struct Walker<'a, V> {
    pub(super) model: &'a ContactModel,
    visit: V,
    contact: Contact,
    ramps: Ramps,
    events: Vec<ContactEvent>,
    work: Work,
}

impl<'a, V: FnMut(&Stretch) -> Result<(), SimulateError>> Walker<'a, V> {
    pub(super) fn new(model: &'a ContactModel, visit: V) -> Self {
        Self {
            model,
            visit,
            contact: Contact::Touching { excess: 0.0 },
            ramps: Ramps::default(),
            events: Vec::new(),
            work: Work::default(),
        }
    }

    fn travel(&mut self, motion: &Motion) -> Result<(), SimulateError> {
        check_displacements(motion, &self.model.specimen, self.model.separation)?;
        let share = |displacement: f64| self.model.specimen.contact_displacement(displacement);
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
        let speed = (to - from) / (end - begin);
        let mut start = begin;
        while start < end {
            let mut stretch = Stretch {
                start,
                end,
                contact_from: if start == begin { from } else { from + speed * (start - begin) },
                contact_speed: speed,
                state: match self.contact {
                    Contact::Touching { excess } => {
                        let drive = self.model.layers.drive(speed, self.model.specimen.depth());
                        let element =
                            Element::solve(self.model.law, excess, drive, end - start, &mut self.ramps, &mut self.work);
                        StretchState::Touching(element)
                    }
                    Contact::Free { surface, since } => StretchState::Free { surface, since },
                },
            };
            let mut event = next_event(&stretch, self.model);
            if let Some(event) = event {
                stretch.end = event.time;
            }
            let mut reached = target.and_then(|target| reaching(&stretch, target, self.model));
            // A jaw that goes back until no force is left stays in touch: that is where it would leave.
            let lost =
                event.filter(|event| event.kind == ContactEventKind::Lost && target.is_some_and(|force| force <= 0.0));
            if let Some(lost) = lost {
                reached = Some(lost.time);
            }
            if let Some(time) = reached {
                (stretch.end, event) = (time, None);
            }
            if stretch.end > stretch.start {
                (self.visit)(&stretch)?;
            }
            self.contact = after(&stretch, event, self.model, &mut self.work)?;
            if let Some(lost) = lost {
                let excess = -self.model.specimen.equilibrium_strain(lost.contact_displacement);
                self.contact = Contact::Touching { excess };
            }
            start = stretch.end;
            self.events.extend(event);
            if reached.is_some() {
                return Ok(reached);
            }
        }
        Ok(None)
    }

    /// Walks through a force history. The jaw keeps in touch: at no force it follows the surface.
    fn press(&mut self, history: &ForceHistory) -> Result<(), SimulateError> {
        let mut behind = 0.0;
        for (&time, &force) in history.times().iter().zip(history.forces()) {
            check_force(time, force, self.model)?;
        }
        for (times, forces) in history.times().windows(2).zip(history.forces().windows(2)) {
            if times[1] > times[0] {
                (_, behind) = self.force((times[0], times[1]), (forces[0], forces[1]), behind)?;
            }
        }
        Ok(())
    }

    /// Walks along a straight piece of force, the node behind the contact layer at `behind` (m); returns the contact displacement and
    /// that node's at the end.
    pub(super) fn force(
        &mut self,
        (start, end): (f64, f64),
        (from, to): (f64, f64),
        behind: f64,
    ) -> Result<(f64, f64), SimulateError> {
        let (model, duration) = (self.model, end - start);
        let body = Body {
            specimen: model.specimen.clone(),
            law: model.law,
            layers: model.layers,
            bonded: model.separation == Separation::Bonded,
        };
        let forced =
            Forced::solve(body, (from, to), behind, duration, &mut self.work).map_err(|stopped| match stopped {
                Stopped::TooMuch { elapsed } => SimulateError::Force {
                    time: start + elapsed,
                    force: from + (to - from) * (elapsed / duration),
                },
                Stopped::TooStiff { elapsed } => SimulateError::TooStiff { time: start + elapsed },
            })?;
        let (first, last) = (forced.at(0.0), forced.at(duration));
        let behind = forced.behind_at(duration);
        if !(behind.is_finite() && last.displacement.is_finite()) {
            return Err(SimulateError::OutOfRange { time: end });
        }
        self.contact = Contact::Touching { excess: last.excess };
        (self.visit)(&Stretch {
            start,
            end,
            contact_from: first.displacement,
            contact_speed: first.speed,
            state: StretchState::Forced(forced),
        })?;
        Ok((last.displacement, behind))
    }

    /// Excess strain of the contact layer; `None` while the jaw is off.
    pub(super) fn excess(&self) -> Option<f64> {
        match self.contact {
            Contact::Touching { excess } => Some(excess),
            Contact::Free { .. } => None,
        }
    }
}

/// Checks that a force can be asked for at all.
pub(super) fn check_force(time: f64, force: f64, model: &ContactModel) -> Result<(), SimulateError> {
    let bonded = model.separation == Separation::Bonded;
    if force < 0.0 && !(bonded && model.specimen.has_constant_section()) {
        return Err(SimulateError::Tension { time, force, bonded });
    }
    Ok(())
}

/// Checks that the body can take every displacement of a motion.
pub(crate) fn check_displacements(
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

/// When the force reaches a target in a stretch, from below if the jaw approaches, from above if it retreats.
fn reaching(stretch: &Stretch, target: f64, model: &ContactModel) -> Option<f64> {
    let (specimen, approaches) = (&model.specimen, stretch.contact_speed > 0.0);
    // Positive before the target is reached.
    let missing = |elapsed: f64| {
        let force = match &stretch.state {
            StretchState::Touching(element) => {
                let u = stretch.jaw_at(stretch.start + elapsed);
                specimen.force(element.excess_at(elapsed) + specimen.equilibrium_strain(u), u)
            }
            StretchState::Forced(forced) => forced.force_at(elapsed),
            StretchState::Free { .. } => 0.0,
        };
        if approaches { target - force } else { force - target }
    };
    if missing(0.0) <= 0.0 {
        return Some(stretch.start);
    }
    let StretchState::Touching(element) = &stretch.state else {
        return None;
    };
    let duration = stretch.end - stretch.start;
    let mut before = 0.0;
    // Between two ends of steps the force bends a little; a step of a long ramp is cut once more.
    for end in element.step_ends().filter(|end| *end < duration).chain([duration]) {
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
fn after(
    stretch: &Stretch,
    event: Option<ContactEvent>,
    model: &ContactModel,
    work: &mut Work,
) -> Result<Contact, SimulateError> {
    let depth = model.specimen.depth();
    let out_of_range = SimulateError::OutOfRange { time: stretch.end };
    Ok(match (&stretch.state, event) {
        (StretchState::Touching(element), None) => {
            let excess = element.excess_at(stretch.end - stretch.start);
            if !excess.is_finite() {
                return Err(out_of_range);
            }
            Contact::Touching { excess }
        }
        (StretchState::Touching(_), Some(event)) => {
            work.closed_forms += 1;
            let dent = event.contact_displacement;
            Contact::Free {
                surface: FreeSurface::new(model.law, depth, model.layers.count(), dent).ok_or(out_of_range)?,
                since: event.time,
            }
        }
        (StretchState::Free { surface, since }, None) => Contact::Free {
            surface: *surface,
            since: *since,
        },
        (StretchState::Forced(forced), _) => Contact::Touching {
            excess: forced.at(stretch.end - stretch.start).excess,
        },
        // The surface is stress-free when the jaw arrives: ε₁ = 0.
        (StretchState::Free { .. }, Some(event)) => Contact::Touching {
            excess: -event.contact_displacement / depth,
        },
    })
}

/// The event that ends a stretch early, if there is one.
fn next_event(stretch: &Stretch, model: &ContactModel) -> Option<ContactEvent> {
    if model.separation == Separation::Bonded {
        return None;
    }
    match &stretch.state {
        StretchState::Touching(element) => loss(stretch, element, model),
        StretchState::Free { surface, since } => regain(stretch, surface, *since, model),
        StretchState::Forced(_) => None,
    }
}

/// When the strain of the contact layer reaches zero.
///
/// Only a retreating jaw can lose the contact, and there the strain is either falling or rises once and then falls
/// (its second derivative has one sign), so that a change of sign shows at the ends of the integration steps.
fn loss(stretch: &Stretch, element: &Element, model: &ContactModel) -> Option<ContactEvent> {
    if stretch.contact_speed >= 0.0 {
        return None;
    }
    let strain = |elapsed: f64| {
        let jaw = stretch.jaw_at(stretch.start + elapsed);
        element.excess_at(elapsed) + model.specimen.equilibrium_strain(jaw)
    };
    let duration = stretch.end - stretch.start;
    let mut touching = 0.0;
    for elapsed in element.step_ends().chain([duration]) {
        if elapsed <= duration && strain(elapsed) < 0.0 {
            let elapsed = if strain(touching) <= 0.0 { touching } else { crossing(touching, elapsed, strain) };
            let time = stretch.start + elapsed;
            return Some(ContactEvent {
                kind: ContactEventKind::Lost,
                time,
                contact_displacement: stretch.jaw_at(time),
            });
        }
        touching = elapsed;
    }
    None
}

/// When the jaw meets the recovering surface.
fn regain(stretch: &Stretch, surface: &FreeSurface, since: f64, model: &ContactModel) -> Option<ContactEvent> {
    let lead = |time: f64| stretch.jaw_at(time) - surface.displacement_at(time - since);
    let mut end = stretch.end;
    if stretch.contact_speed < 0.0 {
        // The surface slows down as it recovers, so the jaw's lead rises while the surface is the faster one
        // and falls afterwards: only that first part can hold the meeting.
        let depth = model.specimen.depth();
        let thickness = model.layers.thickness(depth);
        let surface_speed = |time: f64| {
            let strain = surface.displacement_at(time - since) / depth;
            thickness * model.law.rate(strain)
        };
        let faster = |time: f64| stretch.contact_speed - surface_speed(time);
        if faster(stretch.start) <= 0.0 {
            return None;
        }
        if faster(end) < 0.0 {
            end = crossing(stretch.start, end, faster);
        }
    }
    if lead(end) < 0.0 || (lead(end) == 0.0 && stretch.contact_speed < 0.0) {
        return None;
    }
    let time = if lead(stretch.start) >= 0.0 {
        stretch.start
    } else {
        crossing(stretch.start, end, |time| -lead(time))
    };
    Some(ContactEvent {
        kind: ContactEventKind::Regained,
        time,
        contact_displacement: stretch.jaw_at(time),
    })
}

/// Where a function that is positive at `positive` and negative at `negative` changes sign, by bisection to the last bit.
pub(super) fn crossing(mut positive: f64, mut negative: f64, f: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = 0.5 * (positive + negative);
        if middle <= positive.min(negative) || middle >= positive.max(negative) {
            return negative;
        }
        if f(middle) > 0.0 {
            positive = middle;
        } else {
            negative = middle;
        }
    }
}
