//! The table `[specimen]` to shape, size and stiffness of the body.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use palpate::{
    contact::{Base, Curve, Equilibrium, Shape, Sides, Specimen, ThinLayer, Tip},
    units::Dimension,
};

use super::tables::{BaseName, EquilibriumName, ShapeName, SpecimenTable};
use crate::description::text::{error::DescriptionError, quantity::QuantityText, source::Source};

impl SpecimenTable {
    /// The shape, or `None` where it is stated to be unknown.
    pub(crate) fn shape(&self, source: &Source<'_>) -> Result<Option<Shape>, DescriptionError> {
        self.check_sizes(source)?;
        let size = |name: &str, size: &Option<QuantityText>, dimension| match size {
            Some(size) => source.positive(&format!("specimen.{name}"), size, dimension),
            None => Err(source.missing(format!("specimen.{name}"), "a size")),
        };
        let length = |name: &str, given: &Option<QuantityText>| size(name, given, Dimension::Length);
        Ok(Some(match self.shape {
            ShapeName::None => return Ok(None),
            ShapeName::Ball => Shape::Ball {
                radius: length("radius", &self.radius)?,
            },
            ShapeName::Pad => {
                let (radius, thickness) = (length("radius", &self.radius)?, length("thickness", &self.thickness)?);
                if let Some(written) = self.thickness.as_ref().filter(|_| thickness > radius) {
                    let expected = "a thickness of at most the radius of the pad";
                    return Err(source.value("specimen.thickness", expected, written));
                }
                Shape::Pad { radius, thickness }
            }
            ShapeName::Strip => Shape::Prism {
                area: length("width", &self.width)? * length("thickness", &self.thickness)?,
                length: length("length", &self.length)?,
            },
            ShapeName::Dumbbell => {
                let (key, rows) = ("specimen.widths", self.widths.as_deref().unwrap_or_default());
                let rows = source.rows(key, rows, (Dimension::Length, Dimension::Length))?;
                let expected = "rows of place along the axis and width, from grip to grip";
                Shape::dumbbell(length("thickness", &self.thickness)?, &rows)
                    .map_err(|error| source.value(key, expected, &error))?
            }
            ShapeName::Cylinder => Shape::Prism {
                area: PI / 4.0 * length("diameter", &self.diameter)?.powi(2),
                length: length("length", &self.length)?,
            },
            // In shear: the section of the plate, and the gap at the rim.
            ShapeName::ConeAndPlate => {
                let (diameter, key) = (length("diameter", &self.diameter)?, "specimen.cone_angle");
                let angle = size("cone_angle", &self.cone_angle, Dimension::Angle)?;
                if angle >= FRAC_PI_4 {
                    let expected = "an angle below 45 deg, from the plate to the cone";
                    return Err(self.cone_angle.as_ref().map_or_else(
                        || source.missing(key, expected),
                        |written| source.value(key, expected, written),
                    ));
                }
                Shape::Prism {
                    area: PI / 4.0 * diameter.powi(2),
                    length: angle * diameter / 2.0,
                }
            }
            ShapeName::Block => Shape::Prism {
                area: size("area", &self.area, Dimension::Area)?,
                length: length("length", &self.length)?,
            },
            ShapeName::Profile => {
                let key = "specimen.areas";
                let rows = self.areas.as_deref().unwrap_or_default();
                let rows = source.rows(key, rows, (Dimension::Length, Dimension::Area))?;
                let expected = "rows of contact displacement and contact area";
                Shape::Profile {
                    depth: length("depth", &self.depth)?,
                    area: Curve::new(&rows).map_err(|error| source.value(key, expected, &error))?,
                }
            }
            ShapeName::SphericalTip => self.indenter(
                source,
                Tip::Sphere {
                    radius: length("radius", &self.radius)?,
                },
            )?,
            ShapeName::FlatPunch => self.indenter(
                source,
                Tip::Punch {
                    radius: length("radius", &self.radius)?,
                },
            )?,
            ShapeName::ConicalTip => self.indenter(
                source,
                Tip::Cone {
                    half_angle: self.half_angle(source)?,
                },
            )?,
            ShapeName::PyramidalTip => self.indenter(
                source,
                Tip::Pyramid {
                    half_angle: self.half_angle(source)?,
                },
            )?,
        }))
    }

    /// A tip on its sample.
    fn indenter(&self, source: &Source<'_>, tip: Tip) -> Result<Shape, DescriptionError> {
        let thickness = source.positive_if("specimen.thickness", self.thickness.as_ref(), Dimension::Length)?;
        if let (None, Some(base)) = (thickness, self.base) {
            let reason = format!("without thickness, of a sample that is a half space (found \"{base}\")");
            return Err(source.unused("specimen.base", reason, "give the thickness of the sample, or remove base"));
        }
        let base = match self.base {
            Some(BaseName::Sliding) => Base::Sliding,
            Some(BaseName::Bonded) | None => Base::Bonded,
        };
        let layer = thickness.map(|thickness| ThinLayer { thickness, base });
        Ok(Shape::Indenter { tip, layer })
    }

    /// Half angle of a tip, rad.
    fn half_angle(&self, source: &Source<'_>) -> Result<f64, DescriptionError> {
        let key = "specimen.half_angle";
        let written = self.half_angle.as_ref().ok_or_else(|| source.missing(key, "an angle"))?;
        let angle = source.positive(key, written, Dimension::Angle)?;
        if angle < FRAC_PI_2 {
            return Ok(angle);
        }
        Err(source.value(key, "an angle below 90 deg, from the axis to the surface of the tip", written))
    }

    /// Young's modulus in Pa, if it is given.
    pub(crate) fn modulus(&self, source: &Source<'_>) -> Result<Option<f64>, DescriptionError> {
        source.positive_if("specimen.modulus", self.modulus.as_ref(), Dimension::Pressure)
    }

    /// The body of a protocol, pressed from `sides`.
    pub(crate) fn body(&self, source: &Source<'_>, sides: Option<Sides>) -> Result<Specimen, DescriptionError> {
        let shape = self.known_shape(source)?;
        let sides = sides.unwrap_or_else(|| usual_sides(&shape));
        let modulus = match (self.modulus(source)?, &self.equilibrium_forces) {
            (Some(modulus), None) => modulus,
            // Nothing is made of it.
            (None, Some(_)) => 1.0,
            (Some(_), Some(_)) => return Err(source.both("specimen.equilibrium_forces", "specimen.modulus")),
            (None, None) => return Err(source.missing("specimen.modulus", "Young's modulus, such as \"28 kPa\"")),
        };
        let specimen =
            Specimen::new(shape, modulus, sides).map_err(|error| source.value("specimen", "a body", &error))?;
        let (key, equilibrium) = self.equilibrium(source)?;
        specimen
            .with_equilibrium(equilibrium)
            .map_err(|error| source.value(key, "a law that applies to the body", &error))
    }

    /// The law of the equilibrium force, and the key that says so.
    pub(crate) fn equilibrium(&self, source: &Source<'_>) -> Result<(&'static str, Equilibrium), DescriptionError> {
        let (named, ratio, measured) =
            ("specimen.equilibrium", "specimen.poisson_ratio", "specimen.equilibrium_forces");
        let usual = (self.shape.is_tip() && self.equilibrium_forces.is_none()).then_some(EquilibriumName::Hertz);
        match (self.equilibrium.or(usual), self.poisson_ratio, &self.equilibrium_forces) {
            (Some(_), _, Some(_)) => Err(source.both(measured, named)),
            (None | Some(EquilibriumName::UniformStrain), Some(_), _) => {
                let reason = "without equilibrium = \"hertz\", the only law that uses it";
                Err(source.unused(ratio, reason, "remove poisson_ratio"))
            }
            (Some(EquilibriumName::Hertz), None, _) => {
                Err(source.missing(ratio, "Poisson's ratio for Hertz's law, 0.5 for an incompressible body"))
            }
            (Some(EquilibriumName::Hertz), Some(found), None) => {
                let allowed = |found| (0.0..=0.5).contains(&found);
                let poisson_ratio = source.number(ratio, found, "a number from 0 to 0.5", allowed)?;
                Ok((named, Equilibrium::Hertz { poisson_ratio }))
            }
            (None, None, Some(forces)) => {
                let rows = source.rows(measured, forces, (Dimension::Length, Dimension::Force))?;
                let expected = "rows of contact displacement and force";
                let law = Equilibrium::measured(&rows).map_err(|error| source.value(measured, expected, &error))?;
                Ok((measured, law))
            }
            (None | Some(EquilibriumName::UniformStrain), None, None) => Ok((named, Equilibrium::UniformStrain)),
        }
    }

    /// The law by which a record gives modulus and strain: a table of forces has no modulus, and `is_material` says whether one may be there.
    pub(crate) fn equilibrium_of_test(
        &self,
        source: &Source<'_>,
        shape: &Shape,
        is_material: bool,
    ) -> Result<Equilibrium, DescriptionError> {
        let key = "specimen.equilibrium_forces";
        match self.equilibrium(source)? {
            (_, Equilibrium::Measured { .. }) if is_material => Ok(Equilibrium::UniformStrain),
            (_, Equilibrium::Measured { .. }) => {
                let reason = "in a test, whose strains are force over modulus and area";
                Err(source.unused(key, reason, "keep equilibrium_forces for a protocol"))
            }
            (key, law) => match law.check(shape) {
                Ok(()) => Ok(law),
                Err(error) => Err(source.value(key, "a law that applies to the body", &error)),
            },
        }
    }

    /// Refuses a body without a shape, which cannot be simulated.
    fn known_shape(&self, source: &Source<'_>) -> Result<Shape, DescriptionError> {
        self.shape(source)?.ok_or_else(|| {
            let expected = "the shape of a body, such as \"ball\"";
            source.value("specimen.shape", expected, "\"none\"")
        })
    }

    /// All sizes of the shape must be there, and no other.
    fn check_sizes(&self, source: &Source<'_>) -> Result<(), DescriptionError> {
        let shape = self.shape;
        let (wanted, optional) = (self.shape.sizes(), self.shape.optional());
        let rows = |rows: &Option<Vec<_>>| rows.as_ref().map(|rows| format!("{} rows", rows.len()));
        let written = |size: &Option<QuantityText>| size.as_ref().map(ToString::to_string);
        let given = [
            ("radius", written(&self.radius)),
            ("diameter", written(&self.diameter)),
            ("width", written(&self.width)),
            ("thickness", written(&self.thickness)),
            ("cone_angle", written(&self.cone_angle)),
            ("half_angle", written(&self.half_angle)),
            ("base", self.base.map(|base| format!("\"{base}\""))),
            ("area", written(&self.area)),
            ("length", written(&self.length)),
            ("depth", written(&self.depth)),
            ("widths", rows(&self.widths)),
            ("areas", rows(&self.areas)),
        ];
        for (name, size) in given {
            let key = format!("specimen.{name}");
            match size {
                Some(size) if !wanted.contains(&name) && !optional.contains(&name) => {
                    let sizes = match wanted {
                        [] => "has no sizes".to_owned(),
                        _ => format!("takes {}", [wanted, optional].concat().join(", ")),
                    };
                    let reason = format!("with shape = \"{shape}\", which {sizes} (found {size})");
                    return Err(source.unused(&key, &reason, format!("remove {name}")));
                }
                None if wanted.contains(&name) => {
                    let example = match name {
                        "area" => "\"40 mm^2\"",
                        "cone_angle" => "\"2 deg\"",
                        "half_angle" => "\"35 deg\"",
                        "thickness" if shape.is_tip() => "\"10 um\"",
                        "widths" => {
                            "[[\"0 mm\", \"12 mm\"], [\"10 mm\", \"4 mm\"], [\"30 mm\", \"4 mm\"], [\"40 mm\", \"12 mm\"]]"
                        }
                        "areas" => "[[\"0 mm\", \"0 mm^2\"], [\"1 mm\", \"40 mm^2\"]]",
                        _ => "\"35 mm\"",
                    };
                    let expected = format!("the {name} of a {shape}, such as {example}");
                    return Err(source.missing(key, &expected));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// From how many sides a body of this shape is squeezed where nothing is stated.
pub(crate) fn usual_sides(shape: &Shape) -> Sides {
    match shape {
        Shape::Ball { .. } => Sides::Two,
        Shape::Pad { .. } | Shape::Prism { .. } | Shape::Profile { .. } | Shape::Indenter { .. } => Sides::One,
    }
}
