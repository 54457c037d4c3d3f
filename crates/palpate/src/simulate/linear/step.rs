//! A linear contact one step at a time.
//!
//! The state is the position of the jaw and an excess x_k for every term. While q goes straight by Δq over dt,
//!
//! ```text
//! x_k(dt) = exp(−λ_k dt) x_k + g_k Δq (1 − exp(−λ_k dt))/(λ_k dt)
//! ```
//!
//! exact for a memory of strain under a jaw of constant speed, and second order in dt for a memory of force, whose q = F_e(u) does not go
//! straight where the contact grows. The jaw leaves the body where q + Σ x_k = 0; the surface then fades in its own modes until they meet.

use smallvec::SmallVec;

use super::{LinearContact, Modes};
use crate::simulate::StepError;
use crate::simulate::step::{check_step, crossing};

/// x_k of a contact.
pub(in crate::simulate) type Memories = SmallVec<[f64; 8]>;

/// What fades of a memory over a time, and what a change of q adds to it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Fading {
    /// exp(−λ dt)
    kept: f64,
    /// g (1 − exp(−λ dt))/(λ dt)
    gained: f64,
}

impl Fading {
    fn new((overshoot, rate): (f64, f64), dt: f64) -> Self {
        let z = rate * dt;
        let change = (-z).exp_m1();
        Self {
            kept: 1.0 + change,
            gained: if z > 0.0 { -overshoot * change / z } else { overshoot },
        }
    }
}

/// A linear contact that is moved one step at a time.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::simulate) struct LinearStepper {
    contact: LinearContact,
    modes: Modes,
}

impl LinearStepper {
    pub(in crate::simulate) fn new(contact: LinearContact) -> Self {
        Self {
            modes: Modes::new(&contact.law),
            contact,
        }
    }

    /// The same law of another body.
    pub(in crate::simulate) fn with(&self, contact: LinearContact) -> Self {
        let modes = self.modes.clone();
        Self { contact, modes }
    }

    pub(in crate::simulate) fn contact(&self) -> &LinearContact {
        &self.contact
    }

    /// q + Σ x_k: above 0 in contact.
    fn sum(&self, u: f64, memory: &[f64]) -> f64 {
        self.contact.value(u) + memory.iter().sum::<f64>()
    }

    /// Whether the jaw touches the body.
    pub(in crate::simulate) fn is_touching(&self, u: f64, memory: &[f64]) -> bool {
        self.contact.is_bonded() || self.sum(u, memory) >= 0.0
    }

    /// Contact force, N; 0 while the jaw is off.
    pub(in crate::simulate) fn force(&self, u: f64, memory: &[f64]) -> f64 {
        match self.sum(u, memory) {
            sum if sum <= 0.0 && !self.contact.is_bonded() => 0.0,
            sum => self.contact.stiffness(u).0 * sum,
        }
    }

    /// dF/dd against the displacement d of the jaw (N/m) of an instant, in which every x_k gains g_k Δq; 0 while the jaw is off.
    pub(in crate::simulate) fn stiffness(&self, u: f64, memory: &[f64]) -> f64 {
        if !self.is_touching(u, memory) {
            return 0.0;
        }
        let (stiffness, growth) = self.contact.stiffness(u);
        let at_once = (1.0 + self.contact.law.overshoot()) * self.contact.slope(u);
        let slope = growth * self.sum(u, memory) + stiffness * at_once;
        self.contact.specimen.contact_displacement(1.0) * slope
    }

    /// Displacement of the surface of the body at one contact, m.
    pub(in crate::simulate) fn surface(&self, u: f64, memory: &[f64]) -> f64 {
        match self.is_touching(u, memory) {
            true => u,
            false => self.contact.place(-memory.iter().sum::<f64>()).unwrap_or(0.0),
        }
    }

    /// Moves the jaw from contact displacement `from` to `to` (m) within `dt` (s); returns the force (N).
    pub(in crate::simulate) fn step(&self, from: f64, memory: &mut [f64], dt: f64, to: f64) -> Result<f64, StepError> {
        check_step(dt, "displacement must be a finite number", to)?;
        self.contact.specimen.check_contact_displacement(to, self.contact.is_bonded())?;
        let jaw = |share: f64| if share == 1.0 { to } else { from + share * (to - from) };
        let after = if self.is_touching(from, memory) {
            let next = self.pressed((from, to), memory, dt);
            if self.is_touching(to, &next) {
                next
            } else {
                let there = |share: f64| self.pressed((from, jaw(share)), memory, share * dt);
                let share = crossing(|share| self.sum(jaw(share), &there(share)));
                self.free(&there(share), (1.0 - share) * dt)
            }
        } else {
            let apart = |share: f64| -self.sum(jaw(share), &self.free(memory, share * dt));
            if apart(1.0) > 0.0 {
                self.free(memory, dt)
            } else {
                let share = crossing(apart);
                self.pressed((jaw(share), to), &self.free(memory, share * dt), (1.0 - share) * dt)
            }
        };
        memory.copy_from_slice(&after);
        Ok(self.force(to, memory))
    }

    /// Brings the force to `force` (N) within `dt` (s), with the jaw at constant speed; returns the contact displacement (m).
    ///
    /// A jaw that is off meets the surface at once.
    pub(in crate::simulate) fn step_force(
        &self,
        from: f64,
        memory: &mut [f64],
        dt: f64,
        force: f64,
    ) -> Result<f64, StepError> {
        check_step(dt, "force must be a finite number", force)?;
        let contact = &self.contact;
        if force < 0.0 && !(contact.is_bonded() && contact.specimen.has_constant_section()) {
            return Err(StepError::Force { force });
        }
        let value = match self.is_touching(from, memory) {
            true => contact.value(from),
            false => -memory.iter().sum::<f64>(),
        };
        // q + Σ x_k = (1 + Σ gained) q + behind
        let (mut whole, mut behind) = (1.0, 0.0);
        for (fading, x) in self.fadings(dt).zip(memory.iter()) {
            whole += fading.gained;
            behind += fading.kept * x - fading.gained * value;
        }
        let to = contact.carried_by(whole, force, behind).ok_or(StepError::Force { force })?;
        let change = contact.value(to) - value;
        for (fading, x) in self.fadings(dt).zip(memory.iter_mut()) {
            *x = fading.kept * *x + fading.gained * change;
        }
        Ok(to)
    }

    fn fadings(&self, dt: f64) -> impl Iterator<Item = Fading> {
        self.contact.law.terms().iter().map(move |term| Fading::new((term.overshoot, term.rate), dt))
    }

    /// In contact all along.
    fn pressed(&self, (from, to): (f64, f64), memory: &[f64], dt: f64) -> Memories {
        let change = self.contact.value(to) - self.contact.value(from);
        let after = |(fading, x): (Fading, &f64)| fading.kept * x + fading.gained * change;
        self.fadings(dt).zip(memory).map(after).collect()
    }

    /// The surface on its own.
    fn free(&self, memory: &[f64], dt: f64) -> Memories {
        let mut after = Memories::from_elem(0.0, memory.len());
        self.modes.fade(&self.contact.law, memory, dt, &mut after);
        after
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Equilibrium, Shape, Sides, Specimen};
    use crate::simulate::{LinearLaw, LinearTerm, Memory, Motion, Separation, simulate_force};

    fn law() -> LinearLaw {
        LinearLaw::new(&[(1.0, 0.5), (0.6, 8.0)].map(|(overshoot, rate)| LinearTerm { overshoot, rate })).unwrap()
    }

    fn contact(shape: Shape, memory: Memory, separation: Separation) -> LinearContact {
        LinearContact {
            specimen: Specimen::new(shape, 3e4, Sides::Two).unwrap(),
            law: law(),
            memory,
            separation,
        }
    }

    const BALL: Shape = Shape::Ball { radius: 0.03 };
    const BLOCK: Shape = Shape::Prism {
        area: 1e-3,
        length: 0.05,
    };

    /// Loaded, held, let go, met again: the jaw's displacement at some times.
    fn motion() -> Motion {
        let times = vec![0.0, 0.5, 2.0, 2.3, 3.0, 3.4, 6.0];
        Motion::new(times, vec![0.0, 6e-3, 6e-3, 1e-3, 1e-3, 8e-3, 8e-3]).unwrap()
    }

    /// Largest difference from `simulate`, relative to the largest force, in steps of `dt`.
    fn error(contact: &LinearContact, steps: usize) -> f64 {
        let (motion, stepper) = (motion(), LinearStepper::new(contact.clone()));
        let dt = 6.0 / steps as f64;
        let times: Vec<f64> = (1..=steps).map(|step| step as f64 * dt).collect();
        let expected = simulate_force(&motion, contact, &times).unwrap();
        let most = expected.iter().fold(0.0f64, |most, force| most.max(*force));
        let (mut from, mut memory) = (0.0, [0.0; 2]);
        let mut worst = 0.0f64;
        for (time, expected) in times.iter().zip(expected) {
            let to = 0.5 * motion.displacement_at(*time);
            let force = stepper.step(from, &mut memory, dt, to).unwrap();
            worst = worst.max((force - expected).abs() / most);
            from = to;
        }
        worst
    }

    #[test]
    fn steps_of_a_memory_of_strain_are_exact() {
        for separation in [Separation::Unilateral, Separation::Bonded] {
            for shape in [BALL, BLOCK] {
                // All bends of the motion are ends of steps; a contact is lost and met to what the bisection leaves.
                let found = error(&contact(shape.clone(), Memory::Strain, separation), 60);
                assert!(found < 1e-8, "{shape:?} {separation:?}: {found:e}");
            }
        }
    }

    #[test]
    fn steps_of_a_memory_of_force_are_of_second_order() {
        let hertz = Specimen::new(BALL, 3e4, Sides::Two).unwrap();
        let mut contact = contact(BALL, Memory::Force, Separation::Unilateral);
        contact.specimen = hertz.with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.45 }).unwrap();
        let [coarse, fine] = [600, 2400].map(|steps| error(&contact, steps));
        assert!(fine < 1e-4 && fine < coarse / 8.0, "{coarse:e} {fine:e}");
    }

    #[test]
    fn a_step_of_force_ends_with_that_force() {
        for (shape, memory) in [(BALL, Memory::Strain), (BALL, Memory::Force), (BLOCK, Memory::Strain)] {
            let stepper = LinearStepper::new(contact(shape, memory, Separation::Unilateral));
            let (mut from, mut memory) = (0.0, [0.0; 2]);
            for (dt, force) in [(0.1, 1.0), (0.0, 2.0), (5.0, 2.0), (0.1, 0.3), (1e-3, 0.0), (2.0, 0.7)] {
                let to = stepper.step_force(from, &mut memory, dt, force).unwrap();
                assert!((stepper.force(to, &memory) - force).abs() < 1e-12, "{force}");
                from = to;
            }
            assert_eq!(stepper.step_force(from, &mut memory, 0.1, -1.0), Err(StepError::Force { force: -1.0 }));
            // At rest the force is the equilibrium force.
            let rest = stepper.step(from, &mut memory, 1e9, from).unwrap();
            assert!((rest - stepper.contact.specimen.equilibrium_force(from)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_stiffness_is_the_slope_of_an_instant() {
        for (shape, kind) in [(BALL, Memory::Strain), (BALL, Memory::Force), (BLOCK, Memory::Strain)] {
            let stepper = LinearStepper::new(contact(shape, kind, Separation::Unilateral));
            let mut memory = [0.0; 2];
            stepper.step(0.0, &mut memory, 0.3, 2e-3).unwrap();
            let force = |by: f64| stepper.step(2e-3, &mut memory.clone(), 0.0, 2e-3 + by).unwrap();
            let slope = 0.5 * (force(1e-8) - force(-1e-8)) / 2e-8;
            let found = stepper.stiffness(2e-3, &memory);
            assert!((found / slope - 1.0).abs() < 1e-6, "{kind:?}: {found} {slope}");
        }
    }
}
