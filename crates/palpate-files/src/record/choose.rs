//! Choosing the columns of a file: from a description, else by the header.

use super::{
    chooser::{Chooser, Found, named_column},
    column_use::ColumnUse,
    conversion::{self, Conversion},
    error::ColumnError,
    named::NamedColumn,
    signals::Time,
};
use crate::{
    description::{ColumnChoices, TestDescription},
    naming::Quantity,
    table::{ColumnInfo, Part, recognise},
};

/// The columns to read and how to make a record of them.
#[derive(Debug)]
pub(super) struct Plan {
    /// Columns in the order to read them.
    pub(super) columns: Vec<ColumnUse>,
    /// What makes force and displacement of them.
    pub(super) conversion: Conversion,
    /// The file has no time: so many rows a second, Hz.
    pub(super) rate: Option<f64>,
    /// A column of shear rates, which may show that the test is no hold, with the factor to 1/s.
    pub(super) shear_rate: Option<(NamedColumn, f64)>,
}

/// The columns that may be recognised by their names: all but those that a description does not use.
fn open_columns(part: &Part, stated: &ColumnChoices) -> Result<Vec<ColumnInfo>, ColumnError> {
    let numbers = stated.unused.iter().map(|named| Ok(named_column(part, "columns.unused", named)?.number));
    let numbers = numbers.collect::<Result<Vec<usize>, ColumnError>>()?;
    let is_unused = |column: &&ColumnInfo| numbers.contains(&column.number);
    // One and the same column may be stated by its number and by its name.
    for (quantity, choice) in stated.all() {
        let named = choice.column.as_ref().and_then(|named| part.column_of(named));
        if let Some(column) = named.filter(is_unused) {
            return Err(ColumnError::StatedAsUnused(quantity, column.into()));
        }
    }
    Ok(part.columns.iter().filter(|column| !is_unused(column)).cloned().collect())
}

/// Chooses the columns of one test.
pub(super) fn choose(part: &Part, test: &TestDescription) -> Result<Plan, ColumnError> {
    let stated = &test.columns;
    let open = open_columns(part, stated)?;
    let chooser = Chooser {
        part,
        open: &open,
        torsion: conversion::torsion(test, &part.metadata),
    };
    let is_stated = stated.stated(Quantity::is_load).is_some() || stated.stated(Quantity::is_travel).is_some();
    if let Some(column) = recognise::storage_modulus(&open).filter(|_| !is_stated) {
        return Err(ColumnError::Oscillation(column.into()));
    }
    let load = chooser.load(test)?;
    let load_choice = load.as_ref().and_then(|load| load.choice);
    let travel_choice = stated.stated(Quantity::is_travel).map(|(_, choice)| choice);
    let is_of_another = |displacement: &Found<'_>| {
        let time = stated.time.as_ref().and_then(|time| time.column.as_ref());
        travel_choice.is_none() && time.is_some_and(|time| chooser.is_of_another(time, load.as_ref(), displacement))
    };
    let displacement = chooser.travel(test, load.as_ref())?.filter(|displacement| !is_of_another(displacement));
    let may_be_there = displacement.is_none() && load_choice.is_none_or(|load| load.column.is_none());
    let clocks = [(travel_choice, displacement.as_ref()), (load_choice, load.as_ref())];
    let one_time = stated.time.as_ref().is_some_and(|time| time.column.is_some());
    let mut found = Vec::new();
    let mut needs_time = false;
    for (choice, values) in clocks {
        let Some(values) = values else { continue };
        let quantity = values.role.measured();
        let own = Some(values).filter(|_| !one_time).and_then(|values| chooser.own_clock(quantity, values));
        match (choice.and_then(|choice| choice.clock.as_ref()), own) {
            (Some(clock), _) => found.push(chooser.clock(quantity, clock)?),
            (None, Some(own)) => found.push(own),
            (None, None) => needs_time = true,
        }
    }
    let added = displacement.as_ref().map(|displacement| chooser.added(displacement)).transpose()?.flatten();
    let deflection = match (&displacement, &stated.deflection) {
        (Some(height), Some(choice)) => Some(chooser.deflection(height, choice)?),
        _ => None,
    };
    let mut rate = None;
    if needs_time {
        match chooser.time(stated.time.as_ref())? {
            Time::Column(time) => found.push(time),
            Time::Rows(a_second) => rate = Some(a_second),
        }
    }
    let conversion = Conversion::of(test, chooser.torsion, (load.as_ref(), displacement.as_ref()))?;
    found.extend(displacement);
    found.extend(added);
    found.extend(deflection);
    found.extend(load);
    chooser.refuse_twice(&found)?;
    let columns = chooser.with_units(&found)?;
    if may_be_there {
        chooser.refuse_unclear(&columns)?;
    }
    Ok(Plan {
        columns,
        conversion,
        rate,
        // Who names the columns decides.
        shear_rate: recognise::shear_rate(&open).filter(|_| !is_stated).map(|(column, factor)| (column.into(), factor)),
    })
}
