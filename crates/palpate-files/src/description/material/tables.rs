//! The tables of a material file as they stand in it.

use palpate::calibrate::{EquilibriumLaw, MaterialUnit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::description::{
    body::tables::{ContactTable, LawTable, SpecimenTable},
    text::quantity::QuantityText,
    uncertainty::{CauseText, DistributionName, EvaluationName},
};

/// A calibrated body: a protocol's specimen, law and contact, and the same parameters with their errors.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "palpate material", rename = "Material")]
pub(crate) struct MaterialTables {
    pub(crate) specimen: SpecimenTable,
    pub(crate) law: LawTable,
    #[serde(default)]
    pub(crate) contact: ContactTable,
    pub(crate) calibration: CalibrationTable,
}

/// The calibration: its record, parameters and uncertainties.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Calibration")]
pub(crate) struct CalibrationTable {
    /// Version of this table: 1.
    #[serde(rename = "version")]
    pub(crate) _version: u64,
    /// The calibrated record.
    pub(crate) record: String,
    /// SHA-256 of its file.
    pub(crate) sha256: String,
    /// Number of tested specimens of the batch, another of which this material is: intervals and covariance contain the spread between
    /// specimens. None of a body that was itself tested.
    #[schemars(range(min = 3))]
    pub(crate) specimens: Option<usize>,
    /// Its test description.
    pub(crate) test: Option<String>,
    /// Version of palpate that calibrated.
    pub(crate) palpate: String,
    /// Samples that were fitted.
    pub(crate) samples: usize,
    /// The fitted law: latency (n estimated), latency:5 (n given), standard-linear-solid, prony:K or fung:K.
    pub(crate) law: String,
    /// What the record shows against that law: the name of another law that refutes it, as "prony:2", or "residuals" that follow a course.
    /// Omitted where nothing.
    pub(crate) misfit: Option<String>,
    /// The fitted law of the equilibrium force.
    pub(crate) equilibrium: CalibratedEquilibriumName,
    /// Standard deviation of the force residuals.
    pub(crate) residual: QuantityText,
    /// Coverage of the intervals, between 0 and 1.
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
    pub(crate) confidence: Option<f64>,
    /// Degrees of freedom of the residual variance.
    pub(crate) freedom: Option<f64>,
    /// The parameters in order.
    #[schemars(extend("minItems" = 1))]
    pub(crate) parameter: Vec<ParameterTable>,
    /// Covariance of the natural logarithms of the parameters, row by row in their order.
    pub(crate) covariance: Option<Vec<Vec<f64>>>,
    /// What the instrument and the body add to the covariance, by cause.
    #[serde(default)]
    pub(crate) systematic: Vec<SystematicTable>,
    /// The range of the test; predictions beyond it are extrapolations.
    pub(crate) range: RangeTable,
}

/// A cause of uncertainty that the whole test has in common.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "SystematicEffect")]
pub(crate) struct SystematicTable {
    /// The input quantity.
    pub(crate) name: String,
    /// Its unit.
    pub(crate) unit: String,
    /// Its standard uncertainty, in its unit.
    #[schemars(extend("minimum" = 0))]
    pub(crate) standard_uncertainty: f64,
    /// Degrees of freedom; endless if omitted.
    #[schemars(extend("minimum" = 1))]
    pub(crate) freedom: Option<f64>,
    /// The distribution of its values.
    pub(crate) distribution: DistributionName,
    /// How it was evaluated.
    #[serde(rename = "type")]
    pub(crate) evaluation: EvaluationName,
    /// The cause that it was stated to have; "record" where each record has its own error.
    pub(crate) cause: Option<CauseText>,
    /// Change of the natural logarithm of each parameter, then of each size of the body, by one standard uncertainty.
    pub(crate) logs: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[schemars(rename = "CalibratedEquilibrium")]
pub(crate) enum CalibratedEquilibriumName {
    /// Force = modulus × displacement/depth × contact area.
    #[serde(rename = "uniform strain")]
    UniformStrain,
    /// Hertz's law.
    #[serde(rename = "hertz")]
    Hertz,
    /// The rows of specimen.equilibrium_forces.
    #[serde(rename = "table")]
    Table,
}

/// One parameter with its errors; a parameter that was given has none.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "CalibratedParameter")]
pub(crate) struct ParameterTable {
    /// Its name, such as modulus_pa, exponent, rate_coefficient_per_s, layer_thickness_m or time_constant_1_s.
    pub(crate) name: String,
    /// Its unit; none of a dimensionless parameter.
    pub(crate) unit: Option<String>,
    /// The estimate, in its unit.
    pub(crate) value: f64,
    /// Standard error, including the correlation of the residuals, in its unit.
    pub(crate) standard_error: Option<f64>,
    /// Standard error under the assumption of white noise, in its unit.
    pub(crate) white_standard_error: Option<f64>,
    /// Lower and upper end of the confidence interval, in its unit.
    #[schemars(extend("minItems" = 2, "maxItems" = 2))]
    pub(crate) interval: Option<Vec<f64>>,
}

/// The range of the test.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "CalibrationRange")]
pub(crate) struct RangeTable {
    /// The longest hold of the displacement, 0 s if there was none.
    pub(crate) longest_hold: QuantityText,
    /// The longest hold of the force; none if omitted.
    pub(crate) longest_force_hold: Option<QuantityText>,
    /// The largest displacement of the jaw since first touch.
    pub(crate) deepest: QuantityText,
    /// The fastest ramp.
    pub(crate) fastest: QuantityText,
    /// The slowest ramp.
    pub(crate) slowest: QuantityText,
    /// The largest force.
    pub(crate) largest_force: QuantityText,
    /// The farthest retreat from the deepest place before it; none if omitted.
    pub(crate) farthest_retreat: Option<QuantityText>,
    /// How often the body was loaded from the virgin state on: 1 if omitted.
    #[schemars(extend("minimum" = 1))]
    pub(crate) loadings: Option<u32>,
}

impl From<EquilibriumLaw> for CalibratedEquilibriumName {
    fn from(law: EquilibriumLaw) -> Self {
        match law {
            EquilibriumLaw::UniformStrain => Self::UniformStrain,
            EquilibriumLaw::Hertz { .. } => Self::Hertz,
            EquilibriumLaw::Table => Self::Table,
        }
    }
}

shown_as_written!(CalibratedEquilibriumName);

/// Units of parameters as they are written.
pub(crate) const UNITS: [(MaterialUnit, Option<&str>); 6] = [
    (MaterialUnit::One, None),
    (MaterialUnit::Second, Some("s")),
    (MaterialUnit::PerSecond, Some("/s")),
    (MaterialUnit::Metre, Some("m")),
    (MaterialUnit::Newton, Some("N")),
    (MaterialUnit::Pascal, Some("Pa")),
];
