//! A linear contact layer while the jaw moves at constant speed.
//!
//! A memory of strain has a closed form, since strain goes straight. A memory of force is driven by F_e(u(t)): stages over which that is a
//! polynomial to rounding.

use super::stage::{DEGREE, GAUSS, Stage, legendre};
use crate::simulate::{InMotion, LinearContact, Memory, crossing};

/// Difference of q from its polynomial, relative to the largest q.
const TOLERANCE: f64 = 1e-13;

/// Most halvings of a piece on the way to a smooth stage: at first touch of a ball Hertz's force begins like t^1.5.
const HALVINGS: u32 = 40;

/// A straight piece of motion, from t = 0 at its start.
#[derive(Debug, Clone)]
pub(crate) struct Moving {
    contact: LinearContact,
    /// Contact displacement at the start (m) and its speed (m/s).
    from: f64,
    speed: f64,
    duration: f64,
    stages: Vec<Stage>,
    /// By how much q + Σ x_k may be off, q being a polynomial.
    unsure: f64,
}

impl Moving {
    pub(super) fn solve(contact: &LinearContact, (from, speed): (f64, f64), before: Vec<f64>, duration: f64) -> Self {
        let mut piece = Self {
            contact: contact.clone(),
            from,
            speed,
            duration,
            stages: Vec::new(),
            unsure: 0.0,
        };
        let (first, last) = (contact.value(from), contact.value(from + speed * duration));
        if speed == 0.0 || contact.memory == Memory::Strain || contact.specimen.has_constant_section() {
            let by = if speed == 0.0 { 0.0 } else { last - first };
            piece.stages.push(Stage::straight(0.0, duration, first, by, before));
        } else {
            let allowed = TOLERANCE * first.abs().max(last.abs());
            piece.unsure = (1.0 + contact.law.overshoot()) * allowed;
            piece.divide((0.0, duration), before, allowed, HALVINGS);
        }
        piece
    }

    /// Appends the stages from one time to another; returns x_k at the end.
    fn divide(&mut self, (start, end): (f64, f64), before: Vec<f64>, allowed: f64, halvings: u32) -> Vec<f64> {
        let width = end - start;
        let mut rates = [0.0; DEGREE];
        for &(node, weight) in GAUSS.iter() {
            let slope = width * self.contact.slope(self.jaw(start + width * node)) * self.speed;
            for (p, (rate, value)) in rates.iter_mut().zip(legendre(node)).enumerate() {
                *rate += (2 * p + 1) as f64 * weight * slope * value;
            }
        }
        let rest = rates[DEGREE - 1].abs() + rates[DEGREE - 2].abs();
        if rest > allowed && halvings > 0 {
            let middle = start + 0.5 * width;
            let before = self.divide((start, middle), before, allowed, halvings - 1);
            return self.divide((middle, end), before, allowed, halvings - 1);
        }
        let stage = Stage {
            start,
            width,
            from: self.contact.value(self.jaw(start)),
            rates,
            before,
        };
        let after = stage.memory(1.0, &self.contact.law);
        self.stages.push(stage);
        after
    }

    /// Contact displacement, m.
    fn jaw(&self, elapsed: f64) -> f64 {
        if self.speed == 0.0 { self.from } else { self.from + self.speed * elapsed }
    }

    /// q̇.
    fn pushed(&self, elapsed: f64) -> f64 {
        Stage::within(&self.stages, elapsed, |stage, part| {
            if stage.is_straight() {
                stage.slope(part)
            } else {
                self.contact.slope(self.jaw(elapsed)) * self.speed
            }
        })
    }

    /// Excess strain of the contact layer, and its whole strain rate (1/s).
    pub(super) fn excess_and_rate(&self, elapsed: f64) -> (f64, f64) {
        let (law, specimen) = (&self.contact.law, &self.contact.specimen);
        let memory = self.excess_at(elapsed);
        let sum: f64 = memory.iter().sum();
        let relaxing: f64 = memory.iter().zip(law.terms()).map(|(x, term)| term.rate * x).sum();
        let u = self.jaw(elapsed);
        let rate = self.pushed(elapsed) * (1.0 + law.overshoot()) - relaxing;
        match self.contact.memory {
            Memory::Strain => (sum, rate),
            Memory::Force => {
                let (stiffness, growth) = specimen.stiffness(u);
                if stiffness == 0.0 && (sum == 0.0 || !self.contact.is_bonded()) {
                    // First touch of a relaxed ball: the whole force is there at once, as a multiple of the relaxed one.
                    return (0.0, (1.0 + law.overshoot()) * self.speed / specimen.depth());
                }
                let excess = sum / stiffness;
                let strain = excess + specimen.equilibrium_strain(u);
                (excess, (rate - strain * growth * self.speed) / stiffness)
            }
        }
    }

    /// When q + Σ x_k, and with it the force, reaches zero.
    ///
    /// Sums of exponentials may do so more than once in a hold; intervals are halved until bounds of every term tell that it does not, or
    /// to the last bit.
    pub(super) fn loss(&self, (start, end): (f64, f64)) -> Option<f64> {
        let look = |time: f64| {
            let elapsed = time - start;
            Look {
                time,
                value: self.contact.value(self.jaw(elapsed)),
                slope: self.pushed(elapsed),
                memory: self.excess_at(elapsed),
            }
        };
        let below = self.first_below(&look(start), &look(end), &look)?;
        if self.unsure == 0.0 {
            return Some(below);
        }
        // It is surely lost there, and was on the way.
        Some(crossing(start, below, |time| look(time).sum()))
    }

    fn first_below(&self, a: &Look, b: &Look, look: &impl Fn(f64) -> Look) -> Option<f64> {
        if self.least(a, b) >= -(a.rounding() + self.unsure) {
            return None;
        }
        // Lost from the first on: nothing is to be halved.
        if a.sum() < -(a.rounding() + self.unsure) {
            return Some(a.time.next_up().min(b.time));
        }
        let middle = 0.5 * (a.time + b.time);
        if middle <= a.time || middle >= b.time {
            return (b.sum() < 0.0).then_some(b.time);
        }
        let middle = look(middle);
        self.first_below(a, &middle, look).or_else(|| self.first_below(&middle, b, look))
    }

    /// A lower bound of q + Σ x_k between two times: that of its terms, or that of the sum over its chord, whichever is higher. Where
    /// large terms cancel, bounds of the terms alone would be halved for ever.
    fn least(&self, a: &Look, b: &Look) -> f64 {
        self.least_of_terms(a, b).max(a.sum().min(b.sum()) - self.below_chord(a, b))
    }

    /// By how much q + Σ x_k is below its chord at most, where q̇ goes one way from a to b.
    ///
    /// A q whose slope changes by s is within s w/4 of its chord over a width w. The x_k obey ẋ_k = g_k q̇ − λ_k x_k = y_k and so
    /// ẍ_k = g_k q̈ − λ_k y_k, with y_k no larger than at a but for g_k s.
    fn below_chord(&self, a: &Look, b: &Look) -> f64 {
        let (width, change) = (b.time - a.time, (b.slope - a.slope).abs());
        let bend = |(x, term): (&f64, &super::LinearTerm)| {
            term.rate * ((term.overshoot * a.slope - term.rate * x).abs() + term.overshoot * change)
        };
        let bends: f64 = a.memory.iter().zip(self.contact.law.terms()).map(bend).sum();
        0.25 * width * change * (1.0 + self.contact.law.overshoot()) + 0.125 * width * width * bends
    }

    /// A lower bound of every term of q + Σ x_k.
    fn least_of_terms(&self, a: &Look, b: &Look) -> f64 {
        let fall = (a.value - b.value).max(0.0);
        let is_straight = self.stages.len() == 1 && self.stages[0].is_straight();
        let width = b.time - a.time;
        let each = |((a, b), term): ((&f64, &f64), &super::LinearTerm)| match is_straight {
            // An exponential and a constant: nothing lies outside its ends.
            true => a.min(*b),
            // The memory that fades, and at most all of what is taken away.
            false => a.min(a * (-term.rate * width).exp()).min(*b) - term.overshoot * fall,
        };
        let terms: f64 = a.memory.iter().zip(&b.memory).zip(self.contact.law.terms()).map(each).sum();
        a.value.min(b.value) + terms
    }
}

impl InMotion for Moving {
    /// x_k.
    type Excess = Vec<f64>;

    fn excess_at(&self, elapsed: f64) -> Vec<f64> {
        Stage::within(&self.stages, elapsed, |stage, part| stage.memory(part, &self.contact.law))
    }

    fn strain_at(&self, elapsed: f64) -> f64 {
        self.contact.excess_strain(self.excess_at(elapsed).iter().sum(), self.jaw(elapsed))
    }

    fn extend_strains(&self, start: f64, times: &[f64], strains: &mut Vec<f64>) {
        let (first, mut done) = (strains.len(), 0);
        for (index, stage) in self.stages.iter().enumerate() {
            let is_last = index + 1 == self.stages.len();
            let inside = times[done..].partition_point(|time| is_last || time - start <= stage.end());
            stage.extend_sums(start, &times[done..done + inside], &self.contact.law, strains);
            done += inside;
        }
        for (slot, time) in strains[first..].iter_mut().zip(times) {
            *slot = self.contact.excess_strain(*slot, self.jaw(time - start));
        }
    }

    /// Ever further apart from the fastest rate on.
    fn step_ends(&self) -> Vec<f64> {
        const GROWTH: f64 = 1.5;
        let fastest = self.contact.law.terms().last().map_or(1.0, |term| term.rate);
        let first = 0.5 / fastest;
        let rungs = std::iter::successors(Some(first), |time| Some(GROWTH * time));
        let mut ends: Vec<f64> = rungs.take_while(|end| *end < self.duration).collect();
        ends.extend(self.stages.iter().map(Stage::end).filter(|end| *end < self.duration));
        ends.sort_by(f64::total_cmp);
        ends
    }
}

/// The layer at a moment.
struct Look {
    /// s
    time: f64,
    value: f64,
    /// q̇, 1/s times the unit of q.
    slope: f64,
    memory: Vec<f64>,
}

impl Look {
    fn sum(&self) -> f64 {
        self.value + self.memory.iter().sum::<f64>()
    }

    /// What rounding makes of a sum that is zero.
    fn rounding(&self) -> f64 {
        4.0 * f64::EPSILON * (self.value.abs() + self.memory.iter().map(|x| x.abs()).sum::<f64>())
    }
}
