//! Options and results of a joint fit.

use serde::{Deserialize, Serialize};

use crate::fit::{Fit, FitOptions, IntervalMethod, LawOptions, Parameter};
use crate::laws::{ExponentChoice, Law, Response};
use crate::optimise::{Termination, Work};

/// How the residuals of different holds count beside each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HoldWeights {
    /// All samples alike: the noise is the same in all holds.
    #[default]
    Equal,
    /// By the inverse of the residual variance of the separate fit of each hold.
    SeparateVariance,
}

/// Options of [`fit_joint`](crate::fit::fit_joint).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct JointOptions {
    /// Relaxation or creep.
    pub response: Response,
    /// How holds count beside each other.
    pub weights: HoldWeights,
    /// Range of a free exponent of the latency law, coverage of intervals, most steps.
    pub fit: FitOptions,
}

/// One law fitted to several holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct JointFit {
    /// The law.
    pub law: Law,
    /// Relaxation or creep.
    pub response: Response,
    /// The parameters that all holds share: v and n of the latency law, times, rates and dimensionless parameters of others.
    pub shared: Vec<Parameter>,
    /// Every hold with the shared parameters and its own constant and amplitudes; errors are those of the joint fit.
    pub holds: Vec<Fit>,
    /// Every hold fitted alone.
    pub separate: Vec<Fit>,
    /// Names of the searched parameters, in the order of `values` and `covariance`: `equilibrium_hold_1`, `amplitude_hold_1`, …, then
    /// the shared ones, ln of rates (1/s) and dimensionless parameters.
    pub parameters: Vec<String>,
    /// Their values.
    pub values: Vec<f64>,
    /// Their covariance s² (JᵀJ)⁻¹, s² = RSS/(N − p); `None` where the data leave a parameter open.
    pub white_covariance: Option<Vec<Vec<f64>>>,
    /// Sum of squared residuals over all holds, with weights whose mean over the samples is one.
    pub residual_square: f64,
    /// The same sum, with the same weights, for the holds fitted alone.
    pub separate_residual_square: f64,
    /// Samples of all holds.
    pub samples: usize,
    /// Samples that count as independent: the sum over the holds.
    pub effective_samples: f64,
    /// How it was fitted.
    pub options: JointOptions,
    /// Why it ended.
    pub termination: Termination,
    /// What it cost.
    pub work: Work,
}

impl JointFit {
    /// Parameters found from the data.
    #[must_use]
    pub fn free_parameters(&self) -> usize {
        self.parameters.len()
    }

    /// A shared parameter by its name, such as `rate_coefficient_per_s`.
    #[must_use]
    pub fn shared(&self, name: &str) -> Option<&Parameter> {
        self.shared.iter().find(|parameter| parameter.name == *name)
    }
}

pub(crate) fn law_options(law: Law, options: &JointOptions) -> LawOptions {
    let choice = match law {
        Law::Latency { exponent } => exponent,
        _ => ExponentChoice::Fixed(1.0),
    };
    LawOptions {
        response: options.response,
        intervals: IntervalMethod::Curvature,
        ..options.fit.of_latency(choice)
    }
}
