//! The shapes that a description can name, for those who ask a person for one.

use serde::Serialize;

use super::tables::ShapeName;

/// A shape, by its name in a description.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ShapeAbout {
    /// Its name.
    pub name: String,
    /// The keys of the sizes that it needs.
    pub sizes: &'static [&'static str],
    /// The keys that it may have besides.
    pub optional: &'static [&'static str],
    /// Whether it is the tip of an indenter, which takes a Poisson's ratio.
    pub is_tip: bool,
}

/// All shapes, as `[specimen] shape` takes them.
///
/// ```
/// let shapes = palpate_files::description::shapes();
/// let ball = shapes.iter().find(|shape| shape.name == "ball").unwrap();
/// assert_eq!((ball.sizes, ball.is_tip), (&["radius"][..], false));
/// ```
#[must_use]
pub fn shapes() -> Vec<ShapeAbout> {
    use ShapeName::{
        Ball, Block, ConeAndPlate, ConicalTip, Cylinder, Dumbbell, FlatPunch, None, Pad, Profile, PyramidalTip,
        SphericalTip, Strip,
    };
    let all = [
        Ball,
        Pad,
        Strip,
        Dumbbell,
        Cylinder,
        ConeAndPlate,
        Block,
        Profile,
        SphericalTip,
        ConicalTip,
        PyramidalTip,
        FlatPunch,
        None,
    ];
    let about = |shape: ShapeName| ShapeAbout {
        name: shape.to_string(),
        sizes: shape.sizes(),
        optional: shape.optional(),
        is_tip: shape.is_tip(),
    };
    all.map(about).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_shape_is_left_out() {
        let schema = schemars::schema_for!(ShapeName).to_value();
        let named = schema["oneOf"].as_array().unwrap();
        let mut named: Vec<&str> = named.iter().map(|shape| shape["const"].as_str().unwrap()).collect();
        let shapes = shapes();
        let mut listed: Vec<&str> = shapes.iter().map(|shape| shape.name.as_str()).collect();
        named.sort_unstable();
        listed.sort_unstable();
        assert_eq!(named, listed);
    }
}
