//! Propagation of distributions by a Monte Carlo method (JCGM 101, clauses 6 and 7).

use serde::{Deserialize, Serialize};

use super::InputQuantity;
use crate::random::Rng;

/// A result whose distribution was drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MonteCarlo {
    /// Mean of the drawn results.
    pub mean: f64,
    /// Their standard deviation.
    pub standard_uncertainty: f64,
    /// Ends of the probabilistically symmetric coverage interval.
    pub interval: (f64, f64),
    /// Ends of the shortest coverage interval.
    pub shortest: (f64, f64),
    /// Trials that had a finite result.
    pub trials: usize,
}

/// A propagation of distributions that cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MonteCarloError {
    /// Too few trials for an interval of this coverage.
    #[error("a coverage of {confidence} needs {needed} trials or more, found {found}")]
    TooFew {
        /// The coverage.
        confidence: f64,
        /// 20/(1 − coverage).
        needed: usize,
        /// How many were requested, or had a finite result.
        found: usize,
    },
    /// A coverage that is not between 0 and 1.
    #[error("a coverage must be between 0 and 1, found {found}")]
    Coverage {
        /// What was given.
        found: f64,
    },
}

/// Draws all inputs `trials` times and gives the distributions of the results of `model`; trials without a finite result do not count.
///
/// ```
/// use palpate::budget::{Distribution, InputQuantity, monte_carlo};
/// // JCGM 101, 9.2.3: the sum of four rectangular quantities with u = 1 each has u = 2 and an interval of ±3.88, not ±3.92.
/// let four = vec![InputQuantity::limits("X", "1", 0.0, 3f64.sqrt(), Distribution::Rectangular)?; 4];
/// let sum = &monte_carlo(&four, 200_000, 0.95, 1, |x| vec![x.iter().sum()])?[0];
/// assert!((sum.standard_uncertainty - 2.0).abs() < 0.01);
/// assert!((sum.interval.1 - 3.88).abs() < 0.03);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`MonteCarloError`] for a coverage that is none, and too few trials for it.
pub fn monte_carlo(
    inputs: &[InputQuantity],
    trials: usize,
    confidence: f64,
    seed: u64,
    mut model: impl FnMut(&[f64]) -> Vec<f64>,
) -> Result<Vec<MonteCarlo>, MonteCarloError> {
    if !(confidence > 0.0 && confidence < 1.0) {
        return Err(MonteCarloError::Coverage { found: confidence });
    }
    // So that some ten trials lie beyond either end.
    let needed = (20.0 / (1.0 - confidence)).ceil() as usize;
    let enough = |found: usize| {
        if found >= needed {
            Ok(())
        } else {
            Err(MonteCarloError::TooFew {
                confidence,
                needed,
                found,
            })
        }
    };
    enough(trials)?;
    let mut random = Rng::new(seed);
    let mut drawn: Vec<Vec<f64>> = Vec::new();
    let mut values = vec![0.0; inputs.len()];
    for _ in 0..trials {
        values.iter_mut().zip(inputs).for_each(|(value, input)| *value = input.draw(&mut random));
        let results = model(&values);
        drawn.resize_with(drawn.len().max(results.len()), Vec::new);
        for (all, result) in drawn.iter_mut().zip(results) {
            all.extend(Some(result).filter(|result| result.is_finite()));
        }
    }
    drawn.into_iter().map(|all| enough(all.len()).map(|()| summary(all, confidence))).collect()
}

fn summary(mut drawn: Vec<f64>, confidence: f64) -> MonteCarlo {
    drawn.sort_by(f64::total_cmp);
    let count = drawn.len();
    let mean = drawn.iter().sum::<f64>() / count as f64;
    let square: f64 = drawn.iter().map(|result| (result - mean).powi(2)).sum();
    // JCGM 101, 7.7: q of the trials lie between the ends.
    let inside = (confidence * count as f64).round() as usize;
    let ends = |low: usize| (drawn[low], drawn[(low + inside).min(count - 1)]);
    let last = count - inside.min(count - 1);
    let width = |low: &usize| ends(*low).1 - ends(*low).0;
    let shortest = (0..last).min_by(|a, b| width(a).total_cmp(&width(b))).unwrap_or(0);
    MonteCarlo {
        mean,
        standard_uncertainty: (square / (count - 1) as f64).sqrt(),
        interval: ends((count - inside) / 2),
        shortest: ends(shortest),
        trials: count,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::{Distribution, budget};

    fn numbers(names: [&str; 2], values: [(f64, f64); 2]) -> Vec<InputQuantity> {
        let input = |(name, (x, u)): (&str, (f64, f64))| InputQuantity::standard(name, "1", x, u).unwrap();
        names.into_iter().zip(values).map(input).collect()
    }

    /// JCGM 101, 9.4.2.2: |Γ|² = x₁² + x₂² with u = 0.005 at zero: mean 50e-6, u = 50e-6, shortest 95 % interval to 150e-6, where the law of
    /// propagation has u = 0.
    #[test]
    fn the_mismatch_loss_of_jcgm_101() {
        let inputs = numbers(["x1", "x2"], [(0.0, 0.005); 2]);
        let model = |x: &[f64]| vec![x[0] * x[0] + x[1] * x[1]];
        let found = &monte_carlo(&inputs, 400_000, 0.95, 5, model).unwrap()[0];
        assert!((found.mean - 50e-6).abs() < 0.5e-6, "{found:?}");
        assert!((found.standard_uncertainty - 50e-6).abs() < 0.5e-6, "{found:?}");
        assert!(found.shortest.0 < 0.5e-6 && (found.shortest.1 - 150e-6).abs() < 2e-6, "{found:?}");
        assert_eq!(budget(&inputs, &[], model).unwrap()[0].combined(), 0.0);
    }

    #[test]
    fn draws_have_the_standard_uncertainty_that_is_stated() {
        for distribution in [Distribution::Rectangular, Distribution::Triangular, Distribution::Arcsine] {
            let input = InputQuantity::limits("x", "1", 3.0, 1.0, distribution).unwrap();
            let found = &monte_carlo(std::slice::from_ref(&input), 100_000, 0.95, 1, <[f64]>::to_vec).unwrap()[0];
            assert!((found.standard_uncertainty / input.standard_uncertainty - 1.0).abs() < 0.01, "{distribution:?}");
            assert!(found.interval.0 >= 2.0 && found.interval.1 <= 4.0);
        }
        // Student's t of ν = 5 has the deviation u √(ν/(ν − 2)) (JCGM 101, 6.4.9.4) and the quantile 2.571.
        let few = InputQuantity::standard("x", "1", 0.0, 1.0).unwrap().with_freedom(5.0).unwrap();
        let found = &monte_carlo(&[few], 200_000, 0.95, 2, <[f64]>::to_vec).unwrap()[0];
        assert!((found.standard_uncertainty - (5.0f64 / 3.0).sqrt()).abs() < 0.02, "{found:?}");
        assert!((found.interval.1 - 2.571).abs() < 0.05, "{found:?}");
        let too_few = monte_carlo(&[], 100, 0.95, 1, |_| vec![1.0]);
        assert!(matches!(too_few, Err(MonteCarloError::TooFew { needed: 400, .. })));
    }
}
