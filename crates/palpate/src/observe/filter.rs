//! A calibrated body run beside the record, and corrected by it.
//!
//! The model with its best parameters is stepped with every reading of the displacement, and beside it one pair of models a direction that the
//! calibration leaves open: each column of a root of its covariance, the stiffness of this body as against the one that was calibrated, and
//! first touch. Halves of the differences of a pair are the derivatives of all that is requested by one standard deviation of its direction, so
//! that the standings z of the directions, N(0, 1) before the first reading, follow from the forces by a Kalman filter of a state that does
//! not move (recursive least squares with a prior, Kalman 1960).

use super::signal::Correlation;
use super::{Kept, Normal, ObserveError, ObserverOptions};
use crate::calibrate::Material;
use crate::contact::RateDependence;
use crate::latency::LatencyLaw;
use crate::simulate::{Contact, ContactModel, ContactState, StepError};

/// Readings closer than this (s) tell no more than one: the residuals of a model last longer.
const APART: f64 = 0.01;
/// A mean square of normalised surprises above which the body is not the one that was calibrated.
const INNOVATION_LIMIT: f64 = 6.0;
/// Standard deviations from the calibrated parameters beyond which it is another body.
const FAR: f64 = 5.0;
/// Most directions: those that leave open the most.
const MOST: usize = 16;
/// Share of a surprise in that mean.
const MEMORY: f64 = 0.02;
/// Standard deviations beyond which a surprise counts as one of so many: what a cable or a converter puts into one reading is not of the body.
const STRANGE: f64 = 4.0;
/// A way is stepped in parts until twice as many change the force by less than this share of its noise, or of itself where it has next to none.
const EXACT: (f64, f64) = (0.05, 1e-5);
/// Most parts of a way.
const PARTS: u32 = 64;

/// A model and its state.
#[derive(Debug, Clone)]
struct Member {
    /// With the law as it is where the layer stands.
    model: ContactModel,
    /// The law with its rate coefficient at first touch.
    law: LatencyLaw,
    rate: RateDependence,
    /// What is added to the displacement, m.
    offset: f64,
    state: ContactState,
}

impl Member {
    fn new(contact: Contact, offset: f64) -> Option<Self> {
        let Contact::Latency { model, rate } = contact else {
            return None;
        };
        Some(Self {
            law: model.law,
            rate,
            model,
            offset,
            state: ContactState::default(),
        })
    }

    /// Brings the jaw to `displacement` (m) within `dt` (s); the force, N.
    fn step(&mut self, dt: f64, displacement: f64) -> Result<f64, StepError> {
        let there = displacement + self.offset;
        if self.rate != RateDependence::Constant {
            let place = self.model.specimen.contact_displacement(there);
            self.model.law =
                self.rate.law(self.law, self.excess(&self.state, displacement), place / self.model.specimen.depth());
        }
        self.state.step(&self.model, dt, there)
    }

    /// Brings the jaw along a line from one displacement (m) to another within `dt` (s), in equal parts; the force, N.
    fn go(&mut self, dt: f64, (from, to): (f64, f64), parts: u32) -> f64 {
        let count = f64::from(parts);
        for part in 1..parts {
            // All displacements on the way lie between two that were taken.
            let _ = self.step(dt / count, from + (to - from) * f64::from(part) / count);
        }
        let _ = self.step(dt / count, to);
        self.state.force(&self.model)
    }

    /// Strain in excess of equilibrium; none while the jaw is off.
    fn excess(&self, state: &ContactState, displacement: f64) -> f64 {
        let specimen = &self.model.specimen;
        let place = specimen.contact_displacement(displacement + self.offset);
        let stiffness = specimen.force(1.0, place);
        if stiffness > 0.0 && state.is_touching(&self.model) {
            state.force(&self.model) / stiffness - specimen.equilibrium_strain(place)
        } else {
            0.0
        }
    }

    /// With the jaw `by` (m) beyond a displacement at which it is, before anything relaxes.
    fn placed(&self, displacement: f64, by: f64) -> Placed<'_> {
        let mut state = self.state;
        if by != 0.0 {
            // Where the body cannot be brought there it stays.
            let _ = state.step(&self.model, 0.0, displacement + by + self.offset);
        }
        Placed {
            member: self,
            state,
            displacement: displacement + by,
        }
    }
}

/// A model with its jaw at a displacement, m.
struct Placed<'a> {
    member: &'a Member,
    state: ContactState,
    displacement: f64,
}

fn force_of(placed: &Placed<'_>) -> f64 {
    placed.state.force(&placed.member.model)
}

fn excess_of(placed: &Placed<'_>) -> f64 {
    placed.member.excess(&placed.state, placed.displacement)
}

fn equilibrium_of(placed: &Placed<'_>) -> f64 {
    let specimen = &placed.member.model.specimen;
    specimen.equilibrium_force(specimen.contact_displacement(placed.displacement + placed.member.offset).max(0.0))
}

impl Placed<'_> {
    fn force_after(&self, dt: f64) -> f64 {
        let mut state = self.state;
        state.step(&self.member.model, dt, self.displacement + self.member.offset).unwrap_or(0.0)
    }
}

/// A calibrated body beside the record.
#[derive(Debug, Clone)]
pub(super) struct ModelFilter {
    best: Member,
    /// The pairs, each with how many standard deviations lie on either side.
    pairs: Vec<(Member, Member, f64)>,
    /// Their standings, and the covariance of those, row by row.
    standing: Vec<f64>,
    covariance: Vec<f64>,
    /// Room for a derivative and its product with the covariance.
    slope: Vec<f64>,
    gain: Vec<f64>,
    /// Least standard deviation of a force from the model, N: that of the calibration.
    noise: f64,
    /// Mean of squared surprises in shares of their variance.
    surprise: f64,
    correlation: Correlation,
    /// The last displacement: when (s), and what (m).
    last: Option<f64>,
    displacement: Normal,
    exponent_standard_error: f64,
    /// Degrees of freedom of the calibration.
    pub(super) freedom: f64,
}

impl ModelFilter {
    pub(super) fn new(material: &Material, options: &ObserverOptions) -> Result<Self, ObserveError> {
        let best = Member::new(material.contact().clone(), 0.0).ok_or(ObserveError::LinearMaterial)?;
        let off = |direction: &[f64], by: f64| {
            let factors: Vec<f64> = direction.iter().map(|log| (by * log).exp()).collect();
            Member::new(material.contact_off(&factors)?, 0.0)
        };
        let is_stiffness = |name: &str| name == "modulus_pa" || name.starts_with("equilibrium_force");
        let stiffer = |name: &str| if is_stiffness(name) { options.stiffness_standard_error } else { 0.0 };
        let mut directions = material.directions();
        directions.truncate(MOST - 2);
        directions.push(material.parameters().iter().map(|parameter| stiffer(&parameter.name)).collect());
        let mut pairs = Vec::new();
        for direction in &directions {
            // Closer by where a full deviation makes no body.
            let sides =
                [1.0, 0.25, 0.0625].map(|by| off(direction, by).zip(off(direction, -by)).map(|pair| (pair, by)));
            pairs.extend(sides.into_iter().flatten().next().map(|((high, low), by)| (high, low, by)));
        }
        if options.touch_standard_error > 0.0 {
            let touch = options.touch_standard_error;
            let at = |offset: f64| Member { offset, ..best.clone() };
            pairs.push((at(touch), at(-touch), 1.0));
        }
        let count = pairs.len();
        let mut covariance = vec![0.0; count * count];
        covariance.iter_mut().step_by(count + 1).for_each(|variance| *variance = 1.0);
        let exponent = material.parameters().iter().find(|parameter| parameter.name == "exponent");
        Ok(Self {
            best,
            pairs,
            standing: vec![0.0; count],
            covariance,
            slope: vec![0.0; count],
            gain: vec![0.0; count],
            noise: material.noise().max(f64::MIN_POSITIVE.sqrt()),
            surprise: 1.0,
            correlation: Correlation::default(),
            last: None,
            displacement: Normal::new(0.0, 0.0),
            exponent_standard_error: exponent.and_then(|parameter| parameter.estimate.standard_error).unwrap_or(0.0),
            freedom: material.uncertainty().map_or(f64::INFINITY, |uncertainty| uncertainty.freedom),
        })
    }

    /// Writes what readings have changed; the rest is that of [`new`](Self::new).
    pub(super) fn keep(&self, into: &mut Vec<u8>) {
        for member in self.members() {
            // The law is that of where the layer stands.
            (member.state.to_bytes(), member.model.law.rate_coefficient()).keep(into);
        }
        self.standing.iter().chain(&self.covariance).for_each(|value| value.keep(into));
        (self.surprise, (self.last, self.displacement)).keep(into);
        self.correlation.keep(into);
    }

    /// Reads it.
    pub(super) fn read(&mut self, from: &mut &[u8]) -> Option<()> {
        let pairs = self.pairs.iter_mut().flat_map(|(high, low, _)| [high, low]);
        for member in pairs.chain([&mut self.best]) {
            let (state, rate) = Kept::read(from)?;
            member.state = ContactState::from_bytes(state).ok()?;
            member.model.law = LatencyLaw::new(member.law.exponent(), rate).ok()?;
        }
        for value in self.standing.iter_mut().chain(&mut self.covariance) {
            *value = Kept::read(from)?;
        }
        (self.surprise, (self.last, self.displacement)) = Kept::read(from)?;
        self.correlation = Kept::read(from)?;
        Some(())
    }

    fn members(&self) -> impl Iterator<Item = &Member> {
        self.pairs.iter().flat_map(|(high, low, _)| [high, low]).chain([&self.best])
    }

    /// Checks that all models can be brought to a displacement.
    pub(super) fn check(&self, time: f64, displacement: f64) -> Result<(), ObserveError> {
        for member in self.members() {
            let mut state = member.state;
            if state.step(&member.model, 0.0, displacement + member.offset).is_err() {
                return Err(ObserveError::Displacement { time, displacement });
            }
        }
        Ok(())
    }

    /// Brings the models to the displacement at `time` (s) and corrects them by the force that was read; `noise` has the standard deviations
    /// of one reading of the displacement (m) and of the force (N). A force whose noise is not known yet corrects nothing.
    pub(super) fn feed(&mut self, time: f64, displacement: Normal, force: f64, noise: Option<(f64, f64)>) {
        let dt = self.last.map_or(0.0, |last| time - last);
        let way = (self.displacement.mean, displacement.mean);
        self.last = Some(time);
        self.displacement = displacement;
        let parts = self.parts(dt, way);
        let expected = self.best.go(dt, way, parts);
        for (high, low, _) in &mut self.pairs {
            high.go(dt, way, parts);
            low.go(dt, way, parts);
        }
        let Some(noise) = noise else { return };
        let of = |member: &Member| member.state.force(&member.model);
        let mut surprise = force - expected;
        for ((slope, pair), standing) in self.slope.iter_mut().zip(&self.pairs).zip(&self.standing) {
            *slope = half(pair, of);
            surprise -= *slope * standing;
        }
        if self.slope.iter().all(|slope| *slope == 0.0) {
            return;
        }
        // A mean of displacements errs for as many readings as it has: together they tell as if each had the noise of one reading.
        let by_place = self.by_place(noise.0, force_of);
        let of_reading = self.noise.max(noise.1).powi(2) + by_place * by_place;
        let mut variance = of_reading;
        for (gain, row) in self.gain.iter_mut().zip(self.covariance.chunks_exact(self.slope.len())) {
            *gain = row.iter().zip(&self.slope).map(|(entry, slope)| entry * slope).sum();
        }
        variance += self.gain.iter().zip(&self.slope).map(|(gain, slope)| gain * slope).sum::<f64>();
        let most = STRANGE * variance.sqrt();
        let surprise = surprise.clamp(-most, most);
        self.surprise += MEMORY * (surprise * surprise / variance - self.surprise);
        // What one of several readings within that time tells, or of several that share their noise.
        self.correlation.feed(surprise / variance.sqrt());
        let together = self.correlation.together();
        let share = if dt > 0.0 { (APART / dt).max(together) } else { together };
        variance += (share - 1.0) * of_reading;
        for (standing, gain) in self.standing.iter_mut().zip(&self.gain) {
            *standing += gain * surprise / variance;
        }
        let count = self.slope.len();
        for (row, gain) in self.covariance.chunks_exact_mut(count).zip(&self.gain) {
            for (entry, other) in row.iter_mut().zip(&self.gain) {
                *entry -= gain * other / variance;
            }
        }
    }

    /// How many parts of a way the best model needs: a step is of second order, and its error in a ramp is no noise.
    fn parts(&mut self, dt: f64, way: (f64, f64)) -> u32 {
        if dt <= 0.0 || way.0 == way.1 {
            return 1;
        }
        let (state, law) = (self.best.state, self.best.model.law);
        let mut after = |parts: u32| {
            let force = self.best.go(dt, way, parts);
            (self.best.state, self.best.model.law) = (state, law);
            force
        };
        let (mut parts, mut force) = (1, after(1));
        while parts < PARTS {
            let finer = after(2 * parts);
            let off = (finer - force).abs();
            if off < (EXACT.0 * self.noise).max(EXACT.1 * finer.abs()) {
                break;
            }
            (parts, force) = (2 * parts, finer);
        }
        parts
    }

    /// Exponent of the law of a hold, and what the calibration leaves open of it.
    pub(super) fn exponent(&self) -> Normal {
        Normal::new(self.best.model.law.exponent().max(1.0), self.exponent_standard_error)
    }

    /// Whether the forces are those of the calibrated body.
    pub(super) fn is_met(&self) -> bool {
        self.surprise < INNOVATION_LIMIT && self.standing.iter().all(|standing| standing.abs() < FAR)
    }

    /// What a displacement that is off by `deviation` (m) does to a number.
    fn by_place(&self, deviation: f64, of: impl Fn(&Placed<'_>) -> f64) -> f64 {
        let at = |by: f64| of(&self.best.placed(self.displacement.mean, by));
        if deviation > 0.0 { 0.5 * (at(deviation) - at(-deviation)) } else { 0.0 }
    }

    /// A number with what the calibration, the body, first touch and the last displacement leave open of it.
    fn combined(&self, of: impl Fn(&Placed<'_>) -> f64) -> Normal {
        let here = |member: &Member| of(&member.placed(self.displacement.mean, 0.0));
        let mut value = here(&self.best);
        let count = self.pairs.len();
        let mut slopes = [0.0; MOST];
        for ((slope, pair), standing) in slopes.iter_mut().zip(&self.pairs).zip(&self.standing) {
            *slope = half(pair, here);
            value += *slope * standing;
        }
        let slopes = &slopes[..count];
        let along = |row: &[f64]| row.iter().zip(slopes).map(|(entry, slope)| entry * slope).sum::<f64>();
        let rows = self.covariance.chunks_exact(count.max(1));
        let variance: f64 = rows.zip(slopes).map(|(row, slope)| slope * along(row)).sum();
        Normal::new(value, variance.max(0.0).sqrt().hypot(self.by_place(self.displacement.deviation, &of)))
    }

    /// Force that a hold here tends to, N.
    pub(super) fn equilibrium(&self) -> Normal {
        self.combined(equilibrium_of)
    }

    /// Force in excess of it, N.
    pub(super) fn excess_force(&self) -> Normal {
        self.combined(|placed| force_of(placed) - equilibrium_of(placed))
    }

    /// Strain in excess of equilibrium.
    pub(super) fn excess_strain(&self) -> Normal {
        self.combined(excess_of)
    }

    /// v|x|ⁿ⁻¹, 1/s.
    pub(super) fn relative_rate(&self) -> f64 {
        self.best.model.law.relative_rate(self.excess_strain().mean)
    }

    /// The force after `dt` (s) more with the jaw where it is, N.
    pub(super) fn force_after(&self, dt: f64) -> Normal {
        self.combined(|placed| placed.force_after(dt))
    }
}

/// Derivative by one standard deviation of a direction.
fn half((high, low, by): &(Member, Member, f64), of: impl Fn(&Member) -> f64) -> f64 {
    0.5 * (of(high) - of(low)) / by
}
