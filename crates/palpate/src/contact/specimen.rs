//! The body that is squeezed.

use core::f64::consts::FRAC_PI_2;

#[cfg(feature = "alloc")]
use serde::{Deserialize, Serialize};

use super::equilibrium::{Equilibrium, EquilibriumError};
use super::shape::{Limit, Shape, Sides};
use super::tip::Tip;

/// A body with its modulus: what turns displacement and force into strain.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "alloc", derive(Serialize, Deserialize))]
pub struct Specimen {
    shape: Shape,
    modulus: f64,
    sides: Sides,
    #[cfg_attr(feature = "alloc", serde(default))]
    equilibrium: Equilibrium,
}

/// An invalid specimen, or a displacement beyond its range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
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
    /// Rows of the widths of a dumbbell that make none.
    #[error(
        "row {row} of the widths of a dumbbell: two rows or more are needed, whose places rise and whose widths are above 0 m"
    )]
    Widths {
        /// Which row, from 1.
        row: usize,
    },
    /// A cone or a pyramid on a half space: neither has a length.
    #[error("a conical or pyramidal tip needs the thickness of the sample, since the tip has no length of its own")]
    NoDepth,
    /// A half angle of a tip that is not between its axis and the surface.
    #[error("the half angle of a tip must be above 0 and below 90 deg, found {} deg", .found.to_degrees())]
    HalfAngle {
        /// What was given, rad.
        found: f64,
    },
    /// A law of the equilibrium force that does not go with the body.
    #[error(transparent)]
    Equilibrium(#[from] EquilibriumError),
    /// A contact displacement beyond what the body, or a table of it, has.
    #[error("contact displacement must stay below the {limit_name} of {limit} m, found {found} m")]
    TooDeep {
        /// What limits it.
        limit_name: &'static str,
        /// The limit in m.
        limit: f64,
        /// The contact displacement requested, in m.
        found: f64,
    },
    /// A body whose contact grows, pulled away beyond the first touch while bonded to the jaw.
    #[error(
        "contact displacement must be 0 m or more where the contact area grows with it or a table has the force, found {found} m"
    )]
    PulledOff {
        /// The contact displacement requested, in m.
        found: f64,
    },
}

impl Specimen {
    /// A body of the given shape and Young's modulus `modulus` (Pa).
    ///
    /// # Errors
    /// [`SpecimenError::NotPositive`] for a length, area or modulus that is not a finite number above zero;
    /// [`SpecimenError::PadTooThick`], [`SpecimenError::HalfAngle`] and [`SpecimenError::NoDepth`] for shapes that are none.
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
        match &shape {
            &Shape::Ball { radius } => positive("radius", "m", radius)?,
            &Shape::Pad { radius, thickness } => {
                positive("radius", "m", radius)?;
                positive("thickness", "m", thickness)?;
                if thickness > radius {
                    return Err(SpecimenError::PadTooThick {
                        radius,
                        found: thickness,
                    });
                }
            }
            &Shape::Prism { area, length } => {
                positive("area", "m²", area)?;
                positive("length", "m", length)?;
            }
            Shape::Profile { depth, area } => {
                positive("depth", "m", *depth)?;
                positive("area at the last row", "m²", area.value(area.end()))?;
            }
            Shape::Indenter { tip, layer } => {
                match *tip {
                    Tip::Sphere { radius } | Tip::Punch { radius } => positive("radius", "m", radius)?,
                    Tip::Cone { half_angle } | Tip::Pyramid { half_angle } => {
                        if !(half_angle > 0.0 && half_angle < FRAC_PI_2) {
                            return Err(SpecimenError::HalfAngle { found: half_angle });
                        }
                    }
                }
                match layer {
                    Some(layer) => positive("thickness", "m", layer.thickness)?,
                    None if tip.length().is_none() => return Err(SpecimenError::NoDepth),
                    None => {}
                }
            }
        }
        Ok(Self {
            shape,
            modulus,
            sides,
            equilibrium: Equilibrium::UniformStrain,
        })
    }

    /// The same body with another law of the force that it tends to.
    ///
    /// ```
    /// use palpate::contact::{Equilibrium, Shape, Sides, Specimen};
    /// // An incompressible ball of 20 mm radius and 100 kPa, pressed 1 mm deep by a rigid flat:
    /// // 4/3 · 100 kPa/0.75 · √(20 mm) · (1 mm)^(3/2) = 0.795 N
    /// let ball = Specimen::new(Shape::Ball { radius: 0.02 }, 1e5, Sides::One)?;
    /// let ball = ball.with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.5 })?;
    /// assert!((ball.equilibrium_force(1e-3) - 0.795_046_5).abs() < 1e-6);
    ///
    /// // A conical tip of 35° on a gel of 1 kPa that is thick against its indentation of 0.5 µm:
    /// // 2/π · 1 kPa/0.75 · tan 35° · (0.5 µm)² = 0.1486 nN
    /// use palpate::contact::{ThinLayer, Tip};
    /// let tip = Tip::Cone { half_angle: 35f64.to_radians() };
    /// let layer = Some(ThinLayer { thickness: 1e-3, base: Default::default() });
    /// let gel = Specimen::new(Shape::Indenter { tip, layer }, 1e3, Sides::One)?;
    /// let gel = gel.with_equilibrium(Equilibrium::Hertz { poisson_ratio: 0.5 })?;
    /// assert!((gel.force(gel.equilibrium_strain(5e-7), 5e-7) - 1.486e-10).abs() < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`EquilibriumError`] for Hertz's law with a body that is not round, a Poisson's ratio that no solid has, or a punch that is wider than its
    /// layer is thick.
    pub fn with_equilibrium(self, equilibrium: Equilibrium) -> Result<Self, EquilibriumError> {
        equilibrium.check(&self.shape)?;
        Ok(Self { equilibrium, ..self })
    }

    /// The law of the force that it tends to.
    #[must_use]
    pub fn equilibrium(&self) -> &Equilibrium {
        &self.equilibrium
    }

    /// The shape.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
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
    /// zero before first touch. A pad: the same with its outer radius, up to where it is pressed flat on the core. A prism: its section,
    /// whatever the displacement. A profile: its table. A tip: π a² with the contact radius a of [`Tip`](super::Tip).
    #[must_use]
    pub fn contact_area(&self, contact_displacement: f64) -> f64 {
        self.shape.area(contact_displacement).0
    }

    /// Strain that spreads evenly behind the contact once relaxation is over, ε_e,1 = u₁/depth.
    #[must_use]
    pub fn equilibrium_strain(&self, contact_displacement: f64) -> f64 {
        contact_displacement / self.depth()
    }

    /// Force in N of a contact whose layer has strain `strain`: F = E ε A(u₁), equation (11), or S(u₁) ε with the stiffness S of another
    /// law of [`Equilibrium`].
    #[must_use]
    pub fn force(&self, strain: f64, contact_displacement: f64) -> f64 {
        match self.equilibrium {
            Equilibrium::UniformStrain => self.modulus * strain * self.contact_area(contact_displacement),
            _ => self.stiffness(contact_displacement).0 * strain,
        }
    }

    /// Force in N that a contact tends to, F_e(u₁) = S(u₁) u₁/depth.
    #[must_use]
    pub fn equilibrium_force(&self, contact_displacement: f64) -> f64 {
        self.force(self.equilibrium_strain(contact_displacement), contact_displacement)
    }

    /// S = E A(u₁), the force per strain of the contact layer (N), and its slope dS/du₁ (N/m).
    pub(crate) fn stiffness(&self, contact_displacement: f64) -> (f64, f64) {
        self.equilibrium.stiffness(&self.shape, self.modulus, self.depth(), contact_displacement)
    }

    /// p of F_e ∝ uᵖ: that of a tip by Hertz's law on a half space, 1 of a constant section; `None` of other bodies.
    #[cfg(feature = "std")]
    pub(crate) fn hertz_power(&self) -> Option<f64> {
        let of_tip = self.shape.tip().map(|(tip, _)| tip.power().1);
        of_tip.or_else(|| self.has_constant_section().then_some(1.0))
    }

    /// Contact displacements (m) between which the stiffness is smooth, up to `reach`: the rows of tables, and ever closer places to first
    /// touch where it begins like √u.
    #[cfg(feature = "std")]
    pub(crate) fn bends(&self, reach: f64) -> Vec<f64> {
        let mut bends: Vec<f64> = match &self.equilibrium {
            Equilibrium::Hertz { .. } => (1..=24).map(|k| reach * 0.25f64.powi(k)).collect(),
            Equilibrium::Measured { force_per_displacement } => force_per_displacement.places().collect(),
            Equilibrium::UniformStrain => match &self.shape {
                Shape::Profile { area, .. } => area.places().collect(),
                _ => Vec::new(),
            },
        };
        bends.retain(|u| *u < reach);
        bends
    }

    /// Whether the force per strain is the same at any displacement.
    pub(crate) fn has_constant_section(&self) -> bool {
        matches!((&self.shape, &self.equilibrium), (Shape::Prism { .. }, Equilibrium::UniformStrain))
    }

    /// How deep the body can be squeezed; a strip in grips can be stretched further.
    pub(crate) fn limit(&self) -> Limit {
        let (end, name) = self.equilibrium.end(&self.shape);
        self.shape.limit(self.sides).or_end(end, name)
    }

    /// The largest contact displacement that the body takes, m: the last number below the depth, or the end of a table or of a law. A prism
    /// bonded to its grips takes any.
    ///
    /// ```
    /// use palpate::contact::{Shape, Sides, Specimen};
    /// let ball = Specimen::new(Shape::Ball { radius: 0.035 }, 28e3, Sides::Two)?;
    /// assert!(ball.deepest() < 0.035 && ball.check_contact_displacement(ball.deepest(), false).is_ok());
    /// # Ok::<(), palpate::contact::SpecimenError>(())
    /// ```
    #[must_use]
    pub fn deepest(&self) -> f64 {
        let limit = self.limit();
        if limit.included { limit.at } else { limit.at.next_down() }
    }

    /// Checks that a contact displacement (m) is one the body can take.
    ///
    /// # Errors
    /// [`SpecimenError::TooDeep`] at or beyond the depth, except for a prism `bonded` at its ends: a strip in grips may be
    /// stretched to several times its length. [`SpecimenError::PulledOff`] below zero when `bonded` to a ball.
    pub fn check_contact_displacement(&self, contact_displacement: f64, bonded: bool) -> Result<(), SpecimenError> {
        let limit = self.limit();
        let is_strip = bonded && self.has_constant_section();
        if limit.is_passed_by(contact_displacement) && !is_strip {
            return Err(SpecimenError::TooDeep {
                limit_name: limit.name,
                limit: limit.at,
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

pub(super) fn positive(name: &'static str, unit: &'static str, found: f64) -> Result<(), SpecimenError> {
    if found.is_finite() && found > 0.0 {
        Ok(())
    } else {
        Err(SpecimenError::NotPositive { name, unit, found })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

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
    fn a_measured_law_passes_through_its_rows_and_ends_with_them() {
        let rows = [(0.0, 0.0), (0.001, 0.1), (0.002, 0.28), (0.004, 0.8)];
        let ball = || Specimen::new(Shape::Ball { radius: 0.02 }, 1e5, Sides::One).unwrap();
        let body = ball().with_equilibrium(Equilibrium::measured(&rows).unwrap()).unwrap();
        for (u, force) in rows {
            assert!((body.force(body.equilibrium_strain(u), u) - force).abs() < 1e-15);
        }
        assert!(body.check_contact_displacement(0.004, false).is_ok());
        let beyond = body.check_contact_displacement(0.0041, false);
        assert!(matches!(beyond, Err(SpecimenError::TooDeep { limit, .. }) if limit == 0.004));
        let softening = Equilibrium::measured(&[(0.0, 0.0), (0.001, 0.2), (0.002, 0.3)]);
        assert!(matches!(softening, Err(EquilibriumError::Softening { row: 3, .. })));
        assert_eq!(Equilibrium::measured(&[(0.0, 0.1), (1.0, 0.2)]), Err(EquilibriumError::Touch { found: 0.1 }));
        let block = Shape::Prism {
            area: 1e-4,
            length: 0.1,
        };
        let block = Specimen::new(block, 1e5, Sides::One).unwrap();
        let hertz = |poisson_ratio| Equilibrium::Hertz { poisson_ratio };
        assert_eq!(block.with_equilibrium(hertz(0.5)), Err(EquilibriumError::NotRound));
        assert_eq!(ball().with_equilibrium(hertz(0.51)), Err(EquilibriumError::PoissonRatio { found: 0.51 }));
        assert!(ball().with_equilibrium(hertz(f64::NAN)).is_err());
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
