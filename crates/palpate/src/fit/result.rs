//! What the fit of a law says.

use serde::{Deserialize, Serialize};

use super::{ErrorParts, Estimate, IntervalMethod, NoiseCourse, NoiseModel, ParameterName, RedundantTerm, Uncertainty};
use crate::laws::{Law, LawCurve, Loading, Response};
use crate::optimise::{Termination, Work};

/// Unit of a parameter of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ParameterUnit {
    /// That of the signal.
    Signal,
    /// s.
    Second,
    /// 1/s.
    PerSecond,
    /// Unit of the signal per s.
    SignalPerSecond,
    /// A dimensionless parameter.
    One,
    /// (Unit of the signal)^(1 − n)/s, of the rate coefficient v; 1/s if the signal is strain.
    RateCoefficient,
    /// Unit of the signal per s^α.
    SignalPerPower,
}

/// In which plane a law was fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Domain {
    /// The closed form, equations (4) and (5), against the signal over time.
    #[default]
    Time,
    /// Equation (10) against strain rate over strain, as the paper does; biased by noise in both.
    Rate,
}

impl Domain {
    fn is_time(&self) -> bool {
        *self == Self::Time
    }
}

/// Where a parameter of a fit comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ParameterRole {
    /// Estimated from the data.
    Estimated,
    /// Given: held at a value, or part of the name of the law.
    Given,
    /// Follows from the other parameters, as v follows from λ, Δ and n.
    Derived,
}

/// One parameter of a law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Parameter {
    /// Which it is, such as `equilibrium`, `time_constant_1_s`, `exponent`.
    pub name: ParameterName,
    /// Its unit.
    pub unit: ParameterUnit,
    /// Value, standard errors, interval.
    pub estimate: Estimate,
    /// Where it comes from.
    pub role: ParameterRole,
    /// What its error is made of, where the instrument is described.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parts: Option<ErrorParts>,
}

/// Curves at the ends of the profiles of the parameters: what the data allow beside the best curve. Of an open profile the last that was looked at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ProfileCurves {
    /// Coverage of the intervals.
    pub confidence: f64,
    /// The curves, as that of the fit.
    pub curves: Vec<LawCurve>,
    /// Those whose profile is open: beyond them the data allow others still.
    #[serde(default)]
    pub open: Vec<bool>,
}

/// A fitted law: its parameters, their uncertainty, and why the search ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
#[non_exhaustive]
pub struct Fit {
    /// The law.
    pub law: Law,
    /// In which plane.
    #[serde(default, skip_serializing_if = "Domain::is_time")]
    pub domain: Domain,
    /// Relaxation or creep.
    pub response: Response,
    /// The law with the parameters found: a function of the time since the first sample, in s, or since the step that would have stood
    /// for the loading.
    pub curve: LawCurve,
    /// The loading that led to the hold; none if it counted as a step, as it must for the latency law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loading: Option<Loading>,
    /// Its parameters: constant, amplitudes, times or rates, dimensionless parameters; then those that follow from them.
    pub parameters: Vec<Parameter>,
    /// Names of the parameters that were searched, in the order of `values` and `covariance`: constant, amplitudes, ln of rates
    /// (1/s), dimensionless parameters.
    pub searched: Vec<String>,
    /// Their values.
    pub values: Vec<f64>,
    /// Their covariance s² (JᵀJ)⁻¹ with s² = RSS/(N − p), as if the residuals were white noise; `None` where the data leave a
    /// parameter open.
    pub white_covariance: Option<Vec<Vec<f64>>>,
    /// χ² = Σ (r/σ)² over the samples fitted, σ = 1 for samples without standard deviations; under a robust loss too.
    pub residual_square: f64,
    /// Root mean square residual √(Σ r²/N) in the unit of the signal, all samples alike.
    pub rmse: f64,
    /// Correlation of neighbouring residuals, as the loss counts them.
    pub residual_correlation: f64,
    /// The size of the noise follows the signal or time.
    #[serde(default)]
    pub uneven_noise: bool,
    /// How it may change along the hold; `None` where nothing shows that it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_course: Option<NoiseCourse>,
    /// Correlation of the residuals, which intervals take into account.
    pub noise: NoiseModel,
    /// Probability that noise of this model leaves residuals whose innovations correlate as much, by the test of Ljung and Box over 20 lags;
    /// `None` for fewer than 100 samples, and for samples spaced unevenly. Below some 10⁻³ the residuals are not of this kind: the law misses
    /// something, or the noise is of a kind that no model describes.
    #[serde(default)]
    pub noise_p_value: Option<f64>,
    /// Method of the intervals; never automatic.
    #[serde(default = "curvature")]
    pub interval_method: IntervalMethod,
    /// What intervals are made of; `None` where the data leave a parameter open.
    pub uncertainty: Option<Uncertainty>,
    /// Samples fitted.
    pub samples: usize,
    /// Time of the first sample on the clock of the samples, s; 0 in the rate domain.
    #[serde(default)]
    pub start: f64,
    /// Time from the first to the last sample, s; 0 in the rate domain, which knows no time.
    pub duration: f64,
    /// Why it ended.
    pub termination: Termination,
    /// Redundant terms: merged or vanishing ones.
    pub redundant_terms: Vec<RedundantTerm>,
    /// Where the profiles of the parameters end, if intervals are those of profiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<ProfileCurves>,
    /// What it cost.
    pub work: Work,
}

/// What fits have that do not say it.
fn curvature() -> IntervalMethod {
    IntervalMethod::Curvature
}

checked_when_read!(Fit, "a value and a row of every covariance for each parameter that was searched", |fit: &Fit| {
    let count = fit.searched.len();
    let is_square = |matrix: &Vec<Vec<f64>>| matrix.len() == count && matrix.iter().all(|row| row.len() == count);
    let of_noise = fit
        .uncertainty
        .iter()
        .flat_map(|found| found.models.iter().map(|model| &model.covariance).chain([&found.covariance]));
    fit.values.len() == count && fit.white_covariance.iter().chain(of_noise).all(is_square)
});

impl Parameter {
    /// The value and interval, unless the fit ended short of an optimum inside its range: a parameter at a bound, or found beside one,
    /// is no estimate of anything.
    #[must_use]
    pub fn determined(&self, termination: Termination) -> Option<&Estimate> {
        (termination.is_good() || self.estimate.standard_error.is_some() || self.role == ParameterRole::Given)
            .then_some(&self.estimate)
    }
}

impl Fit {
    /// Whether terms merge or vanish: their amplitudes and times are then no estimates of anything, and fewer terms suffice.
    #[must_use]
    pub fn has_redundant_terms(&self) -> bool {
        matches!(self.termination, Termination::Singular | Termination::TermsMerged) || !self.redundant_terms.is_empty()
    }

    /// A parameter.
    #[must_use]
    pub fn parameter(&self, name: impl Into<ParameterName>) -> Option<&Parameter> {
        let name = name.into();
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// The value of a parameter by its name in writing.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.estimate(name).map(|estimate| estimate.value)
    }

    /// A parameter by its name in writing.
    #[must_use]
    pub fn estimate(&self, name: &str) -> Option<&Estimate> {
        self.parameters
            .iter()
            .find(|parameter| parameter.name == *name)
            .map(|parameter| &parameter.estimate)
    }

    /// Parameters found from the data.
    #[must_use]
    pub fn free_parameters(&self) -> usize {
        self.searched.len()
    }

    /// The fit with intervals that end at these bounds of parameters, by name.
    #[must_use]
    pub fn within(mut self, bounds: &[(String, (f64, f64))]) -> Self {
        for (name, (least, most)) in bounds {
            let bounded = self.parameters.iter_mut().find(|parameter| parameter.name == **name);
            if let Some((low, high)) = bounded.and_then(|parameter| parameter.estimate.interval.as_mut()) {
                (*low, *high) = (low.max(*least), high.min(*most));
            }
        }
        self
    }

    /// The signal a time `elapsed` (s) after the first sample, after the loading if there was one.
    #[must_use]
    pub fn predict(&self, elapsed: f64) -> f64 {
        self.predict_many(&[elapsed])[0]
    }

    /// The signal at times on the clock of the samples that were fitted, s.
    #[must_use]
    pub fn predict_at(&self, times: &[f64]) -> Vec<f64> {
        self.predict_many(&times.iter().map(|time| time - self.start).collect::<Vec<f64>>())
    }

    /// The signal at many times, as [`predict`](Self::predict).
    #[must_use]
    pub fn predict_many(&self, elapsed: &[f64]) -> Vec<f64> {
        self.values_of(&self.curve, elapsed)
    }

    /// What the law shows with the parameters of this curve.
    pub(super) fn values_of(&self, curve: &LawCurve, elapsed: &[f64]) -> Vec<f64> {
        match &self.loading {
            None => curve.values(elapsed),
            Some(loading) => curve.after(loading, elapsed),
        }
    }

    /// Covariance in the order of `searched` for residuals that correlate as they do: what the standard errors come from. `None` where
    /// the data leave a parameter open.
    #[must_use]
    pub fn covariance(&self) -> Option<&[Vec<f64>]> {
        self.uncertainty.as_ref().map(|uncertainty| uncertainty.covariance.as_slice())
    }

    /// Correlations of the parameters in the order of `searched`.
    #[must_use]
    pub fn correlation(&self) -> Option<Vec<Vec<f64>>> {
        let covariance = self.covariance()?;
        let deviation = |i: usize| covariance[i][i].sqrt();
        let entry = |i: usize, j: usize| match deviation(i) * deviation(j) {
            0.0 => 0.0,
            product => covariance[i][j] / product,
        };
        let size = covariance.len();
        Some((0..size).map(|i| (0..size).map(|j| if i == j { 1.0 } else { entry(i, j) }).collect()).collect())
    }

    /// The noise that the residuals show, in a word: its model, and `uneven` where its size follows the signal or time.
    ///
    /// ```
    /// use palpate::fit::{LawOptions, Samples, fit_law};
    /// use palpate::laws::Law;
    /// use palpate::test_problems::noisy_hold;
    /// let (times, values) = noisy_hold(400, 5.0, 1e-3);
    /// let fit = fit_law(&Samples::new(&times, &values), "latency:5".parse::<Law>()?, &LawOptions::default())?;
    /// assert_eq!((fit.noise_in_words().as_str(), fit.effective_samples()), ("white", 400.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn noise_in_words(&self) -> String {
        if self.uneven_noise { format!("{}, uneven", self.noise) } else { self.noise.to_string() }
    }

    /// Samples that count as independent, given how residuals correlate.
    #[must_use]
    pub fn effective_samples(&self) -> f64 {
        self.noise.effective_samples(self.samples)
    }
}
