//! The tables `[columns.…]` of a test, as they stand in the file.

use palpate::units::{Dimension, UnitError};
use schemars::JsonSchema;
use serde::Deserialize;

use super::columns::{ClockChoice, ColumnChoice, ColumnChoices};
use crate::{
    description::text::{error::DescriptionError, places::Places, quantity::QuantityText, source::Source},
    naming::{Quantity, unit_factor, volts_are},
    table::{ColumnRef, EPOCH},
};

/// Assignment of columns. Omitted columns are recognised by the header of the file.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Columns", extend("not" = { "anyOf": [
    { "required": ["force", "stress"] },
    { "required": ["force", "modulus"] },
    { "required": ["force", "torque"] },
    { "required": ["stress", "modulus"] },
    { "required": ["stress", "torque"] },
    { "required": ["modulus", "torque"] },
    { "required": ["displacement", "strain"] },
    { "required": ["displacement", "compliance"] },
    { "required": ["displacement", "angle"] },
    { "required": ["strain", "compliance"] },
    { "required": ["strain", "angle"] },
    { "required": ["compliance", "angle"] },
] }))]
pub(crate) struct ColumnsTable {
    /// Time. Not needed where displacement and force have clocks of their own.
    time: Option<TimeTable>,
    /// Travel of the jaw. Without it the phases are derived from the force.
    displacement: Option<DisplacementTable>,
    /// Force.
    force: Option<ColumnTable>,
    /// Stress instead of force; the section of the specimen turns it into force.
    stress: Option<ColumnTable>,
    /// Strain instead of displacement; the length of the specimen turns it into displacement.
    strain: Option<ColumnTable>,
    /// Relaxation modulus E(t) or G(t) instead of force: the stress at a strain of 1.
    modulus: Option<ColumnTable>,
    /// Creep compliance J(t) or D(t) instead of displacement, without a force: the strain at a stress of 1 Pa.
    compliance: Option<ColumnTable>,
    /// Torque instead of force, of a rheometer: the sizes of the specimen turn it into force.
    torque: Option<ColumnTable>,
    /// Angle instead of displacement, of a rheometer: the sizes of the specimen turn it into displacement.
    angle: Option<ColumnTable>,
    /// Deflection of the cantilever of an AFM, subtracted from the displacement, which is then that of the cantilever's base.
    deflection: Option<DeflectionTable>,
    /// Numbers, from 1, or names of columns that are not used, whatever their names say.
    #[serde(default)]
    unused: Vec<ColumnRef>,
}

/// The column of the time.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "TimeColumn", extend("not" = { "required": ["unit", "rate"] }))]
struct TimeTable {
    /// Number of the column, from 1, or its name.
    column: Option<ColumnRef>,
    /// Unit, such as "s"; not needed where the header gives it.
    unit: Option<String>,
    /// Instead of a unit: samples a second, such as "10 kHz", where the column counts samples or, without a column, the rows do.
    rate: Option<QuantityText>,
}

/// The column of a measured quantity.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Column")]
struct ColumnTable {
    /// Number of the column, from 1, or its name.
    column: Option<ColumnRef>,
    /// Unit, such as "mm" or "N"; not needed where the header gives it.
    unit: Option<String>,
    /// Scale of a volt, such as "12.5 N/V"; the unit is then "V" or "mV".
    scale: Option<String>,
    /// Offset, such as "0.2 N": value × scale + offset, then the sign.
    offset: Option<QuantityText>,
    /// -1 where the file counts loading as negative; 1 otherwise.
    #[schemars(extend("enum" = [1, -1]))]
    sign: Option<f64>,
    /// Time stamps of this quantity alone, where it has its own.
    clock: Option<ClockChoice>,
}

/// The column of the travel of the jaw.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "DisplacementColumn", extend("not" = { "required": ["unit", "travel_per_unit"] }))]
struct DisplacementTable {
    /// Number of the column, from 1, or its name.
    column: Option<ColumnRef>,
    /// Unit, such as "mm"; not needed where the header gives it.
    unit: Option<String>,
    /// Scale of a volt, such as "12.5 mm/V"; the unit is then "V" or "mV".
    scale: Option<String>,
    /// Offset, such as "0.2 mm": value × scale + offset, then the sign.
    offset: Option<QuantityText>,
    /// -1 where the file counts loading as negative, such as the opening of a gripper; 1 otherwise.
    #[schemars(extend("enum" = [1, -1]))]
    sign: Option<f64>,
    /// A column that is added to it, where each finger of a gripper has its own.
    also: Option<ColumnRef>,
    /// true: the column holds the travel of one of two fingers that move alike.
    doubled: Option<bool>,
    /// Instead of a unit: travel while the column rises by one, where it counts an angle or a share of the stroke.
    travel_per_unit: Option<QuantityText>,
    /// Time stamps of this quantity alone, where it has its own.
    clock: Option<ClockChoice>,
}

/// The column of the deflection of a cantilever.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "DeflectionColumn")]
struct DeflectionTable {
    /// Number of the column, from 1, or its name.
    column: ColumnRef,
    /// Unit, such as "nm"; not needed where the header gives it.
    unit: Option<String>,
    /// Sensitivity, such as "52 nm/V", where the column holds volts; the unit is then "V" or "mV".
    scale: Option<String>,
    /// Spring constant of the cantilever, such as "0.04 N/m": the force is then the deflection times it. Without it and without a column of
    /// force, the spring constant that stands in the file is taken.
    spring_constant: Option<QuantityText>,
    /// -1 where the file counts the deflection as negative when the sample pushes; 1 otherwise.
    #[schemars(extend("enum" = [1, -1]))]
    sign: Option<f64>,
}

impl ColumnsTable {
    /// The choices; `machine` has stated what the text itself does not.
    pub(super) fn checked(self, source: &Source<'_>, machine: Option<&str>) -> Result<ColumnChoices, DescriptionError> {
        let given = [
            ("columns.force", self.force.is_some(), true),
            ("columns.stress", self.stress.is_some(), true),
            ("columns.modulus", self.modulus.is_some(), true),
            ("columns.torque", self.torque.is_some(), true),
            ("columns.displacement", self.displacement.is_some(), false),
            ("columns.strain", self.strain.is_some(), false),
            ("columns.compliance", self.compliance.is_some(), false),
            ("columns.angle", self.angle.is_some(), false),
        ];
        for of_load in [true, false] {
            let mut stated = given.iter().filter(|(_, given, is_load)| *given && *is_load == of_load);
            if let (Some((one, ..)), Some((other, ..))) = (stated.next(), stated.next()) {
                return Err(source.both(*one, *other));
            }
        }
        // What a header calls a displacement may be one of which the deflection is off already.
        let names_height = self.displacement.as_ref().is_some_and(|table| table.column.is_some());
        let time = self.time.map(|time| time.checked(source, machine)).transpose()?;
        let spring_constant = self.deflection.as_ref().and_then(|table| table.spring_constant.as_ref());
        let spring_key = "columns.deflection.spring_constant";
        if let (Some(_), Some((key, ..))) =
            (spring_constant, given.iter().find(|(_, given, is_load)| *given && *is_load))
        {
            return Err(source.both(spring_key, *key));
        }
        let spring_constant = source.positive_if(spring_key, spring_constant, Dimension::Stiffness)?;
        let deflection = self.deflection.map(|table| ColumnTable {
            column: Some(table.column),
            unit: table.unit,
            scale: table.scale,
            sign: table.sign,
            ..ColumnTable::default()
        });
        let measured = |table: Option<ColumnTable>, key, quantity| {
            table.map(|table| table.checked(source, machine, key, quantity)).transpose()
        };
        Ok(ColumnChoices {
            time,
            displacement: self.displacement.map(|table| table.checked(source, machine)).transpose()?,
            force: measured(self.force, "force", Quantity::Force)?,
            stress: measured(self.stress, "stress", Quantity::Stress)?,
            strain: measured(self.strain, "strain", Quantity::Strain)?,
            modulus: measured(self.modulus, "modulus", Quantity::Modulus)?,
            compliance: measured(self.compliance, "compliance", Quantity::Compliance)?,
            torque: measured(self.torque, "torque", Quantity::Torque)?,
            angle: measured(self.angle, "angle", Quantity::Angle)?,
            spring_constant,
            deflection: match deflection {
                Some(_) if !names_height => return Err(source.missing("columns.displacement", HEIGHT)),
                deflection => measured(deflection, "deflection", Quantity::Displacement)?,
            },
            unused: self.unused,
        })
    }
}

/// What a deflection is taken off.
const HEIGHT: &str = "the column of the height, such as { column = \"measuredHeight\", sign = -1 }";

impl TimeTable {
    fn checked(self, source: &Source<'_>, machine: Option<&str>) -> Result<ColumnChoice, DescriptionError> {
        let key = "columns.time.rate";
        if self.unit.is_some() && self.rate.is_some() {
            return Err(source.both(key, "columns.time.unit"));
        }
        let plain = ColumnTable {
            column: self.column,
            unit: self.unit,
            ..ColumnTable::default()
        };
        Ok(ColumnChoice {
            rate: source.positive_if(key, self.rate.as_ref(), Dimension::Frequency)?,
            ..plain.checked(source, machine, "time", Quantity::Time)?
        })
    }
}

impl DisplacementTable {
    fn checked(self, source: &Source<'_>, machine: Option<&str>) -> Result<ColumnChoice, DescriptionError> {
        let key = "columns.displacement.travel_per_unit";
        if self.unit.is_some() && self.travel_per_unit.is_some() {
            return Err(source.both(key, "columns.displacement.unit"));
        }
        if self.also.is_some() && self.doubled == Some(true) {
            return Err(source.both("columns.displacement.doubled", "columns.displacement.also"));
        }
        let travel_per_unit = source.positive_if(key, self.travel_per_unit.as_ref(), Dimension::Length)?;
        let plain = ColumnTable {
            column: self.column,
            unit: self.unit,
            scale: self.scale,
            offset: self.offset,
            sign: self.sign,
            clock: self.clock,
        };
        Ok(ColumnChoice {
            also: self.also,
            doubled: self.doubled.unwrap_or(false),
            travel_per_unit,
            ..plain.checked(source, machine, "displacement", Quantity::Displacement)?
        })
    }
}

impl ColumnTable {
    /// Of the table `[columns.…]` called `name`.
    fn checked(
        self,
        source: &Source<'_>,
        machine: Option<&str>,
        name: &str,
        quantity: Quantity,
    ) -> Result<ColumnChoice, DescriptionError> {
        let key = |rest: &str| format!("columns.{name}.{rest}");
        let scale = self.scale.as_deref().map(|scale| checked_scale(source, &key("scale"), scale, quantity));
        let scale = scale.transpose()?;
        let measured = if scale.is_some() { Dimension::Voltage } else { quantity.dimension() };
        check_unit(source, &key("unit"), self.unit.as_deref(), measured)?;
        let offset = self.offset.as_ref().map(|offset| source.si(&key("offset"), offset, quantity.dimension()));
        let sign = self.sign.unwrap_or(1.0);
        let sign = source.number(&key("sign"), sign, "1 or -1", |sign| sign.abs() == 1.0)?;
        if let Some(clock) = &self.clock {
            check_unit(source, &key("clock.unit"), clock.unit.as_deref(), Dimension::Time)?;
        }
        let own_unit = Places::of(source.text).start_exactly(&key("unit")).is_some();
        Ok(ColumnChoice {
            column: self.column,
            unit_by: machine.filter(|_| self.unit.is_some() && !own_unit).map(str::to_owned),
            unit: self.unit,
            rate: None,
            scale,
            offset: offset.transpose()?.unwrap_or(0.0),
            sign,
            also: None,
            doubled: false,
            travel_per_unit: None,
            clock: self.clock,
        })
    }
}

fn checked_scale(source: &Source<'_>, key: &str, scale: &str, quantity: Quantity) -> Result<f64, DescriptionError> {
    volts_are(scale, quantity.dimension()).ok_or_else(|| {
        let symbol = quantity.dimension().units()[0].0;
        let expected = format!("a {quantity} per volt other than 0, such as \"12.5 {symbol}/V\"");
        source.value(key, expected, &format!("\"{scale}\""))
    })
}

fn check_unit(
    source: &Source<'_>,
    key: &str,
    unit: Option<&str>,
    dimension: Dimension,
) -> Result<(), DescriptionError> {
    match unit {
        Some(unit) if dimension == Dimension::Time && unit.trim().eq_ignore_ascii_case(EPOCH) => Ok(()),
        Some(unit) if unit_factor(unit, dimension).is_none() => {
            let found = unit.to_owned();
            Err(source.no_quantity(key, unit, UnitError::UnknownUnit { dimension, unit: found }))
        }
        _ => Ok(()),
    }
}
