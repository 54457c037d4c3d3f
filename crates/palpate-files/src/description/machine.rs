//! Grippers and machines whose conventions are known: parts of a test description under a name.
//!
//! `[machine] preset = "franka-hand"` in a test stands for the lines of that name. What the test says itself goes before.

use std::path::Path;

use serde::Deserialize;
use toml::{Table, Value};

use super::{
    columns::{ColumnChoice, ColumnChoices},
    error::DescriptionError,
    places::Places,
    source::Source,
    test::parse_test,
    test_tables::TestTables,
    words,
};
use crate::{
    contents::{ColumnInfo, Part},
    record_file::{Quantity, unit_factor},
};

/// A part of a test description that belongs to a gripper or machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Machine {
    /// The name by which a test description refers to it.
    pub name: &'static str,
    /// The lines that it stands for, with where they are known from.
    pub text: &'static str,
}

impl Machine {
    /// What it is, in one line.
    #[must_use]
    pub fn about(&self) -> &'static str {
        self.text.lines().next().unwrap_or("").trim_start_matches(['#', ' '])
    }
}

/// The machines of the folder `machines/`, by name.
macro_rules! machines {
    ($($name:literal),* $(,)?) => {
        &[$(Machine { name: $name, text: include_str!(concat!("machines/", $name, ".toml")) }),*]
    };
}

const MACHINES: &[Machine] = machines![
    "aurora-600a",
    "franka-hand",
    "franka-hand-fr3",
    "instron-bluehill",
    "instron-bluehill-compressive",
    "instron-bluehill-tension",
    "jpk-afm",
    "jpk-afm-tip-position",
    "robotiq-2f85",
    "ros2-gripper-command",
    "ros2-two-fingers",
    "shimadzu-trapezium",
    "ta-xtplus",
    "ta-xtplus-grams",
    "wsg-50",
    "zwick-testxpert",
    "zwick-testxpert-french",
    "zwick-testxpert-german",
];

/// The grippers and machines whose conventions are known, by name.
///
/// ```
/// use palpate_files::description::machines;
/// assert!(machines().iter().any(|machine| machine.name == "franka-hand"));
/// ```
#[must_use]
pub fn machines() -> &'static [Machine] {
    MACHINES
}

/// The machines that name the columns of a test as its file does, all of them, with units that do not contradict it.
///
/// Several can: a squeeze and a stretch are told apart by nobody but the person who made the test.
#[must_use]
pub fn machines_of(part: &Part) -> Vec<&'static Machine> {
    let fits = |machine: &&Machine| {
        let Ok(test) = parse_test(machine.text, Path::new(machine.name)) else {
            return false;
        };
        let choices = test.columns.all();
        let is_there = |(quantity, choice): &(Quantity, &ColumnChoice)| {
            let named = choice.column.iter().chain(&choice.also);
            let found: Option<Vec<&ColumnInfo>> = named.map(|name| part.column_of(name)).collect();
            found.is_some_and(|found| found.iter().all(|column| !contradicts(*quantity, choice, column)))
        };
        choices.iter().any(|(_, choice)| choice.column.is_some()) && choices.iter().all(is_there)
    };
    MACHINES.iter().filter(fits).collect()
}

/// Whether the header of a column gives another unit of its quantity than is said of it.
pub(crate) fn contradicts(quantity: Quantity, choice: &ColumnChoice, column: &ColumnInfo) -> bool {
    let factor = |unit: Option<&str>| unit_factor(unit?, quantity.dimension());
    let (said, written) = (factor(choice.unit.as_deref()), factor(column.unit.as_deref()));
    said.is_some() && written.is_some() && said != written
}

/// Remembers which units of the columns the machine says and not the test itself.
pub(super) fn mark_units(source: &Source<'_>, machine: &str, columns: &mut ColumnChoices) {
    let places = Places::of(source.text);
    for (key, choice) in columns.all_mut() {
        let own = places.start_exactly(&format!("columns.{key}.unit")).is_some();
        if choice.unit.is_some() && !own {
            choice.unit_by = Some(machine.to_owned());
        }
    }
}

/// Keys that exclude each other: where the test says one, the other of the preset falls away.
const EXCLUSIVE: [(&str, &str); 3] = [
    ("columns.force", "columns.stress"),
    ("columns.displacement.unit", "columns.displacement.travel_per_unit"),
    ("columns.displacement.also", "columns.displacement.doubled"),
];

/// The tables of a test laid over those of its machine, if it names one.
pub(super) fn over_preset(source: &Source<'_>, own: TestTables) -> Result<TestTables, DescriptionError> {
    const KEY: &str = "machine.preset";
    let Some(name) = own.machine.preset.as_deref() else {
        return Ok(own);
    };
    let Some(machine) = MACHINES.iter().find(|machine| machine.name == name) else {
        let names: Vec<String> = MACHINES.iter().map(|machine| format!("\"{}\"", machine.name)).collect();
        return Err(source.value(KEY, words::any_of(&names), &format!("\"{name}\"")));
    };
    let other = |message: String| DescriptionError::Other {
        place: source.place(KEY),
        message,
    };
    let said: Table = source.text.parse().map_err(|error: toml::de::Error| other(error.message().to_owned()))?;
    let mut tables: Table = machine.text.parse().map_err(|error: toml::de::Error| other(error.message().to_owned()))?;
    for (one, another) in EXCLUSIVE {
        for (kept, dropped) in [(one, another), (another, one)] {
            if at(&said, kept).is_some() {
                remove(&mut tables, dropped);
            }
        }
    }
    lay_over(&mut tables, said);
    TestTables::deserialize(Value::Table(tables)).map_err(|error| other(error.message().to_owned()))
}

fn at<'t>(table: &'t Table, path: &str) -> Option<&'t Value> {
    match path.split_once('.') {
        None => table.get(path),
        Some((first, rest)) => at(table.get(first)?.as_table()?, rest),
    }
}

fn remove(table: &mut Table, path: &str) {
    match path.split_once('.') {
        None => {
            table.remove(path);
        }
        Some((first, rest)) => {
            if let Some(Value::Table(inner)) = table.get_mut(first) {
                remove(inner, rest);
            }
        }
    }
}

/// Puts every value of `upper` in place of that of `lower`; tables are laid over one another.
fn lay_over(lower: &mut Table, upper: Table) {
    for (key, value) in upper {
        match (lower.get_mut(&key), value) {
            (Some(Value::Table(below)), Value::Table(above)) => lay_over(below, above),
            (_, value) => {
                lower.insert(key, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::ColumnRef;

    #[test]
    fn every_preset_is_a_test_description_that_says_what_it_is() {
        for machine in machines() {
            let test = parse_test(&format!("machine.preset = \"{}\"", machine.name), Path::new("test.toml"));
            let test = test.unwrap_or_else(|error| panic!("{}: {error}", machine.name));
            assert!(test.columns.displacement.is_some(), "{}", machine.name);
            let about = machine.about();
            assert!((20..=88).contains(&about.chars().count()) && about.ends_with('.'), "{}: {about}", machine.name);
            parse_test(machine.text, Path::new(machine.name)).unwrap_or_else(|error| panic!("{error}"));
        }
        assert!(machines().is_sorted_by_key(|machine| machine.name));
    }

    #[test]
    fn the_test_itself_goes_before() {
        let text = "[machine]\npreset = \"franka-hand\"\n[columns.displacement]\ncolumn = 3\nsign = 1\n[columns]\n\
                    force = { column = \"ft\" }\n";
        let test = parse_test(text, Path::new("test.toml")).unwrap();
        let displacement = test.columns.displacement.unwrap();
        assert_eq!((displacement.column, displacement.sign), (Some(ColumnRef::Number(3)), 1.0));
        assert_eq!(displacement.also, Some(ColumnRef::Name("position[panda_finger_joint2]".to_owned())));
        assert_eq!(displacement.unit.as_deref(), Some("m"));
        let text = "machine.preset = \"robotiq-2f85\"\ncolumns.displacement.unit = \"mm\"\n";
        let displacement = parse_test(text, Path::new("test.toml")).unwrap().columns.displacement.unwrap();
        assert_eq!((displacement.unit.as_deref(), displacement.travel_per_unit), (Some("mm"), None));
    }

    #[test]
    fn an_unknown_name_is_answered_with_those_there_are() {
        let error = parse_test("[machine]\npreset = \"franka-hnd\"\n", Path::new("test.toml")).unwrap_err();
        let text = error.to_string();
        assert!(
            text.starts_with("test.toml, line 2: machine.preset: expected \"aurora-600a\", \"franka-hand\", "),
            "{text}"
        );
        assert_eq!(error.hint().as_deref(), Some("did you mean \"franka-hand\"?"));
    }
}
