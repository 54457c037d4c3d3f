//! The form of the body that is squeezed.

use core::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::{Curve, ThinLayer, Tip};

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

/// Shape of the body, all lengths in m and areas in m².
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "alloc",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", tag = "kind")
)]
pub enum Shape {
    /// A ball pressed by flat plates; the contact circle, in which a plane cuts the undeformed ball, grows with the squeeze: A = π (2 r u − u²)
    /// and ε_e = u/r, equations (7) and (8), for 0 ≤ u < r. The plane through the centre does not move, from one side as from two.
    Ball {
        /// Radius r in m.
        radius: f64,
    },
    /// A spherical fingertip: a soft pad of even thickness over a rigid core, pressed by a flat; equation (7) with the pad as deep as it is
    /// thick: A = π (2 R u − u²), and ε_e = u/thickness spreads evenly down to the core. For 0 ≤ u < thickness; good while the contact is wider
    /// than the pad is thick, and the pad free to bulge.
    Pad {
        /// Outer radius R in m.
        radius: f64,
        /// Thickness of the soft layer in m, at most the radius; equal to it, the pad is a ball without a core.
        thickness: f64,
    },
    /// A body of constant section: strip, block, cylinder or a flat punch on a layer. ε_e = u/length, of a body moved at both ends
    /// u/(length/2); u < length in compression, any length of a strip in grips; ends that slip or lie free of bulging.
    Prism {
        /// Cross-section that carries the force, in m².
        area: f64,
        /// Length along the force, in m: the whole length between the two grips or plates.
        length: f64,
    },
    /// Any other body, by a table of its contact area, a rising cubic between its rows; ε_e = u/depth. For 0 ≤ u up to the last row, and below
    /// the depth.
    Profile {
        /// Distance from an undeformed contact to the plane that does not move, in m.
        depth: f64,
        /// Contact area in m² at contact displacements in m, from first touch on.
        area: Curve,
    },
    /// The rigid tip of an indenter, pressed into a flat sample: area and force by [`Tip`], the force by Hertz's law
    /// ([`Equilibrium::Hertz`](super::Equilibrium::Hertz)). ε_e = u/depth is nominal, since the strain under a tip is not uniform: the depth is
    /// the thickness of the layer; of a half space the radius of a sphere or a punch. For 0 ≤ u below the depth.
    Indenter {
        /// The tip.
        tip: Tip,
        /// The sample: a half space without it. A cone and a pyramid need it, having no length of their own.
        layer: Option<ThinLayer>,
    },
}

/// A length or an area that a shape is described by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ShapeDimension {
    /// Radius of a ball, of a spherical tip or of a punch, outer radius of a pad, m.
    Radius,
    /// Thickness of a pad, or of the layer under a tip, m.
    Thickness,
    /// Section of a prism, m².
    Area,
    /// Length of a prism, m.
    Length,
    /// Depth of a profile, m.
    Depth,
    /// Half angle of a cone or pyramid, rad.
    HalfAngle,
}

impl ShapeDimension {
    /// Its name in a description.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Radius => "radius",
            Self::Thickness => "thickness",
            Self::Area => "area",
            Self::Length => "length",
            Self::Depth => "depth",
            Self::HalfAngle => "half_angle",
        }
    }

    /// Its SI unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Area => "m²",
            Self::HalfAngle => "rad",
            Self::Radius | Self::Thickness | Self::Length | Self::Depth => "m",
        }
    }
}

impl Shape {
    /// What it is described by.
    #[must_use]
    pub fn dimensions(&self) -> &'static [ShapeDimension] {
        match self {
            Self::Ball { .. } => &[ShapeDimension::Radius],
            Self::Pad { .. } => &[ShapeDimension::Radius, ShapeDimension::Thickness],
            Self::Prism { .. } => &[ShapeDimension::Area, ShapeDimension::Length],
            Self::Profile { .. } => &[ShapeDimension::Depth],
            Self::Indenter { tip, layer } => match (tip, layer) {
                (Tip::Sphere { .. } | Tip::Punch { .. }, None) => &[ShapeDimension::Radius],
                (Tip::Sphere { .. } | Tip::Punch { .. }, Some(_)) => {
                    &[ShapeDimension::Radius, ShapeDimension::Thickness]
                }
                (Tip::Cone { .. } | Tip::Pyramid { .. }, None) => &[ShapeDimension::HalfAngle],
                (Tip::Cone { .. } | Tip::Pyramid { .. }, Some(_)) => {
                    &[ShapeDimension::HalfAngle, ShapeDimension::Thickness]
                }
            },
        }
    }

    /// The value of one of its dimensions, to be changed.
    fn dimension_mut(&mut self, dimension: ShapeDimension) -> Option<&mut f64> {
        match (self, dimension) {
            (Self::Ball { radius } | Self::Pad { radius, .. }, ShapeDimension::Radius) => Some(radius),
            (Self::Pad { thickness, .. }, ShapeDimension::Thickness) => Some(thickness),
            (Self::Prism { area, .. }, ShapeDimension::Area) => Some(area),
            (Self::Prism { length, .. }, ShapeDimension::Length) => Some(length),
            (Self::Profile { depth, .. }, ShapeDimension::Depth) => Some(depth),
            (Self::Indenter { layer: Some(layer), .. }, ShapeDimension::Thickness) => Some(&mut layer.thickness),
            (Self::Indenter { tip, .. }, dimension) => match (tip, dimension) {
                (Tip::Sphere { radius } | Tip::Punch { radius }, ShapeDimension::Radius) => Some(radius),
                (Tip::Cone { half_angle } | Tip::Pyramid { half_angle }, ShapeDimension::HalfAngle) => Some(half_angle),
                _ => None,
            },
            _ => None,
        }
    }

    /// The same shape with one of its dimensions put through `change`; unchanged where it has no such dimension.
    #[cfg(feature = "std")]
    #[must_use]
    pub(crate) fn with(mut self, dimension: ShapeDimension, change: impl Fn(f64) -> f64) -> Self {
        if let Some(value) = self.dimension_mut(dimension) {
            *value = change(*value);
        }
        self
    }

    /// The value of one of its dimensions, in SI.
    #[must_use]
    pub fn dimension(&self, dimension: ShapeDimension) -> Option<f64> {
        self.clone().dimension_mut(dimension).map(|value| *value)
    }

    /// Distance from an undeformed contact to the plane that does not move, in m: the depth that is cut into layers.
    ///
    /// The radius of a ball; the thickness of a pad; the length of a prism, half of it when both ends move; what a profile says; the thickness
    /// of the layer under a tip, or else the radius of the tip.
    #[must_use]
    pub fn depth(&self, sides: Sides) -> f64 {
        match (self, sides) {
            (Self::Ball { radius }, _) => *radius,
            (Self::Pad { thickness, .. }, _) => *thickness,
            (Self::Prism { length, .. }, Sides::One) => *length,
            (Self::Prism { length, .. }, Sides::Two) => length / 2.0,
            (Self::Profile { depth, .. }, _) => *depth,
            (Self::Indenter { tip, layer }, _) => {
                layer.map_or_else(|| tip.length().unwrap_or(0.0), |layer| layer.thickness)
            }
        }
    }

    /// The rigid tip whose force on the body is that of the contact by Hertz's law: a rigid flat on an elastic ball is a rigid ball on an elastic
    /// half space.
    pub(super) fn tip(&self) -> Option<(Tip, Option<ThinLayer>)> {
        match self {
            Self::Ball { radius } | Self::Pad { radius, .. } => Some((Tip::Sphere { radius: *radius }, None)),
            Self::Indenter { tip, layer } => Some((*tip, *layer)),
            Self::Prism { .. } | Self::Profile { .. } => None,
        }
    }

    /// Contact area A in m² and its slope dA/du in m at contact displacement u (m).
    pub(super) fn area(&self, u: f64) -> (f64, f64) {
        match self {
            Self::Ball { radius } | Self::Pad { radius, .. } => {
                let growth = if u >= 0.0 { 2.0 * PI * (radius - u) } else { 0.0 };
                let u = u.max(0.0);
                (PI * u * (2.0 * radius - u), growth)
            }
            Self::Prism { area, .. } => (*area, 0.0),
            Self::Profile { area, .. } => area.value_and_slope(u),
            Self::Indenter { tip, .. } => tip.area(u),
        }
    }

    /// How deep the body can be squeezed.
    pub(super) fn limit(&self, sides: Sides) -> Limit {
        let depth = |name| Limit {
            at: self.depth(sides),
            name,
            included: false,
        };
        match (self, sides) {
            (Self::Ball { .. }, _) => depth("radius"),
            (Self::Pad { .. }, _) => depth("thickness of the pad"),
            (Self::Prism { .. }, Sides::One) => depth("length"),
            (Self::Prism { .. }, Sides::Two) => depth("half length"),
            (Self::Profile { area, .. }, _) => depth("depth").or_end(area.end(), "last row of the table of areas"),
            (Self::Indenter { layer: Some(_), .. }, _) => depth("thickness of the layer"),
            (Self::Indenter { layer: None, .. }, _) => depth("radius of the tip"),
        }
    }
}

/// The deepest contact displacement of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limit {
    /// Where it is, m.
    pub(crate) at: f64,
    /// What sets it.
    pub(crate) name: &'static str,
    /// Whether it may be reached: the end of a table or of a law may, the end of a body not.
    pub(crate) included: bool,
}

impl Limit {
    /// The end of a table or of a law if that comes first.
    pub(super) fn or_end(self, end: f64, name: &'static str) -> Self {
        if end < self.at {
            return Self {
                at: end,
                name,
                included: true,
            };
        }
        self
    }

    /// Whether a contact displacement (m) is beyond it.
    pub(crate) fn is_passed_by(self, contact_displacement: f64) -> bool {
        contact_displacement > self.at || (contact_displacement == self.at && !self.included)
    }
}
