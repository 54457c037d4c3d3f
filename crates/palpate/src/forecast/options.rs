//! Options of a comparison.

use serde::{Deserialize, Serialize};

use crate::fit::LawOptions;
use crate::laws::{ExponentChoice, Law, Response};

/// What linear laws take the loading before a hold for. The latency law needs no choice: all that it remembers of a loading is
/// the excess at its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RampChoice {
    /// A step at the start of the fit, as is usual: right where the ramp is short beside all times of the law.
    #[default]
    Step,
    /// What was measured, by the hereditary integral; of use to [`analyze`](crate::analysis::analyze) and
    /// [`creep_holds`](crate::analysis::creep_holds), which know the ramp.
    Measured,
}

/// Options of [`compare_laws`](crate::forecast::compare_laws).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct CompareOptions {
    /// Laws that are compared; if empty, all that suit the response.
    pub laws: Vec<Law>,
    /// Options of every fit.
    pub fit: LawOptions,
    /// What linear laws take the loading before a hold for.
    pub ramps: RampChoice,
    /// Cut points as shares of the duration of the hold, each between 0 and 1.
    pub cuts: Vec<f64>,
    /// Whether the laws are combined to a forecast of what follows the hold too.
    pub forecast: bool,
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self {
            laws: Vec::new(),
            fit: LawOptions::default(),
            ramps: RampChoice::default(),
            cuts: vec![0.25, 1.0 / 3.0, 0.5],
            forecast: true,
        }
    }
}

impl CompareOptions {
    /// The laws that will be compared.
    #[must_use]
    pub fn laws(&self) -> Vec<Law> {
        if !self.laws.is_empty() {
            return self.laws.clone();
        }
        let latency = |exponent| Law::Latency { exponent };
        let all = [
            latency(ExponentChoice::Free),
            latency(ExponentChoice::Fixed(5.0)),
            Law::StandardLinearSolid,
            Law::Prony { terms: 2 },
            Law::Prony { terms: 3 },
            Law::Spectrum,
            Law::Stretched,
            Law::FractionalZener,
            Law::FungContinuous,
            Law::Power,
            Law::Logarithmic,
            Law::Diffusion,
        ];
        let creep = [Law::KelvinVoigt, Law::Burgers];
        let extra = creep.into_iter().filter(|_| self.fit.response == Response::Creep);
        all.into_iter().chain(extra).filter(|law| law.describes(self.fit.response)).collect()
    }
}
