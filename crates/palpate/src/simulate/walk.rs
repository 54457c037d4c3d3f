//! Goes through a motion piece by piece and keeps track of the contact.

use serde::{Deserialize, Serialize};

use super::{ContactModel, Course, ForceHistory, Motion, Separation, SimulateError, Work};
use crate::contact::{Body, Element, Forced, FreeSurface};

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

/// Walks through a motion or a force history, handing every stretch to `visit` in order, and returns the events and the work.
pub(super) fn walk(
    course: Course<'_>,
    model: &ContactModel,
    visit: impl FnMut(&Stretch) -> Result<(), SimulateError>,
) -> Result<(Vec<ContactEvent>, Work), SimulateError> {
    match course {
        Course::Motion(motion) => travel(motion, model, visit),
        Course::Force(history) => Ok((Vec::new(), press(history, model, visit)?)),
    }
}

/// Walks through `motion`, handing every stretch to `visit` in order, and returns the events and the work.
fn travel(
    motion: &Motion,
    model: &ContactModel,
    mut visit: impl FnMut(&Stretch) -> Result<(), SimulateError>,
) -> Result<(Vec<ContactEvent>, Work), SimulateError> {
    check_displacements(motion, model)?;
    let (mut work, mut events) = (Work::default(), Vec::new());
    let mut contact = Contact::Touching { excess: 0.0 };
    let knots = motion.times().windows(2).zip(motion.displacements().windows(2));
    for (times, displacements) in knots {
        let (mut start, end) = (times[0], times[1]);
        let (from, to) = (
            model.specimen.contact_displacement(displacements[0]),
            model.specimen.contact_displacement(displacements[1]),
        );
        let speed = (to - from) / (end - start);
        while start < end {
            let mut stretch = Stretch {
                start,
                end,
                contact_from: if start == times[0] { from } else { from + speed * (start - times[0]) },
                contact_speed: speed,
                state: match contact {
                    Contact::Touching { excess } => {
                        let drive = model.layers.drive(speed, model.specimen.depth());
                        StretchState::Touching(Element::solve(model.law, excess, drive, end - start, &mut work))
                    }
                    Contact::Free { surface, since } => StretchState::Free { surface, since },
                },
            };
            let event = next_event(&stretch, model);
            if let Some(event) = event {
                stretch.end = event.time;
            }
            if stretch.end > stretch.start {
                visit(&stretch)?;
            }
            contact = after(&stretch, event, model, &mut work)?;
            start = stretch.end;
            events.extend(event);
        }
    }
    work.events = events.len() as u64;
    Ok((events, work))
}

/// Walks through a force history. The jaw keeps in touch: at no force it follows the surface.
fn press(
    history: &ForceHistory,
    model: &ContactModel,
    mut visit: impl FnMut(&Stretch) -> Result<(), SimulateError>,
) -> Result<Work, SimulateError> {
    let bonded = model.separation == Separation::Bonded;
    let pulls = bonded && model.specimen.has_constant_section();
    if let Some(index) = history.forces().iter().position(|force| *force < 0.0 && !pulls) {
        return Err(SimulateError::Tension {
            time: history.times()[index],
            force: history.forces()[index],
            bonded,
        });
    }
    let body = Body {
        specimen: model.specimen,
        law: model.law,
        layers: model.layers,
        bonded,
    };
    let (mut work, mut behind) = (Work::default(), 0.0);
    for (times, forces) in history.times().windows(2).zip(history.forces().windows(2)) {
        let (start, duration) = (times[0], times[1] - times[0]);
        if duration == 0.0 {
            continue;
        }
        let forced = Forced::solve(body, (forces[0], forces[1]), behind, duration, &mut work).map_err(|too_much| {
            let share = too_much.elapsed / duration;
            SimulateError::Force {
                time: start + too_much.elapsed,
                force: forces[0] + (forces[1] - forces[0]) * share,
            }
        })?;
        let from = forced.at(0.0);
        behind = forced.behind_at(duration);
        if !behind.is_finite() {
            return Err(SimulateError::OutOfRange { time: times[1] });
        }
        visit(&Stretch {
            start,
            end: times[1],
            contact_from: from.displacement,
            contact_speed: from.speed,
            state: StretchState::Forced(forced),
        })?;
    }
    Ok(work)
}

fn check_displacements(motion: &Motion, model: &ContactModel) -> Result<(), SimulateError> {
    let bonded = model.separation == Separation::Bonded;
    for (&time, &displacement) in motion.times().iter().zip(motion.displacements()) {
        model
            .specimen
            .check_contact_displacement(model.specimen.contact_displacement(displacement), bonded)
            .map_err(|source| SimulateError::Displacement {
                time,
                displacement,
                source,
            })?;
    }
    Ok(())
}

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
fn crossing(mut positive: f64, mut negative: f64, f: impl Fn(f64) -> f64) -> f64 {
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
