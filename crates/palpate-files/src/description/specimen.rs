//! The table `[specimen]`: shape, size and stiffness of the body.

use std::f64::consts::PI;

use palpate::{
    contact::{Shape, Sides},
    units::Dimension,
};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{error::DescriptionError, quantity::QuantityText, source::Source};

/// Shape, size and stiffness of the body. Give the sizes that its shape needs: a ball takes radius; a pad takes
/// radius and thickness; a strip takes width, thickness and length; a cylinder takes diameter and length; a block takes area and length.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Specimen")]
pub(super) struct SpecimenTable {
    /// The shape of the body.
    shape: ShapeName,
    /// Radius of a ball; outer radius of a pad.
    pub(super) radius: Option<QuantityText>,
    /// Diameter of a cylinder that is loaded along its axis.
    pub(super) diameter: Option<QuantityText>,
    /// Width of the section of a strip.
    pub(super) width: Option<QuantityText>,
    /// Thickness of the section of a strip; of the soft layer of a pad, at most its radius.
    pub(super) thickness: Option<QuantityText>,
    /// Area of the section of a block, which carries the force.
    pub(super) area: Option<QuantityText>,
    /// Free length along the force, from grip to grip or plate to plate: of a strip, a cylinder or a block.
    pub(super) length: Option<QuantityText>,
    /// Young's modulus.
    pub(super) modulus: Option<QuantityText>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum ShapeName {
    /// A ball between flat plates; the contact grows with the squeeze.
    Ball,
    /// A spherical fingertip: a soft pad over a rigid core.
    Pad,
    /// A strip of rectangular section, pulled or pressed along its length.
    Strip,
    /// A cylinder, pulled or pressed along its axis.
    Cylinder,
    /// Any body of constant section.
    Block,
    /// Nothing is known: forces stay forces, no strain is computed.
    None,
}

impl ShapeName {
    fn name(self) -> &'static str {
        match self {
            Self::Ball => "ball",
            Self::Pad => "pad",
            Self::Strip => "strip",
            Self::Cylinder => "cylinder",
            Self::Block => "block",
            Self::None => "none",
        }
    }

    /// The sizes that describe it.
    fn sizes(self) -> &'static [&'static str] {
        match self {
            Self::Ball => &["radius"],
            Self::Pad => &["radius", "thickness"],
            Self::Strip => &["width", "thickness", "length"],
            Self::Cylinder => &["diameter", "length"],
            Self::Block => &["area", "length"],
            Self::None => &[],
        }
    }
}

impl SpecimenTable {
    /// The shape, or `None` where it is said to be unknown.
    pub(super) fn shape(&self, source: &Source<'_>) -> Result<Option<Shape>, DescriptionError> {
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
        }))
    }

    /// Young's modulus in Pa, if it is given.
    pub(super) fn modulus(&self, source: &Source<'_>) -> Result<Option<f64>, DescriptionError> {
        let modulus = self.modulus.as_ref();
        modulus.map(|modulus| source.positive("specimen.modulus", modulus, Dimension::Pressure)).transpose()
    }

    /// Refuses a body without a shape, which cannot be simulated.
    pub(super) fn known_shape(&self, source: &Source<'_>) -> Result<Shape, DescriptionError> {
        self.shape(source)?.ok_or_else(|| {
            let expected = "\"ball\", \"pad\", \"strip\", \"cylinder\" or \"block\"";
            source.value("specimen.shape", expected, "\"none\"")
        })
    }

    /// All sizes of the shape must be there, and no other.
    fn check_sizes(&self, source: &Source<'_>) -> Result<(), DescriptionError> {
        let shape = self.shape.name();
        let wanted = self.shape.sizes();
        let given = [
            ("radius", &self.radius),
            ("diameter", &self.diameter),
            ("width", &self.width),
            ("thickness", &self.thickness),
            ("area", &self.area),
            ("length", &self.length),
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
                    return Err(source.unused(&key, &reason, &format!("remove {name}")));
                }
                None if wanted.contains(&name) => {
                    let example = if name == "area" { "40 mm^2" } else { "35 mm" };
                    let expected = format!("the {name} of a {shape}, such as \"{example}\"");
                    return Err(source.missing(key, &expected));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// From how many sides a body of this shape is squeezed where nothing is said.
pub(super) fn usual_sides(shape: &Shape) -> Sides {
    match shape {
        Shape::Ball { .. } => Sides::Two,
        Shape::Pad { .. } | Shape::Prism { .. } => Sides::One,
    }
}
