//! Options of a fit.

use serde::{Deserialize, Serialize};

use super::error::FitError;
use crate::laws::{ExponentChoice, Form, Law, Loading, Response};

/// The constant beside the shapes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ConstantChoice {
    /// Found if the law has one, else 0.
    #[default]
    AsLaw,
    /// Found, even if the law has none.
    Free,
    /// Held at this value, in the unit of the signal.
    Fixed(f64),
}

/// How residuals count.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Loss {
    /// By their square: least squares.
    #[default]
    Squares,
    /// By their square up to 1.345 noise standard deviations, then by their size (Huber).
    Huber,
    /// Less and less, and from 4.685 noise standard deviations on not at all (Tukey's biweight).
    Tukey,
}

/// Which samples are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SampleChoice {
    /// All of them: late times, which have most samples, count most.
    #[default]
    All,
    /// About this many of them, equally spaced in ln t from the first sample after the start: every decade counts alike.
    LogSpaced(usize),
}

/// What intervals take the noise for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseChoice {
    /// What the residuals show, see [`NoiseModel`](crate::fit::NoiseModel).
    #[default]
    FromResiduals,
    /// White, whatever they show.
    White,
}

/// Options of intervals by resampling.
///
/// Draws are fitted from the best parameters downhill, on condensed samples: a thousand take some hundredths of a second.
/// Intervals run between percentiles of the draws, so they follow the parameter through any change of scale; the standard error
/// is the deviation of the draws.
///
/// ```
/// use palpate::fit::{BootstrapOptions, IntervalMethod, LawOptions, Samples, fit_law};
/// use palpate::laws::Law;
/// use palpate::test_problems::noisy_hold;
/// let (times, values) = noisy_hold(500, 1.0, 1e-2);
/// let error = |intervals: IntervalMethod| {
///     let options = LawOptions { intervals, ..LawOptions::default() };
///     let fit = fit_law(&Samples::new(&times, &values), Law::StandardLinearSolid, &options)?;
///     Ok::<_, palpate::fit::FitError>(fit.estimate("time_constant_s").unwrap().standard_error.unwrap())
/// };
/// let drawn = error(IntervalMethod::Bootstrap(BootstrapOptions::default()))?;
/// assert!((drawn / error(IntervalMethod::Curvature)? - 1.0).abs() < 0.1);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct BootstrapOptions {
    /// Times that residuals are drawn.
    pub repetitions: usize,
    /// Where the random sequence begins: the same seed, the same intervals.
    pub seed: u64,
    /// Samples a block; `None` for the length that suits the noise.
    pub block: Option<usize>,
}

impl BootstrapOptions {
    /// What is usual.
    pub const USUAL: Self = Self {
        repetitions: 999,
        seed: 1,
        block: None,
    };
}

impl Default for BootstrapOptions {
    fn default() -> Self {
        Self::USUAL
    }
}

/// Method of the confidence intervals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IntervalMethod {
    /// The curvature where it is to be trusted, else the profile: where the interval of a rate, a time, an exponent or an amplitude is wider
    /// than a third of it to a side (a tenth, if a time constant is longer than the hold), and where terms of a series merge or vanish.
    #[default]
    Automatic,
    /// The curvature at the optimum: symmetric, in ln for parameters that cannot change sign.
    Curvature,
    /// The profile of the residual square: asymmetric, and open where the data do not close it.
    Profile,
    /// Resampled residuals: percentiles of fits to them, and their deviation as the standard error.
    Bootstrap(BootstrapOptions),
}

impl IntervalMethod {
    /// Whether it is the usual one.
    #[must_use]
    pub fn is_automatic(&self) -> bool {
        *self == Self::Automatic
    }

    /// `automatic`, `curvature`, `profile` or `bootstrap`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Automatic => "automatic",
            Self::Curvature => "curvature",
            Self::Profile => "profile",
            Self::Bootstrap(_) => "bootstrap",
        }
    }
}

/// Options of [`fit_law`](crate::fit::fit_law).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LawOptions {
    /// Relaxation or creep.
    pub response: Response,
    /// The constant: equilibrium, start or instantaneous part.
    pub constant: ConstantChoice,
    /// Parameters held at a value, by name as in the result: nonlinear ones in s, 1/s or 1, the constant in the unit of the signal.
    /// Amplitudes cannot be held, but bounded.
    pub fixed: Vec<(String, f64)>,
    /// Bounds of parameters, by name as in the result: nonlinear ones in s, 1/s or 1, the constant and amplitudes in the unit of the signal.
    pub bounds: Vec<(String, (f64, f64))>,
    /// Whether all amplitudes have the sign of the change, as those of a passive material must.
    pub one_sign: bool,
    /// How residuals count.
    pub loss: Loss,
    /// Which samples are fitted.
    pub samples: SampleChoice,
    /// Loading history until the first sample; a step if not given. The estimated parameters are then those of an ideal step.
    /// Laws are taken as linear in it; the latency law, which is not, is fitted to the hold alone, whose initial state
    /// is sufficient.
    pub loading: Option<Loading>,
    /// Coverage of confidence intervals, between 0 and 1.
    pub confidence: f64,
    /// Noise model of the intervals.
    pub noise: NoiseChoice,
    /// Method of the intervals.
    pub intervals: IntervalMethod,
    /// Steps of a refinement after which it ends short.
    pub most_iterations: usize,
}

impl Default for LawOptions {
    fn default() -> Self {
        Self {
            response: Response::default(),
            constant: ConstantChoice::default(),
            fixed: Vec::new(),
            bounds: Vec::new(),
            one_sign: false,
            loss: Loss::default(),
            samples: SampleChoice::default(),
            loading: None,
            confidence: 0.95,
            noise: NoiseChoice::default(),
            intervals: IntervalMethod::default(),
            most_iterations: 200,
        }
    }
}

impl LawOptions {
    /// Whether these options give the same fit of a law as others: options that do not apply to the law are ignored, and so is
    /// the loading for the latency law.
    #[must_use]
    pub fn same_for(&self, law: Law, other: &Self) -> bool {
        let plain = |options: &Self| {
            let widest =
                |bound: &(String, (f64, f64))| *bound == ("exponent".to_owned(), FitOptions::default().exponent_range);
            let is_latency = matches!(law, Law::Latency { .. });
            Self {
                bounds: options.bounds.iter().filter(|bound| !(is_latency && widest(bound))).cloned().collect(),
                loading: if is_latency { None } else { options.loading.clone() },
                ..options.clone()
            }
        };
        plain(self) == plain(other)
    }

    /// The form of a law.
    pub(crate) fn form(&self, law: Law) -> Result<Form, FitError> {
        let response = self.response;
        law.form(response).ok_or(FitError::NoForm { law, response })
    }

    /// What a parameter is held at.
    pub(crate) fn held(&self, name: &str) -> Option<f64> {
        self.fixed.iter().find(|(held, _)| held == name).map(|(_, value)| *value)
    }

    /// Refuses options that no fit can follow.
    pub(crate) fn check(&self) -> Result<(), FitError> {
        if !(self.confidence > 0.0 && self.confidence < 1.0) {
            return Err(FitError::Confidence { found: self.confidence });
        }
        if let ConstantChoice::Fixed(value) = self.constant
            && !value.is_finite()
        {
            return Err(FitError::FixedParameter {
                name: "the constant".to_owned(),
                found: value,
            });
        }
        for (name, (low, high)) in &self.bounds {
            if low.is_nan() || high.is_nan() || low >= high {
                return Err(FitError::Bounds {
                    name: name.clone(),
                    low: *low,
                    high: *high,
                });
            }
        }
        Ok(())
    }
}

/// Options of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FitOptions {
    /// Range in which a free exponent is sought.
    pub exponent_range: (f64, f64),
    /// Coverage of confidence intervals, between 0 and 1.
    pub confidence: f64,
    /// Method of the intervals.
    #[serde(skip_serializing_if = "IntervalMethod::is_automatic")]
    pub intervals: IntervalMethod,
    /// Steps of the refinement after which it ends short.
    pub most_iterations: usize,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            exponent_range: (0.2, 30.0),
            confidence: 0.95,
            intervals: IntervalMethod::default(),
            most_iterations: 200,
        }
    }
}

impl FitOptions {
    /// The same as options of the fit of the latency law.
    #[must_use]
    pub fn of_latency(&self, choice: ExponentChoice) -> LawOptions {
        let free = choice == ExponentChoice::Free;
        LawOptions {
            bounds: free.then(|| ("exponent".to_owned(), self.exponent_range)).into_iter().collect(),
            confidence: self.confidence,
            intervals: self.intervals,
            most_iterations: self.most_iterations,
            ..LawOptions::default()
        }
    }

    pub(crate) fn check(&self, choice: ExponentChoice) -> Result<(), FitError> {
        let (low, high) = self.exponent_range;
        if !(low > 0.0 && low <= high && high.is_finite()) {
            return Err(FitError::ExponentRange { low, high });
        }
        self.of_latency(ExponentChoice::Fixed(1.0)).check()?;
        match choice {
            ExponentChoice::Fixed(n) if !(n.is_finite() && n > 0.0) => Err(FitError::Exponent { found: n }),
            _ => Ok(()),
        }
    }
}
