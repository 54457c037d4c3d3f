//! The tables of a test description as they stand in the file.

use schemars::JsonSchema;
use serde::{Deserialize, de::IgnoredAny};

use super::{
    column_tables::ColumnsTable, conditions::ConditionsTable, description::About, instrument::InstrumentTable,
};
use crate::{
    description::{
        body::tables::{SidesName, SpecimenTable},
        text::quantity::QuantityText,
    },
    table::ReadOptions,
};

/// A squeeze-and-hold test: its columns, the body, and the options of the analysis. Every table may be
/// omitted. Quantities are texts with a unit.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "palpate test description", rename = "Test")]
pub(crate) struct TestTables {
    #[serde(default)]
    pub(crate) about: About,
    #[serde(default)]
    pub(crate) file: ReadOptions,
    #[serde(default)]
    pub(crate) columns: ColumnsTable,
    #[serde(default)]
    pub(crate) clock: ClocksTable,
    #[serde(default)]
    pub(crate) force: ForceTable,
    #[serde(default)]
    pub(crate) machine: MachineTable,
    pub(crate) specimen: Option<SpecimenTable>,
    pub(crate) instrument: Option<InstrumentTable>,
    #[serde(default)]
    pub(crate) conditions: ConditionsTable,
    #[serde(default)]
    pub(crate) contact: ContactTable,
    #[serde(default)]
    pub(crate) phases: PhasesTable,
    #[serde(default)]
    pub(crate) fit: FitTable,
    /// Of a material file: its body is used, its law is ignored.
    #[serde(default)]
    #[schemars(skip)]
    pub(crate) law: Option<IgnoredAny>,
    #[serde(default)]
    #[schemars(skip)]
    pub(crate) calibration: Option<IgnoredAny>,
}

/// How the jaw meets the body.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Contact", extend("not" = { "required": ["layers", "layer_thickness"] }))]
pub(crate) struct ContactTable {
    /// Default: two sides for a ball, one side for other shapes.
    pub(crate) squeezed_from: Option<SidesName>,
    /// Whether the jaw can leave the body. Default: true for a body whose area grows (ball, pad, profile, indenter), else false.
    pub(crate) separation: Option<bool>,
    /// Number of layers for a simulation of the test, a real number of 1 or more.
    #[schemars(extend("minimum" = 1))]
    pub(crate) layers: Option<f64>,
    /// Thickness of one layer, instead of their number.
    pub(crate) layer_thickness: Option<QuantityText>,
    /// First touch: "auto" (estimated from the force), "as recorded" (displacement and force start at zero), one rule
    /// ("loading curve", "threshold", "two lines", "hertz", "ratio of variances"), or a displacement such as "2.5 mm". Default: "auto" for a ball,
    /// "as recorded" for other shapes.
    #[schemars(extend("examples" = ["auto", "as recorded", "threshold", "2.5 mm"]))]
    pub(crate) touch: Option<String>,
}

/// Detection of loading, hold and unloading. Omitted values are derived from the record.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Phases")]
pub(crate) struct PhasesTable {
    /// Largest deviation of the displacement from its level in a hold.
    pub(crate) tolerance: Option<QuantityText>,
    /// Shortest hold.
    pub(crate) minimum_hold: Option<QuantityText>,
    /// Speed below which the jaw is at rest, as a share of the speed of the ramps, between 0 and 1.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub(crate) still_below: Option<f64>,
    /// Start of the fit in a hold: "peak" of the force (the default), "settled" jaw, or a time after the
    /// peak such as "peak + 0.5 s".
    #[schemars(extend("examples" = ["peak", "settled", "peak + 0.5 s"]))]
    pub(crate) hold_start: Option<String>,
    /// Holds with given limits. If one is given, no others are detected.
    #[serde(default)]
    pub(crate) hold: Vec<HoldTable>,
}

/// A hold whose limits are given.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Hold")]
pub(crate) struct HoldTable {
    /// Its start, on the clock of the record.
    pub(crate) from: QuantityText,
    /// Its end.
    pub(crate) to: QuantityText,
    /// The quantity that the machine holds; derived from the record if omitted.
    pub(crate) mode: Option<HoldModeName>,
}

/// What a machine holds.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "HoldMode")]
pub(crate) enum HoldModeName {
    /// The displacement: the force relaxes.
    Displacement,
    /// The force: the displacement creeps.
    Force,
    /// Both move.
    Neither,
}

/// How to fit the law.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Fit")]
pub(crate) struct FitTable {
    /// Exponents to compare; 1, 2, 3, 5 and 7 if omitted.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0 }))]
    pub(crate) exponents: Option<Vec<f64>>,
    /// Whether to fit a free exponent too; true if omitted.
    pub(crate) free_exponent: Option<bool>,
    /// Range of the free exponent; 0.2 to 30 if omitted.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0 }))]
    pub(crate) exponent_range: Option<[f64; 2]>,
    /// Coverage of confidence intervals, between 0 and 1; 0.95 if omitted.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub(crate) confidence: Option<f64>,
    /// Fit at most this time of each hold, from the start of its fit.
    pub(crate) until: Option<QuantityText>,
}

/// Time stamps.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ClockCorrections")]
pub(crate) struct ClocksTable {
    /// Delay of the force stamps after those of the displacement: "report" (estimate it from the ramps, correct nothing; the
    /// default), "auto" (correct it), or a time such as "35 ms", negative if the force is stamped too early.
    #[schemars(extend("examples" = ["report", "auto", "35 ms"]))]
    pub(crate) skew: Option<String>,
    /// Resample to this rate, such as "100 Hz": by averages if coarser than the record, otherwise by linear interpolation.
    pub(crate) resample: Option<QuantityText>,
}

/// The force without contact.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ForceCorrections")]
pub(crate) struct ForceTable {
    /// Filter of first order behind which the force was recorded, which is undone: its time constant such as "0.2 s" or its corner
    /// frequency such as "0.8 Hz".
    #[schemars(extend("examples" = ["0.2 s", "0.8 Hz"]))]
    pub(crate) filter: Option<QuantityText>,
    /// Baseline to subtract from the force: "none" (the default), "constant" (its median without contact) or "sloped" (a line in
    /// time, for a load cell that drifts).
    pub(crate) baseline: Option<BaselineName>,
    /// Time window without contact, on the clock of the record, such as ["0 s", "2 s"]. Default: before
    /// first touch and after the loss of contact.
    pub(crate) baseline_window: Option<(QuantityText, QuantityText)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "Baseline")]
pub(crate) enum BaselineName {
    /// No baseline.
    None,
    /// The median.
    Constant,
    /// A line in time.
    Sloped,
}

/// The machine, and its compliance, which is subtracted from the displacement.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Machine", extend("not" = { "required": ["compliance", "compliance_table"] }))]
pub(crate) struct MachineTable {
    /// Preset of a machine or gripper, by name; fields of this description take precedence.
    pub(crate) preset: Option<String>,
    /// Deflection per force, such as "0.5 um/N". For a cantilever of spring constant k it is 1/k.
    pub(crate) compliance: Option<QuantityText>,
    /// Rows of force and deflection, such as ["10 N", "4 um"]; forces rise, and all forces of the record lie between them.
    pub(crate) compliance_table: Option<Vec<(QuantityText, QuantityText)>>,
}
