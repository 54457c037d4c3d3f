//! The tables `[clock]`, `[force]` and `[machine]` of a test: corrections that nobody makes unasked.

use palpate::{
    record::{Baseline, Compliance, ComplianceTable, CorrectionOptions, SkewChoice},
    units::{self, Dimension},
};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{error::DescriptionError, quantity::QuantityText, source::Source};

/// Time stamps.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ClockCorrections")]
pub(super) struct ClocksTable {
    /// How much later the force is stamped than the displacement: "report" (say what the ramps tell, change nothing; the
    /// default), "auto" (take it away), or a time such as "35 ms", negative where the force is stamped too early.
    #[schemars(extend("examples" = ["report", "auto", "35 ms"]))]
    skew: Option<String>,
    /// Resample to this rate, such as "100 Hz": means where that is coarser than the record, else straight lines.
    resample: Option<QuantityText>,
}

/// The force without contact.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ForceCorrections")]
pub(super) struct ForceTable {
    /// What to take off the force: "none" (the default), "constant" (its median without contact) or "sloped" (a line in
    /// time, for a load cell that drifts).
    baseline: Option<BaselineName>,
    /// From when to when nothing touches, as the record counts time, such as ["0 s", "2 s"]. Found if left out: before
    /// first touch, and after the jaw has left.
    baseline_window: Option<(QuantityText, QuantityText)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "Baseline")]
enum BaselineName {
    /// Nothing is taken off.
    None,
    /// The median.
    Constant,
    /// A line in time.
    Sloped,
}

/// Which machine it was, and what it gives way itself, to be taken off the displacement.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Machine", extend("not" = { "required": ["compliance", "compliance_table"] }))]
pub(super) struct MachineTable {
    /// A machine or gripper whose conventions are known, by name; what this description says itself goes before.
    pub(super) preset: Option<String>,
    /// Way per force, such as "0.5 um/N". For a cantilever of spring constant k it is 1/k.
    compliance: Option<QuantityText>,
    /// Rows of force and deflection, such as ["10 N", "4 um"]; forces rise, and all forces of the record lie between them.
    compliance_table: Option<Vec<(QuantityText, QuantityText)>>,
}

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
