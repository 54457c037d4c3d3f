//! The hold after a loading: peak, equilibrium, decay.

use super::{Conditions, ExportError, PronySeries, PronyTerm};
use crate::simulate::{Contact, LinearContact, Memory, Motion, Sampling, simulate};

/// The force of a hold F(t) = F_e + (F_0 − F_e) φ(t) after a loading at constant speed.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldCurve {
    /// F_0, the force at the start of the hold, N.
    pub peak: f64,
    /// F_e, N.
    pub equilibrium: f64,
    /// Indentation, m.
    pub indentation: f64,
    decay: Decay,
}

/// φ of a hold.
#[derive(Debug, Clone, PartialEq)]
enum Decay {
    Latency {
        exponent: f64,
        relative_rate: f64,
    },
    /// Forces at the start of the hold, N, and rates, 1/s.
    Exponentials(Vec<(f64, f64)>),
}

/// Pieces of the loading in the sum over its history, closer together towards its end.
const PIECES: u32 = 4000;

impl HoldCurve {
    /// The hold of a contact after the fastest loading of the conditions.
    ///
    /// # Errors
    /// [`ExportError::Simulate`] for a depth that the body does not have.
    pub fn of(contact: &Contact, conditions: Conditions) -> Result<Self, ExportError> {
        let duration = conditions.depth / conditions.fastest;
        let motion = Motion::new(vec![0.0, duration], vec![0.0, conditions.depth])?;
        let end = simulate(&motion, contact, &Sampling::Times(vec![duration]))?;
        let (excess, strain, u) = (end.excess_strain[0], end.equilibrium_strain[0], end.contact_displacement[0]);
        let decay = match contact {
            Contact::Latency { model, rate } => {
                let law = rate.law(model.law, excess, strain);
                Decay::Latency {
                    exponent: law.exponent(),
                    relative_rate: law.relative_rate(excess),
                }
            }
            Contact::Linear(contact) => Decay::Exponentials(exponentials(contact, duration, u)),
        };
        Ok(Self {
            peak: end.force[0],
            equilibrium: contact.specimen().equilibrium_force(u),
            indentation: u,
            decay,
        })
    }

    /// Exponent and relative rate (1/s) of the hold, of the latency law.
    #[must_use]
    pub fn latency(&self) -> Option<(f64, f64)> {
        match self.decay {
            Decay::Latency {
                exponent,
                relative_rate,
            } => Some((exponent, relative_rate)),
            Decay::Exponentials(_) => None,
        }
    }

    /// The Prony series of F(t)/F_0 up to a time (s), as [`PronySeries::of_latency`] makes it; linear laws have their own terms.
    ///
    /// # Errors
    /// As there, and [`ExportError::NoRelaxation`] where the force does not fall.
    pub fn series(&self, longest: f64, terms_per_decade: f64) -> Result<PronySeries, ExportError> {
        if !(self.peak > self.equilibrium * (1.0 + 1e-12) && self.equilibrium >= 0.0) {
            return Err(ExportError::NoRelaxation);
        }
        match &self.decay {
            Decay::Latency {
                exponent,
                relative_rate,
            } => {
                let series = PronySeries::of_latency(*exponent, *relative_rate, longest, terms_per_decade)?;
                Ok(series.above(self.equilibrium / self.peak))
            }
            Decay::Exponentials(terms) => {
                let term = |(force, rate): &(f64, f64)| PronyTerm {
                    share: force / self.peak,
                    time_constant: 1.0 / rate,
                };
                Ok(PronySeries::of_terms(terms.iter().map(term).collect()))
            }
        }
    }
}

/// Force (N) and rate (1/s) of each term of a linear law after a loading of a duration (s) to `u` (m):
/// g ∫ exp(−λ (T − s)) dy(s), with y the equilibrium strain, times the stiffness, or the equilibrium force.
fn exponentials(contact: &LinearContact, duration: f64, u: f64) -> Vec<(f64, f64)> {
    let body = &contact.specimen;
    let rest = body.equilibrium_force(u);
    let share = |at: f64| match contact.memory {
        Memory::Strain => at,
        Memory::Force => body.equilibrium_force(at * u) / rest,
    };
    let place = |piece: u32| 1.0 - (1.0 - f64::from(piece) / f64::from(PIECES)).powi(3);
    let term = |rate: f64| {
        let piece = |index: u32| {
            let (from, to) = (place(index), place(index + 1));
            let age = duration * (1.0 - 0.5 * (from + to));
            (share(to) - share(from)) * (-rate * age).exp()
        };
        (0..PIECES).map(piece).sum::<f64>()
    };
    contact
        .law
        .terms()
        .iter()
        .map(|each| (rest * each.overshoot * term(each.rate), each.rate))
        .collect()
}
