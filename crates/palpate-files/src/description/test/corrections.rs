//! The tables `[clock]`, `[force]` and `[machine]` of a test: corrections that nobody makes unasked.

use palpate::{
    record::{Baseline, Compliance, ComplianceTable, CorrectionOptions, SkewChoice},
    units::{self, Dimension},
};

use super::tables::{BaselineName, ClocksTable, ForceTable, MachineTable};
use crate::description::text::{error::DescriptionError, quantity::QuantityText, source::Source};

const SKEW: &str = "\"report\", \"auto\" or a time such as \"35 ms\"";

/// All corrections that a test asks for.
pub(super) fn checked(
    source: &Source<'_>,
    clock: &ClocksTable,
    force: &ForceTable,
    machine: &MachineTable,
) -> Result<CorrectionOptions, DescriptionError> {
    let resample = clock.resample.as_ref();
    let baseline = match force.baseline {
        None | Some(BaselineName::None) => None,
        Some(BaselineName::Constant) => Some(Baseline::Constant),
        Some(BaselineName::Sloped) => Some(Baseline::Sloped),
    };
    if baseline.is_none() && force.baseline_window.is_some() {
        let reason = "without a baseline that is taken off";
        return Err(source.unused("force.baseline_window", reason, "set baseline = \"constant\" or \"sloped\""));
    }
    Ok(CorrectionOptions {
        skew: clock.skew.as_deref().map_or(Ok(SkewChoice::Report), |text| skew(source, text))?,
        resample: resample.map(|rate| source.positive("clock.resample", rate, Dimension::Frequency)).transpose()?,
        baseline,
        baseline_window: force.baseline_window.as_ref().map(|window| span(source, window)).transpose()?,
        compliance: compliance(source, machine)?,
    })
}

fn skew(source: &Source<'_>, text: &str) -> Result<SkewChoice, DescriptionError> {
    let key = "clock.skew";
    match text.trim() {
        "report" => Ok(SkewChoice::Report),
        "auto" => Ok(SkewChoice::Auto),
        other => match units::parse(other, Dimension::Time) {
            Ok(seconds) => Ok(SkewChoice::Given(seconds)),
            Err(units::UnitError::NotANumber { .. }) => Err(source.value(key, SKEW, &format!("\"{text}\""))),
            Err(error) => Err(DescriptionError::Quantity {
                place: source.place(key),
                found: format!("\"{text}\""),
                source: error,
            }),
        },
    }
}

fn span(source: &Source<'_>, (from, until): &(QuantityText, QuantityText)) -> Result<(f64, f64), DescriptionError> {
    let key = "force.baseline_window";
    let (start, end) = (source.si(key, from, Dimension::Time)?, source.si(key, until, Dimension::Time)?);
    if start < end {
        return Ok((start, end));
    }
    Err(source.value(key, "two times, the earlier first", &format!("[{from}, {until}]")))
}

fn compliance(source: &Source<'_>, machine: &MachineTable) -> Result<Option<Compliance>, DescriptionError> {
    let (key, table_key) = ("machine.compliance", "machine.compliance_table");
    match (&machine.compliance, &machine.compliance_table) {
        (Some(_), Some(_)) => Err(source.both(key, table_key)),
        (None, None) => Ok(None),
        (Some(written), None) => {
            let given = source.si(key, written, Dimension::Compliance)?;
            let compliance = Compliance::constant(given);
            compliance.map(Some).map_err(|_| source.value(key, "a compliance of 0 m/N or more", written))
        }
        (None, Some(rows)) => {
            let row = |(force, deflection): &(QuantityText, QuantityText)| {
                Ok((
                    source.si(table_key, force, Dimension::Force)?,
                    source.si(table_key, deflection, Dimension::Length)?,
                ))
            };
            let rows: Vec<(f64, f64)> = rows.iter().map(row).collect::<Result<_, _>>()?;
            let table = ComplianceTable::new(&rows);
            let table = table.map_err(|error| source.value(table_key, "rows of force and deflection", &error))?;
            Ok(Some(Compliance::Table(table)))
        }
    }
}
