//! What `inspect` finds, for programs.

use palpate::analysis::Finding;
use palpate::segment::{HoldMode, Phase, Segment};
use palpate_files::description::TestDescription;
use palpate_files::open::Contents;
use palpate_files::record::{ColumnUse, RecordFile, Role};
use palpate_files::table::{Part, SkippedPart};
use palpate_report::document::Software;
use palpate_report::spelling::with_flags;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::cut::Cut;
use crate::JobError;

/// `palpate.inspection/1`: what is in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InspectionDocument {
    /// Always `palpate.inspection/1`.
    pub schema: String,
    /// What wrote this.
    pub software: Software,
    /// The file.
    pub path: String,
    /// Format of the file.
    pub format: String,
    /// Its tests.
    pub tests: Vec<InspectedTest>,
    /// What it holds besides, with why that is no test.
    pub skipped: Vec<SkippedDocument>,
}

/// A test of a file. Only one that is alone, or was chosen, is read to its phases; of several the use of columns is that of the first which
/// can be read.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InspectedTest {
    /// What the file calls it; `null` where it is the only one and has no name.
    pub name: Option<String>,
    /// Number of rows; `null` where the test was not read and the file does not state it.
    pub rows: Option<usize>,
    /// Columns of the file.
    pub columns: Vec<InspectedColumn>,
    /// The record; `null` where it was not read, or there is none.
    pub record: Option<InspectedRecord>,
    /// Why there is no record, or no phases.
    pub refused: Option<RefusalDocument>,
}

/// A column of a file, and what it is used as.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InspectedColumn {
    /// Its number, from 1.
    pub number: usize,
    /// Its name in the file.
    pub name: Option<String>,
    /// Its unit in the file.
    pub unit: Option<String>,
    /// Its first value.
    pub sample: String,
    /// What it is used as; empty where it is not used.
    pub used_as: Vec<ColumnRole>,
}

/// A use of a column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ColumnRole {
    /// Quantity: `time`, `displacement`, `force`, `stress`, …
    pub quantity: String,
    /// `values`; `added` to those of another column; `deflection` that is subtracted; or `clock` of the quantity.
    #[schemars(extend("enum" = ["values", "added", "deflection", "clock"]))]
    pub role: String,
    /// Unit in which its values are read.
    pub unit: String,
    /// −1 where the sign is turned, else 1.
    pub sign: f64,
    /// Whether the description names the column; else it is guessed from its name.
    pub column_is_stated: bool,
    /// Whether the description states the unit; else it is that of the file.
    pub unit_is_stated: bool,
}

/// A record and its phases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InspectedRecord {
    /// First and last time, s.
    pub time_s: [f64; 2],
    /// Median interval between samples, s.
    pub sample_interval_s: f64,
    /// Lowest and highest displacement, m; `null` where none was recorded.
    pub displacement_m: Option<[f64; 2]>,
    /// Lowest and highest force, N.
    pub force_n: [f64; 2],
    /// Corrections that were made, a sentence each.
    pub corrections: Vec<String>,
    /// Findings about columns and signs, a sentence each.
    pub findings: Vec<String>,
    /// Phases in order; empty where none were detected.
    pub phases: Vec<PhaseDocument>,
}

/// A phase.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PhaseDocument {
    /// `rest`, `loading`, `hold` or `unloading`.
    #[schemars(extend("enum" = ["rest", "loading", "hold", "unloading"]))]
    pub phase: String,
    /// Of a hold, the controlled variable: `displacement`, `force` or `neither`; else `null`.
    #[schemars(extend("enum" = ["displacement", "force", "neither", null]))]
    pub mode: Option<String>,
    /// Whether ramps, or a drift that was rounded, explain the force of this hold nearly as well.
    pub doubtful: bool,
    /// Time of its first sample, s.
    pub start_s: f64,
    /// Time of its last sample, s.
    pub end_s: f64,
    /// Number of samples.
    pub samples: usize,
}

/// What a file holds besides tests.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SkippedDocument {
    /// What the file calls it.
    pub name: String,
    /// Why it is no test.
    pub reason: String,
}

/// Why there is no result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RefusalDocument {
    /// What was expected and what was found.
    pub message: String,
    /// Remedy.
    pub hint: Option<String>,
}

impl From<&JobError> for RefusalDocument {
    fn from(error: &JobError) -> Self {
        Self {
            message: with_flags(&error.to_string()),
            hint: error.hint.as_deref().map(with_flags),
        }
    }
}

impl InspectionDocument {
    /// The document of a file whose tests were looked into.
    pub(super) fn new(contents: &Contents, skipped: &[SkippedPart]) -> Self {
        Self {
            schema: "palpate.inspection/1".to_owned(),
            software: Software::this(),
            path: contents.input.name.display().to_string(),
            format: contents.format.to_string(),
            tests: Vec::new(),
            skipped: skipped
                .iter()
                .map(|part| SkippedDocument {
                    name: part.name.clone(),
                    reason: part.reason.clone(),
                })
                .collect(),
        }
    }
}

impl InspectedTest {
    /// A test by what its file says of it.
    pub(super) fn of_part(part: &Part) -> Self {
        let columns = part.columns.iter().map(|column| InspectedColumn {
            number: column.number,
            name: column.name.clone(),
            unit: column.unit.clone(),
            sample: column.sample.trim().to_owned(),
            used_as: Vec::new(),
        });
        Self {
            name: part.name.clone(),
            rows: part.rows.and_then(|rows| usize::try_from(rows).ok()),
            columns: columns.collect(),
            ..Self::default()
        }
    }

    /// What was read of it.
    pub(super) fn read(&mut self, file: &RecordFile, test: Option<&TestDescription>) {
        self.rows = Some(file.rows);
        for column in &mut self.columns {
            let used = file.columns.iter().filter(|used| used.number == column.number);
            column.used_as = used.map(|used| role(used, test)).collect();
        }
    }

    /// Its record and phases.
    pub(super) fn cut(&mut self, file: &RecordFile, cut: &Cut) {
        let record = &file.record;
        let (time, range) = (record.time(), |values: &[f64]| {
            values.iter().fold([f64::MAX, f64::MIN], |[low, high], value| [low.min(*value), high.max(*value)])
        });
        let times = cut.record.time();
        let phase = |segment: &Segment| PhaseDocument {
            phase: match segment.phase {
                Phase::Rest => "rest",
                Phase::Loading => "loading",
                Phase::Hold => "hold",
                Phase::Unloading => "unloading",
            }
            .to_owned(),
            mode: segment.mode.map(|mode| {
                match mode {
                    HoldMode::DisplacementHeld => "displacement",
                    HoldMode::ForceHeld => "force",
                    HoldMode::Neither => "neither",
                }
                .to_owned()
            }),
            doubtful: segment.doubtful,
            start_s: times[segment.start],
            end_s: times[segment.end - 1],
            samples: segment.len(),
        };
        self.record = Some(InspectedRecord {
            time_s: [time[0], time[time.len() - 1]],
            sample_interval_s: record.sample_interval(),
            displacement_m: record.displacement().map(range),
            force_n: range(record.force()),
            corrections: cut.record.corrections().iter().map(ToString::to_string).collect(),
            findings: cut.findings().iter().map(Finding::observation).collect(),
            phases: cut.found().map_or_else(Vec::new, |found| found.segments.iter().map(phase).collect()),
        });
    }
}

/// What a column is used as, and how that is known.
fn role(used: &ColumnUse, test: Option<&TestDescription>) -> ColumnRole {
    let (quantity, role) = match used.role {
        Role::Values(quantity) => (quantity, "values"),
        Role::Added(quantity) => (quantity, "added"),
        Role::Deflection => (used.role.measured(), "deflection"),
        Role::ClockOf(quantity) => (quantity, "clock"),
    };
    let choice = test.and_then(|test| match used.role {
        Role::Deflection => test.columns.deflection.as_ref(),
        _ => test.columns.stated(|stated| stated == quantity).map(|(_, choice)| choice),
    });
    ColumnRole {
        quantity: quantity.to_string(),
        role: role.to_owned(),
        unit: used.unit.clone(),
        sign: used.sign,
        column_is_stated: choice.is_some_and(|choice| choice.column.is_some()),
        unit_is_stated: choice.is_some_and(|choice| choice.unit.is_some()),
    }
}
