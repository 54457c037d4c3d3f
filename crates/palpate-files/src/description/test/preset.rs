//! Grippers and machines whose conventions are known: parts of a test description under a name.
//!
//! `[machine] preset = "franka-hand"` in a test stands for the lines of that name. What the test says itself goes before.

use serde::Deserialize;
use toml::{Table, Value};

use super::tables::TestTables;
use crate::description::text::{
    error::{DescriptionError, KeyProblem},
    source::Source,
    words,
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

pub(super) const MACHINES: &[Machine] = machines![
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

/// Keys that exclude each other: where the test says one, the other of the preset falls away.
const EXCLUSIVE: [(&str, &str); 6] = [
    ("columns.force", "columns.stress"),
    ("columns.force", "columns.modulus"),
    ("columns.force", "columns.torque"),
    ("columns.time.unit", "columns.time.rate"),
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
    let other = |error: toml::de::Error| source.wrong(KEY, KeyProblem::Other(error.message().to_owned()));
    let stated: Table = source.text.parse().map_err(other)?;
    let mut tables: Table = machine.text.parse().map_err(other)?;
    for (one, another) in EXCLUSIVE {
        for (kept, dropped) in [(one, another), (another, one)] {
            if at(&stated, kept).is_some() {
                remove(&mut tables, dropped);
            }
        }
    }
    lay_over(&mut tables, stated);
    TestTables::deserialize(Value::Table(tables)).map_err(other)
}

/// What stands in a table at a path of two names or more.
fn at<'t>(table: &'t Table, path: &str) -> Option<&'t Value> {
    let (above, name) = path.rsplit_once('.')?;
    above.split('.').try_fold(table, |table, key| table.get(key)?.as_table())?.get(name)
}

fn remove(table: &mut Table, path: &str) -> Option<Value> {
    let (above, name) = path.rsplit_once('.')?;
    above.split('.').try_fold(table, |table, key| table.get_mut(key)?.as_table_mut())?.remove(name)
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
