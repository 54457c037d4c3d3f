//! Parameters of fitted laws with their units and uncertainty, as documents and tables state them.

use std::collections::BTreeMap;

use palpate::calibrate::{Material, MaterialParameter, MaterialUnit};
use palpate::fit::{Estimate, Fit, Parameter, ParameterKind, ParameterName, ParameterRole, ParameterUnit};
use palpate::units::{suited, without_unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Quantity, word};
use crate::number::exact;
use crate::table::{Cell, Table};

/// A parameter of a fitted law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ParameterDocument {
    /// The estimate; `null` where the fit ended at a bound or short of an optimum, and the value is none.
    pub value: Option<f64>,
    /// Its unit, `1` of a dimensionless parameter.
    pub unit: String,
    /// `estimated` from the data, `given`, or `derived` from the others.
    pub role: String,
    /// Standard error for residuals that correlate as they do; `null` where the data leave the parameter open.
    pub standard_error: Option<f64>,
    /// Standard error as if the residuals were white noise, as other software states it.
    pub white_standard_error: Option<f64>,
    /// Confidence interval for residuals that correlate as they do; an end that the data leave open is `null`.
    pub interval: Option<[Option<f64>; 2]>,
}

/// A parameter as people name it: without the unit, which stands beside it. `time_constant_1_s` is "time constant 1".
#[must_use]
pub fn parameter_title(name: &str) -> String {
    without_unit(name).replace('_', " ")
}

/// Whether values of a parameter are of one quantity for one exponent alone, as its unit is: N^(1-n)/s of a rate coefficient.
#[must_use]
pub fn depends_on_exponent(name: &str) -> bool {
    let kind = name.parse().map(|name: ParameterName| name.kind);
    matches!(kind, Ok(ParameterKind::RateCoefficient | ParameterKind::Coefficient))
}

/// What is to be known where those parameters are left out.
pub const MIXED_EXPONENTS: &str =
    "The rate coefficient is left out where exponents differ: it is of another quantity for each.";

/// Parameters by their names.
pub type Parameters = BTreeMap<String, ParameterDocument>;

impl ParameterDocument {
    pub(crate) fn new(estimate: Option<&Estimate>, unit: String, role: ParameterRole) -> Self {
        let finite = |end: f64| Some(end).filter(|end| end.is_finite());
        Self {
            value: estimate.and_then(|estimate| finite(estimate.value)),
            unit,
            role: word(role),
            standard_error: estimate.and_then(|estimate| estimate.standard_error),
            white_standard_error: estimate.and_then(|estimate| estimate.white_standard_error),
            interval: estimate.and_then(|estimate| estimate.interval).map(|(low, high)| [finite(low), finite(high)]),
        }
    }

    /// Value with interval and unit as people read them, in the unit that suits the size; `(given)` where it was.
    pub(crate) fn shown(&self) -> (String, String) {
        let (unit, factor) = suited(&self.unit, self.value.unwrap_or(0.0));
        let unit = if unit == "1" { "" } else { unit };
        let text = match self.value.filter(|_| self.role == word(ParameterRole::Given)) {
            Some(given) => format!("{} (given)", exact(given * factor)),
            None => self.cell().shown(factor),
        };
        (text, unit.to_owned())
    }

    /// The parameter as a cell of a table.
    #[must_use]
    pub fn cell(&self) -> Cell {
        let open = |interval: [Option<f64>; 2]| {
            (interval[0].unwrap_or(f64::NEG_INFINITY), interval[1].unwrap_or(f64::INFINITY))
        };
        match self.value {
            None => Cell::missing("a parameter is at its bound, or the fit did not converge"),
            Some(value) => Cell::Estimate(Estimate {
                value,
                standard_error: self.standard_error,
                white_standard_error: self.white_standard_error,
                interval: self.interval.map(open),
            }),
        }
    }
}

/// The parameters of a fit to this quantity.
#[must_use]
pub fn parameters_of(fit: &Fit, quantity: Quantity) -> Parameters {
    let exponent = fit.value("exponent");
    let document = |parameter: &Parameter| {
        let unit = unit_of(parameter.unit, quantity, exponent);
        let known = parameter.determined(fit.termination);
        (parameter.name.to_string(), ParameterDocument::new(known, unit, parameter.role))
    };
    fit.parameters.iter().map(document).collect()
}

/// The parameters of a calibrated material, in their order.
#[must_use]
pub fn parameters_of_material(material: &Material, is_good: bool) -> Vec<(String, ParameterDocument)> {
    let document = |parameter: &MaterialParameter| {
        let role = if Material::is_given(material.candidate(), &parameter.name) {
            ParameterRole::Given
        } else {
            ParameterRole::Estimated
        };
        let known = Some(&parameter.estimate).filter(|_| is_good || role == ParameterRole::Given);
        (parameter.name.clone(), ParameterDocument::new(known, si_unit(parameter.unit).to_owned(), role))
    };
    material.parameters().iter().map(document).collect()
}

/// The SI unit of a parameter of a material.
#[must_use]
pub fn si_unit(unit: MaterialUnit) -> &'static str {
    match unit {
        MaterialUnit::One => "1",
        MaterialUnit::Second => "s",
        MaterialUnit::PerSecond => "1/s",
        MaterialUnit::Metre => "m",
        MaterialUnit::Newton => "N",
        MaterialUnit::Pascal => "Pa",
    }
}

/// The SI unit of a parameter of a law fitted to this quantity.
fn unit_of(unit: ParameterUnit, quantity: Quantity, exponent: Option<f64>) -> String {
    let own = quantity.unit();
    match unit {
        ParameterUnit::One => "1".to_owned(),
        ParameterUnit::Second => "s".to_owned(),
        ParameterUnit::PerSecond => "1/s".to_owned(),
        ParameterUnit::Signal => own.to_owned(),
        ParameterUnit::SignalPerSecond => format!("{own}/s"),
        ParameterUnit::SignalPerPower => format!("{own}/s^order"),
        ParameterUnit::RateCoefficient if quantity == Quantity::Strain || exponent == Some(1.0) => "1/s".to_owned(),
        ParameterUnit::RateCoefficient => match exponent.filter(|n| n.fract() == 0.0) {
            Some(n) => format!("{own}^{}/s", exact(1.0 - n)),
            None => format!("{own}^(1-n)/s"),
        },
    }
}

/// A parameter of a law on a hold of a record: a row of `parameters.csv`.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterRow {
    /// The file of the record.
    pub record: String,
    /// Which of several tests in it; none of a file with one.
    pub part: Option<String>,
    /// Number of the hold, from 1; none for a law of the whole record.
    pub hold: Option<usize>,
    /// The law as `--laws` takes it.
    pub law: String,
    /// Name of the parameter.
    pub name: String,
    /// The parameter.
    pub parameter: ParameterDocument,
    /// Why the fit ended.
    pub termination: String,
    /// `time` or `rate`: in which domain the law was fitted.
    pub domain: String,
    /// Whether it is the law that is recommended for the hold, or the one calibrated.
    pub is_recommended: bool,
}

/// A column of the tidy table of parameters: what it holds, and where that stands in a row.
#[derive(Debug, Clone, Copy)]
pub enum ParameterColumn {
    /// Words.
    Text(fn(&ParameterRow) -> String),
    /// Words, or none.
    OptionalText(fn(&ParameterRow) -> Option<String>),
    /// A count.
    Count(fn(&ParameterRow) -> Option<usize>),
    /// A number.
    Number(fn(&ParameterRow) -> Option<f64>),
    /// Yes or no.
    Flag(fn(&ParameterRow) -> bool),
}

/// The columns of the tidy table of parameters by their names, in order, wherever it is written.
pub const PARAMETER_COLUMNS: [(&str, ParameterColumn); 15] = [
    ("record", ParameterColumn::Text(|row| row.record.clone())),
    ("part", ParameterColumn::OptionalText(|row| row.part.clone())),
    ("hold", ParameterColumn::Count(|row| row.hold)),
    ("law", ParameterColumn::Text(|row| row.law.clone())),
    ("parameter", ParameterColumn::Text(|row| row.name.clone())),
    ("unit", ParameterColumn::Text(|row| row.parameter.unit.clone())),
    ("value", ParameterColumn::Number(|row| row.parameter.value)),
    ("standard_error", ParameterColumn::Number(|row| row.parameter.standard_error)),
    ("low", ParameterColumn::Number(|row| row.parameter.interval?[0])),
    ("high", ParameterColumn::Number(|row| row.parameter.interval?[1])),
    ("termination", ParameterColumn::Text(|row| row.termination.clone())),
    ("white_standard_error", ParameterColumn::Number(|row| row.parameter.white_standard_error)),
    ("role", ParameterColumn::Text(|row| row.parameter.role.clone())),
    ("domain", ParameterColumn::Text(|row| row.domain.clone())),
    ("recommended", ParameterColumn::Flag(|row| row.is_recommended)),
];

/// The tidy table of all parameters of all laws, one row a parameter.
#[must_use]
pub fn parameters_table(rows: &[ParameterRow]) -> Table {
    let cell = |column: ParameterColumn, row: &ParameterRow| match column {
        ParameterColumn::Text(of) => Cell::text(of(row)),
        ParameterColumn::OptionalText(of) => of(row).map_or(Cell::missing(""), Cell::text),
        ParameterColumn::Count(of) => of(row).map_or(Cell::missing(""), |count| Cell::Integer(count as i64)),
        ParameterColumn::Number(of) => Cell::number_or(of(row), 6, ""),
        ParameterColumn::Flag(of) => Cell::text(of(row).to_string()),
    };
    let mut table = Table::of("parameters", "Every parameter of every law.", rows);
    for (name, column) in PARAMETER_COLUMNS {
        table = table.column(name, name, "", |row| cell(column, row));
    }
    table.table()
}
