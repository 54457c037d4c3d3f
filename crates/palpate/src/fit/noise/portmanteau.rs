//! Whether a model of the noise accounts for the residuals that it was found from.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::model::NoiseModel;
use crate::statistics::dot;
use crate::vector::add_multiple;

/// The probability below which residuals are not of the kind of noise that was found, and intervals do not rest on it alone.
pub(crate) const UNEXPLAINED: f64 = 1e-3;

/// Lags that are tested.
const LAGS: usize = 20;

/// Fewest samples that are tested.
const FEWEST: usize = 100;

/// Most samples that are tested: of more, those in the middle.
const MOST: usize = 1 << 13;

/// Most samples that a prediction looks back.
const MEMORY: usize = 64;

/// The probability that noise of this model has innovations which correlate as much as those of the residuals (Ljung and Box 1978):
///
/// ```text
/// Q = N (N + 2) Σ_k r_k²/(N − k),  k = 1 … 20
/// ```
///
/// follows χ² of 20 − m degrees of freedom for a model of m parameters. `None` for few samples, and for noise in time.
pub(crate) fn p_value(residuals: &[f64], model: NoiseModel) -> Option<f64> {
    let parameters = parameters(model)?;
    let middle = &residuals[residuals.len().saturating_sub(MOST) / 2..];
    let some = &middle[..middle.len().min(MOST)];
    if some.len() < FEWEST {
        return None;
    }
    let memory = MEMORY.min(some.len() / 4);
    let innovations = innovations(some, &predictor(&model.correlations(memory)));
    let (count, square) = (innovations.len() as f64, dot(&innovations, &innovations));
    let of_lag = |lag: usize| {
        let correlation = dot(&innovations[lag..], &innovations[..innovations.len() - lag]) / square;
        correlation * correlation / (count - lag as f64)
    };
    let sum = count * (count + 2.0) * (1..=LAGS).map(of_lag).sum::<f64>();
    let expected = ChiSquared::new((LAGS - parameters) as f64).ok()?;
    sum.is_finite().then(|| expected.sf(sum))
}

/// Parameters of a model of evenly spaced samples.
fn parameters(model: NoiseModel) -> Option<usize> {
    match model {
        NoiseModel::White => Some(0),
        NoiseModel::Autoregressive { .. } | NoiseModel::WhiteAndWalk { .. } => Some(1),
        NoiseModel::AutoregressiveOfOrder { order, .. } => Some(order),
        NoiseModel::WhiteAndAutoregressive { .. } => Some(2),
        NoiseModel::PowerLaw { share, .. } => Some(if share < 1.0 { 2 } else { 1 }),
        NoiseModel::InTime { .. } => None,
    }
}

/// Coefficients of the best prediction by the samples before, of the last before first, for these correlations (Levinson and Durbin).
fn predictor(correlations: &[f64]) -> Vec<f64> {
    let (mut kept, mut variance): (Vec<f64>, f64) = (Vec::new(), 1.0);
    for (k, correlation) in correlations.iter().enumerate() {
        let explained: f64 = kept.iter().zip(correlations[..k].iter().rev()).map(|(by, r)| by * r).sum();
        let by = (correlation - explained) / variance;
        if by.is_nan() || by.abs() >= 1.0 {
            break;
        }
        let mut longer: Vec<f64> = kept.iter().zip(kept.iter().rev()).map(|(ahead, back)| ahead - by * back).collect();
        longer.push(by);
        kept = longer;
        variance *= 1.0 - by * by;
    }
    kept
}

/// Errors of predictions, of the first sample that enough lie before and all after.
fn innovations(residuals: &[f64], predictor: &[f64]) -> Vec<f64> {
    let mut errors = residuals[predictor.len()..].to_vec();
    for (back, by) in (1..).zip(predictor) {
        add_multiple(&mut errors, -by, &residuals[predictor.len() - back..]);
    }
    errors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::noise::model::Noise;
    use crate::fit::noise::residuals::Residuals;
    use crate::test_problems::Rng;

    fn found(noise: &[f64]) -> f64 {
        let mean = noise.iter().sum::<f64>() / noise.len() as f64;
        let left: Vec<f64> = noise.iter().map(|value| value - mean).collect();
        let model = Noise::of(&[&vec![1.0; noise.len()]], &Residuals::of(&left, 1), None).model;
        p_value(&left, model).unwrap()
    }

    /// e_i = Σ_k a_k e_{i−k} + w_i.
    fn autoregressive(seed: u64, poles: &[f64], count: usize) -> Vec<f64> {
        let mut random = Rng::new(seed);
        let mut made: Vec<f64> = Vec::new();
        for _ in 0..count + 200 {
            let kept: f64 = poles.iter().zip(made.iter().rev()).map(|(pole, before)| pole * before).sum();
            made.push(kept + random.normal());
        }
        made.split_off(200)
    }

    #[test]
    fn the_prediction_of_an_autoregression_is_the_autoregression() {
        let model = NoiseModel::AutoregressiveOfOrder {
            order: 2,
            partial: [0.6, -0.3, 0.0, 0.0, 0.0, 0.0],
        };
        // Levinson: a₁ = 0.6 (1 + 0.3), a₂ = −0.3.
        let found = predictor(&model.correlations(6));
        let expected = [0.78, -0.3, 0.0, 0.0, 0.0, 0.0];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
    }

    #[test]
    fn noise_that_a_model_describes_is_seldom_refused_and_a_line_is() {
        let count = |refused: &dyn Fn(u64) -> bool| (0..200).filter(|seed| refused(*seed)).count();
        for poles in [&[][..], &[0.8], &[-0.6], &[1.2, -0.5]] {
            let refused = count(&|seed| found(&autoregressive(seed, poles, 400)) < 1e-3);
            assert!(refused <= 3, "{poles:?}: {refused} of 200");
        }
        let line = |seed: u64| -> Vec<f64> {
            let white = autoregressive(seed, &[], 400);
            white.iter().enumerate().map(|(i, w)| w + 3.0 * (0.817 * i as f64).sin()).collect()
        };
        let refused = count(&|seed| found(&line(seed)) < 1e-3);
        assert!(refused > 160, "{refused} of 200");
    }
}
