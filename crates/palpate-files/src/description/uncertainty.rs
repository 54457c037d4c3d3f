//! Names of distributions and of evaluations of an uncertainty, as descriptions and materials write them.

use palpate::budget::{Cause, Distribution, Evaluation};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "Distribution")]
pub(crate) enum DistributionName {
    /// Normal; Student's t with finite degrees of freedom.
    Normal,
    /// The same everywhere between two limits.
    Rectangular,
    /// Falling from the estimate to two limits.
    Triangular,
    /// U-shaped between two limits, as of a cycle.
    Arcsine,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[schemars(rename = "Evaluation")]
pub(crate) enum EvaluationName {
    /// By the statistics of observations.
    A,
    /// By other means.
    B,
}

shown_as_written!(DistributionName);
shown_as_written!(EvaluationName);

impl From<DistributionName> for Distribution {
    fn from(name: DistributionName) -> Self {
        match name {
            DistributionName::Normal => Self::Normal,
            DistributionName::Rectangular => Self::Rectangular,
            DistributionName::Triangular => Self::Triangular,
            DistributionName::Arcsine => Self::Arcsine,
        }
    }
}

impl From<Distribution> for DistributionName {
    fn from(distribution: Distribution) -> Self {
        match distribution {
            Distribution::Normal => Self::Normal,
            Distribution::Rectangular => Self::Rectangular,
            Distribution::Triangular => Self::Triangular,
            Distribution::Arcsine => Self::Arcsine,
        }
    }
}

impl From<EvaluationName> for Evaluation {
    fn from(name: EvaluationName) -> Self {
        match name {
            EvaluationName::A => Self::A,
            EvaluationName::B => Self::B,
        }
    }
}

impl From<Evaluation> for EvaluationName {
    fn from(evaluation: Evaluation) -> Self {
        match evaluation {
            Evaluation::A => Self::A,
            Evaluation::B => Self::B,
        }
    }
}

/// Which records have an error in common: "record" (none, each has its own), or the name of its cause.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(transparent)]
#[schemars(rename = "Cause")]
pub(crate) struct CauseText(String);

/// The text where each record has its own error.
const EACH_RECORD: &str = "record";

impl CauseText {
    /// The text of a cause; `None` of one that is not stated.
    pub(crate) fn of(cause: &Cause) -> Option<Self> {
        match cause {
            Cause::AsStated => None,
            Cause::EachRecord => Some(Self(EACH_RECORD.to_owned())),
            Cause::Named(name) => Some(Self(name.clone())),
        }
    }

    pub(crate) fn cause(text: Option<&Self>) -> Cause {
        match text {
            None => Cause::AsStated,
            Some(Self(text)) if text == EACH_RECORD => Cause::EachRecord,
            Some(Self(name)) => Cause::Named(name.clone()),
        }
    }

    pub(crate) fn text(&self) -> &str {
        &self.0
    }
}
