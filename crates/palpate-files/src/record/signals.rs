//! Which column becomes the force, the displacement and the time of a record.

use super::{
    chooser::{Chooser, Found},
    column_use::Role,
    error::ColumnError,
    rate,
};
use crate::{
    description::{ColumnChoice, TestDescription},
    naming::Quantity,
    table::recognise,
};

/// Where the time of a record comes from.
pub(super) enum Time<'a> {
    Column(Found<'a>),
    /// So many rows a second.
    Rows(f64),
}

impl<'a> Chooser<'a> {
    /// The column of what becomes the force: the one that is stated, otherwise force, stress, a modulus or a torque, in this order; none
    /// where there is a compliance or a strain alone.
    pub(super) fn load(&self, test: &'a TestDescription) -> Result<Option<Found<'a>>, ColumnError> {
        if let Some(bent) = self.force_of_deflection(test)? {
            return Ok(Some(bent));
        }
        if let Some((quantity, choice)) = test.columns.stated(Quantity::is_load) {
            return self.find(quantity, Some(choice));
        }
        if test.columns.compliance.is_some() {
            return Ok(None);
        }
        // A torque alone is no force: without the sizes of the sample a message says what is needed.
        let turned = self.torsion.map(|_| Quantity::Torque);
        let in_order = [Quantity::Force, Quantity::Stress, Quantity::Modulus].into_iter().chain(turned);
        for quantity in in_order {
            if let Some(found) = self.find(quantity, None)? {
                return Ok(Some(found));
            }
        }
        if recognise::true_measure(self.open, Quantity::Stress).is_some() {
            return Err(self.true_measures());
        }
        // A creep under a stress that is constant, and perhaps not given.
        let creeps = [Quantity::Compliance, Quantity::Strain].map(|quantity| self.find(quantity, None));
        match test.columns.strain.is_some() || creeps.into_iter().any(|found| matches!(found, Ok(Some(_)))) {
            true => Ok(None),
            false if recognise::true_measure(self.open, Quantity::Strain).is_some() => Err(self.true_measures()),
            false => Err(self.missing(Quantity::Force)),
        }
    }

    /// The column of what becomes the displacement: the one that is stated, otherwise a displacement, or what goes with the load.
    pub(super) fn travel(
        &self,
        test: &'a TestDescription,
        load: Option<&Found<'a>>,
    ) -> Result<Option<Found<'a>>, ColumnError> {
        if let Some((quantity, choice)) = test.columns.stated(Quantity::is_travel) {
            return self.find(quantity, Some(choice));
        }
        let beside = match load.map(|load| load.role.measured()) {
            None => &[Quantity::Compliance, Quantity::Strain][..],
            // A curve of a material has been divided by its strain.
            Some(Quantity::Modulus) => &[],
            Some(Quantity::Torque) => &[Quantity::Angle, Quantity::Strain],
            _ => &[Quantity::Displacement, Quantity::Strain],
        };
        for quantity in beside {
            match self.find(*quantity, None) {
                Ok(None) => {}
                // Of several strains none is needed.
                Err(ColumnError::Ambiguous(Quantity::Strain, _)) => return Ok(None),
                found => return found,
            }
        }
        // Who names the column of the force, but none of the displacement, has no displacement.
        let is_force_named = load.is_some_and(|load| {
            let is_named = load.choice.is_some_and(|choice| choice.column.is_some());
            is_named && load.role.measured() == Quantity::Force
        });
        let may_be_strain = beside.contains(&Quantity::Strain) && !is_force_named;
        if may_be_strain && recognise::true_measure(self.open, Quantity::Strain).is_some() {
            return Err(self.true_measures());
        }
        // A fraction or per cent: its unit is requested, unless a column of another name may be the displacement.
        let strains = recognise::strains_without_unit(self.open);
        let is_unclear = || recognise::possible_displacements(self.open).next().is_some();
        Ok(match strains[..] {
            [strain] if may_be_strain && !is_unclear() => Some(Found::of(Role::Values(Quantity::Strain), strain, None)),
            _ => None,
        })
    }

    /// The time: a column, or the rows at a rate that is stated or that the file gives.
    pub(super) fn time(&self, choice: Option<&'a ColumnChoice>) -> Result<Time<'a>, ColumnError> {
        if let Some(choice) = choice
            && let (Some(rate), None) = (choice.rate, &choice.column)
        {
            return Ok(Time::Rows(rate));
        }
        if let Some(found) = self.find(Quantity::Time, choice)? {
            return Ok(Time::Column(found));
        }
        let rate = rate::of_rows(&self.part.metadata).ok_or_else(|| self.missing(Quantity::Time))?;
        let counting = self.open.iter().find(|column| rate::counts_samples(column));
        Ok(counting.map_or(Time::Rows(rate), |column| {
            Time::Column(Found {
                rate: Some(rate),
                ..Found::of(Role::Values(Quantity::Time), column, None)
            })
        }))
    }
}
