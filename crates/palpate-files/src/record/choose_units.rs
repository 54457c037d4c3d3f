//! The units of the columns that were chosen: from the description, else from the header.

use palpate::{number::shortest, units::Dimension};

use super::{
    chooser::{Chooser, Found},
    column_use::{ColumnUse, SAMPLES},
    error::{ColumnError, UnitProblem},
    named::NamedColumn,
};
use crate::{
    cell::{date, unit},
    description::contradicts,
    naming::{Quantity, topic_and_field, unit_factor},
    table::{ColumnInfo, ColumnKind, EXACT_DIGITS, epoch, recognise},
};

impl Found<'_> {
    fn wrong_unit(&self, problem: UnitProblem) -> ColumnError {
        ColumnError::unit(self.column, self.key(), problem)
    }
}

impl Chooser<'_> {
    /// A column whose unit is none that a header could give: a travel stated for each unit of it, or a time since 1970.
    fn without_plain_unit(&self, found: &Found<'_>) -> Result<Option<ColumnUse>, ColumnError> {
        if let Some(travel) = found.choice.and_then(|choice| choice.travel_per_unit) {
            return Ok(Some(found.used(format!("{} mm each", shortest(travel * 1e3, EXACT_DIGITS)), travel)));
        }
        if found.quantity() != Quantity::Time {
            return Ok(None);
        }
        if let Some(rate) = found.rate {
            return Ok(Some(found.used(format!("{SAMPLES}{} Hz", shortest(rate, EXACT_DIGITS)), 1.0 / rate)));
        }
        if found.column.kind == ColumnKind::DateTime && date::has_two_fields(found.column.sample.as_bytes()) {
            return self.of_two_fields(found).map(Some);
        }
        if found.column.kind == ColumnKind::DateTime {
            // A time of day is not counted from 1970; from one o'clock on it is no time since the start of a test either.
            let is_dated = epoch::is_date(&found.column.sample);
            let date = found.used(if is_dated { "date and time" } else { "time of day" }.to_owned(), 1.0);
            return Ok(Some(ColumnUse {
                epoch: is_dated || epoch::is_late(&found.column.sample),
                ..date
            }));
        }
        let is_stated = found.unit.is_some_and(|unit| unit.trim().eq_ignore_ascii_case(epoch::EPOCH));
        let is_named = found.unit.or(found.column.unit.as_deref()).is_none() && epoch::is_named(found.column);
        match epoch::unit(found.column) {
            Some((unit, factor)) if is_stated || is_named => Ok(Some(found.used(format!("{unit} since 1970"), factor))),
            None if is_stated => Err(ColumnError::NoEpoch(found.column.into(), found.column.sample.clone())),
            _ => Ok(None),
        }
    }

    /// A clock of two fields: minutes and seconds where the last one has decimals or the header has seconds, else by what is stated of it.
    fn of_two_fields(&self, found: &Found<'_>) -> Result<ColumnUse, ColumnError> {
        let in_header = found.column.unit.as_deref().filter(|unit| unit.contains(':') || *unit == "s");
        let factor = found.unit.or(in_header).and_then(|unit| unit_factor(unit, Dimension::Time));
        let (has_decimals, sample) = (found.column.sample.contains(['.', ',']), &found.column.sample);
        match factor {
            Some(1.0) => Ok(found.used("s".to_owned(), 1.0)),
            Some(60.0) => Ok(found.used("min".to_owned(), 60.0)),
            None if has_decimals => Ok(found.used("s".to_owned(), 1.0)),
            _ => Err(found.wrong_unit(UnitProblem::Clock(sample.clone()))),
        }
    }

    /// The one column without a unit and of unknown name, where no column is the displacement.
    fn unnamed_travel(&self, found: &[Found<'_>]) -> Option<NamedColumn> {
        let travels = found.iter().any(|found| found.role.measured().is_travel());
        let is_free = |column: &&ColumnInfo| {
            column.unit.is_none()
                && column.name.as_deref().is_some_and(|name| topic_and_field(name).is_none())
                && recognise::may_be(column, Quantity::Displacement)
                && found.iter().all(|found| found.column.number != column.number)
        };
        let mut free = self.open.iter().filter(|_| !travels).filter(is_free);
        free.next().filter(|_| free.next().is_none()).map(NamedColumn::from)
    }

    /// A unit that nobody wrote down for this file, but the conventions of a machine, gives way to none in the header.
    fn refuse_contradiction(&self, found: &Found<'_>) -> Result<(), ColumnError> {
        if let Some(choice) = found.choice
            && let (Some(machine), Some(stated), Some(written)) = (&choice.unit_by, &choice.unit, &found.column.unit)
            && contradicts(found.quantity(), choice, found.column)
        {
            let (machine, stated, written) = (machine.clone(), stated.clone(), written.clone());
            return Err(found.wrong_unit(UnitProblem::OfMachine {
                machine,
                stated,
                written,
            }));
        }
        Ok(())
    }

    /// A unit in the name of a column and another one in the row of units, or beside the column in a typed file: nobody knows which holds.
    fn refuse_two_units(&self, found: &Found<'_>) -> Result<(), ColumnError> {
        let dimension = found.quantity().dimension();
        if let (Some(name), Some(beside), None) = (&found.column.name, &found.column.unit, found.unit)
            && let Some(in_name) = unit::split(name).1
            && let (Some(one), Some(other)) = (unit_factor(&in_name, dimension), unit_factor(beside, dimension))
            && (one / other - 1.0).abs() > 1e-9
        {
            let place = |unit: &str, place: &str| (unit.to_owned(), place.to_owned());
            return Err(
                found.wrong_unit(UnitProblem::Two([place(&in_name, "in its name"), place(beside, "beside it")]))
            );
        }
        Ok(())
    }

    /// A unit in the header and another one in a line above it, or two lines with two units.
    fn refuse_other_above(&self, found: &Found<'_>) -> Result<(), ColumnError> {
        let (quantity, column) = (found.quantity(), found.column);
        if found.unit.is_some() || !recognise::names(column, quantity) {
            return Ok(());
        }
        let factor = |(unit, _): &(String, String)| unit_factor(unit, quantity.dimension());
        let in_header = column.unit.iter().map(|unit| (unit.clone(), "in the header".to_owned()));
        let all: Vec<_> = self.part.stated_units(quantity.dimension()).into_iter().chain(in_header).collect();
        let differs = |pair: &&[(String, String)]| match (factor(&pair[0]), factor(&pair[1])) {
            (Some(one), Some(other)) => (one / other - 1.0).abs() > 1e-9,
            _ => false,
        };
        match all.windows(2).find(differs) {
            Some([one, other]) => Err(found.wrong_unit(UnitProblem::Two([one.clone(), other.clone()]))),
            _ => Ok(()),
        }
    }

    /// Units from the description, else from the header.
    pub(super) fn with_units(&self, found: &[Found<'_>]) -> Result<Vec<ColumnUse>, ColumnError> {
        let mut used = Vec::new();
        let mut without = Vec::new();
        for found in found {
            let quantity = found.quantity();
            if let Some(used_as) = self.without_plain_unit(found)? {
                used.push(used_as);
                continue;
            }
            self.refuse_contradiction(found)?;
            self.refuse_two_units(found)?;
            self.refuse_other_above(found)?;
            // A clock may be called by what it counts: "Seconds", "Minuten".
            let counted = found
                .column
                .name
                .as_deref()
                .filter(|name| quantity == Quantity::Time && unit_factor(name, Dimension::Time).is_some())
                .filter(|name| !recognise::named_plainly(name, Quantity::Time));
            let Some(unit) = found.unit.or(found.column.unit.as_deref()).or(counted) else {
                without.push((found.key(), epoch::usual_unit(found.column, quantity), found.column.into()));
                continue;
            };
            let (factor, problem) = match found.choice.and_then(|choice| choice.scale) {
                Some(scale) => {
                    let volts = unit_factor(unit, Dimension::Voltage);
                    (volts.map(|volts| volts * scale), UnitProblem::NoVolts(unit.to_owned()))
                }
                None => {
                    let factor = unit_factor(unit, quantity.dimension());
                    (factor, UnitProblem::Unknown(quantity, unit.to_owned()))
                }
            };
            let factor = factor.ok_or_else(|| found.wrong_unit(problem))?;
            used.push(found.used(unit.to_owned(), factor));
        }
        if without.is_empty() {
            return Ok(used);
        }
        // What stands in brackets behind the one name without a unit was meant as one.
        let bare = |found: &&Found<'_>| {
            let given = found.unit.or(found.column.unit.as_deref());
            given.is_none() && matches!(self.without_plain_unit(found), Ok(None))
        };
        if let ([_], Some(found)) = (&without[..], found.iter().find(bare))
            && let Some(unit) = found.column.name.as_deref().and_then(in_brackets)
        {
            return Err(found.wrong_unit(UnitProblem::Unknown(found.quantity(), unit.to_owned())));
        }
        Err(ColumnError::NoUnit {
            without,
            travel: self.unnamed_travel(found),
        })
    }
}

/// The one word in brackets at the end of a name, as in `Force (furlong)`.
fn in_brackets(name: &str) -> Option<&str> {
    let (_, word) = name.trim_end().strip_suffix(')')?.rsplit_once('(')?;
    let word = word.trim();
    (!word.is_empty() && !word.contains(char::is_whitespace)).then_some(word)
}
