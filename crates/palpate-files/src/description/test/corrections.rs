//! The tables `[clock]`, `[force]` and `[machine]` of a test: corrections that are made only on request.

use std::f64::consts::TAU;

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
    let baseline = match force.baseline {
        None | Some(BaselineName::None) => None,
        Some(BaselineName::Constant) => Some(Baseline::Constant),
        Some(BaselineName::Sloped) => Some(Baseline::Sloped),
    };
    if baseline.is_none() && force.baseline_window.is_some() {
        let reason = "without a baseline to subtract";
        return Err(source.unused("force.baseline_window", reason, "set baseline = \"constant\" or \"sloped\""));
    }
    let skew = clock.skew.as_deref().map_or(Ok(SkewChoice::Report), |text| skew(source, text))?;
    let force_filter = force.filter.as_ref().map(|text| filter(source, text)).transpose()?;
    let resample = source.positive_if("clock.resample", clock.resample.as_ref(), Dimension::Frequency)?;
    let key = "force.baseline_window";
    let window = force.baseline_window.as_slice();
    let baseline_window = source.rows(key, window, (Dimension::Time, Dimension::Time))?.pop();
    if let (Some((start, end)), [(from, until)]) = (baseline_window, window)
        && start >= end
    {
        return Err(source.value(key, "two times, the earlier first", &format!("[{from}, {until}]")));
    }
    Ok(CorrectionOptions {
        skew,
        force_filter,
        resample,
        baseline,
        baseline_window,
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
            Err(error) => Err(source.no_quantity(key, text, error)),
        },
    }
}

/// The time constant of a filter, s, which its corner frequency tells too: f = 1/(2π τ).
fn filter(source: &Source<'_>, text: &QuantityText) -> Result<f64, DescriptionError> {
    let key = "force.filter";
    match units::parse(&text.text, Dimension::Frequency) {
        Ok(corner) if corner > 0.0 => Ok(1.0 / (TAU * corner)),
        Ok(_) => Err(source.value(key, "a frequency above 0 Hz or a time above 0 s", text)),
        Err(_) => source.positive(key, text, Dimension::Time),
    }
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
            let rows = source.rows(table_key, rows, (Dimension::Force, Dimension::Length))?;
            let table = ComplianceTable::new(rows).map(|table| Some(Compliance::Table(table)));
            table.map_err(|error| source.value(table_key, "rows of force and deflection", &error))
        }
    }
}
