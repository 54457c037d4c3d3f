//! A part of a file whose columns are chosen, and the columns found in it.

use palpate::units::{self, Dimension};

use super::{
    column_use::{ColumnUse, Role},
    error::{ColumnError, UnitProblem},
    named::NamedColumn,
};
use crate::{
    cell::number,
    description::{ClockChoice, ColumnChoice, TestDescription, Torsion},
    naming::{Quantity, UNCALIBRATED, unit_factor},
    table::{ColumnInfo, ColumnRef, Metadata, Part, epoch, recognise},
};

/// A column that was found, before its unit is looked at.
pub(super) struct Found<'a> {
    pub(super) role: Role,
    pub(super) column: &'a ColumnInfo,
    pub(super) unit: Option<&'a str>,
    pub(super) choice: Option<&'a ColumnChoice>,
    /// Of a time: it counts samples, so many a second.
    pub(super) rate: Option<f64>,
    /// The column is the deflection of a cantilever with this spring constant (N/m), which makes it the force.
    pub(super) spring_constant: Option<f64>,
}

impl<'a> Found<'a> {
    /// A column, and what a description says of it.
    pub(super) fn of(role: Role, column: &'a ColumnInfo, choice: Option<&'a ColumnChoice>) -> Self {
        let unit = choice.and_then(|choice| choice.unit.as_deref());
        Self {
            role,
            column,
            unit,
            choice,
            rate: choice.and_then(|choice| choice.rate),
            spring_constant: None,
        }
    }

    /// What its unit is one of.
    pub(super) fn quantity(&self) -> Quantity {
        match self.spring_constant {
            Some(_) => Quantity::Displacement,
            None => self.role.measured(),
        }
    }

    /// The key of a description that says its unit.
    pub(super) fn key(&self) -> String {
        match self.role {
            Role::Values(_) if self.spring_constant.is_some() => "columns.deflection.unit".to_owned(),
            Role::Values(quantity) | Role::Added(quantity) => format!("columns.{quantity}.unit"),
            Role::Deflection => "columns.deflection.unit".to_owned(),
            Role::ClockOf(quantity) => format!("columns.{quantity}.clock.unit"),
        }
    }

    pub(super) fn used(&self, unit: String, factor: f64) -> ColumnUse {
        let doubled = self.choice.is_some_and(|choice| choice.doubled);
        ColumnUse {
            role: self.role,
            number: self.column.number,
            name: self.column.name.clone(),
            unit,
            sign: self.choice.map_or(1.0, |choice| choice.sign),
            // Of two columns that are added the sum is shifted, not each.
            offset: match self.role {
                Role::Added(_) => 0.0,
                _ => self.choice.map_or(0.0, |choice| choice.offset),
            },
            factor: if doubled { 2.0 } else { self.spring_constant.unwrap_or(1.0) } * factor,
            spring_constant: self.spring_constant,
            epoch: self.role.measured() == Quantity::Time && epoch::counts(self.column, factor),
        }
    }
}

/// In names of columns of which the deflection of the cantilever is off already.
const INDENTATIONS: [&str; 4] = ["indentation", "tip position", "tipposition", "separation"];

/// Names of the spring constant of a cantilever in the metadata of files.
const SPRING_CONSTANTS: [&str; 4] = ["springconstant", "spring constant", "spring_constant", "k"];

/// The spring constant that stands in a file with its unit, N/m.
fn spring_constant_of(part: &Part) -> Option<f64> {
    let entry = |entry: &&Metadata| SPRING_CONSTANTS.contains(&entry.name.trim().to_lowercase().as_str());
    part.metadata.iter().filter(entry).find_map(|entry| {
        let factor = units::factor(entry.unit.as_deref()?.trim(), Dimension::Stiffness)?;
        let value = entry.value.trim().parse::<f64>().ok()? * factor;
        (value.is_finite() && value > 0.0).then_some(value)
    })
}

#[derive(Clone, Copy)]
pub(super) struct Chooser<'a> {
    pub(super) part: &'a Part,
    /// Its columns that may be recognised by their names.
    pub(super) open: &'a [ColumnInfo],
    /// What makes force and displacement of torque and angle, where that is known.
    pub(super) torsion: Option<Torsion>,
}

impl<'a> Chooser<'a> {
    /// The column of a quantity; `None` if nothing says which.
    pub(super) fn find(
        &self,
        quantity: Quantity,
        choice: Option<&'a ColumnChoice>,
    ) -> Result<Option<Found<'a>>, ColumnError> {
        let named = choice.and_then(|choice| choice.column.as_ref());
        let column = match named {
            Some(named) => Some(self.named(&format!("columns.{quantity}.column"), named)?),
            None => match recognise::candidates(self.open, quantity)[..] {
                // The unit that is stated is that of a strain without one.
                [] if quantity == Quantity::Strain && choice.is_some_and(|choice| choice.unit.is_some()) => {
                    match recognise::strains_without_unit(self.open)[..] {
                        [only] => Some(only),
                        _ => None,
                    }
                }
                [] => None,
                [only] => Some(only),
                ref several => {
                    let candidates = several.iter().map(|column| NamedColumn::from(*column)).collect();
                    return Err(ColumnError::Ambiguous(quantity, candidates));
                }
            },
        };
        if choice.is_some() && column.is_none() {
            return Err(self.missing(quantity));
        }
        Ok(column.map(|column| Found::of(Role::Values(quantity), column, choice)))
    }

    /// Whether a displacement that nobody named stands in the columns of another test than the time that was named: with a time before it, and a
    /// load of its own.
    pub(super) fn is_of_another(&self, time: &ColumnRef, load: Option<&Found<'a>>, displacement: &Found<'a>) -> bool {
        let numbers = |quantity| recognise::candidates(self.open, quantity).into_iter().map(|found| found.number);
        let times: Vec<usize> = numbers(Quantity::Time).collect();
        let owner = |number: usize| times.iter().rfind(|time| **time <= number);
        let Ok(time) = self.named("columns.time.column", time) else {
            return false;
        };
        let own = owner(displacement.column.number);
        let has_load = numbers(Quantity::Force).any(|number| owner(number) == own);
        own.is_some()
            && own != owner(time.number)
            && has_load
            && load.is_some_and(|load| owner(load.column.number) != own)
    }

    /// The clock that the file itself gives the column of a quantity.
    pub(super) fn own_clock(&self, quantity: Quantity, values: &Found<'a>) -> Option<Found<'a>> {
        let clock = self.part.clock_of(values.column.number)?;
        let column = self.part.columns.get(clock.column.wrapping_sub(1))?;
        Some(Found::of(Role::ClockOf(quantity), column, None))
    }

    /// The column that is added to one, which must have the same clock.
    pub(super) fn added(&self, values: &Found<'a>) -> Result<Option<Found<'a>>, ColumnError> {
        let Some(also) = values.choice.and_then(|choice| choice.also.as_ref()) else {
            return Ok(None);
        };
        let quantity = values.role.measured();
        let column = self.beside(values, &format!("columns.{quantity}.also"), also)?;
        Ok(Some(Found::of(Role::Added(quantity), column, values.choice)))
    }

    /// The column of the deflection of a cantilever whose base stands at `height`; both must have the same clock.
    pub(super) fn deflection(&self, height: &Found<'a>, choice: &'a ColumnChoice) -> Result<Found<'a>, ColumnError> {
        let name = height.column.name.as_deref().unwrap_or("").to_lowercase();
        if INDENTATIONS.iter().any(|known| name.contains(known)) {
            return Err(ColumnError::NoHeight(height.column.into()));
        }
        // A description without the column is refused when it is checked.
        let named = choice.column.as_ref().unwrap_or(&ColumnRef::Number(0));
        let column = self.beside(height, "columns.deflection.column", named)?;
        Ok(Found::of(Role::Deflection, column, Some(choice)))
    }

    /// The deflection of a cantilever as the force: by the spring constant of the description, or where there is no column of force by that of
    /// the file.
    pub(super) fn force_of_deflection(&self, test: &'a TestDescription) -> Result<Option<Found<'a>>, ColumnError> {
        let stated = &test.columns;
        let Some(choice) = &stated.deflection else {
            return Ok(None);
        };
        let has_force = || {
            let is_there = |quantity| !recognise::candidates(self.open, quantity).is_empty();
            stated.stated(Quantity::is_load).is_some() || is_there(Quantity::Force) || is_there(Quantity::Stress)
        };
        let of_file = || if has_force() { None } else { spring_constant_of(self.part) };
        let (Some(spring_constant), Some(named)) = (stated.spring_constant.or_else(of_file), &choice.column) else {
            return Ok(None);
        };
        let column = self.named("columns.deflection.column", named)?;
        Ok(Some(Found {
            spring_constant: Some(spring_constant),
            ..Found::of(Role::Values(Quantity::Force), column, Some(choice))
        }))
    }

    /// Another column that is named under a key, and must have the clock of `values`.
    fn beside(&self, values: &Found<'a>, key: &str, named: &ColumnRef) -> Result<&'a ColumnInfo, ColumnError> {
        let column = self.named(key, named)?;
        if self.part.clock_of(column.number) != self.part.clock_of(values.column.number) {
            return Err(ColumnError::ClocksDiffer(values.column.into(), column.into()));
        }
        if column.number == values.column.number {
            let quantity = values.role.measured();
            return Err(ColumnError::Twice(column.into(), quantity, quantity));
        }
        Ok(column)
    }

    pub(super) fn clock(&self, quantity: Quantity, clock: &'a ClockChoice) -> Result<Found<'a>, ColumnError> {
        let column = self.named(&format!("columns.{quantity}.clock.column"), &clock.column)?;
        let unit = clock.unit.as_deref();
        Ok(Found {
            unit,
            ..Found::of(Role::ClockOf(quantity), column, None)
        })
    }

    fn named(&self, key: &str, named: &ColumnRef) -> Result<&'a ColumnInfo, ColumnError> {
        named_column(self.part, key, named)
    }

    /// No column holds a quantity; perhaps one is named after it, but its unit is one of another.
    pub(super) fn missing(&self, quantity: Quantity) -> ColumnError {
        if let Some((column, unit)) = recognise::misfits(self.open, quantity).next() {
            let unit = unit.to_owned();
            let is_deflection =
                column.name.as_deref() == Some(UNCALIBRATED) && unit_factor(&unit, Dimension::Length).is_some();
            let problem = match is_deflection {
                true => UnitProblem::NoSpringConstant {
                    unit,
                    height: self.height(),
                },
                false => UnitProblem::Unknown(quantity, unit),
            };
            return ColumnError::unit(column, format!("columns.{quantity}.unit"), problem);
        }
        if let Some(error) = self.multiples(quantity) {
            return error;
        }
        if let Some(column) = recognise::text_named(self.open, quantity) {
            return Self::as_text(column, quantity);
        }
        ColumnError::Missing(quantity, self.part.columns.clone())
    }

    /// A column whose name says multiples of a quantity.
    fn multiples(&self, quantity: Quantity) -> Option<ColumnError> {
        let column = recognise::multiples(self.open, quantity)?;
        Some(ColumnError::unit(column, format!("columns.{quantity}.unit"), UnitProblem::Multiples(quantity)))
    }

    /// Stress and strain of a file are true ones.
    pub(super) fn true_measures(&self) -> ColumnError {
        let of = |quantity| {
            let column = recognise::true_measure(self.open, quantity)?;
            recognise::candidates(self.open, quantity).is_empty().then(|| (quantity, column.into()))
        };
        ColumnError::TrueMeasures([Quantity::Stress, Quantity::Strain].into_iter().filter_map(of).collect())
    }

    /// The number of a column of heights of a cantilever's base, a measured one before others.
    fn height(&self) -> Option<usize> {
        let name = |column: &ColumnInfo| column.name.as_ref().map_or_else(String::new, |name| name.to_lowercase());
        let heights = || self.open.iter().filter(|column| name(column).contains("height"));
        let measured = heights().find(|column| name(column).contains("measured"));
        measured.or_else(|| heights().next()).map(|column| column.number)
    }

    /// A column that is named after a quantity, but holds texts.
    fn as_text(column: &ColumnInfo, quantity: Quantity) -> ColumnError {
        let found = column.sample.clone();
        match quantity == Quantity::Time && !number::looks_numeric(&found) {
            true => ColumnError::TimeAsText(column.into(), found),
            false => ColumnError::NotNumbers(column.into(), found),
        }
    }

    /// A record without displacement is one thing, a displacement that is not recognised another. Who names the column of
    /// the force, but none of the displacement, has no displacement.
    pub(super) fn refuse_unclear(&self, used: &[ColumnUse]) -> Result<(), ColumnError> {
        let free = |column: &&ColumnInfo| used.iter().all(|used| used.number != column.number);
        if let Some(error) = self.multiples(Quantity::Displacement) {
            return Err(error);
        }
        if let Some((column, unit)) = recognise::share_of_displacement(self.open).filter(|(column, _)| free(column)) {
            let problem = UnitProblem::Unknown(Quantity::Displacement, unit.to_owned());
            return Err(ColumnError::unit(column, "columns.displacement.unit".to_owned(), problem));
        }
        // The gap of a rheometer is no travel.
        let is_force = used.iter().any(|used| used.role == Role::Values(Quantity::Force));
        let gap = |column: &&ColumnInfo| !is_force && recognise::is_gap(column);
        let possible = recognise::possible_displacements(self.open).filter(free).filter(|column| !gap(column));
        let candidates: Vec<NamedColumn> = possible.map(NamedColumn::from).collect();
        if !candidates.is_empty() {
            let columns = self.part.columns.clone();
            return Err(ColumnError::Unclear { candidates, columns });
        }
        // What begins with a digit was meant as a number.
        let text = recognise::text_named(self.open, Quantity::Displacement);
        match text.filter(|column| number::looks_numeric(&column.sample)) {
            Some(column) => Err(Self::as_text(column, Quantity::Displacement)),
            None => Ok(()),
        }
    }

    /// Two clocks may be one column, two measured quantities may not.
    pub(super) fn refuse_twice(&self, found: &[Found<'_>]) -> Result<(), ColumnError> {
        let values = |found: &Found<'_>| match found.role {
            Role::Values(_) if found.spring_constant.is_some() => None,
            Role::Values(quantity) | Role::Added(quantity) => Some((quantity, found.column.number)),
            // The bending of a cantilever may be the force as well, by another scale.
            Role::ClockOf(_) | Role::Deflection => None,
        };
        let values: Vec<(Quantity, usize)> = found.iter().filter_map(values).collect();
        for (index, (first, number)) in values.iter().enumerate() {
            let same = values[index + 1..].iter().find(|(_, other)| other == number);
            if let Some((second, _)) = same {
                let column = NamedColumn::from(&self.part.columns[number - 1]);
                return Err(ColumnError::Twice(column, *first, *second));
            }
        }
        Ok(())
    }
}

/// The column that is named under a key.
pub(super) fn named_column<'a>(part: &'a Part, key: &str, named: &ColumnRef) -> Result<&'a ColumnInfo, ColumnError> {
    part.column_of(named).ok_or_else(|| ColumnError::NoSuchColumn {
        key: key.to_owned(),
        found: named.clone(),
        columns: part.columns.clone(),
    })
}
