//! Parameters of fitted laws with their units and uncertainty, as documents and tables state them.

use std::collections::BTreeMap;

use palpate::calibrate::{Material, MaterialUnit};
use palpate::fit::{Estimate, Fit, Parameter, ParameterRole, ParameterUnit};
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

/// Parameters by their names.
pub type Parameters = BTreeMap<String, ParameterDocument>;

impl ParameterDocument {
    fn new(estimate: Option<&Estimate>, unit: String, role: ParameterRole) -> Self {
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
    let document = |parameter: &palpate::calibrate::MaterialParameter| {
        let role = if Material::is_given(material.candidate, &parameter.name) {
            ParameterRole::Given
        } else {
            ParameterRole::Estimated
        };
        let known = Some(&parameter.estimate).filter(|_| is_good || role == ParameterRole::Given);
        (parameter.name.clone(), ParameterDocument::new(known, si_unit(parameter.unit).to_owned(), role))
    };
    material.parameters.iter().map(document).collect()
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
    /// The record.
    pub record: String,
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

/// The tidy table of all parameters of all laws, one row a parameter.
#[must_use]
pub fn parameters_table(rows: &[ParameterRow]) -> Table {
    let number = |value: Option<f64>| Cell::number_or(value, 6, "");
    let end = |row: &ParameterRow, which: usize| number(row.parameter.interval.and_then(|interval| interval[which]));
    Table::of("parameters", "Every parameter of every law.", rows)
        .column("Record", "record", "", |row| Cell::text(&row.record))
        .column("Hold", "hold", "", |row| row.hold.map_or(Cell::missing(""), |hold| Cell::Integer(hold as i64)))
        .column("Law", "law", "", |row| Cell::text(&row.law))
        .column("Parameter", "parameter", "", |row| Cell::text(&row.name))
        .column("Unit", "unit", "", |row| Cell::text(&row.parameter.unit))
        .column("Value", "value", "", |row| number(row.parameter.value))
        .column("Standard error", "standard_error", "", |row| number(row.parameter.standard_error))
        .column("Low", "low", "", |row| end(row, 0))
        .column("High", "high", "", |row| end(row, 1))
        .column("Ended", "termination", "", |row| Cell::text(&row.termination))
        .column("White standard error", "white_standard_error", "", |row| number(row.parameter.white_standard_error))
        .column("Role", "role", "", |row| Cell::text(&row.parameter.role))
        .column("Domain", "domain", "", |row| Cell::text(&row.domain))
        .column("Recommended", "recommended", "", |row| Cell::text(row.is_recommended.to_string()))
        .table()
}
