//! Lines to paste into a test description.

use palpate::units::Dimension;

use super::named::NamedColumn;
use crate::{
    error::{few, shown},
    naming::{Quantity, topic_and_field, unit_factor},
    table::{ColumnInfo, ColumnKind, epoch, recognise},
};

/// Most columns that a message shows.
pub(super) const MOST: usize = 8;

/// Longest name, in bytes, that an option is proposed with.
const LONGEST: usize = 240;

/// All columns of a file, for a message.
pub(super) fn described(columns: &[ColumnInfo]) -> String {
    let named = columns.iter().any(|column| column.name.is_some());
    let what = if named { "no name for it" } else { "no names of columns" };
    let mut text = format!("{what} in {} columns", columns.len());
    for column in columns.iter().take(MOST) {
        let sample = if column.sample.is_empty() { "empty" } else { &column.first_value() };
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
    let named = |column: &ColumnInfo| {
        let unit = column.unit.as_deref().map_or_else(String::new, |unit| format!(" in {}", shown(unit)));
        Some(format!("\"{}\"{unit}", shown(column.name.as_deref()?)))
    };
    let names: Vec<String> = columns.iter().filter_map(named).collect();
    if names.is_empty() {
        return format!("a number from 1 to {count} (the columns have no names)");
    }
    let names = few(names.into_iter(), MOST, ", ");
    format!("a number from 1 to {count} or a name that one column has ({names})")
}

/// A column for a quantity as a message proposes it.
struct Proposed<'c> {
    quantity: Quantity,
    column: &'c ColumnInfo,
    unit: &'c str,
}

/// The option and the table `[columns]` for a file; where the header does not tell, columns of numbers in their order.
pub(super) fn of_columns(columns: &[ColumnInfo]) -> String {
    // The topics of a log have clocks of their own.
    let in_topic = |column: &ColumnInfo| column.name.as_deref().and_then(topic_and_field).is_some();
    let is_log = columns.iter().any(in_topic);
    let wanted = [Quantity::Time, Quantity::Displacement, Quantity::Force];
    let mut wanted = if is_log { wanted[1..].to_vec() } else { wanted.to_vec() };
    // A stress or a modulus over time serves where there is no force.
    let measures = |quantity: Quantity| {
        let unit = move |unit: &str| unit_factor(unit, quantity.dimension()).is_some();
        columns.iter().any(|column| column.unit.as_deref().is_some_and(unit))
    };
    if measures(Quantity::Stress) && !measures(Quantity::Force) {
        wanted.retain(|quantity| *quantity != Quantity::Force);
        wanted.push(Quantity::Stress);
    }
    let of = |wanted: &[Quantity]| proposed(columns, wanted, &|column| !is_log || in_topic(column));
    let is_load = |proposed: &Proposed<'_>| matches!(proposed.quantity, Quantity::Force | Quantity::Stress);
    let mut proposed = of(&wanted);
    if !proposed.iter().any(is_load) {
        // A record needs a force and does without a displacement: the one column beside the time is the force.
        let without: Vec<Quantity> = wanted.iter().copied().filter(|one| *one != Quantity::Displacement).collect();
        let again = of(&without);
        proposed = if again.iter().any(is_load) { again } else { proposed };
    }
    let mut lines = vec!["[columns]".to_owned()];
    for quantity in &wanted {
        match proposed.iter().find(|proposed| proposed.quantity == *quantity) {
            Some(proposed) => lines.push(line_of(proposed)),
            None if *quantity == Quantity::Displacement => {}
            None => lines.push(format!("# {quantity}: no candidate column remains")),
        }
    }
    let lines = lines.join("\n");
    let has = |quantity| proposed.iter().any(|proposed| proposed.quantity == quantity);
    let is_valid = (has(Quantity::Force) || has(Quantity::Stress)) && (is_log || has(Quantity::Time));
    // What a volt stands for is stated in a description alone.
    if !is_valid || proposed.iter().any(|proposed| is_volts(proposed.unit)) {
        return format!("assign the columns in a test description:\n{lines}");
    }
    let entries = proposed.iter().rev().map(|Proposed { quantity, column, unit }| {
        let same = columns.iter().filter(|other| other.name == column.name).count();
        entry(*quantity, &NamedColumn::from(*column), Some(unit), same == 1)
    });
    format!("assign the columns: {}, or in a test description:\n{lines}", option(entries))
}

fn proposed<'c>(
    columns: &'c [ColumnInfo],
    wanted: &[Quantity],
    may_be_free: &dyn Fn(&ColumnInfo) -> bool,
) -> Vec<Proposed<'c>> {
    let known = wanted.iter().map(|quantity| match recognise::candidates(columns, *quantity)[..] {
        [only] => Some(only),
        _ => None,
    });
    let known: Vec<Option<&ColumnInfo>> = known.collect();
    let free = |column: &&ColumnInfo| {
        let taken = known.iter().flatten().any(|known| known.number == column.number);
        column.kind == ColumnKind::Number && !taken && may_be_free(column)
    };
    let mut rest: Vec<&ColumnInfo> = columns.iter().filter(free).collect();
    let mut proposed = Vec::new();
    for (quantity, known) in wanted.iter().copied().zip(&known) {
        let fitting = |unit: &str| unit_factor(unit, quantity.dimension()).is_some();
        // A unit tells, and one of another quantity tells against.
        let place = rest
            .iter()
            .position(|column| column.unit.as_deref().is_some_and(fitting))
            .or_else(|| rest.iter().position(|column| recognise::may_be(column, quantity)));
        let Some(column) = known.or_else(|| place.map(|place| rest.remove(place))) else {
            continue;
        };
        let unit = match column.unit.as_deref() {
            Some(unit) if fitting(unit) || is_volts(unit) => unit,
            Some(unit) => quantity.unit_meant(unit),
            None => epoch::usual_unit(column, quantity),
        };
        proposed.push(Proposed { quantity, column, unit });
    }
    proposed
}

fn is_volts(unit: &str) -> bool {
    unit_factor(unit, Dimension::Voltage).is_some()
}

fn line_of(Proposed { quantity, column, unit }: &Proposed<'_>) -> String {
    let scale = if is_volts(unit) { format!(", scale = \"1 {}/V\"", quantity.usual_unit()) } else { String::new() };
    let name = column.name.as_deref().map_or_else(String::new, |name| format!("{}, which ", shown(name)));
    let optional = if *quantity == Quantity::Displacement { "; omit if there is none" } else { "" };
    let number = column.number;
    format!(
        "{quantity} = {{ column = {number}, unit = \"{unit}\"{scale} }}  # check: {name}starts with {}{optional}",
        column.first_value()
    )
}

/// Columns as the option takes them, such as `--columns "force=Kraft:N"`.
pub(super) fn option(entries: impl IntoIterator<Item = String>) -> String {
    format!("--columns \"{}\"", entries.into_iter().collect::<Vec<_>>().join(","))
}

/// One column as the option takes it: by its name, or by its number where the name has a twin, or is not safe in a list or a shell.
pub(super) fn entry(quantity: Quantity, column: &NamedColumn, unit: Option<&str>, has_no_twin: bool) -> String {
    let plain = |name: &&String| {
        let parts = |letter: char| "\"$`\\!:,=\u{FFFD}".contains(letter) || letter.is_control();
        has_no_twin
            && name.len() <= LONGEST
            && !name.contains(parts)
            && name.trim() == *name
            && name.parse::<f64>().is_err()
    };
    let name = column.name.as_ref().filter(plain).map_or_else(|| column.number.to_string(), String::clone);
    let unit = unit.map_or_else(String::new, |unit| format!(":{unit}"));
    format!("{quantity}={name}{unit}")
}

/// What would say the units of columns that are written nowhere, and the displacement where a column of unknown name may be it.
pub(super) fn of_missing_units(
    without: &[(String, &'static str, NamedColumn)],
    travel: Option<&NamedColumn>,
) -> String {
    let quantity = Quantity::Displacement;
    let usual = quantity.usual_unit();
    let lines = without.iter().map(|(key, unit, column)| of_unit(key, unit, column));
    let of_strain = |key: &String| quantity_of(key) == Some(Quantity::Strain);
    let ratio = if without.iter().any(|(key, ..)| of_strain(key)) {
        ", a strain in % or as a ratio in 1"
    } else {
        ""
    };
    let travels = travel.map(|column| {
        format!(
            "[columns.{quantity}]\nunit = \"{usual}\"\ncolumn = {}  # check; omit if there is none",
            column.number
        )
    });
    let lines = lines.chain(travels).collect::<Vec<_>>().join("\n");
    let stated = without.iter().map(|(key, unit, column)| Some(entry(quantity_of(key)?, column, Some(unit), true)));
    let travels = travel.map(|column| Some(entry(quantity, column, Some(usual), true)));
    match stated.chain(travels).collect::<Option<Vec<_>>>() {
        Some(stated) => format!("state it{ratio}: {}, or in a test description:\n{lines}", option(stated)),
        None => format!("state it in a test description:\n{lines}"),
    }
}

/// The quantity whose own table is meant by a key such as `columns.force.unit`.
pub(super) fn quantity_of(key: &str) -> Option<Quantity> {
    let table = key.strip_prefix("columns.")?.strip_suffix(".unit")?;
    Quantity::ALL.into_iter().find(|quantity| quantity.to_string() == table)
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
    let stated = candidates.first().filter(|_| sign.is_empty()).map_or_else(String::new, |column| {
        format!(": {}, or", option([entry(Quantity::Displacement, column, Some(unit), true)]))
    });
    format!(
        "if it is, state this{stated} in a test description:\n[columns.displacement]\ncolumn = {number}\nunit = \"{unit}\"{sign}{without}"
    )
}

/// The lines that say both the column and its unit, where its header says another.
pub(super) fn of_unit_and_column(key: &str, unit: &str, column: &NamedColumn) -> String {
    let (table, key) = key.rsplit_once('.').unwrap_or(("columns", key));
    format!("[{table}]\n{key} = \"{unit}\"\ncolumn = {}", column.number)
}

/// The option and the lines that say both the column and its unit, as the end of a sentence.
pub(super) fn of_unit_stated(key: &str, unit: &str, column: &NamedColumn) -> String {
    let lines = of_unit_and_column(key, unit, column);
    let stated = quantity_of(key)
        .map_or_else(String::new, |quantity| format!(": {}, or", option([entry(quantity, column, Some(unit), true)])));
    format!("{stated} in a test description:\n{lines}")
}

/// What would say the unit of a column of shares.
pub(super) fn of_share(key: &str, quantity: Quantity, column: &NamedColumn) -> String {
    let unit = quantity.usual_unit();
    let strain = match quantity {
        Quantity::Displacement => {
            let strain = option([entry(Quantity::Strain, column, Some("%"), true)]);
            format!("; of a strain: {strain}; if there is no displacement, name the force alone")
        }
        _ => String::new(),
    };
    let stated = of_unit_stated(key, &format!("x5 {unit}"), column);
    format!("state what one per cent is{strain}; of a full scale of 500 {unit} it is 5 {unit}{stated}")
}

/// What helps where stress and strain are true ones, and what says that they are not.
pub(super) fn of_true_measures(columns: &[(Quantity, NamedColumn)]) -> String {
    let stated = option(columns.iter().map(|(quantity, column)| entry(*quantity, column, None, true)));
    let lines = columns.iter().map(|(quantity, column)| format!("[columns.{quantity}]\ncolumn = {}", column.number));
    format!(
        "export engineering (nominal) stress and strain, or force and displacement; if these are engineering ones, name them: {stated}, or in \
         a test description:\n{}",
        lines.collect::<Vec<_>>().join("\n")
    )
}

/// The lines that say the unit under `key`, such as `columns.force.unit`.
pub(super) fn of_unit(key: &str, unit: &str, column: &NamedColumn) -> String {
    let (table, key) = key.rsplit_once('.').unwrap_or(("columns", key));
    let column = if table.ends_with(".clock") { format!("column = {}\n", column.number) } else { String::new() };
    format!("[{table}]\n{column}{key} = \"{unit}\"")
}

/// The lines that make a force and an indentation of the deflection of a cantilever whose spring constant the file does not state.
pub(super) fn of_deflection(column: &NamedColumn, height: Option<usize>) -> String {
    let height = height.map_or_else(|| "\"measuredHeight\"".to_owned(), |number| number.to_string());
    format!(
        "the force is the deflection times the spring constant: state it in a test description, for 0.04 N/m\n\
         [columns.deflection]\ncolumn = {}\nspring_constant = \"0.04 N/m\"\n\
         [columns.displacement]\ncolumn = {height}\nsign = -1",
        column.number
    )
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
