//! Columns of a machine that turns: torque and angle, which a lever arm makes force and travel.

use palpate::units::Dimension;

use super::named::NamedColumn;
use crate::{
    naming::{Quantity, unit_factor},
    table::ColumnInfo,
};

/// The arm of the examples, m.
const ARM: f64 = 0.05;

/// How the sample of a rheometer is described.
pub(super) const SAMPLE: &str = "describe the sample, between parallel plates as\n[specimen]\nshape = \"cylinder\"\n\
    diameter = \"25 mm\"\nlength = \"1 mm\"  # the gap\nor with shape = \"cone and plate\" (diameter, cone_angle) or \"strip\" (width, \
    thickness, length)";

/// What a column of a machine that turns holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Turning {
    Torque,
    Degrees,
    Radians,
}

fn turning(written: &str) -> Option<Turning> {
    match written.trim().to_lowercase().as_str() {
        "deg" | "°" | "degree" | "degrees" | "grad" => return Some(Turning::Degrees),
        "rad" | "radian" | "radians" => return Some(Turning::Radians),
        _ => {}
    }
    unit_factor(written, Dimension::Torque).is_some().then_some(Turning::Torque)
}

/// Whether a column holds a torque or an angle.
pub(super) fn turns(column: &ColumnInfo) -> bool {
    column.unit.as_deref().is_some_and(|unit| turning(unit).is_some())
}

/// What would help where one of the columns turns; none where none does.
pub(super) fn hint_of(columns: &[ColumnInfo]) -> Option<String> {
    let first = columns.iter().find(|column| turns(column))?;
    let torque = columns.iter().find(|column| column.unit.as_deref().and_then(turning) == Some(Turning::Torque));
    let column = torque.unwrap_or(first);
    hint_of_unit(
        column.unit.as_deref()?,
        &column.into(),
        if torque.is_some() { Quantity::Force } else { Quantity::Displacement },
    )
}

/// What would help where a column that should hold a quantity has a unit of torque or angle.
pub(super) fn hint_of_unit(unit: &str, column: &NamedColumn, quantity: Quantity) -> Option<String> {
    let (arm, number) = (1e3 * ARM, column.number);
    let per_unit = match (turning(unit)?, quantity) {
        (Turning::Degrees, Quantity::Displacement) => format!("{:.4} mm", (1e3 * ARM).to_radians()),
        (Turning::Radians, Quantity::Displacement) => format!("{arm} mm"),
        _ => {
            return Some(format!(
                "a force and a length are needed: of a rheometer describe the sample (shape = \"cylinder\" between parallel plates, \
                 \"cone and plate\", or \"strip\") in [specimen]; with a lever arm, write columns of torque / arm in N and of angle (rad) × arm in mm \
                 to the file; at an arm of {arm} mm, 1 N m is {} N and 1° is {:.4} mm",
                1.0 / ARM,
                (1e3 * ARM).to_radians()
            ));
        }
    };
    Some(format!(
        "an angle becomes a travel by its lever arm; for one of {arm} mm say in a test description:\n\
         [columns.displacement]\ncolumn = {number}\ntravel_per_unit = \"{per_unit}\""
    ))
}
