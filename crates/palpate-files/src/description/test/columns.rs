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
    /// Of a time: the column counts samples, or without a column the rows do, so many a second, Hz.
    pub rate: Option<f64>,
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
            rate: None,
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
    /// Force; of force, stress, modulus and torque one at most is stated, and of displacement, strain, compliance and angle.
    pub force: Option<ColumnChoice>,
    /// Stress, to be turned into force by the section of the specimen.
    pub stress: Option<ColumnChoice>,
    /// Strain, to be turned into displacement by the length of the specimen.
    pub strain: Option<ColumnChoice>,
    /// Relaxation modulus: the stress at a strain of 1.
    pub modulus: Option<ColumnChoice>,
    /// Creep compliance: the strain at a stress of 1 Pa.
    pub compliance: Option<ColumnChoice>,
    /// Torque of a rheometer, to be turned into force by the sizes of the specimen.
    pub torque: Option<ColumnChoice>,
    /// Angle of a rheometer, to be turned into displacement.
    pub angle: Option<ColumnChoice>,
    /// Deflection of the cantilever, to be taken off the displacement.
    pub deflection: Option<ColumnChoice>,
    /// Columns that are not used, whatever their names say.
    pub unused: Vec<ColumnRef>,
    /// Spring constant of the cantilever, N/m: the force is that times its deflection.
    pub spring_constant: Option<f64>,
}

impl ColumnChoices {
    /// What is stated of one of several quantities.
    pub fn stated(&self, is_one: impl Fn(Quantity) -> bool) -> Option<(Quantity, &ColumnChoice)> {
        // The deflection of a cantilever comes behind the displacement, which it is taken off.
        self.all().into_iter().find(|(quantity, _)| is_one(*quantity))
    }

    /// What is stated about each column of which anything is, and what it measures.
    pub(crate) fn all(&self) -> Vec<(Quantity, &ColumnChoice)> {
        let deflection = self.deflection.iter().map(|choice| (Quantity::Displacement, choice));
        self.measured().chain(deflection).collect()
    }

    /// The same without the deflection, which is taken off a displacement.
    pub(super) fn measured(&self) -> impl Iterator<Item = (Quantity, &ColumnChoice)> {
        let stated = [
            (Quantity::Time, &self.time),
            (Quantity::Displacement, &self.displacement),
            (Quantity::Force, &self.force),
            (Quantity::Stress, &self.stress),
            (Quantity::Strain, &self.strain),
            (Quantity::Modulus, &self.modulus),
            (Quantity::Compliance, &self.compliance),
            (Quantity::Torque, &self.torque),
            (Quantity::Angle, &self.angle),
        ];
        stated.into_iter().filter_map(|(quantity, choice)| Some((quantity, choice.as_ref()?)))
    }
}
