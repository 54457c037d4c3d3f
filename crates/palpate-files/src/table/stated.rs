//! Units of columns that lines above the table state.

use palpate::units::Dimension;

use super::{
    part::{Metadata, Part},
    recognise,
};
use crate::{
    error::shown,
    naming::{Quantity, stated_units, unit_factor},
};

/// A unit, and where it stands, as a message says it.
pub(crate) type StatedUnit = (String, String);

impl Part {
    /// The units of a dimension that lines above the table state.
    pub(crate) fn stated_units(&self, dimension: Dimension) -> Vec<StatedUnit> {
        self.stated().into_iter().filter(|(own, _)| *own == dimension).map(|(_, unit)| unit).collect()
    }

    /// All of them.
    fn stated(&self) -> Vec<(Dimension, StatedUnit)> {
        let of_entry = |entry: &Metadata| {
            let unit = entry.unit.as_deref().map_or_else(String::new, |unit| format!(" {unit}"));
            let line = format!("{}: {}{unit}", entry.name, entry.value);
            let place = |unit: &str| (unit.to_owned(), format!("in \"{}\" above", shown(&line)));
            stated_units(&line).into_iter().map(|(own, unit)| (own, place(unit))).collect::<Vec<_>>()
        };
        self.metadata.iter().flat_map(of_entry).collect()
    }

    /// Gives each column without a unit of its own the one that the lines above state of what it is named after.
    pub(crate) fn take_stated_units(&mut self) {
        if self.columns.iter().all(|column| column.unit.is_some()) {
            return;
        }
        let all = self.stated();
        let stated = |quantity: Quantity| {
            let dimension = quantity.dimension();
            let units: Vec<&StatedUnit> =
                all.iter().filter(|(own, _)| *own == dimension).map(|(_, unit)| unit).collect();
            let (first, _) = units.first()?;
            let agrees = |(unit, _): &&StatedUnit| unit_factor(unit, dimension) == unit_factor(first, dimension);
            units.iter().all(agrees).then(|| (quantity, first.clone()))
        };
        let stated: Vec<(Quantity, String)> = Quantity::ALL.into_iter().filter_map(stated).collect();
        for column in self.columns.iter_mut().filter(|column| column.unit.is_none()) {
            let mut named = stated.iter().filter(|(quantity, _)| recognise::names(column, *quantity));
            let first = named.next();
            column.unit = first.filter(|(_, unit)| named.all(|(_, other)| other == unit)).map(|(_, unit)| unit.clone());
        }
    }
}
