//! The tables of a test description as they stand in the file.

use schemars::JsonSchema;
use serde::{Deserialize, de::IgnoredAny};

use super::{
    column_tables::ColumnsTable,
    contact::SidesName,
    corrections::{ClocksTable, ForceTable, MachineTable},
    file::FileTable,
    quantity::QuantityText,
    specimen::SpecimenTable,
};

/// A squeeze-and-hold test: what its record holds, what was tested, and how to evaluate it. Every table may be
/// left out. Quantities are texts with a unit.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "palpate test description", rename = "Test")]
pub(super) struct TestTables {
    #[serde(default)]
    pub(super) about: AboutTable,
    #[serde(default)]
    pub(super) file: FileTable,
    #[serde(default)]
    pub(super) columns: ColumnsTable,
    #[serde(default)]
    pub(super) clock: ClocksTable,
    #[serde(default)]
    pub(super) force: ForceTable,
    #[serde(default)]
    pub(super) machine: MachineTable,
    pub(super) specimen: Option<SpecimenTable>,
    #[serde(default)]
    pub(super) contact: ContactTable,
    #[serde(default)]
    pub(super) phases: PhasesTable,
    #[serde(default)]
    pub(super) fit: FitTable,
    /// Of a material file, whose body is taken and whose law is left aside.
    #[serde(default)]
    #[schemars(skip)]
    pub(super) law: Option<IgnoredAny>,
    #[serde(default)]
    #[schemars(skip)]
    pub(super) calibration: Option<IgnoredAny>,
}

/// What the test is about.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "About")]
pub(super) struct AboutTable {
    /// Title for reports.
    pub(super) title: Option<String>,
    /// Where the record comes from.
    pub(super) source: Option<String>,
    /// Anything else.
    pub(super) note: Option<String>,
}

/// How the jaw meets the body.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Contact", extend("not" = { "required": ["layers", "layer_thickness"] }))]
pub(super) struct ContactTable {
    /// Two sides for a ball, one side for other shapes, unless said otherwise.
    pub(super) squeezed_from: Option<SidesName>,
    /// Whether the jaw can leave the body: true for a ball, false for other shapes, unless said otherwise.
    pub(super) separation: Option<bool>,
    /// Number of layers for a simulation of the test, any number of 1 or more.
    #[schemars(extend("minimum" = 1))]
    pub(super) layers: Option<f64>,
    /// Thickness of one layer, instead of their number.
    pub(super) layer_thickness: Option<QuantityText>,
    /// First touch: "auto" (found from the force), "as recorded" (displacement and force start at zero), one rule
    /// ("loading curve", "threshold", "two lines", "hertz", "ratio of variances"), or a displacement such as "2.5 mm". "auto" for a ball, "as recorded" for other shapes, unless said otherwise.
    #[schemars(extend("examples" = ["auto", "as recorded", "threshold", "2.5 mm"]))]
    pub(super) touch: Option<String>,
}

/// How to find loading, hold and unloading. What is left out is derived from the record.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Phases")]
pub(super) struct PhasesTable {
    /// How far the displacement may stray from its level in a hold.
    pub(super) tolerance: Option<QuantityText>,
    /// Shortest hold.
    pub(super) minimum_hold: Option<QuantityText>,
    /// Speed under which the jaw counts as standing still, as a share of the speed of the ramps, between 0 and 1.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub(super) still_below: Option<f64>,
    /// From where in a hold laws are fitted: "peak" of the force (the default), "settled" jaw, or a time after the
    /// peak such as "peak + 0.5 s".
    #[schemars(extend("examples" = ["peak", "settled", "peak + 0.5 s"]))]
    pub(super) hold_start: Option<String>,
    /// Holds with given limits. Where there are any, no others are sought.
    #[serde(default)]
    pub(super) hold: Vec<HoldTable>,
}

/// A hold whose limits are given.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Hold")]
pub(super) struct HoldTable {
    /// Its first moment, as the record counts time.
    pub(super) from: QuantityText,
    /// Its last moment.
    pub(super) to: QuantityText,
    /// What the machine holds; seen from the record if left out.
    pub(super) mode: Option<HoldModeName>,
}

/// What a machine holds.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "HoldMode")]
pub(super) enum HoldModeName {
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
pub(super) struct FitTable {
    /// Exponents to compare; 1, 2, 3, 5 and 7 if left out.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0 }))]
    pub(super) exponents: Option<Vec<f64>>,
    /// Whether a free exponent is fitted too; true if left out.
    pub(super) free_exponent: Option<bool>,
    /// Range in which the free exponent is sought; 0.2 to 30 if left out.
    #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0 }))]
    pub(super) exponent_range: Option<[f64; 2]>,
    /// Coverage of confidence intervals, between 0 and 1; 0.95 if left out.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub(super) confidence: Option<f64>,
    /// Fit no more than this much of every hold, counted from where its fit starts.
    pub(super) until: Option<QuantityText>,
}
