//! A linear contact layer through a motion.

use super::law::LinearLaw;
use super::recovery::Recovery;
use crate::contact::Specimen;
use crate::simulate::course::Course;
use crate::simulate::trajectory::sample_times;
use crate::simulate::walk::{check_displacements, crossing};
use crate::simulate::{ContactEvent, ContactEventKind, Motion, Sampling, Separation, SimulateError, Trajectory};

/// A soft body whose contact layer relaxes by a linear law.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearContact {
    /// Shape and modulus, the relaxed one.
    pub specimen: Specimen,
    /// The law.
    pub law: LinearLaw,
    /// Whether the jaw can pull.
    pub separation: Separation,
}

/// Simulates a linear contact under a motion of the jaw: as [`simulate`](crate::simulate::simulate()) does for the latency law, exact up to
/// rounding.
///
/// ```
/// use palpate::contact::{Shape, Sides, Specimen};
/// use palpate::simulate::{LinearContact, LinearLaw, Motion, Sampling, Separation, simulate_linear};
///
/// let block = Shape::Prism { area: 1e-3, length: 0.04 };
/// let contact = LinearContact {
///     specimen: Specimen::new(block, 1e5, Sides::One)?,
///     law: LinearLaw::standard(3.0, 2.0)?,
///     separation: Separation::Unilateral,
/// };
/// // 4 mm in 1 s, a strain of 0.1: ε = 0.1 + 3 · 0.1/1 s · 2 s · (1 − exp(−1/2)) right after
/// let squeeze = Motion::new(vec![0.0, 1.0, 11.0], vec![0.0, 0.004, 0.004])?;
/// let result = simulate_linear(&squeeze, &contact, &Sampling::Times(vec![1.0, 11.0]))?;
/// let excess = 0.6 * (1.0 - (-0.5f64).exp());
/// assert!((result.force[0] - 100.0 * (0.1 + excess)).abs() < 1e-10); // N
/// assert!((result.force[1] - 100.0 * (0.1 + excess * (-5.0f64).exp())).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SimulateError`] if the motion goes where the specimen cannot, or the sampling does not fit it.
pub fn simulate_linear(
    motion: &Motion,
    contact: &LinearContact,
    sampling: &Sampling,
) -> Result<Trajectory, SimulateError> {
    check_displacements(motion, &contact.specimen, contact.separation)?;
    let course = Course::of_motion(motion);
    let mut result = Trajectory::with_times(sample_times(&course, sampling)?);
    let mut state = State::Touching(vec![0.0; contact.law.terms().len()]);
    let knots = motion.times().windows(2).zip(motion.displacements().windows(2));
    for (times, displacements) in knots {
        let end = times[1];
        let depth = contact.specimen.depth();
        let strain = |displacement: f64| contact.specimen.contact_displacement(displacement) / depth;
        let (from, to) = (strain(displacements[0]), strain(displacements[1]));
        let rate = (to - from) / (end - times[0]);
        let mut start = times[0];
        loop {
            let piece = Piece {
                start,
                even: if start == times[0] { from } else { from + rate * (start - times[0]) },
                rate,
                state,
            };
            let event = piece.event(end - start, contact);
            let until = event.as_ref().map_or(end, |event| event.time);
            let is_last = until == course.end();
            let inside = |time: &f64| *time < until || is_last;
            let next = result.force.len();
            let count = result.time[next..].partition_point(inside);
            for index in next..next + count {
                piece.report(result.time[index] - start, contact, &mut result);
            }
            state = piece.after(until - start, event.as_ref(), contact);
            result.work.closed_forms += 1;
            start = until;
            result.work.events += u64::from(event.is_some());
            result.events.extend(event);
            if start >= end {
                break;
            }
        }
    }
    match result.force.iter().position(|force| !force.is_finite()) {
        Some(index) => Err(SimulateError::OutOfRange {
            time: result.time[index],
        }),
        None => Ok(result),
    }
}

/// The contact from piece to piece.
#[derive(Debug, Clone)]
enum State {
    /// Excess strains x_k.
    Touching(Vec<f64>),
    /// The surface on its own since a time (s).
    Free { recovery: Recovery, since: f64 },
}

/// A piece of motion at constant speed over which the contact does not change its state.
struct Piece {
    start: f64,
    /// Equilibrium strain that the jaw asks for at the start, and its rate (1/s).
    even: f64,
    rate: f64,
    state: State,
}

impl Piece {
    /// Equilibrium strain that the jaw asks for.
    fn jaw(&self, elapsed: f64) -> f64 {
        if self.rate == 0.0 { self.even } else { self.even + self.rate * elapsed }
    }

    /// Excess strains in contact: x_k exp(−λ_k t) + g_k ε̇ (1 − exp(−λ_k t))/λ_k.
    fn excess(&self, before: &[f64], elapsed: f64, law: &LinearLaw) -> Vec<f64> {
        let each = |(x, term): (&f64, &super::LinearTerm)| {
            let over = (-term.rate * elapsed).exp_m1();
            x * (1.0 + over) - term.overshoot * self.rate * over / term.rate
        };
        before.iter().zip(law.terms()).map(each).collect()
    }

    fn report(&self, elapsed: f64, contact: &LinearContact, result: &mut Trajectory) {
        let (specimen, depth) = (&contact.specimen, contact.specimen.depth());
        let jaw = self.jaw(elapsed);
        let (even, excess, rate) = match &self.state {
            State::Touching(before) => {
                let excess = self.excess(before, elapsed, &contact.law);
                let relaxing: f64 = excess.iter().zip(contact.law.terms()).map(|(x, term)| term.rate * x).sum();
                (jaw, excess.iter().sum::<f64>(), self.rate * (1.0 + contact.law.overshoot()) - relaxing)
            }
            State::Free { recovery, since } => {
                let even = recovery.equilibrium_strain(self.start + elapsed - since);
                (even, -even, 0.0)
            }
        };
        let (u, strain) = (even * depth, even + excess);
        let touches = matches!(self.state, State::Touching(_));
        result.displacement.push(jaw * depth / specimen.contact_displacement(1.0));
        result.contact_displacement.push(u);
        result.force.push(if touches { specimen.force(strain, u) } else { 0.0 });
        result.equilibrium_strain.push(even);
        result.excess_strain.push(excess);
        result.strain.push(if touches { strain } else { 0.0 });
        result.strain_rate.push(rate);
    }

    /// Above zero as long as the contact is as it is: the strain of the layer, or how far the jaw is off.
    fn margin(&self, elapsed: f64, contact: &LinearContact) -> f64 {
        match &self.state {
            State::Touching(before) => {
                self.jaw(elapsed) + self.excess(before, elapsed, &contact.law).iter().sum::<f64>()
            }
            State::Free { recovery, since } => {
                recovery.equilibrium_strain(self.start + elapsed - since) - self.jaw(elapsed)
            }
        }
    }

    /// What ends the piece early, if anything does within `duration` (s).
    ///
    /// A sum of exponentials may change its sign more than once; it is looked at on a grid finer than each of them.
    fn event(&self, duration: f64, contact: &LinearContact) -> Option<ContactEvent> {
        if contact.separation == Separation::Bonded {
            return None;
        }
        let margin = |elapsed: f64| self.margin(elapsed, contact);
        let touches = matches!(self.state, State::Touching(_));
        // Right where contact changed it is zero to rounding: what counts is which way it goes.
        let slack = 4.0 * f64::EPSILON * (self.even.abs() + self.jaw(duration).abs());
        let mut before = 0.0;
        for elapsed in looks(contact.law.terms().last().map_or(1.0, |term| term.rate), duration) {
            let here = margin(elapsed);
            if here < -slack || (here < 0.0 && elapsed == duration) {
                let at = if margin(before) > 0.0 { crossing(before, elapsed, margin) } else { before };
                let time = self.start + at;
                // An event at the very start of the piece would repeat itself.
                if time > self.start || here < -slack {
                    return Some(ContactEvent {
                        kind: if touches { ContactEventKind::Lost } else { ContactEventKind::Regained },
                        time,
                        contact_displacement: self.jaw(at) * contact.specimen.depth(),
                    });
                }
            }
            before = elapsed;
        }
        None
    }

    fn after(self, elapsed: f64, event: Option<&ContactEvent>, contact: &LinearContact) -> State {
        match (&self.state, event) {
            (State::Touching(before), None) => State::Touching(self.excess(before, elapsed, &contact.law)),
            (State::Touching(before), Some(event)) => State::Free {
                recovery: Recovery::new(&contact.law, &self.excess(before, elapsed, &contact.law)),
                since: event.time,
            },
            (State::Free { .. }, None) => self.state,
            (State::Free { recovery, since }, Some(event)) => State::Touching(recovery.excess(event.time - since)),
        }
    }
}

/// Times at which a piece is looked at: ever further apart from the fastest rate on, and evenly.
fn looks(fastest: f64, duration: f64) -> impl Iterator<Item = f64> {
    const EVEN: i32 = 64;
    let first = (0.05 / fastest).min(duration);
    let steps = ((duration / first).ln() / GROWTH.ln()).ceil() as i32;
    let mut all: Vec<f64> = (0..steps).map(|i| first * GROWTH.powi(i)).collect();
    all.extend((1..EVEN).map(|i| duration * f64::from(i) / f64::from(EVEN)));
    all.retain(|elapsed| *elapsed < duration);
    all.sort_by(f64::total_cmp);
    all.push(duration);
    all.into_iter()
}

/// Growth of the distance between looks.
const GROWTH: f64 = 1.15;
