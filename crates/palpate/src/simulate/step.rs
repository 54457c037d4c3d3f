//! One step at a time, for controllers: what the contact does between two ticks of a clock.
//!
//! The whole state is the node behind the contact layer and the place of the jaw. A step of the jaw by Δu over dt splits the law of the contact
//! layer, ẋ = g − v sgn(x)|x|ⁿ with g dt = Δu (m − 1)/depth, into half the drive, the closed form (4), (5) over dt, and the other half
//! (Strang 1968): second order in dt, exact while the jaw stands still, stable at any dt, one power a step. With dt = 0 the contact
//! layer takes the travel at once.

use serde::{Deserialize, Serialize};

use super::{ContactModel, Separation};
use crate::contact::{Layer, SpecimenError, carried_at, share};

/// The state of a contact between two steps: two numbers.
///
/// ```
/// use palpate::contact::{Layers, Shape, Sides, Specimen};
/// use palpate::latency::LatencyLaw;
/// use palpate::simulate::{ContactModel, ContactState, Separation};
///
/// let model = ContactModel {
///     specimen: Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?,
///     law: LatencyLaw::new(5.0, 2e4)?,
///     layers: Layers::new(8.0)?,
///     separation: Separation::Unilateral,
/// };
/// let mut contact = ContactState::default();
/// // 5 mm within 0.6 s at 1 kHz, then a hold of 10 s in one step
/// let mut force = 0.0;
/// for i in 1..=600 {
///     force = contact.step(&model, 1e-3, 0.005 * f64::from(i) / 600.0)?;
/// }
/// assert!((force - 3.035_025).abs() < 1e-3); // N; second order in dt
/// force = contact.step(&model, 10.0, 0.005)?;
/// assert!((force - 1.556_133).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Without std
///
/// A controller without an operating system asks for the step alone:
///
/// ```toml
/// [dependencies]
/// palpate = { version = "0.1", default-features = false }
/// ```
///
/// That leaves this type, [`ContactModel`], the law ([`latency`](crate::latency), but for whole series) and the bodies
/// ([`contact`](crate::contact)). Nothing allocates. Bodies by a table of areas or forces, and bodies for serde, need the feature `alloc`;
/// states, laws and layers have serde without it.
///
/// Powers, logarithms and exponentials are then those of the crate `libm`. Forces and displacements stay within a few units in the last
/// place of those with std, and are the same bits for n = 5, which needs roots alone. `crates/palpate/examples/controller` is a library
/// for firmware, and `./test bare` builds it and compares.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// One contact's share of the jaw's displacement, m.
    pub(super) jaw: f64,
    /// Displacement of the node behind the contact layer, m: where the surface is once it is free.
    pub(super) behind: f64,
}

/// A step that cannot be taken; the state is as before.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// A time step, displacement or force that is NaN or infinite, or a time step below zero.
    #[error("{expected}, found {found}")]
    Number {
        /// What must be what.
        expected: &'static str,
        /// What was given.
        found: f64,
    },
    /// Bytes that begin otherwise than those of a state.
    #[error("expected the {} bytes of a contact state of format {}", ContactState::BYTES, FORMAT[7] - b'0')]
    Format,
    /// A displacement that the body cannot take.
    #[error(transparent)]
    Displacement(#[from] SpecimenError),
    /// A force that no displacement carries, or that pulls where nothing can be pulled.
    #[error("no single displacement within the range of the body carries {force} N")]
    Force {
        /// What was given, N.
        force: f64,
    },
}

/// What the bytes of a state begin with; another number where the rest has another form.
const FORMAT: [u8; 8] = *b"contact1";

impl ContactState {
    /// Length of [`to_bytes`](Self::to_bytes).
    pub const BYTES: usize = 24;

    /// Moves the jaw to `displacement` (m, since first touch) within `dt` (s) and returns the contact force (N).
    ///
    /// # Errors
    /// [`StepError`] for numbers that are not finite, a negative time step, and a displacement that the body cannot take.
    pub fn step(&mut self, model: &ContactModel, dt: f64, displacement: f64) -> Result<f64, StepError> {
        check_step(dt, "displacement must be a finite number", displacement)?;
        let (specimen, bonded) = (&model.specimen, model.separation == Separation::Bonded);
        let to = specimen.contact_displacement(displacement);
        specimen.check_contact_displacement(to, bonded)?;
        let was_touching = bonded || self.jaw >= self.behind;
        let next = if was_touching {
            let next = self.pressed(model, dt, to);
            if bonded || next.jaw >= next.behind { next } else { self.left(model, dt, to) }
        } else {
            self.met(model, dt, to)
        };
        *self = next;
        Ok(self.force(model))
    }

    /// Brings the force to `force` (N) within `dt` (s) and returns the displacement of the jaw (m).
    ///
    /// The layer takes half the change at once, creeps for dt, and takes the other half: second order in dt, stable at any. At no force
    /// the jaw follows the surface.
    ///
    /// # Errors
    /// [`StepError`] for numbers that are not finite, a negative time step, and a force that no displacement carries.
    pub fn step_force(&mut self, model: &ContactModel, dt: f64, force: f64) -> Result<f64, StepError> {
        check_step(dt, "force must be a finite number", force)?;
        let (specimen, bonded) = (&model.specimen, model.separation == Separation::Bonded);
        let (depth, thickness) = (specimen.depth(), model.layers.thickness(specimen.depth()));
        if force < 0.0 && !(bonded && specimen.has_constant_section()) {
            return Err(StepError::Force { force });
        }
        let refused = StepError::Force { force };
        let at = |force: f64, behind: f64| {
            carried_at(specimen, Layer::Behind { behind, thickness }, force, bonded).ok_or(refused)
        };
        let held = |force: f64, excess: f64| carried_at(specimen, Layer::Excess(excess), force, bonded).ok_or(refused);
        let halfway = 0.5 * (self.force(model).max(0.0) + force.max(0.0)) + 0.5 * force.min(0.0);
        let u = at(halfway, self.behind)?;
        let excess = (u - self.behind) / thickness - u / depth;
        // Creep: the law in its own time, ṡ = K; the mean of K at both ends.
        let keeps = |u: f64, excess: f64| share(specimen, model.layers, u, excess).0;
        let first = keeps(u, excess);
        let guess = model.law.excess_after(excess, first * dt);
        let second = keeps(held(halfway, guess)?, guess);
        let after = model.law.excess_after(excess, 0.5 * (first + second) * dt);
        let u = held(halfway, after)?;
        let behind = u - thickness * (after + u / depth);
        let jaw = at(force, behind)?;
        *self = Self { jaw, behind };
        Ok(jaw / specimen.contact_displacement(1.0))
    }

    /// Current contact force, N; zero while the jaw is off.
    #[must_use]
    pub fn force(&self, model: &ContactModel) -> f64 {
        // The same product as in the solution for a displacement, so that `step_force` finds again the force that it reached.
        let strain = (self.jaw - self.behind) * (1.0 / model.layers.thickness(model.specimen.depth()));
        match model.separation {
            Separation::Unilateral if strain <= 0.0 => 0.0,
            _ => model.specimen.force(strain, self.jaw),
        }
    }

    /// Displacement of the surface of the body at one contact, m: where the jaw is or, once it is off, the dent that is left.
    #[must_use]
    pub fn surface(&self, model: &ContactModel) -> f64 {
        match model.separation {
            Separation::Unilateral => self.jaw.max(self.behind),
            Separation::Bonded => self.jaw,
        }
    }

    /// Whether the jaw touches the body.
    #[must_use]
    pub fn is_touching(&self, model: &ContactModel) -> bool {
        model.separation == Separation::Bonded || self.jaw >= self.behind
    }

    /// The state as bytes, the same on every machine: their format, the jaw and the layer.
    #[must_use]
    pub fn to_bytes(self) -> [u8; Self::BYTES] {
        let mut bytes = [0; Self::BYTES];
        let parts = [FORMAT, self.jaw.to_le_bytes(), self.behind.to_le_bytes()];
        bytes.chunks_exact_mut(8).zip(parts).for_each(|(bytes, part)| bytes.copy_from_slice(&part));
        bytes
    }

    /// The state from [`to_bytes`](Self::to_bytes), to the last bit.
    ///
    /// # Errors
    /// [`StepError::Format`] for bytes of something else, [`StepError::Number`] for those that hold no finite numbers.
    pub fn from_bytes(bytes: [u8; Self::BYTES]) -> Result<Self, StepError> {
        let mut parts = [[0; 8]; 3];
        parts.iter_mut().zip(bytes.chunks_exact(8)).for_each(|(part, bytes)| part.copy_from_slice(bytes));
        let [format, jaw, behind] = parts;
        if format != FORMAT {
            return Err(StepError::Format);
        }
        Self::from_displacements(f64::from_le_bytes(jaw), f64::from_le_bytes(behind))
    }

    /// The two displacements that are the state, m: one contact's share of that of the jaw, and that of the node behind the contact layer.
    #[must_use]
    pub fn displacements(self) -> (f64, f64) {
        (self.jaw, self.behind)
    }

    /// The state from its [`displacements`](Self::displacements), to the last bit.
    ///
    /// # Errors
    /// [`StepError::Number`] for one that is not finite.
    pub fn from_displacements(jaw: f64, behind: f64) -> Result<Self, StepError> {
        for found in [jaw, behind] {
            check_step(0.0, "displacement must be a finite number", found)?;
        }
        Ok(Self { jaw, behind })
    }

    /// In contact all along.
    fn pressed(self, model: &ContactModel, dt: f64, to: f64) -> Self {
        let depth = model.specimen.depth();
        let thickness = model.layers.thickness(depth);
        // A tick waits for the one before it, and many contacts share one divider: products are ready sooner than quotients.
        let per_depth = 1.0 / depth;
        let kick = (to - self.jaw) * (0.5 * (model.layers.drive(1.0, 1.0) * per_depth));
        let excess = (self.jaw - self.behind) * (1.0 / thickness) - self.jaw * per_depth;
        let excess = model.law.excess_after(excess + kick, dt) + kick;
        Self {
            jaw: to,
            behind: to - thickness * (excess + to * per_depth),
        }
    }

    /// The surface on its own for dt.
    fn free(self, model: &ContactModel, dt: f64, to: f64) -> Self {
        let depth = model.specimen.depth();
        // ẏ = −(v/m) yⁿ with y = u/depth is the law itself in a slower time.
        let left = model.law.excess_after(self.behind / depth, dt / model.layers.count());
        Self {
            jaw: to,
            behind: depth * left,
        }
    }

    /// The jaw leaves on the way: in contact until the force is gone, free from there.
    fn left(self, model: &ContactModel, dt: f64, to: f64) -> Self {
        let share = crossing(|share| {
            let there = self.pressed(model, share * dt, self.jaw + share * (to - self.jaw));
            there.jaw - there.behind
        });
        let leaving = self.pressed(model, share * dt, self.jaw + share * (to - self.jaw));
        let surface = Self {
            behind: leaving.jaw.max(leaving.behind),
            ..leaving
        };
        surface.free(model, (1.0 - share) * dt, to)
    }

    /// The jaw is off; it may meet the surface on the way.
    fn met(self, model: &ContactModel, dt: f64, to: f64) -> Self {
        let apart = |share: f64| {
            let there = self.free(model, share * dt, self.jaw + share * (to - self.jaw));
            there.behind - there.jaw
        };
        if apart(1.0) > 0.0 {
            return self.free(model, dt, to);
        }
        let share = crossing(apart);
        let meeting = self.free(model, share * dt, self.jaw + share * (to - self.jaw));
        let touching = Self {
            jaw: meeting.behind,
            ..meeting
        };
        touching.pressed(model, (1.0 - share) * dt, to)
    }
}

pub(super) fn check_step(dt: f64, expected: &'static str, value: f64) -> Result<(), StepError> {
    if !(dt.is_finite() && dt >= 0.0) {
        return Err(StepError::Number {
            expected: "time step must be a finite number of 0 s or more",
            found: dt,
        });
    }
    if !value.is_finite() {
        return Err(StepError::Number { expected, found: value });
    }
    Ok(())
}

/// Where in 0…1 a function that begins above zero and ends below crosses it, to a thousandth of a millionth, in a bounded number of steps.
///
/// The last of 2³⁰ equal parts whose beginning is still above zero, the same that 30 halvings find. The rule of false position finds it in six
/// to eleven steps where the function is smooth; the value at an end that stays is reduced as Anderson and Björck have it (BIT 13, 1973),
/// and three steps that leave more than a quarter are followed by a halving.
pub(super) fn crossing(f: impl Fn(f64) -> f64) -> f64 {
    const PARTS: u32 = 1 << 30;
    let at = |part: u32| f64::from(part) / f64::from(PARTS);
    let (mut above, mut below) = (0, PARTS);
    let (mut high, mut low) = (f(0.0), f(1.0));
    let mut last = None;
    // Of the three steps before; none after a halving.
    let mut widths = [u64::MAX; 3];
    while below - above > 1 {
        let width = below - above;
        let share = high / (high - low);
        let is_slow = 4 * u64::from(width) > widths[0];
        let share = if share > 0.0 && share <= 1.0 && !is_slow { share } else { 0.5 };
        widths = if is_slow { [u64::MAX; 3] } else { [widths[1], widths[2], u64::from(width)] };
        let part = (above + (share * f64::from(width)) as u32).clamp(above + 1, below - 1);
        let value = f(at(part));
        let is_above = value > 0.0;
        let (near, far) = if is_above { (&mut high, &mut low) } else { (&mut low, &mut high) };
        if last == Some(is_above) {
            let kept = 1.0 - value / *near;
            *far *= if kept > 0.0 { kept } else { 0.5 };
        }
        *near = value;
        (above, below) = if is_above { (part, below) } else { (above, part) };
        last = Some(is_above);
    }
    at(above)
}

#[cfg(test)]
mod tests {
    use super::crossing;
    use std::cell::Cell;

    /// By 30 halvings.
    fn halved(f: impl Fn(f64) -> f64) -> f64 {
        let (mut above, mut below) = (0.0, 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (above + below);
            if f(middle) > 0.0 { above = middle } else { below = middle }
        }
        above
    }

    #[test]
    fn a_crossing_is_the_one_that_halvings_find() {
        let mut most = 0;
        for root in [1e-12, 3e-9, 1e-4, 0.1, 0.37, 0.5, 0.9, 1.0 - 1e-7, 1.0] {
            type Function = fn(f64, f64) -> f64;
            let functions: [Function; 6] = [
                |x, root| root - x,
                |x, root| 3e-7 * (root * root - x * x),
                |x, root| (-40.0 * x).exp() - (-40.0 * root).exp(),
                |x, root| {
                    let falls = |x: f64| (1.0 + 8.0 * x).powf(-0.25) - 0.9 * x;
                    falls(x) - falls(root)
                },
                |x, root| (1.0 + 1e6 * root).ln() - (1.0 + 1e6 * x).ln(),
                // Neither smooth nor a number beyond.
                |x, root| if x < root { 1.0 } else { f64::NAN },
            ];
            for (index, function) in functions.into_iter().enumerate() {
                let calls = Cell::new(0);
                let found = crossing(|x| {
                    calls.set(calls.get() + 1);
                    function(x, root)
                });
                assert_eq!(found, halved(|x| function(x, root)), "function {index}, root {root}");
                assert!(calls.get() <= 34, "function {index}, root {root}: {} calls", calls.get());
                if index == 3 {
                    most = most.max(calls.get());
                }
            }
        }
        assert!(most <= 12, "{most} calls for an excess strain that relaxes");
    }
}
