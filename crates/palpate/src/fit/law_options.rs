//! What may be asked of the fit of a law.

use serde::{Deserialize, Serialize};

use super::FitError;
use super::build::suits;
use crate::laws::{Law, Loading, Response};

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
    /// By their square up to 1.345 noise deviations, then by their size (Huber).
    Huber,
    /// Less and less, and from 4.685 noise deviations on not at all (Tukey's biweight).
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
    /// What the residuals show, see [`NoiseModel`](super::NoiseModel).
    #[default]
    FromResiduals,
    /// White, whatever they show.
    White,
}

/// What may be asked of [`fit_law`](super::fit_law).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LawOptions {
    /// Relaxation or creep.
    pub response: Response,
    /// The constant: equilibrium, start or instantaneous part.
    pub constant: ConstantChoice,
    /// Numbers held at a value, by name as in the result: nonlinear ones in s, 1/s or 1, the constant in the unit of the signal.
    /// Amplitudes cannot be held, but bounded.
    pub fixed: Vec<(String, f64)>,
    /// Bounds of numbers, by name as in the result: nonlinear ones in s, 1/s or 1, the constant and amplitudes in the unit of the signal.
    pub bounds: Vec<(String, (f64, f64))>,
    /// Whether all amplitudes have the sign of the change, as those of a passive material must.
    pub one_sign: bool,
    /// How residuals count.
    pub loss: Loss,
    /// Which samples are fitted.
    pub samples: SampleChoice,
    /// What was imposed until the first sample, if that is not to count as a step. The numbers found are then those of a true step.
    /// Laws are taken as linear in it; the latency law, which is not, is fitted to the hold alone, whose start says all
    /// that it needs to know.
    pub loading: Option<Loading>,
    /// Coverage of confidence intervals, between 0 and 1.
    pub confidence: f64,
    /// What intervals take the noise for.
    pub noise: NoiseChoice,
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
            most_iterations: 200,
        }
    }
}

impl LawOptions {
    /// Refuses options that no fit of a law can follow, whatever the samples: what [`fit_law`](super::fit_law) looks at first.
    ///
    /// ```
    /// use palpate::fit::{FitError, LawOptions};
    /// use palpate::laws::Law;
    /// let held = |name: &str| LawOptions { fixed: vec![(name.to_owned(), 2.0)], ..LawOptions::default() };
    /// assert_eq!(held("equilibrium").suit(Law::StandardLinearSolid), Ok(()));
    /// assert!(matches!(held("exponent").suit(Law::StandardLinearSolid), Err(FitError::UnknownNumber { .. })));
    /// ```
    ///
    /// # Errors
    /// [`FitError`] for a law without a form for the response, for numbers that the law does not have or that cannot be held,
    /// values that they cannot have, bounds that do not rise, and a confidence that is none.
    pub fn suit(&self, law: Law) -> Result<(), FitError> {
        let form = law.form(self.response).ok_or(FitError::NoForm {
            law,
            response: self.response,
        })?;
        suits(&form, self)
    }

    /// What a number is held at.
    pub(super) fn held(&self, name: &str) -> Option<f64> {
        self.fixed.iter().find(|(held, _)| held == name).map(|(_, value)| *value)
    }

    /// Refuses options that no fit can follow.
    pub(super) fn check(&self) -> Result<(), FitError> {
        if !(self.confidence > 0.0 && self.confidence < 1.0) {
            return Err(FitError::Confidence { found: self.confidence });
        }
        if let ConstantChoice::Fixed(value) = self.constant
            && !value.is_finite()
        {
            return Err(FitError::FixedNumber {
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
