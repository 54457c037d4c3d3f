//! The table `[specimen]` to shape, size and stiffness of the body.

use std::f64::consts::PI;

use palpate::{
    contact::{Curve, Equilibrium, Shape, Sides, Specimen},
    units::Dimension,
};

use super::tables::{EquilibriumName, ShapeName, SpecimenTable};
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
            ShapeName::Cylinder => Shape::Prism {
                area: PI / 4.0 * length("diameter", &self.diameter)?.powi(2),
                length: length("length", &self.length)?,
            },
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
        }))
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
    fn equilibrium(&self, source: &Source<'_>) -> Result<(&'static str, Equilibrium), DescriptionError> {
        let (named, ratio, measured) =
            ("specimen.equilibrium", "specimen.poisson_ratio", "specimen.equilibrium_forces");
        match (self.equilibrium, self.poisson_ratio, &self.equilibrium_forces) {
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

    /// Refuses laws of the equilibrium force where one is found from a record.
    pub(crate) fn no_equilibrium(&self, source: &Source<'_>) -> Result<(), DescriptionError> {
        let given = [
            ("equilibrium", self.equilibrium.is_some()),
            ("poisson_ratio", self.poisson_ratio.is_some()),
            ("equilibrium_forces", self.equilibrium_forces.is_some()),
        ];
        match given.iter().find(|(_, given)| *given) {
            Some((name, _)) => {
                let reason = "in a test, whose strains are force over modulus and area";
                Err(source.unused(format!("specimen.{name}"), reason, format!("keep {name} for a protocol")))
            }
            None => Ok(()),
        }
    }

    /// Refuses a body without a shape, which cannot be simulated.
    fn known_shape(&self, source: &Source<'_>) -> Result<Shape, DescriptionError> {
        self.shape(source)?.ok_or_else(|| {
            let expected = "\"ball\", \"pad\", \"strip\", \"cylinder\", \"block\" or \"profile\"";
            source.value("specimen.shape", expected, "\"none\"")
        })
    }

    /// All sizes of the shape must be there, and no other.
    fn check_sizes(&self, source: &Source<'_>) -> Result<(), DescriptionError> {
        let shape = self.shape;
        let wanted = self.shape.sizes();
        let areas = self.areas.as_ref().map(|rows| format!("{} rows", rows.len()));
        let written = |size: &Option<QuantityText>| size.as_ref().map(ToString::to_string);
        let given = [
            ("radius", written(&self.radius)),
            ("diameter", written(&self.diameter)),
            ("width", written(&self.width)),
            ("thickness", written(&self.thickness)),
            ("area", written(&self.area)),
            ("length", written(&self.length)),
            ("depth", written(&self.depth)),
            ("areas", areas),
        ];
        for (name, size) in given {
            let key = format!("specimen.{name}");
            match size {
                Some(size) if !wanted.contains(&name) => {
                    let sizes = match wanted {
                        [] => "has no sizes".to_owned(),
                        _ => format!("takes {}", wanted.join(", ")),
                    };
                    let reason = format!("with shape = \"{shape}\", which {sizes} (found {size})");
                    return Err(source.unused(&key, &reason, format!("remove {name}")));
                }
                None if wanted.contains(&name) => {
                    let example = match name {
                        "area" => "\"40 mm^2\"",
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
        Shape::Pad { .. } | Shape::Prism { .. } | Shape::Profile { .. } => Sides::One,
    }
}
