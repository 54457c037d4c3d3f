//! Choosing the columns of a file: from a description, else by the header.

use std::path::Path;

use palpate::{contact::Shape, units::Dimension};

use super::{
    ColumnUse, Quantity, Role,
    error::{ColumnError, NamedColumn},
    quantity::unit_factor,
    recognise,
};
use crate::{
    description::{ClockChoice, ColumnChoice, ColumnRef, TestDescription},
    text::{ColumnInfo, Layout},
};

/// The columns to read and how to make a record of them.
#[derive(Debug)]
pub(super) struct Plan {
    /// Columns in the order to read them.
    pub(super) columns: Vec<ColumnUse>,
    /// What turns force or stress (SI) into N: the section in m² where it is stress, else 1.
    pub(super) section: f64,
    /// Stress without a section: the record is that of 1 m².
    pub(super) per_unit_area: bool,
}

/// A column that was found, before its unit is looked at.
struct Found<'a> {
    role: Role,
    column: &'a ColumnInfo,
    unit: Option<&'a str>,
    sign: f64,
    scale: Option<f64>,
    offset: f64,
}

impl Found<'_> {
    /// The key of a description that says its unit.
    fn key(&self) -> String {
        match self.role {
            Role::Values(quantity) => format!("columns.{quantity}.unit"),
            Role::ClockOf(quantity) => format!("columns.{quantity}.clock.unit"),
        }
    }
}

#[derive(Clone, Copy)]
struct Chooser<'a> {
    path: &'a Path,
    columns: &'a [ColumnInfo],
    layout: &'a Layout,
}

/// Chooses the columns of the file at `path`.
pub(super) fn choose(path: &Path, layout: &Layout, test: &TestDescription) -> Result<Plan, ColumnError> {
    let chooser = Chooser {
        path,
        columns: &layout.columns,
        layout,
    };
    let said = &test.columns;
    let (load, load_said) = chooser.force_or_stress(test)?;
    let displacement = chooser.find(Quantity::Displacement, said.displacement.as_ref())?;
    let clocks = [
        (Quantity::Displacement, said.displacement.as_ref(), displacement.is_some()),
        (load_quantity(&load), load_said, true),
    ];
    let mut found = Vec::new();
    for (quantity, choice, _) in clocks {
        if let Some(clock) = choice.and_then(|choice| choice.clock.as_ref()) {
            found.push(chooser.clock(quantity, clock)?);
        }
    }
    let has_clock =
        |(_, choice, _): &(_, Option<&ColumnChoice>, _)| choice.is_some_and(|choice| choice.clock.is_some());
    let needs_time = clocks.iter().any(|clock| clock.2 && !has_clock(clock));
    if needs_time {
        let time = chooser.find(Quantity::Time, said.time.as_ref())?;
        found.push(time.ok_or_else(|| chooser.missing(Quantity::Time))?);
    }
    found.extend(displacement);
    found.push(load);
    chooser.refuse_twice(&found)?;
    let (section, per_unit_area) = chooser.section(test, &found)?;
    Ok(Plan {
        columns: chooser.with_units(&found)?,
        section,
        per_unit_area,
    })
}

fn load_quantity(load: &Found<'_>) -> Quantity {
    match load.role {
        Role::Values(quantity) | Role::ClockOf(quantity) => quantity,
    }
}

impl<'a> Chooser<'a> {
    /// The column of force, or that of stress where the description says so or there is no force.
    fn force_or_stress(&self, test: &'a TestDescription) -> Result<(Found<'a>, Option<&'a ColumnChoice>), ColumnError> {
        let said = &test.columns;
        let missing = || self.missing(Quantity::Force);
        if let Some(stress) = &said.stress {
            let found = self.find(Quantity::Stress, Some(stress))?;
            return Ok((found.ok_or_else(|| self.missing(Quantity::Stress))?, Some(stress)));
        }
        if let Some(force) = &said.force {
            let found = self.find(Quantity::Force, Some(force))?;
            return Ok((found.ok_or_else(missing)?, Some(force)));
        }
        let found = match self.find(Quantity::Force, None)? {
            Some(force) => Some(force),
            None => self.find(Quantity::Stress, None)?,
        };
        Ok((found.ok_or_else(missing)?, None))
    }

    /// The column of a quantity; `None` if nothing says which.
    fn find(&self, quantity: Quantity, choice: Option<&'a ColumnChoice>) -> Result<Option<Found<'a>>, ColumnError> {
        let named = choice.and_then(|choice| choice.column.as_ref());
        let column = match named {
            Some(named) => Some(self.named(&format!("columns.{quantity}.column"), named)?),
            None => match recognise::candidates(self.columns, quantity)[..] {
                [] => None,
                [only] => Some(only),
                ref several => {
                    return Err(ColumnError::Ambiguous {
                        path: self.path.to_owned(),
                        quantity,
                        candidates: several.iter().map(|column| NamedColumn::from(*column)).collect(),
                    });
                }
            },
        };
        if choice.is_some() && column.is_none() {
            return Err(self.missing(quantity));
        }
        Ok(column.map(|column| Found {
            role: Role::Values(quantity),
            column,
            unit: choice.and_then(|choice| choice.unit.as_deref()),
            sign: choice.map_or(1.0, |choice| choice.sign),
            scale: choice.and_then(|choice| choice.scale),
            offset: choice.map_or(0.0, |choice| choice.offset),
        }))
    }

    fn clock(&self, quantity: Quantity, clock: &'a ClockChoice) -> Result<Found<'a>, ColumnError> {
        let key = format!("columns.{quantity}.clock.column");
        Ok(Found {
            role: Role::ClockOf(quantity),
            column: self.named(&key, &clock.column)?,
            unit: clock.unit.as_deref(),
            sign: 1.0,
            scale: None,
            offset: 0.0,
        })
    }

    fn named(&self, key: &str, named: &ColumnRef) -> Result<&'a ColumnInfo, ColumnError> {
        let column = match named {
            ColumnRef::Number(number) => self.columns.get(number.wrapping_sub(1)),
            ColumnRef::Name(name) => self.layout.column_named(name),
        };
        column.ok_or_else(|| ColumnError::NoSuchColumn {
            path: self.path.to_owned(),
            key: key.to_owned(),
            found: named.clone(),
            columns: self.columns.to_vec(),
        })
    }

    /// No column holds a quantity; perhaps one is named after it, but its unit is one of another.
    fn missing(&self, quantity: Quantity) -> ColumnError {
        if let Some((column, unit)) = recognise::misfits(self.columns, quantity).next() {
            return self.unknown_unit(column, quantity, format!("columns.{quantity}.unit"), unit);
        }
        ColumnError::Missing {
            path: self.path.to_owned(),
            quantity,
            columns: self.columns.to_vec(),
        }
    }

    /// Two clocks may be one column, two measured quantities may not.
    fn refuse_twice(&self, found: &[Found<'_>]) -> Result<(), ColumnError> {
        let values = |found: &Found<'_>| match found.role {
            Role::Values(quantity) => Some((quantity, found.column.number)),
            Role::ClockOf(_) => None,
        };
        let values: Vec<(Quantity, usize)> = found.iter().filter_map(values).collect();
        for (index, (first, number)) in values.iter().enumerate() {
            let same = values[index + 1..].iter().find(|(_, other)| other == number);
            if let Some((second, _)) = same {
                return Err(ColumnError::Twice {
                    path: self.path.to_owned(),
                    column: NamedColumn::from(&self.columns[number - 1]),
                    quantities: (*first, *second),
                });
            }
        }
        Ok(())
    }

    /// What turns the load into N, and whether it is that of 1 m².
    fn section(&self, test: &TestDescription, found: &[Found<'_>]) -> Result<(f64, bool), ColumnError> {
        let stress = found.iter().find(|found| found.role == Role::Values(Quantity::Stress));
        let Some(stress) = stress else {
            return Ok((1.0, false));
        };
        match test.geometry.as_ref().map(|body| &body.shape) {
            None => Ok((1.0, true)),
            Some(Shape::Prism { area, .. }) => Ok((*area, false)),
            Some(Shape::Ball { .. } | Shape::Pad { .. } | Shape::Profile { .. }) => Err(ColumnError::NoSection {
                path: self.path.to_owned(),
                column: NamedColumn::from(stress.column),
            }),
        }
    }

    fn unknown_unit(&self, column: &ColumnInfo, quantity: Quantity, key: String, unit: &str) -> ColumnError {
        ColumnError::UnknownUnit {
            path: self.path.to_owned(),
            column: column.into(),
            quantity,
            key,
            unit: unit.to_owned(),
        }
    }

    /// Units from the description, else from the header.
    fn with_units(&self, found: &[Found<'_>]) -> Result<Vec<ColumnUse>, ColumnError> {
        let mut used = Vec::new();
        let mut without = Vec::new();
        for found in found {
            let quantity = found.role.measured();
            let Some(unit) = found.unit.or(found.column.unit.as_deref()) else {
                without.push((found.key(), quantity.usual_unit(), found.column.into()));
                continue;
            };
            let factor = match found.scale {
                Some(scale) => unit_factor(unit, Dimension::Voltage).map(|volts| volts * scale),
                None => unit_factor(unit, quantity.dimension()),
            };
            used.push(ColumnUse {
                role: found.role,
                number: found.column.number,
                name: found.column.name.clone(),
                unit: unit.to_owned(),
                sign: found.sign,
                offset: found.offset,
                factor: factor.ok_or_else(|| self.unknown_unit(found.column, quantity, found.key(), unit))?,
            });
        }
        if without.is_empty() {
            return Ok(used);
        }
        // What stands in brackets behind the one name without a unit was meant as one.
        let bare = |found: &&Found<'_>| found.unit.or(found.column.unit.as_deref()).is_none();
        if let ([_], Some(found)) = (&without[..], found.iter().find(bare))
            && let Some(unit) = found.column.name.as_deref().and_then(in_brackets)
        {
            return Err(self.unknown_unit(found.column, found.role.measured(), found.key(), unit));
        }
        Err(ColumnError::NoUnit {
            path: self.path.to_owned(),
            columns: without,
        })
    }
}

/// The one word in brackets at the end of a name, as in `Force (furlong)`.
fn in_brackets(name: &str) -> Option<&str> {
    let (_, word) = name.trim_end().strip_suffix(')')?.rsplit_once('(')?;
    let word = word.trim();
    (!word.is_empty() && !word.contains(char::is_whitespace)).then_some(word)
}
