//! The table `[sweep]` as editors know it.

use schemars::JsonSchema;

/// Numbers of the protocol to replace by many: their paths as keys, such as law.rate_coefficient or step.2.hold.
#[derive(JsonSchema)]
#[schemars(title = "Sweep", rename = "Sweep", extend("additionalProperties" = { "anyOf": [
    { "type": "string", "description": "Values, such as \"log 1e3..1e6 /s, 50\", \"linear 20..40 mm, 9\" or \"1, 2, 5\"." },
    { "type": "array", "items": { "type": ["string", "number"] }, "minItems": 1 },
    { "type": "object" }
] }))]
#[expect(dead_code, reason = "it describes the table, which is read key by key")]
pub(crate) struct SweepSchema {
    /// Every value with every other (the default), or values drawn evenly from all ranges at once.
    method: Option<Method>,
    /// How many runs a latin hypercube has.
    #[schemars(range(min = 1))]
    samples: Option<u64>,
    /// Which latin hypercube: the same seed gives the same runs; 1 if left out.
    seed: Option<u64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema)]
pub(crate) enum Method {
    #[schemars(rename = "grid")]
    Grid,
    #[schemars(rename = "latin hypercube")]
    LatinHypercube,
}
