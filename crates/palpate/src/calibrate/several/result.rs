//! What a calibration of several records finds.

use serde::{Deserialize, Serialize};

use super::{Sharing, Spread};
use crate::analysis::Finding;
use crate::calibrate::{CalibrationData, Candidate, Material, MaterialUnit};
use crate::fit::{Estimate, NoiseModel};

/// A record of a batch with the name that results and errors give it.
#[derive(Debug, Clone, PartialEq)]
pub struct BatchRecord {
    /// What to call it.
    pub name: String,
    /// What is fitted.
    pub data: CalibrationData,
}

/// Several records calibrated together.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SeveralCalibration {
    /// The laws.
    pub candidate: Candidate,
    /// Which parameters are shared.
    pub sharing: Sharing,
    /// The parameters of the batch, in the order of [`Material::names`].
    pub parameters: Vec<BatchParameter>,
    /// The records, in their order.
    pub specimens: Vec<CalibratedSpecimen>,
    /// A specimen of the batch that was not tested, or the body itself where all parameters are shared; `None` for own parameters of two
    /// records: their covariance is not determined. Its body is that of the first record.
    ///
    /// Its values are the shared parameters and exp of the mean of the logarithms of the own ones. The covariance of the latter is
    /// (1 + 1/k) S, with S the sample covariance of the k estimates and k − 1 degrees of freedom: what differs between specimens, the
    /// error of the mean, and the errors of the records.
    pub specimen: Option<Material>,
    /// Parameters that were estimated: the shared ones, and the own ones of every record.
    pub free_parameters: usize,
    /// Coverage of the intervals.
    pub confidence: f64,
    /// Degrees of freedom of the residuals of all records.
    pub freedom: f64,
}

/// A parameter of the batch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BatchParameter {
    /// Its name, such as `modulus_pa`.
    pub name: String,
    /// Its unit.
    pub unit: MaterialUnit,
    /// What the records say of it.
    pub between: Between,
}

/// A parameter between records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "role")]
pub enum Between {
    /// The law gives it.
    Given {
        /// Its value.
        value: f64,
    },
    /// One value for all records.
    Shared {
        /// That value.
        estimate: Estimate,
        /// Probability that records of one value differ as much as these do when each is calibrated alone (Cochran's test): below 0.05 they
        /// contradict that it is one. `None` where fewer than two of them determine it alone.
        one_value_p: Option<f64>,
    },
    /// Each record's own.
    Own {
        /// The geometric mean over the specimens, with the interval of the mean of the batch.
        mean: Estimate,
        /// The standard deviation between specimens.
        spread: Spread,
    },
}

/// A record with the shared parameters and its own.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CalibratedSpecimen {
    /// Its name.
    pub name: String,
    /// Its body with its parameters.
    pub material: Material,
    /// Simulated force at every sample, N.
    pub simulated: Vec<f64>,
    /// Root mean square residual over the fitted samples, N.
    pub rmse: f64,
    /// The same as a share of the largest force of the record.
    pub relative: f64,
    /// The root mean square residual of the record when it is calibrated alone, N.
    pub rmse_alone: f64,
    /// Correlation of its residuals.
    pub noise: NoiseModel,
    /// Its findings: those of its columns, and whether it is apart from the other records.
    pub findings: Vec<Finding>,
}

impl SeveralCalibration {
    /// A parameter of the batch by its name.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<&Between> {
        self.parameters.iter().find(|parameter| parameter.name == name).map(|parameter| &parameter.between)
    }
}
