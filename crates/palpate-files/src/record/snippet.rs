//! Lines to paste into a test description.

use palpate::units::Dimension;

use super::named::NamedColumn;
use crate::{
    naming::{Quantity, topic_and_field, unit_factor},
    table::{ColumnInfo, ColumnKind, recognise},
};

/// Most columns that a message shows.
const MOST: usize = 8;

/// All columns of a file, for a message.
pub(super) fn described(columns: &[ColumnInfo]) -> String {
    let named = columns.iter().any(|column| column.name.is_some());
    let what = if named { "no name for it" } else { "no names of columns" };
    let mut text = format!("{what} in {} columns", columns.len());
    for column in columns.iter().take(MOST) {
        let sample = if column.sample.is_empty() { "empty" } else { &column.sample };
        let kind = if column.kind == ColumnKind::Text { " (text)" } else { "" };
        text.push_str(&format!("\n  {}: {sample}{kind}", NamedColumn::from(column)));
    }
    if columns.len() > MOST {
        text.push_str(&format!("\n  … and {} more", columns.len() - MOST));
    }
    text
}

/// What a column could be called, for a message.
pub(super) fn choices(columns: &[ColumnInfo]) -> String {
    let count = columns.len();
    let names = columns.iter().filter_map(|column| column.name.as_deref());
    let mut names: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
    if names.len() > MOST {
        let more = names.len() - MOST;
        names.truncate(MOST);
        names.push(format!("… and {more} more"));
    }
    if names.is_empty() {
        return format!("a number from 1 to {count} (the columns have no names)");
    }
    format!("a number from 1 to {count} or a name that one column has ({})", names.join(", "))
}

/// The table `[columns]` for a file; where the header does not tell, columns of numbers in their order.
pub(super) fn of_columns(columns: &[ColumnInfo]) -> String {
    let wanted = [Quantity::Time, Quantity::Displacement, Quantity::Force];
    // The topics of a log have clocks of their own.
    let in_topic = |column: &ColumnInfo| column.name.as_deref().and_then(topic_and_field).is_some();
    let is_log = columns.iter().any(in_topic);
    let known = wanted.map(|quantity| match recognise::candidates(columns, quantity)[..] {
        [only] => Some(only),
        _ => None,
    });
    let free = |column: &&ColumnInfo| {
        let taken = known.iter().flatten().any(|known| known.number == column.number);
        column.kind == ColumnKind::Number && !taken && (!is_log || in_topic(column))
    };
    let mut rest: Vec<&ColumnInfo> = columns.iter().filter(free).collect();
    let mut lines = vec!["[columns]".to_owned()];
    let needed = wanted.into_iter().zip(known).filter(|(quantity, _)| !is_log || *quantity != Quantity::Time);
    for (quantity, known) in needed {
        let fitting = |unit: &str| unit_factor(unit, quantity.dimension()).is_some();
        // A unit tells, and one of another quantity tells against.
        let place = rest
            .iter()
            .position(|column| column.unit.as_deref().is_some_and(fitting))
            .or_else(|| rest.iter().position(|column| may_be(column, quantity)));
        let Some(column) = known.or_else(|| place.map(|place| rest.remove(place))) else {
            if quantity != Quantity::Displacement {
                lines.push(format!("# {quantity}: no candidate column remains"));
            }
            continue;
        };
        let volts = |unit: &&str| unit_factor(unit, Dimension::Voltage).is_some();
        let unit = match column.unit.as_deref() {
            Some(unit) if fitting(unit) => format!("unit = \"{unit}\""),
            Some(unit) if volts(&unit) => format!("unit = \"{unit}\", scale = \"1 {}/V\"", quantity.usual_unit()),
            _ => format!("unit = \"{}\"", quantity.usual_unit()),
        };
        let line = format!("{quantity} = {{ column = {}, {unit} }}", column.number);
        let name = column.name.as_deref().map_or_else(String::new, |name| format!("{name}, which "));
        let optional = if quantity == Quantity::Displacement { "; omit if there is none" } else { "" };
        lines.push(format!("{line}  # check: {name}starts with {}{optional}", column.sample));
    }
    lines.join("\n")
}

/// Whether a column could hold a quantity for all that its unit and name say.
fn may_be(column: &ColumnInfo, quantity: Quantity) -> bool {
    let another = |unit: &str| crate::naming::measures_another(unit, quantity);
    !column.unit.as_deref().is_some_and(another) && !recognise::is_bending(column)
}

/// The lines that say which column is the displacement, and those that say that there is none.
pub(super) fn of_unclear(candidates: &[NamedColumn], columns: &[ColumnInfo]) -> String {
    let number = candidates.first().map_or(1, |column| column.number);
    let unit = columns.get(number.wrapping_sub(1)).and_then(|column| column.unit.as_deref());
    let unit = unit.unwrap_or(Quantity::Displacement.usual_unit());
    let named = |quantity| match recognise::candidates(columns, quantity)[..] {
        [only] => Some(format!("[columns.{quantity}]\ncolumn = {}", only.number)),
        _ => None,
    };
    let force = named(Quantity::Force).or_else(|| named(Quantity::Stress));
    let without = force.map_or_else(String::new, |lines| format!("\nor, if it is not, name the force alone:\n{lines}"));
    // Heights of a cantilever's base fall as it comes down.
    let name = candidates.first().and_then(|column| column.name.as_deref()).unwrap_or("").to_lowercase();
    let sign = match name.as_str() {
        name if name.contains("height") => "\nsign = -1",
        name if name.contains("per ") => "\ndoubled = true  # of two fingers",
        _ => "",
    };
    format!(
        "if it is, state this in a test description:\n[columns.displacement]\ncolumn = {number}\nunit = \"{unit}\"{sign}{without}"
    )
}

/// The lines that say both the column and its unit, where its header says another.
pub(super) fn of_unit_and_column(key: &str, unit: &str, column: &NamedColumn) -> String {
    let (table, key) = key.rsplit_once('.').unwrap_or(("columns", key));
    format!("[{table}]\n{key} = \"{unit}\"\ncolumn = {}", column.number)
}

/// The lines that say the unit under `key`, such as `columns.force.unit`.
pub(super) fn of_unit(key: &str, unit: &str, column: &NamedColumn) -> String {
    let (table, key) = key.rsplit_once('.').unwrap_or(("columns", key));
    let column = if table.ends_with(".clock") { format!("column = {}\n", column.number) } else { String::new() };
    format!("[{table}]\n{column}{key} = \"{unit}\"")
}

/// The lines that make a force and an indentation of the bending of a cantilever in volts, which the file does not calibrate.
pub(super) fn of_bending(column: &NamedColumn, unit: &str) -> String {
    let number = column.number;
    format!(
        "the file lacks a sensitivity (m/V) or a spring constant (N/m): give the scale of a volt in a test description, \
         for 50 nm/V and 0.04 N/m\n[columns.force]\ncolumn = {number}\nunit = \"{unit}\"\nscale = \"2 nN/V\"\n\
         [columns.displacement]\ncolumn = \"measuredHeight\"\nsign = -1\n\
         [columns.deflection]\ncolumn = {number}\nunit = \"{unit}\"\nscale = \"50 nm/V\""
    )
}
