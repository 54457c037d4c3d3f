//! A law with its parameters put in.

use serde::{Deserialize, Serialize};

use super::{BasisFunction, Column, Kernel, Loading, Response, Superposition};

/// One term of a [`LawCurve`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct Term {
    /// In the unit of the signal.
    pub amplitude: f64,
    /// The shape.
    pub shape: BasisFunction,
    /// Its parameters: ln of rates in 1/s, dimensionless parameters as they are.
    pub parameters: Vec<f64>,
}

checked_when_read!(Term, "as many parameters as the shape has", |term: &Term| {
    term.parameters.len() == term.shape.parameters().len()
});

/// A law of relaxation or creep with its parameters put in: a function of time, the answer to a step.
///
/// y(t) = constant + Σ amplitude · shape(t) in relaxation. In creep a shape that decays counts as 1 − shape; in relaxation one that
/// grows counts negative.
///
/// ```
/// use palpate::laws::{LawCurve, Response, BasisFunction, Term};
/// // 2 N + 3 N exp(−t/4 s)
/// let term = Term { amplitude: 3.0, shape: BasisFunction::Exponential, parameters: vec![0.25f64.ln()] };
/// let curve = LawCurve { response: Response::Relaxation, constant: 2.0, terms: vec![term] };
/// assert!((curve.at(4.0) - (2.0 + 3.0 * (-1.0f64).exp())).abs() < 1e-14);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawCurve {
    /// Relaxation or creep.
    pub response: Response,
    /// What stands beside the terms, in the unit of the signal.
    pub constant: f64,
    /// The terms.
    pub terms: Vec<Term>,
}

impl LawCurve {
    /// A curve given as a relaxation, `equilibrium` + Σ amplitude · shape, reported as `response`: y₀ − Σ amplitude (1 − shape) is the
    /// same in the words of creep.
    pub(crate) fn relaxing(response: Response, equilibrium: f64, mut terms: Vec<Term>) -> Self {
        let mut constant = equilibrium;
        if response == Response::Creep {
            for term in &mut terms {
                constant += term.amplitude;
                term.amplitude = -term.amplitude;
            }
        }
        Self {
            response,
            constant,
            terms,
        }
    }

    /// The signal a time `elapsed` (s) after the start; before it, the value at the start.
    #[must_use]
    pub fn at(&self, elapsed: f64) -> f64 {
        let mut value = [0.0];
        self.fill(None, &[elapsed], &mut value);
        value[0]
    }

    /// The signal at many times; before the start the value at the start, NaN at one that is NaN.
    #[must_use]
    pub fn values(&self, elapsed: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; elapsed.len()];
        self.fill(None, elapsed, &mut values);
        values
    }

    /// The signal in the hold that follows a loading, `elapsed` s after its start: what the law, as a linear one, answers.
    ///
    /// A term of the latency law, which is not linear, stays as it is: its amplitude is what is left at the start of the hold.
    ///
    /// ```
    /// use palpate::laws::{LawCurve, Loading, Response, BasisFunction, Term};
    /// // After a ramp of one relaxation time 1 − 1/e of the amplitude remains.
    /// let term = Term { amplitude: 3.0, shape: BasisFunction::Exponential, parameters: vec![0.25f64.ln()] };
    /// let curve = LawCurve { response: Response::Relaxation, constant: 2.0, terms: vec![term] };
    /// let start = curve.after(&Loading::ramp(4.0)?, &[0.0])[0];
    /// assert!((start - (2.0 + 3.0 * (1.0 - (-1.0f64).exp()))).abs() < 1e-14);
    /// # Ok::<(), palpate::laws::LoadingError>(())
    /// ```
    #[must_use]
    pub fn after(&self, loading: &Loading, elapsed: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; elapsed.len()];
        self.fill(Some(&Superposition::new(loading)), elapsed, &mut values);
        values
    }

    fn fill(&self, loading: Option<&Superposition>, elapsed: &[f64], out: &mut [f64]) {
        let times: Vec<f64> = elapsed.iter().map(|t| t.max(0.0)).collect();
        let mut shape = vec![0.0; times.len()];
        out.fill(self.constant);
        for term in &self.terms {
            let column = Column::of(&term.shape, self.response);
            match loading {
                None => term.shape.value(&times, &term.parameters, &mut shape),
                Some(loading) => loading.value(&term.shape, &times, &term.parameters, &mut shape),
            }
            for (out, value) in out.iter_mut().zip(&shape) {
                *out += term.amplitude * (column.offset + column.sign * value);
            }
        }
        // f64::max takes NaN for the start.
        for (out, _) in out.iter_mut().zip(elapsed).filter(|(_, t)| t.is_nan()) {
            *out = f64::NAN;
        }
    }
}
