//! The tables `[specimen]`, `[law]` and `[contact]` of a body, as they stand in a protocol or a material.

use palpate::contact::Sides;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::description::text::quantity::QuantityText;

/// Shape, size and stiffness of the body. Give the sizes of its shape: a ball takes radius; a pad takes
/// radius and thickness; a strip takes width, thickness and length; a dumbbell takes thickness and widths; a cylinder takes diameter and length; a cone and plate takes diameter and cone_angle; a block takes area and length;
/// a profile takes depth and areas; a spherical tip or a flat punch takes radius and may take thickness and base; a conical or pyramidal tip
/// takes half_angle and thickness and may take base. Tips also take poisson_ratio.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Specimen")]
pub(crate) struct SpecimenTable {
    /// The shape of the body.
    pub(crate) shape: ShapeName,
    /// Radius of a ball, a spherical tip or a flat punch; outer radius of a pad.
    pub(crate) radius: Option<QuantityText>,
    /// Diameter of a cylinder that is loaded along its axis, or turned about it between parallel plates, and of a cone and plate.
    pub(crate) diameter: Option<QuantityText>,
    /// Angle between a cone and its plate, such as "2 deg".
    pub(crate) cone_angle: Option<QuantityText>,
    /// Width of the section of a strip.
    pub(crate) width: Option<QuantityText>,
    /// Thickness of the section of a strip or a dumbbell; of the soft layer of a pad, at most its radius; of the sample under a tip, a half space without it.
    pub(crate) thickness: Option<QuantityText>,
    /// Half angle of a conical or pyramidal tip, from its axis to its surface or face, such as "35 deg".
    pub(crate) half_angle: Option<QuantityText>,
    /// Far side of the sample under a tip, with its thickness: bonded (the default) to its rigid base, or sliding on it.
    pub(crate) base: Option<BaseName>,
    /// Area of the section of a block, which carries the force.
    pub(crate) area: Option<QuantityText>,
    /// Free length along the force, from grip to grip or plate to plate: of a strip, a cylinder or a block.
    pub(crate) length: Option<QuantityText>,
    /// Depth of a profile, from the undeformed contact to the plane that does not move.
    pub(crate) depth: Option<QuantityText>,
    /// Widths of a dumbbell along its axis, from grip to grip: rows of place and width, such as ["0 mm", "12 mm"].
    pub(crate) widths: Option<Vec<(QuantityText, QuantityText)>>,
    /// Contact area of a profile: rows of contact displacement and area, from first touch on, such as ["1 mm", "40 mm^2"].
    pub(crate) areas: Option<Vec<(QuantityText, QuantityText)>>,
    /// Young's modulus.
    pub(crate) modulus: Option<QuantityText>,
    /// Law of the equilibrium force: uniform strain (the paper's law, the default) or hertz (the default of tips).
    pub(crate) equilibrium: Option<EquilibriumName>,
    /// Poisson's ratio with hertz, from 0 to 0.5.
    pub(crate) poisson_ratio: Option<f64>,
    /// Measured equilibrium force, in a protocol: rows of contact displacement and force, from first touch on, such as
    /// ["1 mm", "0.2 N"]. In place of modulus and equilibrium.
    pub(crate) equilibrium_forces: Option<Vec<(QuantityText, QuantityText)>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[schemars(rename = "Equilibrium")]
pub(crate) enum EquilibriumName {
    /// Force = modulus × displacement/depth × contact area.
    #[serde(rename = "uniform strain")]
    UniformStrain,
    /// Force = 4/3 modulus/(1 − ν²) √radius displacement^(3/2) of a ball, a pad or a spherical tip; its extensions to other tips.
    #[serde(rename = "hertz")]
    Hertz,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[schemars(rename = "Base")]
#[serde(rename_all = "lowercase")]
pub(crate) enum BaseName {
    /// The sample adheres to a rigid base.
    Bonded,
    /// The sample slides on a rigid base without friction.
    Sliding,
}

shown_as_written!(BaseName);

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ShapeName {
    /// A ball between flat plates; the contact area grows with displacement.
    Ball,
    /// A spherical fingertip: a soft pad over a rigid core.
    Pad,
    /// A strip of rectangular section, pulled or pressed along its length.
    Strip,
    /// A dumbbell (ISO 37, ASTM D412) pulled along its length.
    Dumbbell,
    /// A cylinder, pulled or pressed along its axis, or turned between the parallel plates of a rheometer.
    Cylinder,
    /// The sample between the cone and the plate of a rheometer.
    #[serde(rename = "cone and plate")]
    ConeAndPlate,
    /// Any body of constant section.
    Block,
    /// Any other body, by a table of its contact area.
    Profile,
    /// A rigid sphere on the sample, such as a bead on a cantilever.
    #[serde(rename = "spherical tip")]
    SphericalTip,
    /// A rigid cone on the sample.
    #[serde(rename = "conical tip")]
    ConicalTip,
    /// A rigid four-sided pyramid on the sample.
    #[serde(rename = "pyramidal tip")]
    PyramidalTip,
    /// The flat end of a rigid cylinder on the sample.
    #[serde(rename = "flat punch")]
    FlatPunch,
    /// Unknown shape: palpate fits forces and computes no strain.
    None,
}

shown_as_written!(ShapeName);

impl ShapeName {
    /// The sizes that describe it; see also [`optional`](Self::optional).
    pub(crate) fn sizes(self) -> &'static [&'static str] {
        match self {
            Self::Ball => &["radius"],
            Self::Pad => &["radius", "thickness"],
            Self::Strip => &["width", "thickness", "length"],
            Self::Dumbbell => &["thickness", "widths"],
            Self::Cylinder => &["diameter", "length"],
            Self::ConeAndPlate => &["diameter", "cone_angle"],
            Self::Block => &["area", "length"],
            Self::Profile => &["depth", "areas"],
            Self::SphericalTip | Self::FlatPunch => &["radius"],
            Self::ConicalTip | Self::PyramidalTip => &["half_angle", "thickness"],
            Self::None => &[],
        }
    }

    /// What it may take besides its sizes.
    pub(crate) fn optional(self) -> &'static [&'static str] {
        match self {
            Self::SphericalTip | Self::FlatPunch => &["thickness", "base"],
            Self::ConicalTip | Self::PyramidalTip => &["base"],
            _ => &[],
        }
    }

    /// Whether it is the tip of an indenter.
    pub(crate) fn is_tip(self) -> bool {
        self.optional().contains(&"base")
    }
}

/// The law of the strain. Give its parameters: latency takes exponent and rate_coefficient, and may take strain_factor or
/// unloading_factor; standard-linear-solid takes
/// overshoot and time; prony takes terms; fung takes shares; fractional-zener takes overshoot, time and order.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Law")]
pub(crate) struct LawTable {
    pub(crate) name: LawName,
    /// Exponent n of the latency law, any number above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub(crate) exponent: Option<f64>,
    /// Rate coefficient v of the latency law, such as "2e4 /s".
    pub(crate) rate_coefficient: Option<QuantityText>,
    /// Factor by which v changes per 0.1 of equilibrium strain; rate_coefficient is then the value at first touch.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub(crate) strain_factor: Option<f64>,
    /// Ratio of the rate coefficient to v while strain rises to equilibrium, after unloading.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub(crate) unloading_factor: Option<f64>,
    /// Overshoot of the force after a step of displacement, as a multiple of the equilibrium force.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub(crate) overshoot: Option<f64>,
    /// Relaxation time, such as "2 s".
    pub(crate) time: Option<QuantityText>,
    /// Order of a fractional law, from 0.05 to below 1.
    pub(crate) order: Option<f64>,
    /// Terms of a Prony series: G = 1 + sum of overshoot exp(-t/time).
    #[schemars(extend("minItems" = 1))]
    pub(crate) terms: Option<Vec<TermTable>>,
    /// Terms of Fung's reduced relaxation function: g = c0 + sum of share exp(-rate t), all shares and c0 together 1.
    #[schemars(extend("minItems" = 1))]
    pub(crate) shares: Option<Vec<ShareTable>>,
    /// Memory of a linear law: strain, or the equilibrium force (quasi-linear). Default: strain; force with fung.
    pub(crate) memory: Option<MemoryName>,
}

/// A term of a Prony series.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Term")]
pub(crate) struct TermTable {
    /// Contribution of this term to the overshoot after a step of displacement, as a multiple of the equilibrium force.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub(crate) overshoot: f64,
    /// Its relaxation time, such as "2 s".
    pub(crate) time: QuantityText,
}

/// A term of Fung's reduced relaxation function.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Share")]
pub(crate) struct ShareTable {
    /// c, its share of the force immediately after a step of displacement.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub(crate) share: f64,
    /// Its rate ν, such as "0.5 /s".
    pub(crate) rate: QuantityText,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum LawName {
    /// The nonlinear latency law: strain rate = −v · sign(excess strain) · |excess strain|ⁿ.
    Latency,
    /// One relaxation time and a parallel spring (Zener).
    StandardLinearSolid,
    /// Several relaxation times and a parallel spring.
    Prony,
    /// Fung's reduced relaxation function of several terms.
    Fung,
    /// A fractional element and a parallel spring, accurate from 10⁻⁶ to 10⁶ times its relaxation time.
    FractionalZener,
}

#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum MemoryName {
    /// Strain: the force uses the current contact area.
    Strain,
    /// The equilibrium force, Fung's quasi-linear viscoelasticity.
    Force,
}

shown_as_written!(LawName);

impl LawName {
    /// The numbers that it needs.
    pub(crate) fn numbers(self) -> &'static [&'static str] {
        match self {
            Self::Latency => &["exponent", "rate_coefficient"],
            Self::StandardLinearSolid => &["overshoot", "time"],
            Self::Prony => &["terms"],
            Self::Fung => &["shares"],
            Self::FractionalZener => &["overshoot", "time", "order"],
        }
    }
}

/// How the jaw meets the body.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Contact", extend("not" = { "required": ["layers", "layer_thickness"] }))]
pub(crate) struct ContactTable {
    /// Number of layers, a real number of 1 or more; 8 unless layer_thickness is given.
    #[schemars(extend("minimum" = 1))]
    pub(crate) layers: Option<f64>,
    /// Thickness of one layer, instead of their number.
    pub(crate) layer_thickness: Option<QuantityText>,
    /// Default: two sides for a ball, one side for other shapes.
    pub(crate) squeezed_from: Option<SidesName>,
    /// true (the default): the jaw can only push and leaves the body when the force reaches zero.
    /// false: body and jaw are bonded, and the force may become tension.
    pub(crate) separation: Option<bool>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[schemars(rename = "Sides")]
pub(crate) enum SidesName {
    /// Both jaws meet the body: each contact takes half the travel of the jaw.
    #[serde(rename = "two sides")]
    Two,
    /// One jaw presses or pulls: its contact takes the whole travel.
    #[serde(rename = "one side")]
    One,
}

impl From<SidesName> for Sides {
    fn from(name: SidesName) -> Self {
        match name {
            SidesName::Two => Self::Two,
            SidesName::One => Self::One,
        }
    }
}
