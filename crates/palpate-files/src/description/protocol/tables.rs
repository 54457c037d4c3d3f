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
    /// Numbers to replace by many, for `palpate sweep`; left aside otherwise.
    #[serde(default)]
    #[schemars(with = "Option<super::sweep_schema::SweepSchema>")]
    pub(crate) sweep: Option<IgnoredAny>,
    /// Path of a material file, from this file on, in place of specimen, law and contact.
    #[serde(default, rename = "material")]
    #[schemars(with = "Option<String>")]
    pub(crate) _material: Option<IgnoredAny>,
    /// Of a material file, whose body is taken as any other.
    #[serde(default, rename = "calibration")]
    #[schemars(skip)]
    pub(crate) _calibration: Option<IgnoredAny>,
}

/// Go to a displacement or to a force, then stay there or keep the force; either part may be left out.
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
    /// Force to go to, by moving the jaw at rate until it is met or by raising the force at force_rate.
    pub(crate) to_force: Option<QuantityText>,
    /// Speed of the jaw in the ramp, always above 0.
    pub(crate) rate: Option<QuantityText>,
    /// Rate at which the force goes to to_force, always above 0.
    pub(crate) force_rate: Option<QuantityText>,
    /// Time for which the jaw then stays where it is; none if left out.
    pub(crate) hold: Option<QuantityText>,
    /// Time for which the force is then kept as it is.
    pub(crate) hold_force: Option<QuantityText>,
}

/// When to report: at a rate, or at times.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Output", extend("not" = { "required": ["sample_rate", "times"] }))]
pub(crate) struct OutputTable {
    /// Samples per second; "100 Hz" unless times are given. Every kink of the motion is reported as well.
    pub(crate) sample_rate: Option<QuantityText>,
    /// These times and no others, rising, inside the motion.
    #[schemars(extend("minItems" = 1))]
    pub(crate) times: Option<Vec<QuantityText>>,
}
