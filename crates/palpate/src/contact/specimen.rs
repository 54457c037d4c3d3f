//! The body that is squeezed.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

/// Shape of the body, all lengths in m and areas in m².
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Shape {
    /// A ball pressed by flat plates; the contact circle grows with the squeeze, equation (7).
    Ball {
        /// Radius r in m.
        radius: f64,
    },
    /// A spherical fingertip: a soft pad of even thickness over a rigid core, pressed by a flat; equation (7) with the pad as deep as it is
    /// thick.
    Pad {
        /// Outer radius R in m.
        radius: f64,
        /// Thickness of the soft layer in m, at most the radius; equal to it, the pad is a ball without a core.
        thickness: f64,
    },
    /// A body of constant section: strip, block, cylinder or a flat punch on a layer.
    Prism {
        /// Cross-section that carries the force, in m².
        area: f64,
        /// Length along the force, in m: the whole length between the two grips or plates.
        length: f64,
    },
}

impl Shape {
    /// Distance from an undeformed contact to the plane that does not move, in m: the depth that is cut into layers.
    ///
    /// The radius of a ball; the thickness of a pad; the length of a prism, half of it when both ends move.
    #[must_use]
    pub fn depth(self, sides: Sides) -> f64 {
        match (self, sides) {
            (Self::Ball { radius }, _) => radius,
            (Self::Pad { thickness, .. }, _) => thickness,
            (Self::Prism { length, .. }, Sides::One) => length,
            (Self::Prism { length, .. }, Sides::Two) => length / 2.0,
        }
    }
}

/// From how many sides the body is squeezed: decides which share of the jaw's travel one contact takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sides {
    /// Both jaws meet the body; by symmetry each contact takes half the travel (section IV of the paper).
    #[default]
    Two,
    /// One jaw presses, the other side rests or is bonded: the contact takes the whole travel.
    One,
}

/// A body with its modulus: what turns displacement and force into strain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Specimen {
    shape: Shape,
    modulus: f64,
    sides: Sides,
}

/// Numbers that make no specimen, or a displacement that it cannot take.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SpecimenError {
    /// A length, area or modulus that is not a finite number above zero.
    #[error("{name} must be above 0 {unit}, found {found} {unit}")]
    NotPositive {
        /// Which number.
        name: &'static str,
        /// Its SI unit.
        unit: &'static str,
        /// What was given, in that unit.
        found: f64,
    },
    /// A pad thicker than its radius.
    #[error("the thickness of a pad must be at most its radius of {radius} m, found {found} m")]
    PadTooThick {
        /// Radius, m.
        radius: f64,
        /// What was given, m.
        found: f64,
    },
    /// A contact displacement that is not below the depth of the body.
    #[error("contact displacement must stay below the {limit_name} of {limit} m, found {found} m")]
    TooDeep {
        /// What limits it.
        limit_name: &'static str,
        /// The limit in m.
        limit: f64,
        /// The contact displacement asked for, in m.
        found: f64,
    },
    /// A ball or a pad pulled away beyond the first touch while bonded to the jaw.
    #[error(
        "a round body has no contact area beyond first touch: contact displacement must be 0 m or more, found {found} m"
    )]
    PulledOff {
        /// The contact displacement asked for, in m.
        found: f64,
    },
}

impl Specimen {
    /// A body of the given shape and Young's modulus `modulus` (Pa).
    ///
    /// # Errors
    /// [`SpecimenError::NotPositive`] for a length, area or modulus that is not a finite number above zero.
    ///
    /// ```
    /// use palpate::contact::{Shape, Sides, Specimen};
    /// let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?;
    /// // equation (7) at 25 mm of jaw travel, 12.5 mm a contact
    /// assert!((ball.contact_area(0.0125) - 2.258_019_720e-3).abs() < 1e-11);
    /// # Ok::<(), palpate::contact::SpecimenError>(())
    /// ```
    pub fn new(shape: Shape, modulus: f64, sides: Sides) -> Result<Self, SpecimenError> {
        positive("modulus", "Pa", modulus)?;
        match shape {
            Shape::Ball { radius } => positive("radius", "m", radius)?,
            Shape::Pad { radius, thickness } => {
                positive("radius", "m", radius)?;
                positive("thickness", "m", thickness)?;
                if thickness > radius {
                    return Err(SpecimenError::PadTooThick {
                        radius,
                        found: thickness,
                    });
                }
            }
            Shape::Prism { area, length } => {
                positive("area", "m²", area)?;
                positive("length", "m", length)?;
            }
        }
        Ok(Self { shape, modulus, sides })
    }

    /// The shape.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Young's modulus E in Pa.
    #[must_use]
    pub fn modulus(&self) -> f64 {
        self.modulus
    }

    /// From how many sides the body is squeezed.
    #[must_use]
    pub fn sides(&self) -> Sides {
        self.sides
    }

    /// Distance from an undeformed contact to the plane that does not move, in m; see [`Shape::depth`].
    #[must_use]
    pub fn depth(&self) -> f64 {
        self.shape.depth(self.sides)
    }

    /// One contact's share u₁ of the jaw's travel d, in m: d/2 from two sides, d from one.
    #[must_use]
    pub fn contact_displacement(&self, displacement: f64) -> f64 {
        match self.sides {
            Sides::Two => displacement / 2.0,
            Sides::One => displacement,
        }
    }

    /// Contact area A in m² at contact displacement u₁ (m).
    ///
    /// A ball: A = π [r² − (r − u₁)²] = π (2 r u₁ − u₁²), equation (7), from 0 at first touch to π r² at u₁ = r;
    /// zero before first touch. A pad: the same with its outer radius, up to where it is pressed flat on the core. A prism: its section, whatever the displacement.
    #[must_use]
    pub fn contact_area(&self, contact_displacement: f64) -> f64 {
        match self.shape {
            Shape::Ball { radius } | Shape::Pad { radius, .. } => {
                let u = contact_displacement.max(0.0);
                PI * u * (2.0 * radius - u)
            }
            Shape::Prism { area, .. } => area,
        }
    }

    /// Strain that spreads evenly behind the contact once relaxation is over, ε_e,1 = u₁/depth.
    #[must_use]
    pub fn equilibrium_strain(&self, contact_displacement: f64) -> f64 {
        contact_displacement / self.depth()
    }

    /// Force in N of a contact whose layer has strain `strain`: F = E ε A(u₁), equation (11).
    #[must_use]
    pub fn force(&self, strain: f64, contact_displacement: f64) -> f64 {
        self.modulus * strain * self.contact_area(contact_displacement)
    }

    /// S = E A(u₁), the force per strain of the contact layer (N), and its slope dS/du₁ (N/m).
    pub(crate) fn stiffness(&self, contact_displacement: f64) -> (f64, f64) {
        let growth = match self.shape {
            Shape::Ball { radius } | Shape::Pad { radius, .. } if contact_displacement >= 0.0 => {
                2.0 * PI * (radius - contact_displacement)
            }
            _ => 0.0,
        };
        (self.modulus * self.contact_area(contact_displacement), self.modulus * growth)
    }

    /// Whether the area is the same at any displacement.
    pub(crate) fn has_constant_section(&self) -> bool {
        matches!(self.shape, Shape::Prism { .. })
    }

    /// Checks that a contact displacement (m) is one the body can take.
    ///
    /// # Errors
    /// [`SpecimenError::TooDeep`] at or beyond the depth, except for a prism `bonded` at its ends: a strip in grips may be
    /// stretched to several times its length. [`SpecimenError::PulledOff`] below zero when `bonded` to a ball.
    pub fn check_contact_displacement(&self, contact_displacement: f64, bonded: bool) -> Result<(), SpecimenError> {
        let limit = self.depth();
        let is_strip = bonded && matches!(self.shape, Shape::Prism { .. });
        if contact_displacement >= limit && !is_strip {
            return Err(SpecimenError::TooDeep {
                limit_name: match (self.shape, self.sides) {
                    (Shape::Ball { .. }, _) => "radius",
                    (Shape::Pad { .. }, _) => "thickness of the pad",
                    (Shape::Prism { .. }, Sides::One) => "length",
                    (Shape::Prism { .. }, Sides::Two) => "half length",
                },
                limit,
                found: contact_displacement,
            });
        }
        if bonded && contact_displacement < 0.0 && !self.has_constant_section() {
            return Err(SpecimenError::PulledOff {
                found: contact_displacement,
            });
        }
        Ok(())
    }
}

fn positive(name: &'static str, unit: &'static str, found: f64) -> Result<(), SpecimenError> {
    if found.is_finite() && found > 0.0 {
        Ok(())
    } else {
        Err(SpecimenError::NotPositive { name, unit, found })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn area_of_a_ball_grows_from_nothing_to_its_great_circle() {
        let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two).unwrap();
        assert_eq!(ball.contact_area(0.0), 0.0);
        assert_eq!(ball.contact_area(-0.01), 0.0);
        assert!((ball.contact_area(0.035) - PI * 0.035 * 0.035).abs() < 1e-18);
        // π (35² − 32.5²) mm² = π · 168.75 mm²
        assert!((ball.contact_area(0.0025) - PI * 168.75e-6).abs() < 1e-15);
    }

    #[test]
    fn a_pad_as_thick_as_its_radius_is_a_ball_and_a_thin_one_is_stiff() {
        let pad = |thickness| {
            let shape = Shape::Pad {
                radius: 0.01,
                thickness,
            };
            Specimen::new(shape, 1e5, Sides::One)
        };
        let ball = Specimen::new(Shape::Ball { radius: 0.01 }, 1e5, Sides::One).unwrap();
        let (thick, thin) = (pad(0.01).unwrap(), pad(0.002).unwrap());
        for u in [0.0, 1e-4, 1.9e-3] {
            let force = |body: &Specimen| body.force(body.equilibrium_strain(u), u);
            assert_eq!(force(&thick), force(&ball));
            assert!((force(&thin) - 5.0 * force(&ball)).abs() < 1e-12);
        }
        assert!(matches!(pad(0.011), Err(SpecimenError::PadTooThick { .. })));
        let flat = thin.check_contact_displacement(0.002, false);
        assert!(matches!(
            flat,
            Err(SpecimenError::TooDeep {
                limit_name: "thickness of the pad",
                ..
            })
        ));
    }

    #[test]
    fn wrong_specimens_are_refused() {
        let ball = |radius| Specimen::new(Shape::Ball { radius }, 1.0, Sides::Two);
        assert!(ball(0.0).is_err() && ball(-1.0).is_err() && ball(f64::NAN).is_err());
        assert!(Specimen::new(Shape::Ball { radius: 1.0 }, -1.0, Sides::One).is_err());
        let ball = ball(0.035).unwrap();
        assert!(ball.check_contact_displacement(0.035, false).is_err());
        assert!(ball.check_contact_displacement(-1e-3, true).is_err());
        assert!(ball.check_contact_displacement(-1e-3, false).is_ok());
    }
}
