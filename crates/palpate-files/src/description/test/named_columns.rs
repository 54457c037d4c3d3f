//! The columns of a record as they are named on a command line.

use palpate::units::{self, Dimension, UnitError};

use super::{
    choices::ChoiceError,
    columns::{ColumnChoice, ColumnChoices},
};
use crate::{
    naming::{Quantity, unit_factor},
    table::{ColumnRef, EPOCH},
};

const COLUMNS: &str = "a list of time, displacement, force, stress, strain, modulus, compliance, torque or angle, each as \
    QUANTITY=COLUMN:UNIT, such as \"force=Kraft:N,displacement=Weg:mm,time=Zeit:s\" (a column by its name or its number from 1; a unit in \
    the header may be left out; \"time=:10 kHz\" counts rows)";

/// Columns of a record as they were typed.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedColumns {
    /// What was typed.
    pub text: String,
    /// What it says.
    pub columns: ColumnChoices,
}

impl NamedColumns {
    /// Which columns hold what: `force=Kraft:N,displacement=Weg:mm,time=Zeit:s`, with names or numbers of columns.
    ///
    /// # Errors
    /// [`ChoiceError`] for any other text, and for a unit that the quantity does not take.
    ///
    /// ```
    /// use palpate_files::{description::NamedColumns, table::ColumnRef};
    /// let columns = NamedColumns::parse("force=Kraft:N,time=1:ms")?.columns;
    /// assert_eq!(columns.force.and_then(|force| force.column), Some(ColumnRef::Name("Kraft".to_owned())));
    /// assert_eq!(columns.time.and_then(|time| time.unit).as_deref(), Some("ms"));
    /// # Ok::<(), palpate_files::description::ChoiceError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, ChoiceError> {
        let columns = parsed(text)?;
        let text = text.to_owned();
        Ok(Self { text, columns })
    }
}

fn parsed(text: &str) -> Result<ColumnChoices, ChoiceError> {
    let error = |source| ChoiceError {
        expected: COLUMNS,
        found: text.to_owned(),
        source,
    };
    let mut columns = ColumnChoices::default();
    for entry in entries(text) {
        let (quantity, stated) = entry.split_once('=').ok_or_else(|| error(None))?;
        let quantity = quantity_of(quantity).ok_or_else(|| error(None))?;
        let (name, unit) = stated.rsplit_once(':').map_or((stated, ""), |(name, unit)| (name.trim(), unit.trim()));
        let rate = Some(unit).filter(|_| quantity == Quantity::Time);
        let rate = rate.and_then(|unit| units::parse(unit, Dimension::Frequency).ok()).filter(|rate| *rate > 0.0);
        let since_1970 = quantity == Quantity::Time && unit.eq_ignore_ascii_case(EPOCH);
        if !unit.is_empty() && !since_1970 && rate.is_none() && unit_factor(unit, quantity.dimension()).is_none() {
            let (dimension, unit) = (quantity.dimension(), unit.to_owned());
            return Err(error(Some(UnitError::UnknownUnit { dimension, unit })));
        }
        let column = match name.trim() {
            "" if rate.is_some() => None,
            "" => return Err(error(None)),
            name => Some(match name.parse() {
                Ok(number) if number > 0 => ColumnRef::Number(number),
                _ => ColumnRef::Name(name.to_owned()),
            }),
        };
        let place = columns.place(quantity);
        if place.is_some() {
            return Err(error(None));
        }
        *place = Some(ColumnChoice {
            column,
            unit: Some(unit.to_owned()).filter(|unit| !unit.is_empty() && rate.is_none()),
            rate,
            ..ColumnChoice::default()
        });
    }
    for is_one in [Quantity::is_load, Quantity::is_travel] {
        if columns.all().into_iter().filter(|(quantity, _)| is_one(*quantity)).count() > 1 {
            return Err(error(None));
        }
    }
    Ok(columns)
}

/// The parts of a list between commas; a comma in the name of a column parts nothing.
fn entries(text: &str) -> Vec<String> {
    let mut entries: Vec<String> = Vec::new();
    for piece in text.split(',') {
        let begins = piece.split_once('=').is_some_and(|(quantity, _)| quantity_of(quantity).is_some());
        match entries.last_mut() {
            Some(last) if !begins => *last = format!("{last},{piece}"),
            _ => entries.push(piece.to_owned()),
        }
    }
    entries
}

fn quantity_of(name: &str) -> Option<Quantity> {
    Quantity::ALL.into_iter().find(|quantity| quantity.to_string() == name.trim())
}

impl ColumnChoices {
    fn place(&mut self, quantity: Quantity) -> &mut Option<ColumnChoice> {
        match quantity {
            Quantity::Time => &mut self.time,
            Quantity::Displacement => &mut self.displacement,
            Quantity::Force => &mut self.force,
            Quantity::Stress => &mut self.stress,
            Quantity::Strain => &mut self.strain,
            Quantity::Modulus => &mut self.modulus,
            Quantity::Compliance => &mut self.compliance,
            Quantity::Torque => &mut self.torque,
            Quantity::Angle => &mut self.angle,
        }
    }

    /// Takes the columns of `upper`, and their units where it says any, in place of its own.
    pub fn lay_over(&mut self, upper: &Self) {
        for (quantity, stated) in upper.all() {
            for other in Quantity::ALL.into_iter().filter(|other| *other != quantity) {
                if quantity.is_load() && other.is_load() || quantity.is_travel() && other.is_travel() {
                    *self.place(other) = None;
                }
            }
            let own = self.place(quantity).get_or_insert_default();
            own.column.clone_from(&stated.column);
            own.rate = stated.rate;
            if stated.rate.is_some() {
                own.unit = None;
            }
            if stated.unit.is_some() {
                own.unit.clone_from(&stated.unit);
                (own.unit_by, own.scale, own.travel_per_unit) = (None, None, None);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_may_hold_colons_commas_and_blanks() {
        let columns = parsed("force=Kraft, gefiltert:kN, displacement = Pos: x:mm,time=3").unwrap();
        let column = |choice: Option<ColumnChoice>| choice.and_then(|choice| Some((choice.column?, choice.unit)));
        let named = |name: &str, unit: &str| Some((ColumnRef::Name(name.to_owned()), Some(unit.to_owned())));
        assert_eq!(column(columns.force), named("Kraft, gefiltert", "kN"));
        assert_eq!(column(columns.displacement), named("Pos: x", "mm"));
        assert_eq!(column(columns.time), Some((ColumnRef::Number(3), None)));
    }

    #[test]
    fn what_is_no_list_of_columns_is_shown_one() {
        for text in ["", "Kraft", "force", "force=", "force=:N", "kraft=Kraft:N", "force=a,force=b", "force=a,stress=b"]
        {
            let error = parsed(text).unwrap_err();
            assert!(error.to_string().contains("force=Kraft:N,displacement=Weg:mm,time=Zeit:s"), "{text}: {error}");
        }
        let error = parsed("force=Kraft:mm").unwrap_err();
        assert!(error.hint().contains("mm") && error.hint().contains("kN"), "{}", error.hint());
    }

    #[test]
    fn what_is_typed_goes_before_what_is_described() {
        let mut described = parsed("stress=Spannung:MPa,displacement=2:mm").unwrap();
        if let Some(displacement) = &mut described.displacement {
            displacement.sign = -1.0;
        }
        described.lay_over(&parsed("force=Kraft:N,displacement=Weg").unwrap());
        let displacement = described.displacement.unwrap();
        assert_eq!((described.stress, displacement.sign, displacement.unit.as_deref()), (None, -1.0, Some("mm")));
        assert_eq!(displacement.column, Some(ColumnRef::Name("Weg".to_owned())));
    }
}
