//! The budget of a result: law of propagation of uncertainty (JCGM 100, clause 5 and annex G).

use serde::{Deserialize, Serialize};

use super::{Cause, Distribution, Evaluation, InputQuantity};
use crate::statistics::{effective_factor, effective_freedom};

/// What one input quantity contributes to the uncertainty of a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contribution {
    /// The input quantity.
    pub input: InputQuantity,
    /// c u(x) in the unit of the result: the change of the result by one standard uncertainty of the input, with its sign.
    pub effect: f64,
}

impl Contribution {
    /// Sensitivity coefficient c = ∂y/∂x; 0 of an input that is exact.
    #[must_use]
    pub fn sensitivity(&self) -> f64 {
        if self.input.standard_uncertainty == 0.0 {
            0.0
        } else {
            self.effect / self.input.standard_uncertainty
        }
    }
}

/// Correlation r of two input quantities, by their places.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Correlation {
    /// One of them.
    pub first: usize,
    /// The other.
    pub second: usize,
    /// r, from −1 to 1.
    pub coefficient: f64,
}

/// The uncertainty of a result by its causes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// The result y at the estimates of its inputs.
    pub value: f64,
    /// What each input contributes.
    pub contributions: Vec<Contribution>,
    /// Inputs that correlate.
    pub correlations: Vec<Correlation>,
}

/// A budget that cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BudgetError {
    /// The model gives no finite result at the estimates, or one standard uncertainty away from one of them.
    #[error("the model has no finite result at {place}")]
    NoResult {
        /// Where.
        place: Place,
    },
    /// A correlation of inputs that are none, of an input with itself, or beyond −1 to 1.
    #[error("correlation {number}: expected two different inputs below {inputs} and a coefficient from -1 to 1")]
    Correlation {
        /// Which, from 1.
        number: usize,
        /// How many inputs there are.
        inputs: usize,
    },
}

/// Where a model was evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// At the estimates of all inputs.
    Estimates,
    /// One standard uncertainty off the estimate of this input, by its place.
    Beside(usize),
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Estimates => f.write_str("the estimates of its inputs"),
            Self::Beside(input) => write!(f, "one standard uncertainty off the estimate of input {}", input + 1),
        }
    }
}

/// The budget of the results `model` gives of its inputs, one for each result.
///
/// The contribution of an input is half the difference of the results one standard uncertainty to either side,
/// c u = (f(x + u) − f(x − u))/2 (JCGM 100, 5.1.3, note 2).
///
/// ```
/// use palpate::budget::{InputQuantity, budget};
/// // A resistor of 100 Ω ± 0.1 Ω at 2 V ± 0.01 V: I = U/R = 20 mA, u = √((0.01/100)² + (2 · 0.1/100²)²) = 0.102 mA
/// let voltage = InputQuantity::standard("voltage", "V", 2.0, 0.01)?;
/// let resistance = InputQuantity::standard("resistance", "Ω", 100.0, 0.1)?;
/// let current = &budget(&[voltage, resistance], &[], |x| vec![x[0] / x[1]])?[0];
/// assert!((current.combined() - 1.019_8e-4).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`BudgetError`] where the model has no finite result, and for correlations that are none.
pub fn budget(
    inputs: &[InputQuantity],
    correlations: &[Correlation],
    model: impl Fn(&[f64]) -> Vec<f64>,
) -> Result<Vec<Budget>, BudgetError> {
    let is_sound = |r: &Correlation| {
        r.first != r.second && r.first.max(r.second) < inputs.len() && (-1.0..=1.0).contains(&r.coefficient)
    };
    if let Some(wrong) = correlations.iter().position(|correlation| !is_sound(correlation)) {
        return Err(BudgetError::Correlation {
            number: wrong + 1,
            inputs: inputs.len(),
        });
    }
    let estimates: Vec<f64> = inputs.iter().map(|input| input.estimate).collect();
    let results = |values: &[f64], place: Place| {
        let results = model(values);
        let is_good = !results.is_empty() && results.iter().all(|result| result.is_finite());
        if is_good { Ok(results) } else { Err(BudgetError::NoResult { place }) }
    };
    let best = results(&estimates, Place::Estimates)?;
    let mut budgets: Vec<Budget> = best
        .into_iter()
        .map(|value| Budget {
            value,
            contributions: Vec::with_capacity(inputs.len()),
            correlations: correlations.to_vec(),
        })
        .collect();
    for (index, input) in inputs.iter().enumerate() {
        let beside = |by: f64| {
            let mut values = estimates.clone();
            values[index] += by;
            results(&values, Place::Beside(index))
        };
        let (high, low) = (beside(input.standard_uncertainty)?, beside(-input.standard_uncertainty)?);
        for (budget, (high, low)) in budgets.iter_mut().zip(high.iter().zip(low)) {
            budget.contributions.push(Contribution {
                input: input.clone(),
                effect: 0.5 * (high - low),
            });
        }
    }
    Ok(budgets)
}

impl Budget {
    /// The budget of a parameter of a fit: the scatter of the samples, a standard uncertainty of Type A with these degrees of freedom, and
    /// what other input quantities contribute.
    pub(crate) fn of_estimate(
        value: f64,
        scatter: f64,
        freedom: f64,
        others: impl IntoIterator<Item = Contribution>,
    ) -> Self {
        let input = InputQuantity {
            name: "scatter of the samples".to_owned(),
            unit: String::new(),
            estimate: value,
            standard_uncertainty: scatter,
            freedom,
            distribution: Distribution::Normal,
            evaluation: Evaluation::A,
            cause: Cause::EachRecord,
        };
        let scatter = Contribution { input, effect: scatter };
        Self {
            value,
            contributions: std::iter::once(scatter).chain(others).collect(),
            correlations: Vec::new(),
        }
    }

    /// Combined standard uncertainty u_c (JCGM 100, equations 11a and 16).
    #[must_use]
    pub fn combined(&self) -> f64 {
        let effect = |index: usize| self.contributions[index].effect;
        let both: f64 =
            self.correlations.iter().map(|r| 2.0 * r.coefficient * effect(r.first) * effect(r.second)).sum();
        (self.variance(|_| true) + both).max(0.0).sqrt()
    }

    /// The part of it that was evaluated this way, correlations left out.
    #[must_use]
    pub fn of(&self, evaluation: Evaluation) -> f64 {
        self.variance(|contribution| contribution.input.evaluation == evaluation).sqrt()
    }

    /// Share of a contribution in the sum of all squared ones, from 0 to 1.
    #[must_use]
    pub fn share(&self, contribution: &Contribution) -> f64 {
        let all = self.variance(|_| true);
        if all == 0.0 { 0.0 } else { contribution.effect.powi(2) / all }
    }

    /// Effective degrees of freedom by Welch and Satterthwaite (JCGM 100, G.2b); infinite where all uncertainties are known.
    #[must_use]
    pub fn freedom(&self) -> f64 {
        let parts = self.contributions.iter().map(|contribution| (contribution.effect, contribution.input.freedom));
        effective_freedom(self.combined(), parts)
    }

    /// Coverage factor k_p = t_p(ν_eff), the effective degrees of freedom truncated (JCGM 100, G.4.1).
    #[must_use]
    pub fn coverage_factor(&self, confidence: f64) -> f64 {
        effective_factor(confidence, self.freedom())
    }

    /// Expanded uncertainty U_p = k_p u_c.
    #[must_use]
    pub fn expanded(&self, confidence: f64) -> f64 {
        self.coverage_factor(confidence) * self.combined()
    }

    fn variance(&self, counts: impl Fn(&Contribution) -> bool) -> f64 {
        self.contributions.iter().filter(|found| counts(found)).map(|found| found.effect.powi(2)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(name: &str, estimate: f64, u: f64) -> InputQuantity {
        InputQuantity::standard(name, "1", estimate, u).unwrap()
    }

    /// JCGM 100, H.1: l = l_s + d − l_s (δα θ + α_s δθ), in nm; u_c = 32 nm, ν_eff = 16, U_99 = 93 nm.
    #[test]
    fn the_end_gauge_of_h_1() {
        let limits = |name: &str, estimate, half, distribution| {
            InputQuantity::limits(name, "1", estimate, half, distribution).unwrap()
        };
        let freedom = |input: InputQuantity, freedom: f64| input.with_freedom(freedom).unwrap();
        let inputs = [
            freedom(input("length of the standard, nm", 50_000_623.0, 25.0), 18.0),
            freedom(input("repeated observations, nm", 215.0, 5.8), 24.0),
            freedom(input("random effects of the comparator, nm", 0.0, 3.9), 5.0),
            freedom(input("systematic effects of the comparator, nm", 0.0, 6.7), 8.0),
            limits("expansion of the standard, 1/K", 11.5e-6, 2e-6, Distribution::Rectangular),
            input("mean temperature of the bed, K", -0.1, 0.2),
            limits("cyclic variation, K", 0.0, 0.5, Distribution::Arcsine),
            freedom(limits("difference of expansion, 1/K", 0.0, 1e-6, Distribution::Rectangular), 50.0),
            freedom(limits("difference of temperature, K", 0.0, 0.05, Distribution::Rectangular), 2.0),
        ];
        let model = |x: &[f64]| {
            let (standard, difference, temperature) = (x[0], x[1] + x[2] + x[3], x[5] + x[6]);
            vec![standard + difference - standard * (x[7] * temperature + x[4] * x[8])]
        };
        let found = &budget(&inputs, &[], model).unwrap()[0];
        assert!((found.value - 50_000_838.0).abs() < 0.5, "{}", found.value);
        let effect = |index: usize| found.contributions[index].effect.abs();
        assert!((effect(7) - 2.9).abs() < 0.05 && (effect(8) - 16.6).abs() < 0.05, "{} {}", effect(7), effect(8));
        assert!((found.combined() - 31.7).abs() < 0.1, "{}", found.combined());
        assert_eq!(found.freedom().floor(), 16.0);
        assert!((found.coverage_factor(0.99) - 2.92).abs() < 0.005);
        // The example rounds u_c to 32 nm before it is multiplied.
        assert!((found.expanded(0.99) - 93.0 * found.combined() / 32.0).abs() < 0.5, "{}", found.expanded(0.99));
    }

    /// JCGM 100, H.2: R = V/I cos φ, X = V/I sin φ, Z = V/I of simultaneous observations; u = 0.071, 0.295, 0.236 Ω.
    #[test]
    fn the_correlated_inputs_of_h_2() {
        let inputs =
            [input("V", 4.9990, 0.0032), input("I", 19.6610e-3, 0.0095e-3), input("phase", 1.044_46, 0.000_75)];
        let r = |first, second, coefficient| Correlation {
            first,
            second,
            coefficient,
        };
        let model = |x: &[f64]| {
            let z = x[0] / x[1];
            vec![z * x[2].cos(), z * x[2].sin(), z]
        };
        let found = budget(&inputs, &[r(0, 1, -0.36), r(0, 2, 0.86), r(1, 2, -0.65)], model).unwrap();
        for (budget, (value, u)) in found.iter().zip([(127.732, 0.071), (219.847, 0.295), (254.260, 0.236)]) {
            assert!((budget.value - value).abs() < 1e-3 * value, "{}", budget.value);
            assert!((budget.combined() / u - 1.0).abs() < 0.02, "{} {u}", budget.combined());
        }
        assert!(budget(&inputs, &[r(0, 3, 0.5)], model).is_err() && budget(&inputs, &[r(0, 1, 1.5)], model).is_err());
        assert!(budget(&inputs, &[], |_| vec![f64::NAN]).is_err());
    }
}
