//! Which column of a file holds what.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::{naming::Quantity, table::ColumnRef};

/// Description of one quantity; omitted fields are taken from the header of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnChoice {
    /// The column.
    pub column: Option<ColumnRef>,
    /// Its unit, one that its quantity takes.
    pub unit: Option<String>,
    /// The machine whose conventions say that unit, where the description itself does not.
    pub unit_by: Option<String>,
    /// Scale of a volt, in SI, where the column holds volts.
    pub scale: Option<f64>,
    /// Offset added to the scaled values, in SI, before the sign.
    pub offset: f64,
    /// 1, or −1 where the file has the opposite sign.
    pub sign: f64,
    /// A column that is added to it, where each finger of a gripper has its own.
    pub also: Option<ColumnRef>,
    /// The column holds the travel of one of two fingers: the travel is twice as long.
    pub doubled: bool,
    /// Travel in m while the column rises by one, where it does not count a length.
    pub travel_per_unit: Option<f64>,
    /// A clock of its own.
    pub clock: Option<ClockChoice>,
}

impl Default for ColumnChoice {
    fn default() -> Self {
        Self {
            column: None,
            unit: None,
            unit_by: None,
            scale: None,
            offset: 0.0,
            sign: 1.0,
            also: None,
            doubled: false,
            travel_per_unit: None,
            clock: None,
        }
    }
}

/// The time stamps of one quantity alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Clock")]
pub struct ClockChoice {
    /// Number of the column, from 1, or its name.
    pub column: ColumnRef,
    /// Unit, such as "s"; not needed where the header gives it.
    pub unit: Option<String>,
}

/// Which columns of a file hold what; `None`: recognised by the header of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ColumnChoices {
    /// Time.
    pub time: Option<ColumnChoice>,
    /// Displacement.
    pub displacement: Option<ColumnChoice>,
    /// Force; never together with stress.
    pub force: Option<ColumnChoice>,
    /// Stress, to be turned into force by the section of the specimen.
    pub stress: Option<ColumnChoice>,
    /// Deflection of the cantilever, to be taken off the displacement.
    pub deflection: Option<ColumnChoice>,
    /// Spring constant of the cantilever, N/m: the force is that times its deflection.
    pub spring_constant: Option<f64>,
}

impl ColumnChoices {
    /// What is stated about each column of which anything is, and what it measures.
    pub(crate) fn all(&self) -> Vec<(Quantity, &ColumnChoice)> {
        let stated = [
            (Quantity::Time, &self.time),
            (Quantity::Displacement, &self.displacement),
            (Quantity::Force, &self.force),
            (Quantity::Stress, &self.stress),
            (Quantity::Displacement, &self.deflection),
        ];
        stated.into_iter().filter_map(|(quantity, choice)| Some((quantity, choice.as_ref()?))).collect()
    }
}
