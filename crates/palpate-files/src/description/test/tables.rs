//! The tables of a test description as they stand in the file.

use schemars::JsonSchema;
use serde::{Deserialize, de::IgnoredAny};

use super::{column_tables::ColumnsTable, description::About};
use crate::{
    description::{
        body::tables::{SidesName, SpecimenTable},
        text::quantity::QuantityText,
    },
    table::ReadOptions,
};

/// A squeeze-and-hold test: what its record holds, what was tested, and how to evaluate it. Every table may be
/// left out. Quantities are texts with a unit.
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
    #[serde(default)]
    pub(crate) contact: ContactTable,
    #[serde(default)]
    pub(crate) phases: PhasesTable,
    #[serde(default)]
    pub(crate) fit: FitTable,
    /// Of a material file, whose body is taken and whose law is left aside.
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
    /// Two sides for a ball, one side for other shapes, unless said otherwise.
    pub(crate) squeezed_from: Option<SidesName>,
    /// Whether the jaw can leave the body: true for a ball, false for other shapes, unless said otherwise.
    pub(crate) separation: Option<bool>,
    /// Number of layers for a simulation of the test, any number of 1 or more.
    #[schemars(extend("minimum" = 1))]
    pub(crate) layers: Option<f64>,
    /// Thickness of one layer, instead of their number.
    pub(crate) layer_thickness: Option<QuantityText>,
    /// First touch: "auto" (found from the force), "as recorded" (displacement and force start at zero), one rule
    /// ("loading curve", "threshold", "two lines", "hertz", "ratio of variances"), or a displacement such as "2.5 mm". "auto" for a ball, "as recorded" for other shapes, unless said otherwise.
    #[schemars(extend("examples" = ["auto", "as recorded", "threshold", "2.5 mm"]))]
    pub(crate) touch: Option<String>,
}

/// How to find loading, hold and unloading. What is left out is derived from the record.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Phases")]
pub(crate) struct PhasesTable {
    /// How far the displacement may stray from its level in a hold.
    pub(crate) tolerance: Option<QuantityText>,
    /// Shortest hold.
    pub(crate) minimum_hold: Option<QuantityText>,
    /// Speed under which the jaw counts as standing still, as a share of the speed of the ramps, between 0 and 1.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub(crate) still_below: Option<f64>,
    /// From where in a hold laws are fitted: "peak" of the force (the default), "settled" jaw, or a time after the
    /// peak such as "peak + 0.5 s".
    #[schemars(extend("examples" = ["peak", "settled", "peak + 0.5 s"]))]
    pub(crate) hold_start: Option<String>,
    /// Holds with given limits. Where there are any, no others are sought.
    #[serde(default)]
    pub(crate) hold: Vec<HoldTable>,
}

/// A hold whose limits are given.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Hold")]
pub(crate) struct HoldTable {
    /// Its first moment, as the record counts time.
    pub(crate) from: QuantityText,
    /// Its last moment.
    pub(crate) to: QuantityText,
    /// What the machine holds; seen from the record if left out.
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
    /// Exponents to compare; 1, 2, 3, 5 and 7 if left out.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0 }))]
    pub(crate) exponents: Option<Vec<f64>>,
    /// Whether a free exponent is fitted too; true if left out.
    pub(crate) free_exponent: Option<bool>,
    /// Range in which the free exponent is sought; 0.2 to 30 if left out.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0 }))]
    pub(crate) exponent_range: Option<[f64; 2]>,
    /// Coverage of confidence intervals, between 0 and 1; 0.95 if left out.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub(crate) confidence: Option<f64>,
    /// Fit no more than this much of every hold, counted from where its fit starts.
    pub(crate) until: Option<QuantityText>,
}

/// Time stamps.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ClockCorrections")]
pub(crate) struct ClocksTable {
    /// How much later the force is stamped than the displacement: "report" (say what the ramps tell, change nothing; the
    /// default), "auto" (take it away), or a time such as "35 ms", negative where the force is stamped too early.
    #[schemars(extend("examples" = ["report", "auto", "35 ms"]))]
    pub(crate) skew: Option<String>,
    /// Resample to this rate, such as "100 Hz": means where that is coarser than the record, else straight lines.
    pub(crate) resample: Option<QuantityText>,
}

/// The force without contact.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ForceCorrections")]
pub(crate) struct ForceTable {
    /// What to take off the force: "none" (the default), "constant" (its median without contact) or "sloped" (a line in
    /// time, for a load cell that drifts).
    pub(crate) baseline: Option<BaselineName>,
    /// From when to when nothing touches, as the record counts time, such as ["0 s", "2 s"]. Found if left out: before
    /// first touch, and after the jaw has left.
    pub(crate) baseline_window: Option<(QuantityText, QuantityText)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "Baseline")]
pub(crate) enum BaselineName {
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
pub(crate) struct MachineTable {
    /// A machine or gripper whose conventions are known, by name; what this description says itself goes before.
    pub(crate) preset: Option<String>,
    /// Way per force, such as "0.5 um/N". For a cantilever of spring constant k it is 1/k.
    pub(crate) compliance: Option<QuantityText>,
    /// Rows of force and deflection, such as ["10 N", "4 um"]; forces rise, and all forces of the record lie between them.
    pub(crate) compliance_table: Option<Vec<(QuantityText, QuantityText)>>,
}
