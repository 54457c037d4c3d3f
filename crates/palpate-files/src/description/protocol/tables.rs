//! The tables of a protocol as they stand in the file.

use schemars::JsonSchema;
use serde::{Deserialize, de::IgnoredAny};

use crate::description::{
    body::tables::{ContactTable, LawTable, SpecimenTable},
    text::quantity::QuantityText,
};

/// A squeeze-and-hold protocol: the body, its law, and the steps of the jaw. Quantities are texts with a unit.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "palpate protocol", rename = "Protocol", extend("required" = [], "anyOf" = [
    { "required": ["specimen", "law"] },
    { "required": ["material"] }
]))]
pub(crate) struct ProtocolTables {
    /// A title for figures and reports.
    pub(crate) title: Option<String>,
    pub(crate) specimen: SpecimenTable,
    pub(crate) law: LawTable,
    #[serde(default)]
    pub(crate) contact: ContactTable,
    /// Steps of the jaw in order, starting at first touch at time 0; none where a record drives the contact.
    #[serde(default)]
    pub(crate) step: Vec<StepTable>,
    #[serde(default)]
    pub(crate) output: OutputTable,
    /// Parameters to sweep, for `palpate sweep`; otherwise ignored.
    #[serde(default)]
    #[schemars(with = "Option<super::sweep_schema::SweepSchema>")]
    pub(crate) sweep: Option<IgnoredAny>,
    /// Path of a material file, relative to this file, in place of specimen, law and contact.
    #[serde(default, rename = "material")]
    #[schemars(with = "Option<String>")]
    pub(crate) _material: Option<IgnoredAny>,
    /// Of a material file, whose body is taken as any other.
    #[serde(default, rename = "calibration")]
    #[schemars(skip)]
    pub(crate) _calibration: Option<IgnoredAny>,
}

/// Move to a displacement or to a force, then hold the position or the force; either part may be omitted.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Step", extend("not" = { "anyOf": [
    { "required": ["to", "to_force"] },
    { "required": ["rate", "force_rate"] },
    { "required": ["hold", "hold_force"] }
] }))]
pub(crate) struct StepTable {
    /// Travel of the jaw since first touch at the end of the ramp; loading is positive. Needs rate.
    pub(crate) to: Option<QuantityText>,
    /// Target force, reached by moving the jaw at rate or by changing the force at force_rate.
    pub(crate) to_force: Option<QuantityText>,
    /// Speed of the jaw in the ramp, always above 0.
    pub(crate) rate: Option<QuantityText>,
    /// Rate at which the force changes to to_force, always above 0.
    pub(crate) force_rate: Option<QuantityText>,
    /// Duration of the following position hold; none if omitted.
    pub(crate) hold: Option<QuantityText>,
    /// Duration of the following force hold.
    pub(crate) hold_force: Option<QuantityText>,
}

/// Output times: at a rate, or listed.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Output", extend("not" = { "required": ["sample_rate", "times"] }))]
pub(crate) struct OutputTable {
    /// Samples per second; "100 Hz" unless times are given. The output also includes every kink of the motion.
    pub(crate) sample_rate: Option<QuantityText>,
    /// The output times, rising, within the motion.
    #[schemars(extend("minItems" = 1))]
    pub(crate) times: Option<Vec<QuantityText>>,
}
