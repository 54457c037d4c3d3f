//! The load on two soft contacts, and the normal force that it needs.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::{GripError, above_zero, at_least, check};
use crate::contact::{Shape, Specimen};

/// Standard gravity, m/s².
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// A body between two jaws: what pulls at it, and what holds it.
///
/// Each of the two contacts carries half of the tangential load, T = m √((g + a_up)² + a_across²)/2, and half of the torsion about the closing
/// axis, M = (τ + m √(…) d)/2 with d the distance of the centre of mass from that axis. A contact of radius a that is pressed by N slips once
///
/// (T/(μN))² + (M/(c μ N a))² > 1,
///
/// the ellipse by which Howe and Cutkosky (Int. J. Robotics Research 15, 1996) approach the limit surface of a soft finger. c = 3π/16 for Hertz's
/// pressure, which round bodies have, 2/3 for an even one, a prism's, and π p/(8p − 4) under a tip whose force goes like uᵖ. Of the two contacts the one counts that acceleration along the closing axis
/// unloads, by m a_closing/2. With a safety factor S the force that is needed is therefore
///
/// F = S √(T² + (M/(c a))²)/μ + m |a_closing|/2.
///
/// ```
/// use palpate::grip::Grasp;
///
/// let grasp = Grasp::new(0.15, 0.6)?;
/// assert!((grasp.tangential_force() - 0.735_499).abs() < 1e-6); // N at each contact
/// # Ok::<(), palpate::grip::GripError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Grasp {
    /// Mass of the body, kg.
    pub mass: f64,
    /// Coefficient of Coulomb friction μ between jaw and body.
    pub friction: f64,
    /// Gravity, m/s²; its direction lies in the plane of the jaws.
    pub gravity: f64,
    /// Acceleration of the hand upwards, m/s².
    pub acceleration_up: f64,
    /// Acceleration along the jaws across gravity, m/s², either way.
    pub acceleration_across: f64,
    /// Acceleration along the closing axis, m/s², either way.
    pub acceleration_closing: f64,
    /// Torque about the closing axis, N m, either way.
    pub torque: f64,
    /// Distance of the centre of mass from the closing axis, m.
    pub off_centre: f64,
    /// Safety factor on friction, 1 or more.
    pub safety: f64,
}

impl Grasp {
    /// A body that hangs at rest between the jaws.
    ///
    /// # Errors
    /// [`GripError::Number`] for a mass or friction that is not above zero.
    pub fn new(mass: f64, friction: f64) -> Result<Self, GripError> {
        let grasp = Self {
            mass,
            friction,
            gravity: STANDARD_GRAVITY,
            acceleration_up: 0.0,
            acceleration_across: 0.0,
            acceleration_closing: 0.0,
            torque: 0.0,
            off_centre: 0.0,
            safety: 1.0,
        };
        grasp.check()?;
        Ok(grasp)
    }

    /// Checks the numbers, which are free to be set.
    ///
    /// # Errors
    /// [`GripError::Number`] with the first that describes no grasp.
    pub fn check(&self) -> Result<(), GripError> {
        above_zero("mass", self.mass, " kg")?;
        above_zero("friction", self.friction, "")?;
        at_least("gravity", self.gravity, 0.0, " m/s²")?;
        at_least("distance of the centre of mass", self.off_centre, 0.0, " m")?;
        at_least("safety factor", self.safety, 1.0, "")?;
        for (name, found, unit) in [
            ("acceleration upwards", self.acceleration_up, " m/s²"),
            ("acceleration across", self.acceleration_across, " m/s²"),
            ("acceleration along the closing axis", self.acceleration_closing, " m/s²"),
            ("torque", self.torque, " N m"),
        ] {
            check(name, found, unit, "finite", found.is_finite())?;
        }
        let load = self.tangential_force().hypot(self.torsion()) + self.unloading();
        let expected = "finite and above 0: nothing pulls at this body";
        check("load", load, " N", expected, load > 0.0 && load.is_finite())
    }

    /// T, the tangential force at each contact, N.
    #[must_use]
    pub fn tangential_force(&self) -> f64 {
        0.5 * self.pull()
    }

    /// M, the torsion at each contact about its normal, N m.
    #[must_use]
    pub fn torsion(&self) -> f64 {
        0.5 * (self.torque.abs() + self.off_centre * self.pull())
    }

    /// By how much acceleration along the closing axis unloads one contact, N.
    #[must_use]
    pub fn unloading(&self) -> f64 {
        0.5 * self.mass * self.acceleration_closing.abs()
    }

    /// The force of the jaws (N) that is needed at contact displacement u₁ (m) of a body; infinite at a contact without area that has to carry
    /// torsion.
    ///
    /// ```
    /// use palpate::contact::{Shape, Sides, Specimen};
    /// use palpate::grip::Grasp;
    ///
    /// let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?;
    /// let mut grasp = Grasp::new(0.15, 0.6)?;
    /// assert!((grasp.needed_force(&ball, 4e-3) - 1.225_831).abs() < 1e-6); // N: m g/(2 μ)
    /// grasp.off_centre = 0.02;
    /// // The contact is 16.25 mm wide and carries 14.7 N mm: 2.3 times as much is needed.
    /// assert!((grasp.needed_force(&ball, 4e-3) - 2.839_779).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn needed_force(&self, body: &Specimen, contact_displacement: f64) -> f64 {
        let torsion = self.torsion();
        let twist = if torsion == 0.0 {
            0.0
        } else {
            let radius = (body.contact_area(contact_displacement) / PI).sqrt();
            torsion / (torsional_share(body.shape()) * radius)
        };
        self.safety * self.tangential_force().hypot(twist) / self.friction + self.unloading()
    }

    fn pull(&self) -> f64 {
        self.mass * (self.gravity + self.acceleration_up).hypot(self.acceleration_across)
    }
}

/// c in M = c μ N a, the torsion at which a contact of radius a slips all over.
fn torsional_share(shape: &Shape) -> f64 {
    match shape {
        Shape::Ball { .. } | Shape::Pad { .. } => 3.0 * PI / 16.0,
        Shape::Prism { .. } | Shape::Profile { .. } => 2.0 / 3.0,
        Shape::Indenter { tip, .. } => tip.torsional_share(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Sides;

    #[test]
    fn torsion_at_slip_is_the_moment_of_friction_over_the_contact() {
        // ∫ μ p(s) s 2π s ds over a disc of radius 1, by the midpoint rule.
        let moment = |pressure: &dyn Fn(f64) -> f64| -> f64 {
            let count = 200_000;
            (0..count)
                .map(|i| (f64::from(i) + 0.5) / f64::from(count))
                .map(|s| 2.0 * PI * s * s * pressure(s) / f64::from(count))
                .sum()
        };
        let hertz = moment(&|s| 1.5 / PI * (1.0 - s * s).sqrt());
        let even = moment(&|_| 1.0 / PI);
        assert!((torsional_share(&Shape::Ball { radius: 1.0 }) - hertz).abs() < 1e-8);
        assert!((torsional_share(&Shape::Prism { area: 1.0, length: 1.0 }) - even).abs() < 1e-8);
    }

    #[test]
    fn needed_forces_carry_the_load_and_no_less() {
        let block = Specimen::new(
            Shape::Prism {
                area: 4e-4,
                length: 0.04,
            },
            1e5,
            Sides::Two,
        )
        .unwrap();
        let mut grasp = Grasp::new(0.2, 0.5).unwrap();
        grasp.acceleration_up = 2.0;
        grasp.acceleration_across = 1.0;
        grasp.acceleration_closing = -3.0;
        grasp.torque = -0.01;
        grasp.off_centre = 5e-3;
        grasp.safety = 1.5;
        let needed = grasp.needed_force(&block, 2e-3);
        let normal = (needed - 0.2 * 3.0 / 2.0) / 1.5;
        let radius = (4e-4 / PI).sqrt();
        let (t, m) = (grasp.tangential_force(), grasp.torsion());
        let on_surface = (t / (0.5 * normal)).powi(2) + (m / (2.0 / 3.0 * 0.5 * normal * radius)).powi(2);
        assert!((on_surface - 1.0).abs() < 1e-12, "{on_surface}");
        assert!((t - 0.1 * 11.806_65f64.hypot(1.0)).abs() < 1e-12);
    }

    #[test]
    fn loads_and_frictions_that_are_none_are_named() {
        for (mass, friction, name) in [(0.0, 0.5, "mass"), (0.1, 0.0, "friction"), (0.1, f64::NAN, "friction")] {
            let error = Grasp::new(mass, friction).unwrap_err();
            assert!(error.to_string().starts_with(name) && !error.is_answer(), "{error}");
        }
        let mut floating = Grasp::new(0.1, 0.5).unwrap();
        floating.gravity = 0.0;
        assert!(floating.check().unwrap_err().to_string().contains("nothing pulls"));
        let mut bold = Grasp::new(0.1, 0.5).unwrap();
        bold.safety = 0.9;
        assert_eq!(bold.check().unwrap_err().to_string(), "safety factor must be finite and not below 1, found 0.9");
    }
}
