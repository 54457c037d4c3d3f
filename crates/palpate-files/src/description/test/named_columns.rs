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

const COLUMNS: &str = "a list of time, displacement, force, stress, strain, modulus, compliance, torque, angle or deflection, each as \
    QUANTITY=COLUMN:UNIT, such as \"force=Kraft:N,displacement=Weg:mm,time=Zeit:s\" (a column by its name or its number from 1; a unit in \
    the header may be left out; a minus before it turns the sign; \"time=:10 kHz\" counts rows; \"deflection=2:nm:0.04 N/m\" makes the \
    force of a cantilever)";
/// A deflection is taken off the height of the cantilever's base, which a header may call by other names than the indentation.
const HEIGHT: &str = "the height of the cantilever's base beside its deflection, such as \
    \"displacement=height:-um,deflection=deflection:nm:0.04 N/m\"";
/// The name of the deflection of a cantilever among the quantities.
const DEFLECTION: &str = "deflection";

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
        let (named, stated) = entry.split_once('=').ok_or_else(|| error(None))?;
        let quantity = quantity_of(named).ok_or_else(|| error(None))?;
        let is_deflection = named.trim() == DEFLECTION;
        let (stated, spring_constant) = if is_deflection { with_stiffness(stated) } else { (stated, None) };
        let (name, unit) = stated.rsplit_once(':').map_or((stated, ""), |(name, unit)| (name.trim(), unit.trim()));
        // A minus alone is the unit of a ratio.
        let turned = unit.strip_prefix('-').map(str::trim_start).filter(|unit| !unit.is_empty());
        let (unit, sign) = turned.map_or((unit, 1.0), |unit| (unit, -1.0));
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
        let place = if is_deflection { &mut columns.deflection } else { columns.place(quantity) };
        if place.is_some() || sign < 0.0 && quantity == Quantity::Time {
            return Err(error(None));
        }
        *place = Some(ColumnChoice {
            column,
            unit: Some(unit.to_owned()).filter(|unit| !unit.is_empty() && rate.is_none()),
            rate,
            sign,
            ..ColumnChoice::default()
        });
        columns.spring_constant = columns.spring_constant.or(spring_constant);
    }
    let count = |is_one: fn(Quantity) -> bool| {
        let measured = columns.measured();
        measured.filter(|(quantity, _)| is_one(*quantity)).count()
    };
    // The spring constant makes the force.
    let loads = count(Quantity::is_load) + usize::from(columns.spring_constant.is_some());
    if loads > 1 || count(Quantity::is_travel) > 1 {
        return Err(error(None));
    }
    if columns.deflection.is_some() && columns.displacement.is_none() {
        return Err(ChoiceError {
            expected: HEIGHT,
            ..error(None)
        });
    }
    Ok(columns)
}

/// What is stated of a deflection, and behind the last colon the spring constant of its cantilever, N/m.
fn with_stiffness(stated: &str) -> (&str, Option<f64>) {
    let parts = stated.rsplit_once(':').and_then(|(stated, last)| {
        let stiffness = units::parse(last.trim(), Dimension::Stiffness).ok()?;
        (stiffness > 0.0).then_some((stated, Some(stiffness)))
    });
    parts.unwrap_or((stated, None))
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

/// The quantity of a name; a deflection is a displacement.
fn quantity_of(name: &str) -> Option<Quantity> {
    if name.trim() == DEFLECTION {
        return Some(Quantity::Displacement);
    }
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
        for (quantity, stated) in upper.measured() {
            for other in Quantity::ALL.into_iter().filter(|other| *other != quantity) {
                if quantity.is_load() && other.is_load() || quantity.is_travel() && other.is_travel() {
                    *self.place(other) = None;
                }
            }
            if quantity.is_load() {
                self.spring_constant = None;
            }
            lay(self.place(quantity), stated);
        }
        if let Some(stated) = &upper.deflection {
            lay(&mut self.deflection, stated);
        }
        if upper.spring_constant.is_some() {
            self.spring_constant = upper.spring_constant;
            for load in Quantity::ALL.into_iter().filter(|quantity| quantity.is_load()) {
                *self.place(load) = None;
            }
        }
    }
}

/// Takes a column, and its unit and sign where any is stated, in place of those of a description.
fn lay(own: &mut Option<ColumnChoice>, stated: &ColumnChoice) {
    let own = own.get_or_insert_default();
    own.column.clone_from(&stated.column);
    own.rate = stated.rate;
    if stated.rate.is_some() {
        own.unit = None;
    }
    if stated.unit.is_some() {
        own.unit.clone_from(&stated.unit);
        (own.unit_by, own.scale, own.travel_per_unit) = (None, None, None);
    }
    if stated.sign < 0.0 {
        own.sign = stated.sign;
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
    fn the_deflection_of_a_cantilever_is_named_with_its_height_and_spring_constant() {
        let columns = parsed("displacement=height:-um,deflection=bend: x:nm:0.04 N/m,time=1:s").unwrap();
        let (height, bend) = (columns.displacement.unwrap(), columns.deflection.unwrap());
        assert_eq!((height.sign, height.unit.as_deref()), (-1.0, Some("um")));
        assert_eq!(bend.column, Some(ColumnRef::Name("bend: x".to_owned())));
        assert_eq!((bend.sign, bend.unit.as_deref(), columns.spring_constant), (1.0, Some("nm"), Some(0.04)));
        // The unit stands in the header; or the force in a column of its own.
        let columns = parsed("displacement=1,deflection=2:40 mN/m").unwrap();
        assert_eq!((columns.deflection.unwrap().unit, columns.spring_constant), (None, Some(0.04)));
        let columns = parsed("displacement=1:nm,deflection=2:nm,force=3:nN").unwrap();
        assert_eq!((columns.spring_constant, columns.force.is_some()), (None, true));
        // A minus alone is a unit.
        assert_eq!(parsed("strain=2:-").unwrap().strain.unwrap().unit.as_deref(), Some("-"));
        for (text, expected) in [
            ("deflection=2:nm:0.04 N/m", "the height of the cantilever's base"),
            ("displacement=1:nm,deflection=2:nm:0.04 N/m,force=3:nN", "a list of"),
            ("displacement=1:nm,deflection=2:nm,deflection=3:nm", "a list of"),
            ("time=1:-s", "a list of"),
        ] {
            let error = parsed(text).unwrap_err();
            assert!(error.to_string().starts_with(&format!("expected {expected}")), "{text}: {error}");
        }
        // A stiffness that is none is taken for a unit.
        let error = parsed("displacement=1:nm,deflection=2:nm:-1 N/m").unwrap_err();
        assert!(error.hint().contains("N/m"), "{}", error.hint());
    }

    #[test]
    fn a_typed_spring_constant_goes_before_a_described_force() {
        let afm = parsed("displacement=1:um,deflection=2:nm:0.04 N/m").unwrap();
        let mut described = parsed("displacement=height:-um,force=3:nN").unwrap();
        described.lay_over(&afm);
        let height = described.displacement.clone().unwrap();
        assert_eq!((height.column, height.sign), (Some(ColumnRef::Number(1)), -1.0));
        assert_eq!((described.spring_constant, described.force.is_some()), (Some(0.04), false));
        assert_eq!(described.deflection.as_ref().unwrap().column, Some(ColumnRef::Number(2)));
        described.lay_over(&parsed("force=3:nN").unwrap());
        assert_eq!((described.spring_constant, described.force.is_some()), (None, true));
        assert!(described.deflection.is_some());
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
