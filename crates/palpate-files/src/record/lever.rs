//! Columns of a machine that turns: torque and angle, which a lever arm makes force and travel.

use palpate::units::{self, Dimension};

use super::named::NamedColumn;
use crate::{naming::Quantity, table::ColumnInfo};

/// The arm of the examples, m.
const ARM: f64 = 0.05;

/// What a column of a machine that turns holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Turning {
    Torque,
    Degrees,
    Radians,
}

fn turning(unit: &str) -> Option<Turning> {
    let unit = unit.trim().to_lowercase();
    match unit.as_str() {
        "deg" | "°" | "degree" | "degrees" | "grad" => return Some(Turning::Degrees),
        "rad" | "radian" | "radians" => return Some(Turning::Radians),
        _ => {}
    }
    // "Nm", "N·m", "N*mm", "N-m": a force and a length with anything between them.
    let plain: String = unit.chars().filter(|letter| letter.is_alphanumeric()).collect();
    let known = Dimension::Torque.units().iter().map(|(symbol, _)| symbol.replace([' ', '·'], "").to_lowercase());
    let is_torque =
        known.into_iter().any(|symbol| symbol == plain) || units::factor(&unit, Dimension::Torque).is_some();
    is_torque.then_some(Turning::Torque)
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
                "a force and a length are needed: with a lever arm, write columns of torque / arm in N and of angle (rad) × arm in mm \
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
