//! What the parameters of laws are called.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::error::FitError;
use crate::laws::{Form, name_of_term, term_of_name};
use crate::statistics::{coverage_factor, effective_factor, effective_freedom};

/// What a parameter of a law is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ParameterKind {
    /// The value that a relaxation tends to.
    Equilibrium,
    /// The signal at the start of a relaxation.
    Start,
    /// The part of a creep that is there at once.
    Instantaneous,
    /// The value that a creep tends to.
    Final,
    /// The amplitude of a shape.
    Amplitude,
    /// The amplitude of a straight flow.
    Flow,
    /// The time constant of a shape.
    Time,
    /// The longest time of a continuous spectrum.
    TimeLong,
    /// The shortest time of a continuous spectrum.
    TimeShort,
    /// ln of the ratio of both.
    LogRatio,
    /// λ, the relative rate of the latency law at the start.
    RelativeRate,
    /// v, the rate coefficient of the latency law.
    RateCoefficient,
    /// The exponent of the latency law or of a power.
    Exponent,
    /// The order of a fractional derivative.
    Order,
    /// The exponent of a stretched exponential.
    Stretching,
    /// The elastic response of Fung's law.
    ElasticResponse,
    /// The share of a term of Fung's series in it.
    Share,
    /// The rate of such a term.
    TermRate,
    /// The strength of Fung's continuous spectrum.
    Strength,
    /// The slope of a straight flow.
    FlowRate,
    /// The coefficient of a power.
    Coefficient,
    /// A parameter of a law that another crate defines, by its name.
    Custom(&'static str),
}

impl ParameterKind {
    /// All kinds with the words that stand for them.
    const WORDS: [(Self, &str); 21] = [
        (Self::Equilibrium, "equilibrium"),
        (Self::Start, "start"),
        (Self::Instantaneous, "instantaneous"),
        (Self::Final, "final"),
        (Self::Amplitude, "amplitude"),
        (Self::Flow, "flow"),
        (Self::Time, "time_constant_s"),
        (Self::TimeLong, "time_constant_long_s"),
        (Self::TimeShort, "time_constant_short_s"),
        (Self::LogRatio, "log_ratio"),
        (Self::RelativeRate, "relative_rate_per_s"),
        (Self::RateCoefficient, "rate_coefficient_per_s"),
        (Self::Exponent, "exponent"),
        (Self::Order, "order"),
        (Self::Stretching, "stretching"),
        (Self::ElasticResponse, "elastic_response"),
        (Self::Share, "c"),
        (Self::TermRate, "nu_per_s"),
        (Self::Strength, "strength"),
        (Self::FlowRate, "flow_rate_per_s"),
        (Self::Coefficient, "coefficient"),
    ];

    fn word(self) -> &'static str {
        if let Self::Custom(name) = self {
            return name;
        }
        Self::WORDS.iter().find(|(kind, _)| *kind == self).map_or("", |(_, word)| word)
    }
}

/// A parameter of a law: its kind, and the number of its term in a series; written `time_constant_2_s`.
///
/// ```
/// use palpate::fit::{ParameterKind, ParameterName};
/// let name: ParameterName = "time_constant_2_s".parse()?;
/// assert_eq!((name.kind, name.term), (ParameterKind::Time, Some(2)));
/// assert_eq!(name.to_string(), "time_constant_2_s");
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct ParameterName {
    /// What it is.
    pub kind: ParameterKind,
    /// Which of several alike.
    pub term: Option<usize>,
}

impl ParameterName {
    /// The one of this kind of a term of a series.
    #[must_use]
    pub fn of_term(kind: ParameterKind, term: usize) -> Self {
        Self { kind, term: Some(term) }
    }
}

impl ParameterName {
    /// The name of a parameter of a law of this form.
    pub(crate) fn of_form(form: &Form, name: &str) -> Option<Self> {
        let custom = || {
            form.parameter(name).map(|(name, term)| Self {
                kind: ParameterKind::Custom(name),
                term,
            })
        };
        name.parse().ok().or_else(custom)
    }
}

impl From<ParameterKind> for ParameterName {
    fn from(kind: ParameterKind) -> Self {
        Self { kind, term: None }
    }
}

impl fmt::Display for ParameterName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.term {
            None => f.write_str(self.kind.word()),
            Some(term) => f.write_str(&name_of_term(self.kind.word(), term)),
        }
    }
}

impl FromStr for ParameterName {
    type Err = FitError;

    fn from_str(name: &str) -> Result<Self, FitError> {
        let kinds = ParameterKind::WORDS.iter();
        let named = |(kind, word): &(ParameterKind, &str)| {
            let term = term_of_name(word, name);
            (*word == name || term.is_some()).then_some(Self { kind: *kind, term })
        };
        match kinds.filter_map(named).next() {
            Some(found) => Ok(found),
            None => Err(FitError::UnknownParameter {
                name: name.to_owned(),
                known: ParameterKind::WORDS.map(|(_, word)| word).join(", "),
            }),
        }
    }
}

impl From<ParameterName> for String {
    fn from(name: ParameterName) -> Self {
        name.to_string()
    }
}

impl TryFrom<String> for ParameterName {
    type Error = FitError;

    fn try_from(name: String) -> Result<Self, FitError> {
        name.parse()
    }
}

impl PartialEq<str> for ParameterName {
    fn eq(&self, name: &str) -> bool {
        match self.term {
            None => self.kind.word() == name,
            Some(term) => term_of_name(self.kind.word(), name) == Some(term),
        }
    }
}

/// A parameter with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// Standard error, including the correlation of the residuals ([`NoiseModel`](crate::fit::NoiseModel)): half of the 95 % interval that curvature
    /// gives over the quantile of Student's t. Where several models of the noise are likely it is less than the root of the mean covariance, which
    /// an improbable model with a large variance may rule. `None` for a parameter that was given, and where the data do not determine it.
    pub standard_error: Option<f64>,
    /// Standard error as if the residuals were white noise, s² (JᵀJ)⁻¹ with s² = RSS/(N − p): what most other software states.
    #[serde(default)]
    pub white_standard_error: Option<f64>,
    /// Confidence interval for residuals that correlate as they do ([`NoiseModel`](crate::fit::NoiseModel)); in ln for parameters that
    /// cannot change sign. An end that the data leave open is infinite, or 0 below a parameter that is above 0; in JSON `null`.
    #[serde(with = "open_ends")]
    pub interval: Option<(f64, f64)>,
}

impl Estimate {
    /// The same with other, independent causes in quadrature: the changes by one standard uncertainty of each, in its unit, with the degrees of
    /// freedom of that; `freedom` are those of this estimate. The interval has Student's factor of the effective degrees of freedom by Welch and
    /// Satterthwaite, as the [budget](crate::budget::Budget) has. An estimate without an error keeps none.
    #[must_use]
    pub(crate) fn beside(self, freedom: f64, others: impl IntoIterator<Item = (f64, f64)>, confidence: f64) -> Self {
        let others: Vec<(f64, f64)> = others.into_iter().filter(|(effect, _)| *effect != 0.0).collect();
        if others.is_empty() {
            return self;
        }
        let variance: f64 = others.iter().map(|(effect, _)| effect * effect).sum();
        let scatter = self.standard_error.unwrap_or(0.0);
        let parts = others.iter().copied().chain([(scatter, freedom)]);
        let factor = effective_factor(confidence, effective_freedom(scatter.hypot(variance.sqrt()), parts));
        let (by, share) = (factor * variance.sqrt(), factor / coverage_factor(confidence, freedom));
        let ends = |(low, high): (f64, f64)| {
            if low > 0.0 && self.value > 0.0 {
                // A parameter that cannot change sign.
                let end = |end: f64| (share * (end / self.value).ln()).hypot(by / self.value);
                (self.value * (-end(low)).exp(), self.value * end(high).exp())
            } else {
                let end = |end: f64| (share * (end - self.value)).hypot(by);
                (self.value - end(low), self.value + end(high))
            }
        };
        Self {
            value: self.value,
            standard_error: self.standard_error.map(|error| error.hypot(variance.sqrt())),
            white_standard_error: self.white_standard_error,
            interval: self.interval.map(ends),
        }
    }
}

/// The causes of the error of a parameter where the instrument is described.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorParts {
    /// Standard error from the scatter of the samples; `None` where the data do not determine the parameter.
    pub scatter: Option<f64>,
    /// Change of the parameter by one standard uncertainty of each input quantity of the instrument, in their order.
    pub effects: Vec<f64>,
}

impl ErrorParts {
    /// Σ of the squared effects.
    #[must_use]
    pub fn variance(&self) -> f64 {
        self.effects.iter().map(|effect| effect * effect).sum()
    }
}

/// An interval in JSON, which has no word for infinity.
mod open_ends {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[expect(clippy::ref_option, reason = "the signature that serde asks for")]
    pub(super) fn serialize<S: Serializer>(interval: &Option<(f64, f64)>, to: S) -> Result<S::Ok, S::Error> {
        let finite = |end: f64| Some(end).filter(|end| end.is_finite());
        interval.map(|(low, high)| (finite(low), finite(high))).serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<(f64, f64)>, D::Error> {
        let ends = Option::<(Option<f64>, Option<f64>)>::deserialize(from)?;
        Ok(ends.map(|(low, high)| (low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY))))
    }
}

impl Estimate {
    /// A parameter that was given, not found.
    #[must_use]
    pub fn fixed(value: f64) -> Self {
        Self {
            value,
            standard_error: None,
            white_standard_error: None,
            interval: None,
        }
    }
}

/// A confidence interval whose ends the data may leave open.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Lower end; `None` if no value is too low.
    pub low: Option<f64>,
    /// Upper end; `None` if no value is too high.
    pub high: Option<f64>,
}

impl Interval {
    /// Nothing is known.
    pub(crate) const OPEN: Self = Self { low: None, high: None };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{ExponentChoice, Law, Response, ShapeParameterKind};

    #[test]
    fn every_parameter_of_every_law_has_a_kind() {
        let exponent = ExponentChoice::Free;
        let laws = [
            Law::Latency { exponent },
            Law::StandardLinearSolid,
            Law::Prony { terms: 3 },
            Law::Fung { terms: 2 },
            Law::FungContinuous,
            Law::Stretched,
            Law::FractionalZener,
            Law::Power,
            Law::Logarithmic,
            Law::Diffusion,
            Law::KelvinVoigt,
            Law::Burgers,
            Law::Maxwell,
        ];
        let mut observed = 0;
        for form in laws.iter().flat_map(|law| [Response::Relaxation, Response::Creep].map(|r| law.form(r))).flatten() {
            let parameters =
                form.parameters().into_iter().filter(|(_, _, kind)| *kind != ShapeParameterKind::Reference);
            let names = parameters.map(|(_, name, _)| name).chain(form.amplitude_names());
            for name in names.chain([form.constant_name().to_owned()]) {
                assert_eq!(name.parse::<ParameterName>().unwrap().to_string(), name);
                observed += 1;
            }
        }
        assert!(observed > 60, "{observed}");
        assert!("quickness".parse::<ParameterName>().is_err());
    }
}
