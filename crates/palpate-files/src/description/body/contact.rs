//! What the tables `[contact]` of a protocol and of a test have in common.

use palpate::{analysis::LayersChoice, simulate::Separation, units::Dimension};

use crate::description::text::{error::DescriptionError, quantity::QuantityText, source::Source};

/// What `separation = true` or `false` means.
pub(crate) fn separation(jaw_may_leave: bool) -> Separation {
    if jaw_may_leave { Separation::Unilateral } else { Separation::Bonded }
}

/// The choice between `contact.layers` and `contact.layer_thickness` for a body of this depth (m).
pub(crate) fn layers(
    source: &Source<'_>,
    count: Option<f64>,
    thickness: Option<&QuantityText>,
    depth: f64,
) -> Result<Option<LayersChoice>, DescriptionError> {
    let key = "contact.layer_thickness";
    match (count, thickness) {
        (Some(_), Some(_)) => Err(source.both("contact.layers", key)),
        (None, None) => Ok(None),
        (Some(count), None) => {
            let count = source.number("contact.layers", count, "a number of 1 or more", |count| count >= 1.0);
            count.map(|count| Some(LayersChoice::Count(count)))
        }
        (None, Some(written)) => {
            let thickness = source.positive(key, written, Dimension::Length)?;
            if thickness > depth {
                let expected = format!("at most {} mm, the depth of the body", depth * 1e3);
                return Err(source.value(key, expected, written));
            }
            Ok(Some(LayersChoice::Thickness(thickness)))
        }
    }
}
